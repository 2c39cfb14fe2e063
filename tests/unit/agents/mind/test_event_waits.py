"""Waits for events are found by the kind of event, and end in the order in which they began."""

from recording_host import mind

from jacaros.agents.mind.mind import Mind
from jacaros.agents.mind.rules.pending import cancel, listen, notify_listeners
from jacaros.agents.mind.state.pending import Listener
from jacaros.agents.mind.state.triggers import trigger
from jacaros.agents.terms.values import BY_SELF, Var, functor

ADDED = trigger("+", "", functor("a", 1))
OTHER = trigger("+", "", functor("b", 1))


def wait(agent: Mind, kind: object, heard: list[Listener]) -> Listener:
    made = listen(agent, kind, Var(), lambda _: heard.append(made))  # type: ignore[arg-type]
    return made


def test_waits_keep_their_order_and_leave_nothing_behind():
    agent = mind("").agent
    heard: list[Listener] = []
    first, any_kind, other, last = (wait(agent, kind, heard) for kind in (ADDED, None, OTHER, ADDED))
    notify_listeners(agent, ((ADDED, 1.0), None, BY_SELF, None))
    assert heard == [first, any_kind, last]
    notify_listeners(agent, ((OTHER, 1.0), None, BY_SELF, None))
    assert heard == [first, any_kind, last, other]
    assert not agent.waits.events
    agent = mind("").agent
    heard: list[Listener] = []
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
