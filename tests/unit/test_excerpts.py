"""What messages show of files: escaped, cut, and no more messages than can be read."""

from collections.abc import Callable

import pytest

from jacaros.agents.checks.checker import check
from jacaros.agents.checks.goals import KnownActions
from jacaros.agents.language.diagnostics import Diagnostic, SourceFile, Span, render_all
from jacaros.agents.language.loader import read_program
from jacaros.agents.mind.actions.internal_action import STANDARD
from jacaros.runtime.files.texts import LONGEST, MOST, WIDTH, escaped, marked, printable
from jacaros.runtime.files.yaml import Problem, YamlFileError


def test_control_characters_and_marks_of_direction_are_escaped() -> None:
    assert escaped("a\x1b[31m\x9b\u202eb\ud800\tc\n") == "a\\x1b[31m\\u009b\\u202eb\\ud800\tc\n"
    assert escaped("été 日本 🤖") == "été 日本 🤖"


def test_a_long_line_is_cut_around_the_place() -> None:
    line = "x" * 1000 + "WRONG" + "y" * 1000
    shown, carets = marked(line, 1001, 1006)
    assert shown == f"...{'x' * (WIDTH // 2)}WRONG{'y' * (WIDTH // 2 - 5)}..."
    assert carets == " " * (3 + WIDTH // 2) + "^^^^^"


def test_a_long_stretch_is_marked_as_far_as_it_is_shown() -> None:
    shown, carets = marked("z" * 5000, 1, 5001)
    assert shown == "z" * WIDTH + "..."
    assert carets == "^" * WIDTH


def test_carets_are_below_the_place_behind_escaped_characters_and_tabs() -> None:
    assert marked("\tp\x1b(q).", 5, 6) == ("\tp\\x1b(q).", "\t      ^")
    assert marked("p", 7) == ("p", " ^")


def test_a_long_line_of_a_message_is_cut() -> None:
    assert len(printable("x" * 10_000)) == LONGEST
    assert printable("one\ntwo") == "one\ntwo"


def test_many_diagnostics_are_counted_not_printed_and_errors_come_first() -> None:
    file = SourceFile("many.asl", "p.\n" * 1000)
    spans = [Span(file, line, 1, line, 2) for line in range(1, 1001)]
    warnings = [Diagnostic("warning", "odd", span) for span in spans]
    told = render_all([*warnings, Diagnostic("error", "wrong", spans[-1])])
    assert told.count("odd") == MOST - 1
    assert told.count("wrong") == 1
    assert "warning: 901 more warnings in many.asl" in told


def test_many_problems_of_a_yaml_file_are_counted_not_printed() -> None:
    told = str(YamlFileError("many.yaml", "x\n" * 1000, [Problem(n, 1, "odd") for n in range(1, 1001)]))
    assert told.count("odd") == MOST
    assert told.endswith("many.yaml: 900 more problems")


def test_messages_about_one_line_grow_with_the_file_not_with_its_square() -> None:
    text = "!s. +!s <- " + "; ".join(f"!undefined_goal_{i}" for i in range(1000)) + "."
    assert len(render_all(_warnings(text))) < 3 * len(text)


@pytest.mark.parametrize(
    "line",
    [
        "+!g({0}) <- !g({0} + 1).\n",
        "+!goal{0} <- !gaol{0}.\n",
        "+!g{0} <- .prunt{0}(a).\n",
        "+p(X, {0}) : q{0}(X) <- +q{0}(X).\n",
        "+!g{0} <- a b.\n",
    ],
)
def test_the_work_of_a_check_is_in_proportion_to_the_program(
    line: str, calls_of: Callable[[Callable[[], object]], int]
) -> None:
    def work(lines: int) -> int:
        return calls_of(lambda: _checked("".join(line.format(number) for number in range(lines))))

    assert work(1600) < 8 * 1.5 * work(200)


def _checked(text: str) -> None:
    program, errors = read_program(SourceFile("many.asl", text))
    render_all([*errors, *check(program, KnownActions(STANDARD), errors)])


def _warnings(text: str) -> list[Diagnostic]:
    program, errors = read_program(SourceFile("line.asl", text))
    assert not errors
    return check(program, KnownActions(STANDARD))
