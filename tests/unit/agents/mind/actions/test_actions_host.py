"""Internal actions on time, chance and the system of agents."""

from itertools import islice
from random import Random

import pytest
from fake_context import term

from jacaros import __version__
from jacaros.agents.mind.actions.internal_action import STANDARD, ActionError, WrongArguments
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


def test_stop_mas_is_not_a_condition_and_version_is_that_of_jacaros(mind):
    assert STANDARD[".stopMAS"].suspends
    assert mind.result(".version") == f'"{__version__}"'
