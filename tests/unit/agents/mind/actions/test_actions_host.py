"""Internal actions on time, chance, output and the system of agents."""

from itertools import islice
from random import Random
from types import SimpleNamespace

import pytest
from fake_context import term

from jacaros import __version__
from jacaros.agents.mind.actions.internal_action import STANDARD, ActionError, WrongArguments
from jacaros.agents.mind.actions.java_format import java_format
from jacaros.agents.terms.text import text
from jacaros.agents.terms.values import String, Var

# time

A_MOMENT = 1_700_000_123.456  # 2023-11-14 22:15:23.456 UTC


def test_time_and_date_are_those_of_the_clock_in_utc(mind):
    mind.architecture.time = A_MOMENT
    parts = [Var("H"), Var("M"), Var("S"), Var("Ms")]
    assert mind.instances(".time", *parts, of=list(parts)) == ["[22,15,23,456]"]
    assert mind.succeeds(".time", *parts[:3])
    assert text(term(parts[:3])) == "[22,15,23]"
    mind.architecture.time = A_MOMENT
    parts = [Var("Y"), Var("M"), Var("D")]
    assert mind.instances(".date", *parts, of=list(parts)) == ["[2023,11,14]"]
    assert mind.succeeds(".date", 2023, 11, 14)
    assert not mind.succeeds(".date", 2023, 11, 15)


def test_other_times_fail_and_nano_time_counts_nanoseconds(mind):
    assert mind.succeeds(".time", 0, 0, Var("S"))
    assert not mind.succeeds(".time", 1, Var("M"), Var("S"))
    mind.architecture.time = 2.5
    assert mind.result(".nano_time") == "2500000000"
    assert not mind.succeeds(".nano_time", 1)


# chance


def test_a_seed_repeats_what_is_drawn_from_the_generator_of_the_agent(mind):
    mind.architecture.random = Random(7)
    same = Random(7)
    variable = Var("X")
    assert mind.succeeds(".random", variable)
    assert variable.ref == same.random()
    assert mind.result(".random", [String("a"), "b", "c"]) in ('"a"', "b", "c")
    drawn = []
    for _ in range(2):
        assert mind.succeeds(".set_random_seed", 20)
        drawn.append(mind.result(".random"))
    assert drawn[0] == drawn[1]
    with pytest.raises(WrongArguments):
        mind.succeeds(".set_random_seed", "x")


def test_random_gives_as_many_answers_as_are_asked_for(mind):
    variable = Var("X")
    numbers = [float(n) for n in mind.instances(".random", variable, 5, of=variable)]
    assert len(set(numbers)) == 5
    assert all(0 <= n < 1 for n in numbers)
    assert len(mind.instances(".random", ["a", "b"], variable, 3, of=variable)) == 3
    assert len(list(islice(mind.run(".random", variable, 0), 100))) == 100
    assert not mind.succeeds(".random", [], Var("X"))
    assert not mind.succeeds(".random", [], Var("X"), 0)


@pytest.mark.parametrize(
    "arguments", [(1,), ("a",), (Var("X"), "a"), (["a"], "b"), (["a"], Var("X"), "n"), (["a"],)]
)
def test_random_needs_a_variable(mind, arguments):
    with pytest.raises(WrongArguments):
        mind.succeeds(".random", *arguments)


# agents


def test_my_name_and_all_names_are_atoms(mind):
    assert mind.result(".my_name") == "bob"
    assert mind.succeeds(".my_name", "bob")
    assert not mind.succeeds(".my_name", "carl")
    assert mind.result(".all_names") == "[bob,carl]"


def test_create_agent_asks_the_host_and_binds_a_variable_to_the_final_name(mind):
    assert mind.succeeds(".create_agent", "dora")
    assert mind.succeeds(".create_agent", String("emil"), String("x.asl"))
    assert mind.succeeds(".create_agent", "bob", String("x.asl"))
    assert mind.architecture.created == [("dora", None, {}), ("emil", "x.asl", {}), ("bob", "x.asl", {})]
    first, second = Var("Dora"), Var("Bob")
    assert mind.succeeds(".create_agent", first, String("x.asl"))
    assert mind.succeeds(".create_agent", second, String("x.asl"))
    assert (text(first), text(second)) == ('"dora"', '"bob_1"')


def test_create_agent_names_the_classes_and_fails_when_the_host_cannot(mind):
    options = [("agentClass", String("a.B(1)")), ("beliefBaseClass", "c")]
    assert mind.succeeds(".create_agent", "dora", String("x.asl"), options)
    classes = {"agentClass": "a.B(1)", "beliefBaseClass": "c"}
    assert mind.architecture.created == [("dora", "x.asl", classes)]
    mind.architecture.broken = True
    with pytest.raises(ActionError, match="dora could not be created"):
        mind.succeeds(".create_agent", "dora", String("x.asl"))


@pytest.mark.parametrize("arguments", [("x",), (String("x.asl"), "a"), (String("x.asl"), [("color", "red")])])
def test_create_agent_refuses_other_arguments(mind, arguments):
    with pytest.raises(WrongArguments):
        mind.succeeds(".create_agent", "dora", *arguments)
    assert mind.architecture.created == []


def test_kill_agent_ends_an_agent_and_can_wait(mind):
    assert mind.succeeds(".kill_agent", "carl", 1500)
    assert mind.architecture.delay == 1.5
    assert not mind.succeeds(".kill_agent", "carl", 1500)
    with pytest.raises(WrongArguments):
        mind.succeeds(".kill_agent", "bob", "soon")
    mind.architecture.agents = ["bob", "carl"]
    assert mind.succeeds(".kill_agent", "carl")
    assert not mind.succeeds(".kill_agent", String("carl"))
    assert mind.architecture.agents == ["bob"]


@pytest.mark.parametrize(
    ("arguments", "asked"),
    [((), (0.0, 0)), ((2000,), (2.0, 0)), ((0, 3), (0.0, 3)), ((500, "false"), (0.5, 0)), ((-1,), (0.0, 0))],
)
def test_stop_mas_ends_the_run(mind, arguments, asked):
    assert mind.succeeds(".stopMAS", *arguments)
    assert mind.architecture.stopped == asked


@pytest.mark.parametrize("arguments", [("now",), (0, "code")])
def test_stop_mas_needs_numbers(mind, arguments):
    with pytest.raises(WrongArguments):
        mind.succeeds(".stopMAS", *arguments)


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


def test_puts_fills_values_into_texts_or_a_variable_and_appends(mind):
    mind.readable = {"X": 1.0}
    assert mind.result(".puts", String("x=#{X}")) == '"x=1"'
    assert mind.architecture.printed == []
    mind.readable = {"X": String("a b"), "Y+1": 3.0}
    assert mind.succeeds(".puts", String("#{X}, #{Y+1}, #{X}; #{?}"))
    assert mind.architecture.printed == ["a b, 3, a b; #{?}"]
    with pytest.raises(WrongArguments):
        mind.succeeds(".puts", 1)
    assert mind.succeeds(".puts", String("a"), String("#{X}"))
    assert mind.architecture.printed[1:] == ["aa b"]


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


def test_verbose_and_version_are_known(mind):
    assert mind.succeeds(".verbose", 2)
    assert mind.agent.options.verbose == 2
    assert STANDARD[".stopMAS"].suspends
    assert mind.result(".version") == f'"{__version__}"'


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
