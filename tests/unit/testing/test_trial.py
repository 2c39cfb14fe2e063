"""Running agent tests: what passes, what fails, and the report."""

import signal
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from jacaros.runtime.alarm import SIGNAL
from jacaros.runtime.mas.agents.programs import SourcePath
from jacaros.runtime.mas.checks.files import check_files
from jacaros.testing.suites import Outcome, suite_of
from jacaros.testing.trial import TrialOptions, run_suite

Outcomes = Callable[..., list[Outcome]]
BRIEF = TrialOptions(timeout=10.0, cycles=20_000)


@pytest.fixture
def outcomes(tmp_path: Path) -> Outcomes:
    """Runs the tests of a program, with other files beside it."""

    def run_program(text: str, options: TrialOptions = BRIEF, **others: str) -> list[Outcome]:
        for name, other in others.items():
            (tmp_path / name.replace("_asl", ".asl").replace("_py", ".py")).write_text(
                other, encoding="utf-8"
            )
        path = tmp_path / "t.asl"
        path.write_text(text, encoding="utf-8")
        suite = suite_of(path)
        assert suite.error is None
        return list(run_suite(suite, options))

    return run_program


@pytest.fixture
def told(outcomes: Outcomes, tmp_path: Path) -> Callable[..., str]:
    """Return the report about the only test of a program, which fails."""

    def tell(text: str, **others: object) -> str:
        (outcome,) = outcomes(text, **others)
        assert not outcome.passed
        return "\n".join(outcome.lines()).replace(f"{tmp_path}/", "")

    return tell


@pytest.mark.parametrize(
    "assertion",
    [
        "assert_equals(2, 1 + 1)",
        "assert_equals(f(X), f(X))",
        "assert_equals([1, 2], [2, 1])",
        "assert_equals(3.9, 3.95, 0.1)",
        "assert_equals(2, .length([a, b]))",
        "assert_not_equals(1, 2)",
        "assert_not_equals([1], [2])",
        "assert_true(p(1) & not p(3))",
        "assert_true(.string(\"x\"))",
        "assert_true(p(X))",
        "assert_false(p(3))",
        "assert_contains([a, f(b)], f(_))",
        "assert_not_contains([a, b], c)",
        "assert_greater_than(2, 1)",
        "assert_greater_than_equals(2, 2)",
        "assert_between(2, 2, 3)",
        "assert_fail(no_plan_for_this)",
        "force_pass",
    ],
)  # fmt: skip
def test_an_assertion_that_holds_passes(outcomes: Outcomes, assertion: str) -> None:
    (outcome,) = outcomes(f"p(1). p(2). @t[test] +!t <- !{assertion}.")
    assert outcome.problems == []
    assert outcome.assertions == 1


@pytest.mark.parametrize(
    ("assertion", "lines"),
    [
        ("assert_equals(2, 3)", ["expected  2", "but       was 3"]),
        ("assert_equals(2, two)", ["expected  2", "but       was two"]),
        ("assert_equals([1, 2], [1])", ["expected  [1,2]", "but       was [1]"]),
        ("assert_equals(p[a], p[b])", ["expected  p[a]", "but       was p[b]"]),
        ("assert_equals(1, 1.2, 0.1)", ["expected  1 +/- 0.1", "but       was 1.2"]),
        ("assert_equals(1, one, 0.1)", ["expected  1 +/- 0.1", "but       was one"]),
        ("assert_not_equals(1, 1)", ["expected  anything but 1", "but       was 1"]),
        (
            "assert_true(p(3))",
            ["expected  p(3)", "the agent believes p(1)[source(self)], p(2)[source(self)]"],
        ),
        ("assert_true(q(3))", ["expected  q(3)", "no belief q/1"]),
        ("assert_true(p(1) & q)", ["expected  (p(1) & q)", "but       it does not hold"]),
        ("assert_false(p(1))", ["expected  not p(1)", "but       it holds"]),
        ("assert_contains([a], b)", ["expected  b", "but       [a] does not contain it"]),
        ("assert_contains(7, b)", ["expected  b", "but       7 is not a list or set"]),
        ("assert_not_contains([a], a)", ["expected  no a", "but       [a] contains it"]),
        ("assert_greater_than(1, 1)", ["expected  more than 1", "but       was 1"]),
        ("assert_greater_than(one, 0)", ["expected  more than 0", "but       was one"]),
        ("assert_greater_than_equals(1, 2)", ["expected  2 or more", "but       was 1"]),
        ("assert_between(4, 1, 3)", ["expected  1 to 3", "but       was 4"]),
        ("assert_fail(fine)", ["expected  !fine to fail", "but       it was achieved"]),
        ('force_failure("no such day")', ["because   no such day"]),
        ("assert_did(go(_))", ["expected  go(_)", "but       it did nothing"]),
    ],
)
def test_an_assertion_that_does_not_hold_fails_with_place_and_values(
    outcomes: Outcomes, assertion: str, lines: list[str]
) -> None:
    (outcome,) = outcomes(f"p(1). p(2). +!fine.\n@t[test] +!t <-\n   !{assertion}.")
    (problem,) = outcome.problems
    assert problem.message == f"{assertion.partition('(')[0]} failed"
    assert problem.span is not None
    assert (problem.span.line, problem.span.column) == (3, 4)
    shown = "\n".join(problem.details)
    assert [line for line in lines if line not in shown] == []


