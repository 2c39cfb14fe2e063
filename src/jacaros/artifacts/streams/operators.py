"""The operators: sliding windows, states, absences, and samples of several streams together."""

import math
from bisect import bisect_left, bisect_right
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

from jacaros.artifacts.streams.declarations import Values

SHOW, HIDE = "show", "hide"
"""Kinds of output: the derived state begins or changes its values; it ends."""

Emit = Callable[[str, Values], None]
"""Takes the kind of an output and its values (empty for `HIDE`)."""


class Operator:
    """Takes events in time order and emits their consequences.

    The pattern calls `advance` at each deadline before it passes a later event.

    Args:
        emit: takes the outputs.

    Attributes:
        ordered: whether events must arrive in time order; otherwise the operator orders them itself.
        deadline: time in seconds at which the output may change without an event; infinite for never.
        shown: values of the current state, None without one.
    """

    ordered = True

    __slots__ = ("_emit", "deadline", "shown")

    def __init__(self, emit: Emit) -> None:
        self._emit = emit
        self.deadline = math.inf
        self.shown: Values | None = None

    def take(self, source: int, time: float, values: Values | None) -> None:
        """Process an event.

        Args:
            source: number of its stream.
            time: seconds since the start of the pattern.
            values: values of the event; None if the state shown by the stream ended.
        """
        raise NotImplementedError

    def advance(self, time: float) -> None:
        """Advance to *time*, at which `deadline` is reached."""
        raise NotImplementedError

    def show(self, values: Values) -> None:
        """Emit that the state holds with *values*, unless it already does."""
        if values != self.shown:
            self.shown = values
            self._emit(SHOW, values)

    def hide(self) -> None:
        """Emit that the state ended, if it held."""
        if self.shown is not None:
            self.shown = None
            self._emit(HIDE, ())


def number_at(values: Values | None, place: int) -> float | None:
    """Return the finite number at *place*; None otherwise."""
    if values is None or place >= len(values):
        return None
    value = values[place]
    return float(value) if isinstance(value, int | float) and math.isfinite(value) else None


# Conditions on one value.


ANYTHING: Final = object()
"""Marks that no value is required."""


@dataclass(frozen=True, slots=True)
class Condition:
    """A condition on a value; all given parts must hold.

    Attributes:
        above, below: exclusive limits; None for no limit.
        equals: required value.
    """

    above: float | None = None
    below: float | None = None
    equals: object = ANYTHING

    @property
    def is_open(self) -> bool:
        """Whether every value satisfies the condition."""
        return self.above is None and self.below is None and self.equals is ANYTHING

    def holds(self, value: object) -> bool:
        """Return whether *value* satisfies the condition; values that are not numbers never exceed a limit."""
        if self.equals is not ANYTHING and value != self.equals:
            return False
        if self.above is None and self.below is None:
            return True
        if not isinstance(value, int | float):
            return False
        return (self.above is None or value > self.above) and (self.below is None or value < self.below)


# The number of events in a sliding window.


class Count(Operator):
    """The number of events in the window.

    Args:
        within: length of the window, in seconds.
        at_least: show a state while there are that many events; None to show the number.
    """

    __slots__ = ("_at_least", "_times", "_within")

    def __init__(self, emit: Emit, within: float, at_least: int | None) -> None:
        super().__init__(emit)
        self._within, self._at_least = within, at_least
        self._times: deque[float] = deque()

    def take(self, source: int, time: float, values: Values | None) -> None:
        if values is None:
            return
        times = self._times
        times.append(time)
        if self._at_least is not None and len(times) > self._at_least:
            times.popleft()  # only the newest events decide whether there are enough
        self._look(time)

    def advance(self, time: float) -> None:
        self._look(time)

    def _look(self, time: float) -> None:
        times, within = self._times, self._within
        while times and times[0] + within <= time:
            times.popleft()
        self.deadline = times[0] + within if times else math.inf
        if self._at_least is not None:
            enough = len(times) >= self._at_least
            self.show(()) if enough else self.hide()
        elif times:
            self.show((len(times),))
        else:
            self.hide()


# States of one stream: hysteresis, and a condition held for a while.


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


# The absence of events.


class Absent(Operator):
    """Holds while the newest event, or the start of the pattern, is *lasting* seconds or longer ago."""

    __slots__ = ("_lasting",)

    def __init__(self, emit: Emit, lasting: float) -> None:
        super().__init__(emit)
        self._lasting = lasting
        self.deadline = lasting

    def take(self, source: int, time: float, values: Values | None) -> None:
        if values is not None:
            self.deadline = time + self._lasting
            self.hide()

    def advance(self, time: float) -> None:
        self.deadline = math.inf
        self.show(())


# Join samples of several streams with nearby stamps, like ApproximateTime of message_filters.


class Together(Operator):
    """Shows the values of one sample of each stream, concatenated, if their times are close enough.

    A set is formed as soon as possible, from the new sample and the nearest ones of the other streams. No sample is used
    twice, nor after a newer one of its stream. The samples of each stream are kept in time order, for as long as a
    partner may arrive.

    Args:
        count: number of streams.
        within: maximum seconds between the first and the last sample of a set.
        lateness: further seconds for which a sample waits for those of other streams.
    """

    ordered = False

    __slots__ = ("_newest", "_retention", "_times", "_used", "_values", "_within", "dropped")

    def __init__(self, emit: Emit, count: int, within: float, lateness: float) -> None:
        super().__init__(emit)
        self._within, self._retention = within, within + lateness
        self._times: list[list[float]] = [[] for _ in range(count)]
        self._values: list[list[Values]] = [[] for _ in range(count)]
        self._used = [-math.inf] * count
        self._newest = -math.inf
        self.dropped = 0

    def take(self, source: int, time: float, values: Values | None) -> None:
        if values is None:
            self._times[source].clear()
            self._values[source].clear()
            self.hide()
            return
        if time <= self._used[source] or time < self._newest - self._retention:
            self.dropped += 1
            return
        place = bisect_right(self._times[source], time)
        self._times[source].insert(place, time)
        self._values[source].insert(place, values)
        if time > self._newest:
            self._newest = time
            self._forget()
        chosen = self._nearest(source, place, time)
        if chosen is not None:
            self._join(chosen)

    def advance(self, time: float) -> None:
        self.deadline = math.inf

    def _join(self, chosen: list[int]) -> None:
        """Show a set of samples: they and earlier ones are not used again."""
        made: list[object] = []
        for number, place in enumerate(chosen):
            times, values = self._times[number], self._values[number]
            made += values[place]
            self._used[number] = times[place]
            del times[: place + 1], values[: place + 1]
        self.show(tuple(made))

    def _nearest(self, source: int, place: int, time: float) -> list[int] | None:
        """Return the index of one sample in each stream; None unless they are close enough."""
        chosen: list[int] = []
        first = last = time
        for number, times in enumerate(self._times):
            found = place if number == source else _nearest_to(times, time)
            if found is None:
                return None
            chosen.append(found)
            first, last = min(first, times[found]), max(last, times[found])
        return chosen if last - first <= self._within else None

    def _forget(self) -> None:
        oldest = self._newest - self._retention
        for times, values in zip(self._times, self._values, strict=True):
            if times and times[0] < oldest:
                count = bisect_left(times, oldest)
                del times[:count], values[:count]


def _nearest_to(times: list[float], time: float) -> int | None:
    """Return the index of the time nearest to *time*, the earlier of two; None without times."""
    if not times:
        return None
    place = bisect_left(times, time)
    if place == len(times) or (place and time - times[place - 1] <= times[place] - time):
        return place - 1
    return place
