"""A Python program gives agents data, which is never parsed, and gives back what it got."""

import pickle
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import pytest
from hypothesis import given

from drawn_values import VALUES, same
from jacaros import Atom, GoalFailed, Literal, Mas, Structure, UsageError
from jacaros.testing import AgentHarness

NAMES = ["Ann, O'Hara", 'x"); !evil("', "Name", "1 + 1", "C:\\new\n", "", "{ +!g <- .stopMAS }", "é\0'"]
"""Strings that are, or would break, text of the language."""

DESK = "+!check_in(Name) <- +in(Name). +!check_in(Name, Room) <- +in(Name, Room). +!evil(_) <- +evil."


class Move(NamedTuple):
    """Recorded as ``move(X,Y)``."""

    x: int
    place: str


@dataclass
class CheckIn:
    """Recorded as ``checkIn(Name)``."""

    name: str


@given(VALUES)
def test_what_is_given_comes_back_and_can_be_given_again(value):
    first, second = AgentHarness("", name="first"), AgentHarness("", name="second")
    first.add_belief("held", value)
    answer = first.ask("held(X)")
    assert answer is not None
    assert same(answer["X"], value)
    second.add_belief("copied(X)", **answer)
    second.add_belief(first.beliefs[0])
    for name in ("copied", "held"):
        again = second.ask(f"{name}(X)")
        assert again is not None
        assert same(again["X"], value)
    assert first.beliefs[0] in second.beliefs


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize(
    "achieve",
    [
        lambda agent, name: agent.achieve("check_in", name),
        lambda agent, name: agent.achieve("check_in(Who)", Who=name),
        lambda agent, name: agent.achieve(("check_in", name)),
        lambda agent, name: agent.achieve(Structure("check_in", (name,))),
        lambda agent, name: agent.achieve(Literal("check_in", (name,))),
        lambda agent, name: agent.post_goal("check_in", name),
    ],
    ids=["arguments", "variables", "tuple", "structure", "literal", "posted"],
)
def test_a_string_is_never_parsed(achieve: Callable[[AgentHarness, str], object], name: str) -> None:
    agent = AgentHarness(DESK)
    achieve(agent, name)
    agent.run()
    assert agent.answers("in(N)") == [{"N": name}]
    assert agent.believes("in", name)
    assert agent.believes("in(N) & N == Wanted", Wanted=name)
    assert not agent.believes("evil")


def test_literals_of_all_kinds_are_given() -> None:
    agent = AgentHarness("")
    for literal in (
        "p(X)",
        Atom("p"),
        ("p",),
        ("ns::p", 1),
        ("~p", [1, (2, "a")]),
        Move(1, "a, b"),
        CheckIn("Ann"),
        Literal("p", (1,), (Structure("source", (Atom("ann"),)),)),
    ):
        agent.add_belief(literal)
    assert sorted(agent.beliefs) == [
        'checkIn("Ann")[source(self)]',
        'move(1,"a, b")[source(self)]',
        "ns::p(1)[source(self)]",
        "p(1)[source(ann)]",
        "p(X)[source(self)]",
        "p[source(self)]",
        '~p([1,[2,"a"]])[source(self)]',
    ]


def test_beliefs_are_changed_and_perceived_with_data() -> None:
    agent = AgentHarness("+bump(Where)[source(percept)] <- .print(Where).")
    agent.add_belief("at", "room 1")
    agent.replace_belief("at", "room 2")
    agent.perceive("door", "room 2", Atom("open"))
    agent.signal("bump", "front, left")
    agent.run()
    assert agent.prints == ["front, left"]
    assert agent.answers("at(X)") == [{"X": "room 2"}]
    assert agent.ask("door", "room 2", None) == {}
    assert agent.ask("door(Room, X)", Room="room 2") == {"X": Atom("open")}
    assert agent.ask("door", "room 3", None) is None
    agent.remove_belief("at", "room 2")
    agent.perceive_no_more("door", "room 2", Atom("open"))
    agent.run()
    assert agent.beliefs == []
    with pytest.raises(ValueError, match="a percept must be ground"):
        agent.perceive("door", "room 2", None)


async def test_goals_and_waits_take_data(mas: Mas) -> None:
    bob = mas.add_agent("bob", "+!go(_, T) <- .wait(T); +been(T). +!no(X) : X == 1.")
    goal = bob.achieve("go", "a, b", 1000)
    assert bob.goals == ['go("a, b",1000)']
    assert str(goal) == '!go("a, b",1000) (running)'
    assert await bob.until("been", 1000, timeout=2) == {}
    assert await bob.until("been(T) & T > Least", Least=1) == {"T": 1000}
    bob.post_goal(("go", "c", 1000))
    await mas.sleep(0.1)
    assert not bob.drop_goal("go", "other", None)
    assert bob.drop_goal(bob.goals[0])
    assert bob.goals == []
    with pytest.raises(
        TimeoutError, match=r'^been\("x"\) did not hold for agent bob \(it believes been\(1000\)\)'
    ):
        await bob.until("been", "x", timeout=1)
    with pytest.raises(GoalFailed) as failed:
        await bob.achieve("no(X)", X="a")
    assert failed.value.goal == 'no("a")'


