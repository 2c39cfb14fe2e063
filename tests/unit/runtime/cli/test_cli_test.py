"""``jacaros test``: exit codes, report, options, JUnit XML."""

from pathlib import Path

import pytest
from command_lab import Outcome

COMMAND = ("test",)

TESTS = """
@adds[test]   +!adding   <- .print(quiet); !assert_equals(3, 1 + 2).
@breaks[test] +!breaking <- .print(loud); !assert_equals(3, 1 + 1).
@ends[test]   +!ending   <- !assert_true(true).
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "tests").mkdir()
    (tmp_path / "tests" / "sums.asl").write_text(TESTS, encoding="utf-8")
    return tmp_path


def test_a_failing_test_is_reported_with_its_cause(folder: Path, outcome: Outcome) -> None:
    assert outcome("tests") == (
        1,
        """\
tests/sums.asl
  ok      adds
  FAILED  breaks
  ok      ends

tests/sums.asl::breaks
  tests/sums.asl:3:43: assert_equals failed
    3 | @breaks[test] +!breaking <- .print(loud); !assert_equals(3, 1 + 1).
      |                                           ^^^^^^^^^^^^^^^^^^^^^^^^
    expected  3
    but       was 2
  printed:
    [sums] loud

2 passed, 1 failed; 3 assertions, seed 0
""",
        "",
    )


def test_tests_that_pass_are_selected_by_file_and_pattern_or_in_the_current_folder(
    folder: Path, outcome: Outcome
) -> None:
    code, output, errors = outcome("tests/sums.asl", "-k", "sums.asl::*s", "-k", "adds")
    assert (code, errors) == (0, "")
    assert output.endswith("1 passed; 1 assertions, seed 0\n")
    assert "quiet" not in output
    code, output, _ = outcome("-k", "END")
    assert code == 0
    assert output.startswith("tests/sums.asl\n  ok      ends\n")
    assert "[sums] quiet" in outcome("-v")[1]


def test_x_stops_after_the_first_failure(folder: Path, outcome: Outcome) -> None:
    (folder / "tests" / "xyz.asl").write_text("@later[test] +!later.", encoding="utf-8")
    code, output, _ = outcome("-x")
    assert code == 1
    assert "1 passed, 1 failed" in output
    assert "later" not in output


def test_a_run_without_tests_is_wrong_usage(folder: Path, outcome: Outcome) -> None:
    (folder / "none.asl").write_text("!go. +!go.", encoding="utf-8")
    code, output, errors = outcome("none.asl")
    assert (code, output) == (2, "")
    assert errors == (
        "error: no tests in none.asl\n"
        "  = help: a test is a plan for a goal with the label test: @name[test] +!goal <- ...\n"
    )
    code, _, errors = outcome("tests", "-k", "nothing")
    assert code == 2
    assert "no test in tests matches `-k nothing`\n  = help: tests: tests/sums.asl::adds" in errors
    assert outcome("nowhere")[0] == 2
    assert outcome("--timeout", "0")[0] == 2


def test_a_program_with_errors_fails(folder: Path, outcome: Outcome) -> None:
    (folder / "tests" / "test_wrong.asl").write_text("@a[test] +!g <- .print(.", encoding="utf-8")
    code, output, _ = outcome()
    assert code == 1
    assert "  ERROR   cannot run the file" in output
    assert "tests/test_wrong.asl:1:24: error: " in output
    assert "2 passed, 1 failed, 1 file cannot be run" in output


def test_output_is_coloured_only_on_terminals(folder: Path, outcome: Outcome, monkeypatch) -> None:
    assert "\x1b[" not in outcome()[1]
    (folder / "tests" / "evil.asl").write_text('@e[test] +!e <- .print("\x1b[2J").', encoding="utf-8")
    monkeypatch.setattr("sys.stdout.isatty", lambda: True)
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.delenv("NO_COLOR", raising=False)
    output = outcome("-v")[1]
    assert "\x1b[32mok" in output
    assert "\x1b[2J" not in output


def test_warnings_go_to_the_standard_error_output(folder: Path, outcome: Outcome) -> None:
    (folder / "warn.asl").write_text("@a[test] +!a : false <- !missing.", encoding="utf-8")
    code, output, errors = outcome("warn.asl")
    assert code == 1
    assert "no plan for `!missing/0`" in errors
    assert "no plan for `!missing/0`" not in output
