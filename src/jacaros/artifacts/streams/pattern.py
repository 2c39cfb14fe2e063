"""One derived event: takes events of its streams, and drives its operator."""

import math

from jacaros.artifacts.streams.declarations import Spec, Values
from jacaros.artifacts.streams.operators import (
    ANYTHING,
    Absent,
    Condition,
    Count,
    Emit,
    Held,
    Hysteresis,
    Operator,
    Together,
)


def _operator(spec: Spec, emit: Emit) -> Operator:
    """Make the operator of a valid declaration."""
    options = spec.options
    match spec.operator:
        case "count":
            wanted = options.get("at_least")
            return Count(emit, spec.seconds("within"), int(wanted) if wanted is not None else None)
        case "hysteresis":
            above = "on_above" in options
            limits = ("on_above", "off_below") if above else ("on_below", "off_above")
            return Hysteresis(emit, spec.place, options[limits[0]], options[limits[1]], above)
        case "held":
            condition = Condition(options.get("above"), options.get("below"), options.get("equals", ANYTHING))
            return Held(emit, spec.seconds("for"), spec.place, condition)
        case "absent":
            return Absent(emit, spec.seconds("for"))
    return Together(emit, len(spec.sources), spec.seconds("within"), spec.lateness)


class Pattern:
    """The incremental evaluation of one declaration.

    Event times are seconds of any clock. An event that is older than the time up to which the pattern has been evaluated,
    because its message took long, counts at that time.

    Args:
        spec: a valid declaration.
        start: start time of the pattern.
        emit: takes the outputs, in order.
    """

    __slots__ = ("_mark", "_operator", "_start", "spec")

    def __init__(self, spec: Spec, start: float, emit: Emit) -> None:
        self.spec = spec
        self._operator = _operator(spec, emit)
        self._start = start
        self._mark = 0.0

    @property
    def shown(self) -> Values | None:
        """Values of the derived state, None while it does not hold."""
        return self._operator.shown

    @property
    def dropped(self) -> int:
        """Number of events that arrived too late for their partners."""
        return int(getattr(self._operator, "dropped", 0))

    @property
    def deadline(self) -> float:
        """Time of the next call of `advance`, unless an event arrives before; infinite for never."""
        return self._start + self._operator.deadline

    def take(self, source: int, time: float, values: Values | None) -> None:
        """Process an event.

        Args:
            source: number of its stream in `Spec.sources`.
            time: time of the event, in seconds.
            values: values of the event; None if the state shown by the stream ended.
        """
        time -= self._start
        if self._operator.ordered:
            time = max(time, self._mark)
            self._pass(time)
        self._operator.take(source, time, values)

    def advance(self, now: float) -> None:
        """Advance to *now* on the clock of the event times."""
        time = max(self._mark, now - self._start)
        # A deadline at *now* is due, despite rounding in the conversion of times.
        self._pass(max(time, self._operator.deadline) if self.deadline <= now else time)

    def _pass(self, time: float) -> None:
        """Advance the operator through its deadlines up to *time*."""
        self._mark = time
        operator = self._operator
        while (due := operator.deadline) <= time:
            operator.advance(due)
            if operator.deadline <= due:  # an operator that makes no progress would block all others
                operator.deadline = math.nextafter(due, math.inf)
