"""Waits for events are found by the kind of event, and end in the order in which they began."""

from recording_host import mind

from jacaros.agents.mind.mind import Mind
from jacaros.agents.mind.rules.pending import cancel, listen, notify_listeners
from jacaros.agents.mind.state.pending import PendingEvent
from jacaros.agents.mind.state.triggers import trigger
from jacaros.agents.terms.values import BY_SELF, Var, functor

ADDED = trigger("+", "", functor("a", 1))
OTHER = trigger("+", "", functor("b", 1))


def wait(agent: Mind, kind: object, heard: list[PendingEvent]) -> PendingEvent:
    made = listen(agent, kind, Var(), lambda _: heard.append(made))  # type: ignore[arg-type]
    return made


def test_waits_for_one_kind_and_for_any_kind_keep_their_order() -> None:
    agent = mind("").agent
    heard: list[PendingEvent] = []
    first, any_kind, other, last = (wait(agent, kind, heard) for kind in (ADDED, None, OTHER, ADDED))
    notify_listeners(agent, ((ADDED, 1.0), None, BY_SELF, None))
    assert heard == [first, any_kind, last]
    notify_listeners(agent, ((OTHER, 1.0), None, BY_SELF, None))
    assert heard == [first, any_kind, last, other]
    assert not agent.waits.events


def test_ended_waits_leave_nothing_behind() -> None:
    agent = mind("").agent
    heard: list[PendingEvent] = []
    first, second = wait(agent, ADDED, heard), wait(agent, ADDED, heard)
    cancel(agent, first)
    cancel(agent, first)
    notify_listeners(agent, ((ADDED, 1.0), None, BY_SELF, None))
    assert heard == [second]
    assert not agent.waits.events


def test_waits_for_any_event_see_those_of_every_kind() -> None:
    host = mind(
        "!begin. +!begin <- !!one; !!any; .wait(10); +b(1); .wait(10); +a(2)."
        "+!one <- .wait({+a(X)}); .print(one, X). +!any <- .wait({+V}); .print(any)."
    )
    host.run(seconds=5)
    assert host.printed == ["any", "one2"]
