"""Waits for events are found by the kind of event, and end in the order in which they began."""

from recording_host import mind

from jacaros.bdi.state.intention import Intention
from jacaros.bdi.state.triggers import trigger
from jacaros.bdi.state.waiting import EventWait, EventWaits
from jacaros.terms.values import functor

ADDED = trigger("+", "", functor("a", 1))
OTHER = trigger("+", "", functor("b", 1))


def wait(waits: EventWaits, kind: object) -> EventWait:
    made = EventWait(Intention(1), None, None, 0.0, kind, None)  # type: ignore[arg-type]
    waits.add(made)
    return made


def test_waits_for_one_kind_and_for_any_kind_keep_their_order() -> None:
    waits = EventWaits()
    first, any_kind, other, last = (wait(waits, kind) for kind in (ADDED, None, OTHER, ADDED))
    assert list(waits.candidates(ADDED)) == [first, any_kind, last]
    assert list(waits.candidates(OTHER)) == [any_kind, other]


def test_ended_waits_leave_nothing_behind() -> None:
    waits = EventWaits()
    first, second = wait(waits, ADDED), wait(waits, ADDED)
    waits.remove(first)
    waits.remove(first)
    assert list(waits.candidates(ADDED)) == [second]
    waits.remove(second)
    assert not waits


def test_waits_for_any_event_see_those_of_every_kind() -> None:
    host = mind(
        "!begin. +!begin <- !!one; !!any; .wait(10); +b(1); .wait(10); +a(2)."
        "+!one <- .wait({+a(X)}); .print(one, X). +!any <- .wait({+V}); .print(any)."
    )
    host.run(seconds=5)
    assert host.printed == ["any", "one2"]