@pytest.mark.parametrize("name", ["assert_true", "assert_false"])
def test_a_formula_that_cannot_be_evaluated_fails_its_assertion(outcomes: Outcomes, name: str) -> None:
    (outcome,) = outcomes(f"q :- 1 div 0 > 2. @t[test] +!t <-\n !{name}(q); .print(end).")
    assert [problem.message for problem in outcome.problems] == [f"{name} failed"]
    assert outcome.problems[0].span is not None
    assert outcome.problems[0].span.line == 2
    assert outcome.output[-1] == "[t] end"


def test_a_test_continues_after_a_failed_assertion(outcomes: Outcomes) -> None:
    (outcome,) = outcomes(
        "@t[test] +!t <- !assert_true(a); !assert_true(true); !assert_true(b); .print(end)."
    )
    assert [problem.details[0] for problem in outcome.problems] == ["expected  a", "expected  b"]
    assert outcome.assertions == 3
    assert outcome.output == ["[t] end"]


def test_a_failure_has_the_location_of_the_executed_branch(outcomes: Outcomes) -> None:
    (outcome,) = outcomes(
        "@t[test] +!t <-\n if (b) {\n !assert_true(x)\n } else {\n !assert_equals(1, 2)\n }; .print(end)."
    )
    assert outcome.problems[0].span is not None
    assert outcome.problems[0].span.line == 5


def test_each_test_starts_with_a_new_agent(outcomes: Outcomes) -> None:
    both = "@a[test] +!a <- +p. @b[test] +!b <- !assert_false(p)."
    assert [outcome.passed for outcome in outcomes(both)] == [True, True]


def test_a_plan_before_an_include_overrides_an_included_one(outcomes: Outcomes) -> None:
    program = '+!start. { include("robot.asl") } @t[test] +!t <- .wait(10); !assert_false(started).'
    (outcome,) = outcomes(program, robot_asl="!start. +!start <- +started.")
    assert outcome.passed


def test_assertions_of_separate_goals_count(outcomes: Outcomes) -> None:
    (outcome,) = outcomes("@t[test] +!t <- !!later. +!later <- .wait(500); !assert_true(false).")
    assert [problem.message for problem in outcome.problems] == ["assert_true failed"]


def test_a_busy_run_does_not_delay_the_end_of_a_test(outcomes: Outcomes) -> None:
    endless = "!tick. +!tick <- .wait(10); !tick. "
    busy = "!tick. +!tick <- !tick. "
    for begin in (endless, busy):
        (outcome,) = outcomes(begin + "@t[test] +!t <- .print(done).")
        assert outcome.passed
        assert outcome.simulated <= 1.0


def test_a_goal_that_fails_fails_its_test(told: Callable[..., str]) -> None:
    assert told("@t[test] +!t <-\n !help. +!help <-\n .fail(broken(leg), error_msg(\"ouch\")).") == (
        "t.asl:3:2: the goal of the test failed: internal_action\n"
        '  3 |  .fail(broken(leg), error_msg("ouch")).\n'
        "    |  ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^\n"
        "  ouch\n"
        '  step: .fail(...), for !help, !t\n'
        "  reason: broken(leg)"
    )  # fmt: skip


ENDLESS = "did not end within 20000 reasoning cycles: an endless loop?"
UNHANDLED = "agent t: the goal !other failed and has no plan for its failure"


@pytest.mark.parametrize(
    ("test", "parts"),
    [
        ("+!t <- !absent(1).", ["no relevant plan for !absent(1)"]),
        ("+!t : never <- .print(x).", ["no applicable plan for !t"]),
        ("+!t <- !!other; .wait(50). +!other <- ?nothing(X).", [UNHANDLED, "test_goal_failed"]),
        ("+!t <- .nth(7, [a], X); .print(X).", ["the goal of the test failed: "]),
        ("+!t <- !t.", [ENDLESS]),
        ("+!t <- while (true) { +p; -p }.", ["an endless loop?"]),
        ("+!t <- .drop_intention.", ["its intention was dropped"]),
        ("+!t <- .stopMAS; .wait(10).", ["(.stopMAS)"]),
        ("+!t <- !fake_action(drive, soon).", ["invalid outcome soon"]),
        (
            "+!t <- !fake_action(drive(_), never);\n drive(3).",
            ["t.asl:2:2: the test did not end", "it waits for drive(3)"],
        ),
    ],
)
def test_a_failure_says_what_went_wrong(told: Callable[..., str], test: str, parts: list[str]) -> None:
    shown = told(f"@t[test] {test}")
    assert [part for part in parts if part not in shown] == []


