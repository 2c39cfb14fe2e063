"""The blackboard and the console, which every workspace has."""

import pytest

from jacaros.artifacts import Atom, Out, Structure
from stage_lab import play


def blackboard(stage):
    board = stage.main.lookup("blackboard")

    def call(operation, *args):
        outs = [arg for arg in args if isinstance(arg, Out)]
        made = stage.call(board, operation, *args)
        return [out.value for out in outs] if made.ok else made

    return call


async def test_a_tuple_that_is_not_there_fails_with_its_reason(stage):
    do = blackboard(stage)
    do("out", "msg", 2, "two")
    assert do("rd", "msg", 2, Out()) == ["two"]
    failed = do("inp", "msg", 1, Out())
    assert failed.reason == Atom("no_match")
    assert failed.outcome.message == 'no tuple on the blackboard matches ("msg",1,_)'
    assert do("inp", "msg", 2, Out()) == ["two"]
    assert do("rdp", "msg", 2, Out()).reason == Atom("no_match")


async def test_values_are_compared_as_agents_do(stage):
    do = blackboard(stage)
    do("out", "v", True)
    assert do("inp", "v", 1).reason == Atom("no_match")
    do("out", "v", 1)
    assert do("inp", "v", 1.0) == []
    assert do("inp", "v", True) == []
    do("out", Atom("goal"), Structure("at", (1, 2)), [1, "a"])
    assert do("inp", "goal", Structure("at", (1, 2)), [1, "a"]) == []


async def test_the_same_variable_twice_matches_only_equal_values(stage):
    do = blackboard(stage)
    do("out", "pair", 1, 2)
    do("out", "pair", 3, 3)
    both = Out()
    assert do("in", "pair", both, both) == [3, 3]


async def test_any_name_may_be_asked_for_and_tuples_must_be_bound(stage):
    do = blackboard(stage)
    failed = do("out", "x", Out())
    assert failed.reason == Atom("unbound_argument")
    do("out", "x", 1)
    assert do("in", Out(), Out()) == ["x", 1]


@pytest.mark.parametrize("operation", ["print", "println", "printWithAgName", "printlnWithAgName"])
def test_the_console_prints_lines_for_the_agent(operation):
    printed = []

    async def scene(stage):
        console = stage.main.lookup("console")
        assert stage.call(
            console, operation, "at ", Atom("kitchen"), " ", 3.0, [1, "a"], True, agent="bob"
        ).ok
        assert stage.call(console, operation, agent="eve").ok

    play(scene, console=lambda agent, text: printed.append((agent, text)))
    assert printed == [("bob", 'at kitchen 3[1,"a"]true'), ("eve", "")]


async def test_a_console_without_host_prints_to_the_log(stage):
    stage.call(stage.main.lookup("console"), "println", "hello")
    assert stage.lines == ["[console] hello"]
