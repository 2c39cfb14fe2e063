"""States of one stream: hysteresis, a condition held for a while, debouncing, delayed values."""

import math
from collections import deque

from jacaros.streams.condition import Condition
from jacaros.streams.operator import Emit, Operator, Values, number_at


class Hysteresis(Operator):
    """Starts when the number passes one limit and ends when it passes another.

    Args:
        place: index of the value of an event to use, from 0.
        on, off: limits.
        rising: the state starts above *on* and ends below *off*; otherwise it starts below and ends above.
    """

    __slots__ = ("_off", "_on", "_place", "_sign")

    def __init__(self, emit: Emit, place: int, on: float, off: float, rising: bool) -> None:
        super().__init__(emit)
        self._place = place
        self._sign = 1.0 if rising else -1.0
        self._on, self._off = self._sign * on, self._sign * off

    def take(self, source: int, time: float, values: Values | None) -> None:
        if values is None:
            self.hide()
            return
        value = number_at(values, self._place)
        if value is None:
            return
        if self._sign * value > self._on:
            self.show(())
        elif self._sign * value < self._off:
            self.hide()

    def advance(self, time: float) -> None:
        self.deadline = math.inf


class Held(Operator):
    """Holds once the condition has held for *lasting* seconds without a break."""

    __slots__ = ("_condition", "_lasting", "_place", "_since")

    def __init__(self, emit: Emit, lasting: float, place: int, condition: Condition) -> None:
        super().__init__(emit)
        self._lasting, self._place, self._condition = lasting, place, condition
        self._since: float | None = None

    def take(self, source: int, time: float, values: Values | None) -> None:
        if not _satisfies(values, self._place, self._condition):
            self._since, self.deadline = None, math.inf
            self.hide()
        elif self._since is None:
            self._since, self.deadline = time, time + self._lasting

    def advance(self, time: float) -> None:
        self.deadline = math.inf
        self.show(())


class Debounce(Operator):
    """Shows the values of the stream once they have stayed the same for *lasting* seconds."""

    __slots__ = ("_candidate", "_lasting")

    def __init__(self, emit: Emit, lasting: float) -> None:
        super().__init__(emit)
        self._lasting = lasting
        self._candidate: Values | None = None

    def take(self, source: int, time: float, values: Values | None) -> None:
        if values != self._candidate:
            self._candidate = values
            self.deadline = math.inf if values == self.shown else time + self._lasting

    def advance(self, time: float) -> None:
        self.deadline = math.inf
        if self._candidate is None:
            self.hide()
        else:
            self.show(self._candidate)


class Delayed(Operator):
    """Shows what the stream showed *by* seconds ago."""

    __slots__ = ("_by", "_past")

    def __init__(self, emit: Emit, by: float) -> None:
        super().__init__(emit)
        self._by = by
        self._past: deque[tuple[float, Values | None]] = deque()

    def take(self, source: int, time: float, values: Values | None) -> None:
        self._past.append((time, values))
        self.deadline = self._past[0][0] + self._by

    def advance(self, time: float) -> None:
        past = self._past
        while past and past[0][0] + self._by <= time:
            _, values = past.popleft()
            if not past or past[0][0] + self._by > time:  # of simultaneous events the last one counts
                if values is None:
                    self.hide()
                else:
                    self.show(values)
        self.deadline = past[0][0] + self._by if past else math.inf


def _satisfies(values: Values | None, place: int, condition: Condition) -> bool:
    """Return whether the stream shows something, and its value at *place* satisfies the condition."""
    if values is None:
        return False
    return condition.is_open or (place < len(values) and condition.holds(values[place]))
