"""What counts as a test, and where tests are searched."""

from collections.abc import Callable
from pathlib import Path

import pytest

from jacaros.runtime.errors import UsageError
from jacaros.testing.suites import collect, suite_of

Write = Callable[..., Path]

PASSES = "@passes[test] +!passing <- !assert_true(true)."


@pytest.fixture
def write(tmp_path: Path) -> Write:
    """Writes a file and returns its path."""

    def write_file(name: str, text: str = PASSES) -> Path:
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        return path

    return write_file


def names(suite_path: Path) -> list[str]:
    suite = suite_of(suite_path)
    assert suite.error is None
    return [test.name for test in suite.tests]


def test_plans_labelled_test_are_tests_in_their_order(write: Write) -> None:
    text = "@b[test] +!one. +!two. @[atomic, test] +!three. @a[test] +!four(X) : p(X)."
    assert names(write("t.asl", text)) == ["b", "three", "a"]


def test_alternatives_of_one_goal_are_one_test(write: Write) -> None:
    assert names(write("t.asl", "@a[test] +!g : p. @b[test] +!g.")) == ["a"]


def test_two_tests_with_one_goal_test_its_first_plan_twice(write: Write) -> None:
    suite = suite_of(write("t.asl", "@a[test] +!g(X) <- .print(X). @b[test] +!g(Y) <- .print(Y)."))
    assert [test.name for test in suite.tests] == ["a", "b"]
    told = "t.asl:1:31: warning: unreachable test: an earlier plan for !g(_) is always applicable"
    assert any(told in warning for warning in suite.warnings)


def test_jason_s_own_copies_of_its_test_library_are_ours(write: Write) -> None:
    write("tester_agent.asl", '{ include("$jasonJar/test/jason/inc/test_assert.asl") }\n!execute_test_plans.')
    suite = suite_of(write("t.asl", '{ include("tester_agent.asl") } @a[test] +!g <- !assert_equals(1, 1).'))
    assert suite.deployment is not None
    assert [test.name for test in suite.tests] == ["a"]


def test_a_test_without_a_goal_is_an_error(write: Write) -> None:
    suite = suite_of(write("t.asl", "@a[test] +p <- .print(p)."))
    assert suite.error is not None
    assert "a test is a plan for a goal" in suite.error


def test_a_label_gives_a_time_limit_in_milliseconds(write: Write) -> None:
    tests = suite_of(write("t.asl", "@a[test, timeout(2500)] +!g. @b[test] +!h.")).tests
    assert [test.timeout for test in tests] == [2.5, None]


def test_folders_give_the_files_that_have_tests_themselves(write: Write, tmp_path: Path) -> None:
    write("a/charging.asl")
    write("a/robot.asl", "+!drive. // no @a[test] here")
    write("b/test_shared.asl", '{ include("../a/charging.asl") } @more[test] +!more.')
    write(".hidden/test_x.asl")
    suites = collect([tmp_path])
    assert [suite.path.relative_to(tmp_path).as_posix() for suite in suites] == [
        "a/charging.asl",
        "b/test_shared.asl",
    ]
    assert [test.name for suite in suites for test in suite.tests] == ["passes", "more"]


def test_an_unreadable_test_file_is_an_error(write: Write, tmp_path: Path) -> None:
    write("test_wrong.asl", "+!g <- .print(.")
    write("other_wrong.asl", "+!g <- .print(.")
    (suite,) = collect([tmp_path])
    assert suite.path.name == "test_wrong.asl"
    assert suite.error is not None
    assert "test_wrong.asl:1:" in suite.error


def test_a_test_project_includes_the_programs_of_its_agents(write: Write, tmp_path: Path) -> None:
    write("boss.asl", "@asks[test] +!ask.")
    write("test_team.mas2j", "MAS team { agents: boss; worker #3; }")
    write("worker.asl", "@works[test] +!work.")
    write("team.mas2j", "MAS team { agents: boss; worker #3; }")
    (suite,) = collect([tmp_path])
    assert suite.path.name == "test_team.mas2j"
    assert [(test.agent, test.name) for test in suite.tests] == [("boss", "asks"), ("worker1", "works")]


def test_a_file_is_collected_once(write: Write, tmp_path: Path) -> None:
    file = write("test_a.asl")
    assert len(collect([file, tmp_path, file])) == 1


def test_a_missing_path_is_wrong_usage(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="file not found"):
        collect([tmp_path / "nothing.asl"])
    with pytest.raises(UsageError, match=r"expected \.asl, \.mas2j, \.jcm or a folder"):
        collect([tmp_path / "nothing.txt"])


@pytest.mark.parametrize(
    "path",
    [
        "$jasonJar/test/jason/inc/tester_agent.asl",
        "$jason/test/jason/inc/tester_agent.asl",
        "$jacaros/tester_agent.asl",
        "tester_agent.asl",
        "inc/tester_agent.asl",
        "$jasonJar/test/jason/inc/test_assert.asl",
        "test_assert.asl",
        "test_manager.asl",
        "$jasonJar/test/jason/inc/test_performance.asl",
    ],
)
def test_the_harness_of_jason_can_be_included_by_all_its_names(write: Write, path: str) -> None:
    suite = suite_of(write("t.asl", f'{{ include("{path}") }} {{ include("tester_agent.asl") }} {PASSES}'))
    assert suite.error is None
    assert suite.warnings == []
    assert [test.name for test in suite.tests] == ["passes"]


def test_a_file_of_the_user_wins_over_that_of_the_harness(write: Write) -> None:
    write("tester_agent.asl", "@own[test] +!own.")
    assert names(write("t.asl", '{ include("tester_agent.asl") }')) == ["own"]


def test_tests_need_no_include_and_bring_no_warnings(write: Write) -> None:
    suite = suite_of(write("t.asl", "@a[test] +!g <- !assert_equals(1, 1); !assert_did(x)."))
    assert (suite.error, suite.warnings) == (None, [])


def test_programs_of_the_project_are_found_from_a_folder_of_tests(write: Write) -> None:
    write("build.gradle", "")
    write("src/asl/bob.asl", "sum(X, Y, X + Y).")
    assert names(write("src/test/jason/asl/test_bob.asl", '{ include("bob.asl") } @a[test] +!g.')) == ["a"]
