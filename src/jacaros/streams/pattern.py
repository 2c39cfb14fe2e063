"""One derived event: takes events of its streams, sorts late ones, and drives its operator."""

import heapq
import itertools
import math
from collections import deque
from typing import Any

from jacaros.streams.operator import Emit, Operator, Values
from jacaros.streams.schema import OPERATORS, Spec

_DATA = (bool, int, float, str, tuple, list, deque, type(None))


class Pattern:
    """The incremental evaluation of one declaration.

    Event times are seconds of any clock. The *watermark* is the event time up to which all events are known: the time
    of the newest event or of the last `advance`, whichever is later, minus the lateness. Events are evaluated in time
    order when the watermark reaches them; events older than the watermark are dropped.

    Args:
        spec: a valid declaration.
        start: start time of the pattern.
        emit: takes the outputs, in order.

    Attributes:
        dropped: number of events that arrived too late.
    """

    __slots__ = ("_dropped", "_early", "_lateness", "_mark", "_numbers", "_operator", "_start", "spec")

    def __init__(self, spec: Spec, start: float, emit: Emit) -> None:
        self.spec = spec
        self._operator = OPERATORS[spec.operator].make(spec, emit)
        self._start, self._lateness = start, spec.lateness if self._operator.ordered else 0.0
        self._mark = 0.0
        self._early: list[tuple[float, int, int, Values | None]] = []
        self._numbers = itertools.count()
        self._dropped = 0

    @property
    def shown(self) -> Values | None:
        """Values of the derived state, None while it does not hold."""
        return self._operator.shown

    @property
    def dropped(self) -> int:
        """Number of events that arrived too late."""
        return self._dropped + int(getattr(self._operator, "dropped", 0))

    @property
    def deadline(self) -> float:
        """Time of the next call of `advance`, unless an event arrives before; infinite for never."""
        if not self._early:
            return self._start + self._operator.deadline + self._lateness
        return self._start + self._due() + self._lateness

    def _due(self) -> float:
        """Return the event time of the next change without an event."""
        due = self._operator.deadline
        return self._early[0][0] if self._early and self._early[0][0] < due else due

    def take(self, source: int, time: float, values: Values | None) -> None:
        """Process an event.

        Args:
            source: number of its stream in `Spec.streams`.
            time: time of the event, in seconds.
            values: values of the event; None if the state shown by the stream ended.
        """
        time -= self._start
        operator = self._operator
        if not operator.ordered:
            operator.take(source, time, values)
        elif time < self._mark:
            self._dropped += 1
        elif self._lateness:
            heapq.heappush(self._early, (time, next(self._numbers), source, values))
            self._release(time - self._lateness)
        else:
            if operator.deadline <= time:
                self._pass(time)
            self._mark = time
            operator.take(source, time, values)

    def state(self) -> dict[str, Any]:
        """Return the state of the evaluation, as numbers, tuples, lists and dictionaries."""
        early = [tuple(each) for each in self._early]
        own = {"start": self._start, "mark": self._mark, "early": early, "dropped": self._dropped}
        return {**own, "operator": {name: _plain(value) for name, value in _kept(self._operator)}}

    def resume(self, state: dict[str, Any]) -> None:
        """Continue from the `state` of a pattern with the same declaration."""
        self._start, self._mark, self._dropped = state["start"], state["mark"], state["dropped"]
        self._early = [tuple(each) for each in state["early"]]
        self._numbers = itertools.count(1 + max((each[1] for each in self._early), default=-1))
        for name, value in state["operator"].items():
            before = getattr(self._operator, name)
            setattr(self._operator, name, deque(value) if isinstance(before, deque) else value)

    def advance(self, now: float) -> None:
        """Advance to *now* on the clock of the event times."""
        mark = now - self._start - self._lateness
        # Deadlines at *now* are due, despite rounding in the conversion of times.
        self._release(max(mark, self._due()) if self.deadline <= now else mark)

    def _release(self, mark: float) -> None:
        """Move the watermark, and evaluate the events up to it."""
        self._mark = mark = max(self._mark, mark)
        early = self._early
        while early and early[0][0] <= mark:
            time, _, source, values = heapq.heappop(early)
            self._pass(time)
            self._operator.take(source, time, values)
        self._pass(mark)

    def _pass(self, time: float) -> None:
        """Advance the operator through its deadlines up to *time*."""
        operator = self._operator
        while (due := operator.deadline) <= time:
            operator.advance(due)
            if operator.deadline <= due:  # an operator that makes no progress would block all others
                operator.deadline = math.nextafter(due, math.inf)


def _kept(operator: Operator) -> list[tuple[str, Any]]:
    """Return the attributes of an operator that are data."""
    names = [name for kind in type(operator).__mro__ for name in getattr(kind, "__slots__", ())]
    found = [(name, getattr(operator, name)) for name in names]
    return [(name, value) for name, value in found if isinstance(value, _DATA)]


def _plain(value: Any) -> Any:
    """Return data with lists instead of deques."""
    return list(value) if isinstance(value, deque) else value
