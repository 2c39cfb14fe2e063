"""Mean, minimum, maximum and slope of the numbers in a sliding window.

The result is that of the window that ends with the newest event; it is withdrawn when that event leaves the window.
"""

import math
from collections import deque

from jacaros.streams.condition import Condition
from jacaros.streams.operator import Emit, Operator, Values, number_at


class Aggregate(Operator):
    """A number computed from the window.

    Args:
        within: length of the window, in seconds.
        place: index of the value of an event to use, from 0.
        condition: show a state while it holds for the number; an open condition shows the number.
    """

    __slots__ = ("_condition", "_place", "_within")

    def __init__(self, emit: Emit, within: float, place: int, condition: Condition) -> None:
        super().__init__(emit)
        self._within, self._place, self._condition = within, place, condition

    def take(self, source: int, time: float, values: Values | None) -> None:
        value = number_at(values, self._place)
        if value is None:
            return
        self.deadline = time + self._within
        found = self.add(time, value)
        if found is None:
            self.hide()
        elif not self._condition.is_open:
            self.hold(self._condition.holds(found))
        else:
            self.show((found,))

    def advance(self, time: float) -> None:
        self.deadline = math.inf
        self.clear()
        self.hide()

    def add(self, time: float, value: float) -> float | None:
        """Put a number into the window and return the aggregate; None without a value."""
        raise NotImplementedError

    def clear(self) -> None:
        """Empty the window."""
        raise NotImplementedError


class Extreme(Aggregate):
    """The maximum (*sign* 1) or minimum (-1): candidates in a deque, each beyond those after it."""

    __slots__ = ("_candidates", "_sign")

    def __init__(self, emit: Emit, within: float, place: int, condition: Condition, sign: float) -> None:
        super().__init__(emit, within, place, condition)
        self._sign = sign
        self._candidates: deque[tuple[float, float]] = deque()

    def add(self, time: float, value: float) -> float | None:
        candidates, signed = self._candidates, self._sign * value
        while candidates and candidates[-1][1] <= signed:
            candidates.pop()
        candidates.append((time, signed))
        within = self._within
        while candidates[0][0] + within <= time:
            candidates.popleft()
        return self._sign * candidates[0][1]

    def clear(self) -> None:
        self._candidates.clear()


class Summed(Aggregate):
    """An aggregate computed from running sums.

    The sums are recomputed whenever as many numbers have left the window as are in it, so that rounding errors do not
    accumulate; this costs constant time per number.
    """

    __slots__ = ("_left", "_samples")

    def __init__(self, emit: Emit, within: float, place: int, condition: Condition) -> None:
        super().__init__(emit, within, place, condition)
        self._samples: deque[tuple[float, float]] = deque()
        self._left = 0
        self.begin(0.0, 0.0)

    def add(self, time: float, value: float) -> float | None:
        samples, within = self._samples, self._within
        while samples and samples[0][0] + within <= time:
            self.count(*samples.popleft(), -1.0)
            self._left += 1
        samples.append((time, value))
        if self._left >= len(samples) or len(samples) == 1:
            self._renew()
        else:
            self.count(time, value, 1.0)
        return self.result(len(samples))

    def _renew(self) -> None:
        self._left = 0
        self.begin(*self._samples[0])
        for time, value in self._samples:
            self.count(time, value, 1.0)

    def clear(self) -> None:
        self._samples.clear()

    def begin(self, time: float, value: float) -> None:
        """Reset the sums, relative to this time and value."""
        raise NotImplementedError

    def count(self, time: float, value: float, sign: float) -> None:
        """Add a sample to the sums (*sign* 1), or subtract it (-1)."""
        raise NotImplementedError

    def result(self, count: int) -> float | None:
        """Return the aggregate of *count* samples."""
        raise NotImplementedError


class Mean(Summed):
    """The arithmetic mean."""

    __slots__ = ("_base", "_sum")

    def begin(self, time: float, value: float) -> None:
        self._base, self._sum = value, 0.0

    def count(self, time: float, value: float, sign: float) -> None:
        self._sum += sign * (value - self._base)

    def result(self, count: int) -> float | None:
        return self._base + self._sum / count


class Slope(Summed):
    """The slope of the least-squares line, per second; None without two different times."""

    __slots__ = ("_start", "_t", "_tt", "_tv", "_v", "_zero")

    def begin(self, time: float, value: float) -> None:
        self._start, self._zero = time, value
        self._t = self._tt = self._v = self._tv = 0.0

    def count(self, time: float, value: float, sign: float) -> None:
        t, v = time - self._start, value - self._zero
        self._t += sign * t
        self._tt += sign * t * t
        self._v += sign * v
        self._tv += sign * t * v

    def result(self, count: int) -> float | None:
        spread = count * self._tt - self._t * self._t
        if spread <= 1e-12 * count * self._within * self._within:
            return None
        return (count * self._tv - self._t * self._v) / spread
