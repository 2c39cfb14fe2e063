"""Waits for conditions and for events: what ends them, and in which order."""

import pytest
from recording_host import believed, mind, printed

from jacaros.agents.mind.mind import Mind
from jacaros.agents.mind.rules.pending import cancel, listen, notify_listeners
from jacaros.agents.mind.state.act import Percept
from jacaros.agents.mind.state.pending import PendingEvent
from jacaros.agents.mind.state.triggers import trigger
from jacaros.agents.terms.values import BY_SELF, SOURCE_PERCEPT, Var, atom, functor, structure


@pytest.mark.parametrize(
    ("condition", "change"),
    [
        ("c(1)", "+c(1)"),
        ("c(1)", "+>c(1)"),
        ("c(1)", "++c(1)"),
        ("c(1)", ".asserta(c(1))"),
        ("c(1)", "+c(_)"),
        ("c(1)", "-+c(1)"),
        ("c(1)", "+{c(X) :- X > 0}"),
        ("c(1)", "+{other(X) :- c(X)}; +c(1)"),
        ("c(_)", "+c(1)"),
        ("c(X) & X > 1", "+c(1); +c(2)"),
        ("c(1)[source(bob)]", "+c(1); +c(1)[source(bob)]"),
        ("~c(1)", "+~c(1)"),
        ("not old(1)", "-old(1)"),
        ("not old(1)", ".abolish(old(_))"),
        ("not old(1)", "-+old(2)"),
        ("not old(1)[source(self)]", "-old(1)[source(self)]"),
        ("not (old(_) & old(2))", "-old(1); -old(2)"),
        ("c(1) | d(1)", "+d(1)"),
        (".count(old(_), 3)", "+old(3)"),
        (".findall(X, old(X), [_, _, _])", "+old(3)"),
        ("by_rule(1)", "+c(1)"),
        ("not by_rule(_) & old(3)", "+old(3)"),
        ("c([1, f(X)])", "+c([1, f(2)])"),
        (".intend(other)", "!!other"),
        ("Q", "+c(1)"),
        ("elsewhere::c(1)", "+elsewhere::c(1)"),
        ("math.max(1, 2) == 2 & c(1)", "+c(1)"),
    ],
)
def test_a_wait_ends_when_its_condition_comes_true(condition, change):
    program = f"""
        old(1). old(2).
        by_rule(X) :- c(X).
        !wait.
        !change.
        +!wait : Q = c(1) <- .wait({condition}); .print(came).
        +!change <- .wait(10); +unrelated(1); .print(before); {change}; .wait(10); .print(after).
        +!other <- .wait(50).
        """
    assert printed(program) == ["before", "came", "after"]


def test_a_percept_ends_a_wait():
    host = mind("!wait. +!wait <- .wait(seen(2)); .print(came).")
    host.run(seconds=0)
    for number in (1.0, 2.0):
        assert host.printed == []
        host.agent.perceive([Percept("add", structure("seen", number), (SOURCE_PERCEPT,))])
        host.run(seconds=0)
    assert host.printed == ["came"]


def test_waits_end_in_the_order_in_which_they_began():
    program = """
        !begin.
        +!begin <- !!first; !!second; !!third; !!fourth; .wait(10); -e; +d; +c(1).
        e.
        +!first <- .wait(c(_)); .print(first).
        +!second <- .wait(d); .print(second).
        +!third <- .wait(c(1)); .print(third).
        +!fourth <- .wait(not e); .print(fourth).
        """
    assert printed(program) == ["fourth", "second", "first", "third"]


def test_a_condition_costs_nothing_when_other_beliefs_change(calls_of):
    def work(waits: int) -> int:
        host = mind(
            f"!wait({waits}). +!wait(0). +!wait(I) : I > 0 <- !!sleep(I); !wait(I - 1). +!sleep(I) <- .wait(c(I, _))."
            "+!change <- for (.range(I, 1, 100)) { +c(-I, I); .wait(0); +d(I) }."
        )
        host.run()
        assert len(host.agent.waits.conditions) == waits
        host.agent.post_goal(atom("change"))
        return calls_of(host.run)

    # A look at each wait would be 20,000 calls more; what is freed meanwhile makes a hundred or so.
    assert work(200) < work(2) + 1000


def test_ended_waits_leave_nothing_behind():
    host = mind(
        "!go. +!go <- !!wait; .wait(1); !!wait; .wait(1); .drop_intention(wait); +done."
        "+!wait <- .wait(c(1, X) & not d(X) & .count(e(X), 5) & .intend(go), 10000)."
    )
    host.run(seconds=1)
    waits = host.agent.waits
    assert "done[source(self)]" in believed(host, "done")
    assert (waits.conditions, waits.restless, waits.due, waits.asked) == ({}, {}, {}, {})


ADDED = trigger("+", "", functor("a", 1))
OTHER = trigger("+", "", functor("b", 1))


def wait(agent: Mind, kind: object, heard: list[PendingEvent]) -> PendingEvent:
    made = listen(agent, kind, Var(), lambda _: heard.append(made))  # type: ignore[arg-type]
    return made


def test_waits_keep_their_order_and_leave_nothing_behind():
    agent = mind("").agent
    heard: list[PendingEvent] = []
    first, any_kind, other, last = (wait(agent, kind, heard) for kind in (ADDED, None, OTHER, ADDED))
    notify_listeners(agent, ((ADDED, 1.0), None, BY_SELF, None))
    assert heard == [first, any_kind, last]
    notify_listeners(agent, ((OTHER, 1.0), None, BY_SELF, None))
    assert heard == [first, any_kind, last, other]
    assert not agent.waits.events
    agent = mind("").agent
    heard: list[PendingEvent] = []
    first, second = wait(agent, ADDED, heard), wait(agent, ADDED, heard)
    cancel(agent, first)
    cancel(agent, first)
    notify_listeners(agent, ((ADDED, 1.0), None, BY_SELF, None))
    assert heard == [second]
    assert not agent.waits.events
    host = mind(
        "!begin. +!begin <- !!one; !!any; .wait(10); +b(1); .wait(10); +a(2)."
        "+!one <- .wait({+a(X)}); .print(one, X). +!any <- .wait({+V}); .print(any)."
    )
    host.run(seconds=5)
    assert host.printed == ["any", "one2"]
