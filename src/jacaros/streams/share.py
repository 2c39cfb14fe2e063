"""The share of time, within a sliding window, for which a condition holds."""

import math
from collections import deque

from jacaros.streams.condition import Condition
from jacaros.streams.operator import Emit, Operator, Values

TOLERANCE = 1e-6
"""Maximum error of the share caused by rounding, as a fraction of the window."""


class Share(Operator):
    """The share of the known time, which begins with the first event and is limited to the window.

    Between two events, the condition has its value at the first of them.

    Args:
        within: length of the window, in seconds.
        place: index of the value of an event to use, from 0.
        condition: condition on that value; an open one holds while the stream shows anything.
        at_least: show a state while the share is that large; None to show the share at each event.
    """

    __slots__ = ("_at_least", "_condition", "_first", "_past", "_place", "_since", "_sum", "_within")

    def __init__(
        self, emit: Emit, within: float, place: int, condition: Condition, at_least: float | None
    ) -> None:
        super().__init__(emit)
        self._within, self._place, self._condition, self._at_least = within, place, condition, at_least
        self._first: float | None = None
        self._since: float | None = None
        self._past: deque[tuple[float, float]] = deque()
        self._sum = 0.0

    def take(self, source: int, time: float, values: Values | None) -> None:
        if self._first is None:
            self._first = time
        holds = (
            values is not None
            and self._place < max(1, len(values))
            and self._condition.holds(values[self._place] if values else None)
        )
        if holds and self._since is None:
            self._since = time
        elif not holds and self._since is not None:
            self._past.append((self._since, time))
            self._sum += time - self._since
            self._since = None
        self._look(time)

    def advance(self, time: float) -> None:
        self._look(time)

    def _look(self, time: float) -> None:
        assert self._first is not None
        known = min(self._within, time - self._first)
        held = self._held(time)
        if self._at_least is None:
            share = held / known if known > 0.0 else float(self._since is not None)
            self.show((min(1.0, max(0.0, share)),))
            return
        margin = held - self._at_least * known
        if known <= 0.0:
            margin = 0.0 if self._since is not None else -math.inf
        self.hold(margin >= -TOLERANCE * self._within)
        self.deadline = self._next(time, held - self._at_least * known)

    def _held(self, time: float) -> float:
        """Return the seconds for which the condition held in the window that ends at *time*."""
        past, start = self._past, time - self._within
        while past and past[0][1] <= start:
            began, ended = past.popleft()
            self._sum = self._sum - (ended - began) if past else 0.0
        held = self._sum
        if past and past[0][0] < start:
            held -= start - past[0][0]
        if self._since is not None:
            held += time - max(start, self._since)
        return held

    def _next(self, time: float, margin: float) -> float:
        """Return when the margin crosses zero or changes its rate, whichever is first."""
        assert self._first is not None
        assert self._at_least is not None
        start = time - self._within
        turns = [self._first + self._within]
        oldest = self._past[0] if self._past else None
        if oldest is not None:
            turns += (oldest[0] + self._within, oldest[1] + self._within)
        elif self._since is not None:
            turns.append(self._since + self._within)
        turn = min((each for each in turns if each > time), default=math.inf)
        oldest_start = oldest[0] if oldest is not None else self._since
        leaves = oldest_start is not None and oldest_start <= start
        rate = float(self._since is not None) - float(leaves)
        if time < self._first + self._within:
            rate -= self._at_least
        goal = 0.0 if rate > 0.0 else -2.0 * TOLERANCE * self._within
        crossing = time + (goal - margin) / rate if rate and (goal - margin) / rate > 0.0 else math.inf
        return max(min(turn, crossing), math.nextafter(time, math.inf))
