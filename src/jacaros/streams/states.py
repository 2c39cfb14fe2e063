"""States of one stream: hysteresis, and a condition held for a while."""

import math

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


def _satisfies(values: Values | None, place: int, condition: Condition) -> bool:
    """Return whether the stream shows something, and its value at *place* satisfies the condition."""
    if values is None:
        return False
    return condition.is_open or (place < len(values) and condition.holds(values[place]))
