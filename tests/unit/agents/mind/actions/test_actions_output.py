from types import SimpleNamespace

import pytest

from jacaros.agents.mind.actions.internal_action import ActionError, WrongArguments
from jacaros.agents.mind.actions.java_format import java_format
from jacaros.agents.terms.values import String, Var


@pytest.mark.parametrize("action", [".print", ".println"])
def test_print_joins_its_arguments_without_separators(mind, action):
    assert mind.succeeds(action, "a", 1, String(" x"), [String("y"), ("f", 2.5)])
    assert mind.architecture.printed == ['a1 x["y",f(2.5)]']


def test_print_keeps_line_breaks_and_marks_unbound_variables(mind):
    assert mind.succeeds(".print")
    assert mind.architecture.printed == [""]
    assert mind.succeeds(".print", String("one\ntwo"))
    assert mind.architecture.printed == ["", "one\ntwo"]
    assert mind.succeeds(".print", Var("X"), " ", ("f", Var("Y")))
    assert mind.architecture.printed[2:] == ["X<no-value> f(Y)"]


@pytest.mark.parametrize(
    ("template", "arguments", "shown"),
    [
        ("plain", [], "plain"),
        ("%s and %s", ["a", 3.0], "a and 3.0"),
        ("%2$s %1$s", ["a", "b"], "b a"),
        ("[%5s|%-5s|%.2s]", ["a", "b", "word"], "[    a|b    |wo]"),
        ("%f", [3.14159], "3.141590"),
        ("%10.3f|", [3.14159], "     3.142|"),
        ("%08.0f", [461012.0], "00461012"),
        ("%.1f %.2f %.0f", [0.25, 1.005, 2.5], "0.3 1.01 3"),
        ("%+.1f % .1f %(.1f", [1.0, 1.0, -1.0], "+1.0  1.0 (1.0)"),
        ("%,.2f", [1234567.891], "1,234,567.89"),
        ("%06.1f", [-2.5], "-002.5"),
        ("%e %.2E %.0e", [12345.678, 0.00123, 5.0], "1.234568e+04 1.23E-03 5e+00"),
        ("%e", [0.0], "0.000000e+00"),
        ("%g %g %g", [0.0001, 123456.0, 1234567.0], "0.000100000 123456 1.23457e+06"),
        ("%g %.3g", [0.00001, 0.0], "1.00000e-05 0.00"),
        ("%b %b %S", [True, "x", "loud"], "true true LOUD"),
        ("100%%%n", [], "100%\n"),
        ("%f %5.1f", [float("inf"), float("nan")], "Infinity   NaN"),
        ("%f", [float("-inf")], "-Infinity"),
        ("%s", [1e10], "1.0E10"),
    ],
)
def test_formats_are_read_as_java_reads_them(template, arguments, shown):
    assert java_format(template, arguments) == shown  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("template", "arguments"),
    [("%d", [1.0]), ("%s", []), ("%q", [1.0]), ("%.f", [1.0]), ("50%", []), ("%f", ["a"])],
)
def test_wrong_formats_are_refused(template, arguments):
    with pytest.raises(ValueError, match="%"):
        java_format(template, arguments)  # type: ignore[arg-type]


def test_printf_shows_what_the_format_makes_of_fitting_values(mind):
    assert mind.succeeds(".printf", String("%.1f %s %s %b"), 2.25, String("text"), [1, "a"], "false")
    assert mind.architecture.printed == ["2.3 text [1,a] false"]
    with pytest.raises(ActionError, match=r"use %\.0f"):
        mind.succeeds(".printf", String("%d"), 1)
    with pytest.raises(WrongArguments, match="must be a string, not a"):
        mind.succeeds(".printf", "a")


def test_puts_fills_values_into_texts_or_a_variable(mind):
    mind.readable = {"X": 1.0}
    assert mind.result(".puts", String("x=#{X}")) == '"x=1"'
    assert mind.architecture.printed == []
    mind.readable = {"X": String("a b"), "Y+1": 3.0}
    assert mind.succeeds(".puts", String("#{X}, #{Y+1}, #{X}; #{?}"))
    assert mind.architecture.printed == ["a b, 3, a b; #{?}"]
    with pytest.raises(WrongArguments):
        mind.succeeds(".puts", 1)


def test_puts_appends_a_second_string(mind):
    mind.readable = {"X": 1.0}
    assert mind.succeeds(".puts", String("a"), String("#{X}"))
    assert mind.architecture.printed == ["a1"]


@pytest.mark.parametrize(
    ("level", "known"),
    [
        ("severe", "error"),
        ("warning", "warning"),
        ("info", "info"),
        ("fine", "debug"),
        ("finest", "debug"),
        ("x", "info"),
    ],
)
def test_log_translates_the_levels_of_java(mind, level, known):
    assert mind.succeeds(".log", level, String("n="), 2)
    assert mind.architecture.logged == [(known, "n=2")]


@pytest.mark.parametrize("level", [1, String("info"), ("f", 1)])
def test_log_needs_a_level(mind, level):
    with pytest.raises(WrongArguments):
        mind.succeeds(".log", level)


def test_verbose_sets_the_level_of_logging(mind):
    assert mind.succeeds(".verbose", 2)
    assert mind.agent.options.verbose == 2


@pytest.mark.parametrize("level", ["loud", -1, 3])
def test_verbose_knows_three_levels(mind, level):
    with pytest.raises(WrongArguments):
        mind.succeeds(".verbose", level)


def test_print_unifier_shows_the_variables_that_have_values(mind):
    assert mind.succeeds(".print_unifier")
    assert mind.architecture.printed == ["done"]
    bound = Var("Y")
    mind.unify(bound, String("s"))
    plan = SimpleNamespace(slots={"X": 5, "Y": 6, "Z": 7, "W": 8})
    mind.intention = SimpleNamespace(frames=[[None, None, (), 0, plan, 1.0, bound, Var("Z"), None]])
    assert mind.succeeds(".print_unifier")
    assert mind.architecture.printed == ["done", "X=1", 'Y="s"', "done"]
