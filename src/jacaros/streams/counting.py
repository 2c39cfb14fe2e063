"""The number of events in a sliding window."""

import math
from collections import deque

from jacaros.streams.operator import Emit, Operator, Values


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
            self.hold(len(times) >= self._at_least)
        elif times:
            self.show((len(times),))
        else:
            self.hide()
