"""Records of causes: those that an agent acted for, of all that arise."""

from collections.abc import Callable, Mapping
from typing import Any

from jacaros.clock import Clock
from jacaros.trace import Cause, Tracer

KEPT = 10_000
"""Causes that are remembered until an act needs them; most sensor messages lead to nothing."""


class CauseRecords:
    """Numbers the causes of a run, and tells the chain of each act once: message, operation, property, act.

    A cause is told as ``cause``, with its ``id``, that of its ``parent`` (0: none), ``kind``, ``what``, and ``at``, when it
    arose.

    Args:
        clock: of the run.
        beginning: seconds of the clock from which ``at`` counts.
        tell: takes the kind of an event and its data.
    """

    def __init__(
        self, clock: Clock, beginning: float, tell: Callable[[str, Mapping[str, Any]], None]
    ) -> None:
        self._clock, self._beginning, self._tell = clock, beginning, tell
        self._last = 0
        self._untold: dict[int, tuple[Cause, float]] = {}

    def listen_to(self, trace: Callable[[Tracer | None], None]) -> Callable[[], None]:
        """Be the tracer of a system, which *trace* sets; gives what ends it."""
        trace(self)
        return lambda: trace(None)

    def link(self, kind: str, what: str, parent: Cause | None = None) -> Cause:
        """Make the next link of a chain, see `jacaros.trace.Tracer`."""
        self._last += 1
        made = Cause(self._last, parent.id if parent is not None else 0, kind, what)
        self._untold[made.id] = made, self._clock.now()
        if kind == "act":
            self._tell_chain(made.id)
        elif len(self._untold) > KEPT:
            del self._untold[next(iter(self._untold))]
        return made

    def _tell_chain(self, number: int) -> None:
        chain = []
        while number in self._untold:
            chain.append(self._untold.pop(number))
            number = chain[-1][0].parent
        for cause, at in reversed(chain):
            self._tell("cause", {**cause._asdict(), "at": round(at - self._beginning, 3)})