async def test_messages_take_data_and_are_passed_on(mas: Mas, lines: list[str]) -> None:
    me, other = mas.mailbox("me"), mas.mailbox("other")
    bob = mas.add_agent("bob", 'age("O\'Hara", 30). +!fetch(X)[source(S)] <- .send(S, tell, X).')
    sent: list[Any] = [
        "a, b",
        Atom("a"),
        3,
        [Structure("p", ("x y",)), "q(1)", [Atom("r")]],
        {"k": 1},
        CheckIn("A"),
    ]
    for content in sent:
        me.send("bob", "achieve", "fetch", content)
        message = await me.get(timeout=1)
        me.send("other", message.performative, "Content", Content=message.content)
        passed = await other.get(timeout=1)
        assert passed.content == message.content
        assert str(passed) == str(message).replace("bob", "me")
    me.send("bob", "achieve", "fetch", bob.beliefs[0])
    assert (await me.get(timeout=1)).content == bob.beliefs[0].literal
    me.send("other", "tell", (1, "a, b"))
    assert (await other.get(timeout=1)).content == [1, "a, b"], "as anywhere among values"
    assert await me.ask("bob", "age(Who, N)", Who="O'Hara") == {"N": 30}
    assert await me.ask("bob", "age", "O'Hara", None) == {}
    assert await me.ask("bob", "age", "O'Hara", 31) is None
    mas.send("bob", "achieve", "fetch(X)", X="done", sender="other")
    assert (await other.get(timeout=1)).content == "done"


def test_beliefs_are_texts_with_data() -> None:
    agent = AgentHarness('seen("Ann, \\"O\\"", at(hall))[source(bob)].')
    (belief,) = agent.beliefs
    assert belief == 'seen("Ann, "O"",at(hall))[source(bob)]'
    assert belief.literal.arguments == ('Ann, "O"', Structure("at", (Atom("hall"),)))
    assert belief.literal.sources == ("bob",)
    copied = pickle.loads(pickle.dumps(belief))
    assert (type(copied), copied) == (str, str(belief))


def _ring() -> list[object]:
    ring: list[object] = []
    ring.append(ring)
    return ring


@pytest.mark.parametrize(
    ("give", "error", "told"),
    [
        (
            lambda a: a.achieve("p(X)", "b"),
            UsageError,
            r"expected a name before the arguments, found `p\(X\)`\n",
        ),
        (
            lambda a: a.ask("p & q", 1),
            UsageError,
            "expected a name before the arguments, found `p & q`\n  = help: ",
        ),
        (
            lambda a: a.ask("p(Name)", Nme=1),
            UsageError,
            r"no variable `Nme`\n  = help: did you mean `Name`\?",
        ),
        (
            lambda a: a.achieve("deliver", parcel="p1"),
            UsageError,
            r"no variable `parcel`\n.*help: pass arguments by position, or",
        ),
        (lambda a: a.achieve("p", 1, X=2), UsageError, "unexpected keyword `X`"),
        (lambda a: a.achieve((3,)), UsageError, "expected a name before the arguments, found `3`"),
        (
            lambda a: a.achieve(("p(X)", 1)),
            UsageError,
            r"expected a name before the arguments, found `p\(X\)`",
        ),
        (lambda a: a.achieve(3), UsageError, "expected a literal, found 3"),
        (lambda a: a.achieve(["p"]), UsageError, r'expected a literal, found \["p"\]'),
        (lambda a: a.ask(()), UsageError, r"expected a literal, found \[\]"),
        (
            lambda a: a.add_belief("p", _ring()),
            ValueError,
            "contains itself, or is nested deeper than 200 levels",
        ),
        (lambda a: a.add_belief("p(X)", X=_ring()), ValueError, "contains itself"),
    ],
)
def test_mistakes_are_reported(
    give: Callable[[AgentHarness], object], error: type[Exception], told: str
) -> None:
    agent = AgentHarness("")
    with pytest.raises(error, match=told):
        give(agent)
    assert (agent.beliefs, agent.goals) == ([], [])


async def test_positions_of_older_programs_are_deprecated(mas: Mas) -> None:
    bob, me = mas.add_agent("bob", "ready(1)."), mas.mailbox("me")
    with pytest.warns(DeprecationWarning, match="pass timeout by keyword") as warned:
        assert await bob.until("ready(X)", 5) == {"X": 1}
    assert warned[0].filename == __file__
    with pytest.warns(DeprecationWarning, match="pass timeout by keyword"):
        assert await me.ask("bob", "ready(X)", 5) == {"X": 1}
    with pytest.warns(DeprecationWarning, match="pass sender by keyword"):
        mas.send("me", "tell", "hello(1)", "ann")
    message = await me.get()
    assert message.sender == "ann"
    with pytest.warns(DeprecationWarning, match="pass reply_to by keyword"):
        me.send("bob", "tell", "hello(2)", message)
    with pytest.warns(DeprecationWarning, match="give one literal per call") as warned:
        bob.add_belief("p(1)", "q(2)")
    assert warned[0].filename == __file__
    assert bob.believes("p(1) & q(2)")
