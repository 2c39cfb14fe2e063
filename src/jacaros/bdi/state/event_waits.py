"""Waits for events (``.wait({+e})``), found by the kind of event: others that wait cost an event nothing."""

from collections.abc import Iterator

from jacaros.bdi.state.intention import Intention
from jacaros.bdi.state.triggers import Trigger
from jacaros.bdi.state.waiting import TimedWait
from jacaros.terms.values import Term


class EventWait(TimedWait):
    """Waits for an event.

    Attributes:
        kind: of the events that may be meant; None for all.
        pattern: what the literal of the event has to unify with.
        number: it is the so-many-th wait of the agent.
    """

    __slots__ = ("kind", "number", "pattern")

    def __init__(
        self,
        intention: Intention,
        reason: Term,
        elapsed: Term,
        began: float,
        kind: Trigger | None,
        pattern: Term,
    ) -> None:
        super().__init__(intention, reason, elapsed, began)
        self.kind, self.pattern = kind, pattern
        self.number = 0


class EventWaits(dict[Trigger | None, dict[int, EventWait]]):
    """The waits of one agent: those for a kind of event, by their numbers; a kind without any has no entry."""

    def __init__(self) -> None:
        super().__init__()
        self._count = 0

    def add(self, wait: EventWait, number: int | None = None) -> None:
        """Begin to wait; *number* is that of a wait that was stored."""
        self._count = wait.number = self._count + 1 if number is None else number
        self.setdefault(wait.kind, {})[wait.number] = wait

    def remove(self, wait: EventWait) -> None:
        """Wait no more; nothing happens if it is over already."""
        held = self.get(wait.kind)
        if held is not None and held.pop(wait.number, None) is not None and not held:
            del self[wait.kind]

    def candidates(self, kind: Trigger) -> Iterator[EventWait]:
        """The waits that an event of that kind may end, in the order in which they began."""
        own, all_ = self.get(kind), self.get(None)
        if all_ is None:
            return iter(() if own is None else list(own.values()))
        both = (*(own.values() if own is not None else ()), *all_.values())
        return iter(sorted(both, key=lambda wait: wait.number))