def test_a_time_out_reports_what_the_test_waits_for(told: Callable[..., str]) -> None:
    shown = told("@t[test, timeout(500)] +!t <- .print(begun);\n .wait(600).")
    assert "t.asl:2:2: the test did not end within 0.5 s of the run's clock" in shown
    assert "printed:\n  [t] begun" in shown


@pytest.mark.parametrize(
    ("program", "assertions"),
    [
        pytest.param(
            "!start. +!start <- +started. @t[test] +!t <- .wait(started); !assert_true(started).",
            1,
            id="the goals of the program are pursued too",
        ),
        pytest.param(
            "@t[test] +!t <- .fail. -!t <- !assert_true(true).", 1, id="a goal handled by its own plan"
        ),
        pytest.param(
            "+!a <- .wait(10); +c(1). +!b <- .wait(20). @t[test] +!t <- (!a |&| !b); !assert_true(c(1)).",
            1,
            id="a test may fork",
        ),
        pytest.param(
            "@t[test] +!t <- !fake_action(drive(_, _)); !fake_action(pose(7, _)); drive(1, 2); pose(X, Y);"
            " !assert_equals(7, X); !assert_did(drive(1, _)); !assert_not_did(drive(2, _)).",
            3,
            id="actions can be faked",
        ),
        pytest.param(
            "@t[test] +!t <- !fake_action(see(1)); see(X); !fake_action(see(2)); see(Y);"
            " !assert_equals([1, 2], [X, Y]).",
            1,
            id="the last fake of an action wins",
        ),
    ],
)
def test_a_test_passes(outcomes: Outcomes, program: str, assertions: int) -> None:
    (outcome,) = outcomes(program)
    assert outcome.problems == []
    assert outcome.assertions == assertions


def test_the_default_time_limit_applies(outcomes: Outcomes) -> None:
    (outcome,) = outcomes("@t[test] +!t <- .wait(11000).")
    assert outcome.problems[0].message == "the test did not end within 10 s of the run's clock"
    assert outcome.simulated == pytest.approx(10.0)


def test_a_step_that_does_not_end_is_stopped(outcomes: Outcomes) -> None:
    program = (
        "@t[test] +!t <- .findall(X, .range(X, 1, 100000000000), _). @u[test] +!u <- !assert_true(true)."
    )
    before = signal.getsignal(SIGNAL)
    hanging, other = outcomes(program, replace(BRIEF, patience=2.0))
    assert "did not end within 2 s of real time" in hanging.problems[0].message
    assert other.passed
    assert signal.getsignal(SIGNAL) is before
    assert sys.platform == "win32" or signal.getitimer(signal.ITIMER_REAL)[0] == 0.0


def test_waiting_forever_is_detected_immediately(outcomes: Outcomes) -> None:
    (outcome,) = outcomes('@t[test] +!t <- .wait("+never").')
    assert outcome.problems[0].message == "the test did not end, and nothing is left to do"
    assert outcome.simulated < 1.0


def test_a_faked_action_can_fail_and_take_time(outcomes: Outcomes) -> None:
    (outcome,) = outcomes(
        """
        @t[test] +!t
          <- !fake_action(drive, failed(blocked(wall), "a wall")); !fake_action(wait, after(1500)); wait; !go.
        +!go <- drive.
        -!go[error_msg(Text), env_failure_reason(Reason)]
          <- !assert_equals("a wall", Text); !assert_equals(blocked(wall), Reason).
        """
    )
    assert outcome.problems == []
    assert outcome.assertions == 2
    assert outcome.simulated == pytest.approx(1.5)


def test_tests_may_create_agents_and_exchange_messages(outcomes: Outcomes) -> None:
    (outcome,) = outcomes(
        """
        @t[test] +!t
          <- .create_agent(bob, "bob.asl");
             .send(bob, askOne, age(X), age(Age));
             !assert_equals(42, Age);
             .send(bob, achieve, greet(t));
             .wait(hello[source(bob)], 1000);
             !assert_true(hello[source(bob)]).
        """,
        bob_asl="age(42). +!greet(Who) <- .send(Who, tell, hello).",
    )
    assert outcome.problems == []


def test_assertions_of_other_agents_count(outcomes: Outcomes) -> None:
    (outcome,) = outcomes(
        '@t[test] +!t <- .create_agent(bob, "bob.asl").',
        bob_asl='{ include("$jacaros/test_assert.asl") } !check. +!check <- !assert_true(false).',
    )
    assert outcome.problems[0].span is not None
    assert outcome.problems[0].span.file.name.endswith("bob.asl")


def test_artifacts_of_the_project_can_be_used(outcomes: Outcomes) -> None:
    (outcome,) = outcomes(
        """
        @t[test] +!t
          <- makeArtifact("c", "Counter", [], Id); focus(Id); inc; .wait(count(1), 1000); !assert_true(count(1)).
        """,
        artifacts_py=(
            "from jacaros.artifacts import Artifact, operation\n\n\n"
            "class Counter(Artifact):\n"
            "    def init(self) -> None:\n"
            "        self.define_property('count', 0)\n\n"
            "    @operation\n"
            "    def inc(self) -> None:\n"
            "        self.update_property('count', self.value('count') + 1)\n"
        ),
    )
    assert outcome.problems == []


def test_a_test_project_runs_with_its_robot(tmp_path: Path) -> None:
    (tmp_path / "robot.asl").write_text(
        """
        { include("$jacaros/artifacts.asl") }
        @drives[test] +!drives
          <- !use_artifact("wheels", "ArtCmdVelMuxAndOdometry");
             moveForward(1);
             getCurrentPose(X, _, _);
             !assert_equals(1, X, 0.05).
        """,
        encoding="utf-8",
    )
    project = tmp_path / "test_drive.jcm"
    project.write_text('mas drive { agent robot : robot.asl world: "empty" }', encoding="utf-8")
    (outcome,) = run_suite(suite_of(project))
    assert outcome.problems == []
    assert outcome.simulated > 1.0


def test_an_unknown_world_fails_the_test(outcomes: Outcomes) -> None:
    program = (
        '{ include("$jacaros/artifacts.asl") } @t[test] +!t <- !use_artifact("wheels", "ArtCmdVel"); move(1).'
    )
    (outcome,) = outcomes(program, replace(BRIEF, world="nowhere"))
    assert "nowhere" in "\n".join(outcome.lines())


def test_tests_can_be_run_in_real_time(outcomes: Outcomes) -> None:
    (outcome,) = outcomes("@t[test] +!t <- .wait(20).", replace(BRIEF, fast=False))
    assert outcome.passed
    assert outcome.seconds >= 0.02


def test_a_seed_makes_tests_repeatable(outcomes: Outcomes) -> None:
    program = "@t[test] +!t <- .random(X); .print(X)."
    once, again, other = (outcomes(program, replace(BRIEF, seed=seed))[0].output for seed in (1, 1, 2))
    assert once == again
    assert once != other


def test_assertions_outside_of_tests_are_logged(tmp_path: Path) -> None:
    from jacaros.testing import run_project

    program = tmp_path / "a.asl"
    program.write_text(
        '{ include("$jasonJar/test/jason/inc/test_assert.asl") }'
        "!go. +!go <- !assert_true(p); !assert_false(p); .print(end).",
        encoding="utf-8",
    )
    result = run_project(program, until_idle=True)
    assert result.lines == ["[a] end"]
    assert "assert_true failed: expected p, but no belief p/0" in result.errors[0]
    assert "assert_false passed" in result.errors[1]


MOCK_AGENT = """
@mock[test] +!test_partner_learns
  <- !create_mock_agent(partner);
     .send(partner, tell, battery(80));
     !wait_idle(partner);
     .send(partner, askOne, battery(_), battery(B));
     !assert_equals(80, B).
"""


def test_the_mock_agent_of_the_library_needs_no_file_of_the_project(outcomes: Outcomes) -> None:
    (outcome,) = outcomes('{ include("$jacaros/tester_agent.asl") }' + MOCK_AGENT)
    assert outcome.passed, outcome.lines()


@pytest.mark.parametrize(
    "name", ["mock_agent", "test_assert", "test_manager", "test_performance", "tester_agent"]
)
def test_each_library_file_for_tests_works_alone(outcomes: Outcomes, name: str) -> None:
    include = f'{{ include("$jacaros/{name}.asl") }}'
    (outcome,) = outcomes(include + "@t[test] +!passing <- !assert_true(true).")
    assert outcome.passed, outcome.lines()


@pytest.mark.parametrize("file", sorted(SourcePath(()).find("$jacaros/artifacts.asl").parent.glob("*.asl")))
def test_a_program_with_only_a_library_file_has_nothing_wrong(file: Path, tmp_path: Path) -> None:
    program = tmp_path / "lone.asl"
    program.write_text(f'{{ include("$jacaros/{file.name}") }}', encoding="utf-8")
    for path in (program, file):
        assert [each.render() for each in check_files([path]).diagnostics] == []
    assert suite_of(program).error is None
    assert suite_of(program).warnings == []
