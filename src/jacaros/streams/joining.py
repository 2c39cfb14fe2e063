"""The buffers of operators that join samples of several streams by time."""

import math
from bisect import bisect_left, bisect_right
from collections.abc import Sequence

from jacaros.streams.operator import Emit, Operator, Values


class Joining(Operator):
    """Keeps the samples of each stream in time order, for as long as a partner may arrive.

    Args:
        retention: for each stream, the seconds that a sample is kept after the newest sample of all streams.
    """

    ordered = False

    __slots__ = ("_newest", "_retention", "_times", "_used", "_values", "dropped")

    def __init__(self, emit: Emit, retention: Sequence[float]) -> None:
        super().__init__(emit)
        self._retention = tuple(retention)
        self._times: list[list[float]] = [[] for _ in retention]
        self._values: list[list[Values]] = [[] for _ in retention]
        self._used = [-math.inf] * len(retention)
        self._newest = -math.inf
        self.dropped = 0

    def take(self, source: int, time: float, values: Values | None) -> None:
        if values is None:
            self._times[source].clear()
            self._values[source].clear()
            self.hide()
            return
        if time <= self._used[source] or time < self._newest - self._retention[source]:
            self.dropped += 1
            return
        place = bisect_right(self._times[source], time)
        self._times[source].insert(place, time)
        self._values[source].insert(place, values)
        if time > self._newest:
            self._newest = time
            self._forget()
        self.join(source, place, time)

    def advance(self, time: float) -> None:
        self.deadline = math.inf

    def join(self, source: int, place: int, time: float) -> None:
        """Emit the consequences of a new sample, which is at *place* among those of its stream."""
        raise NotImplementedError

    def use(self, source: int, place: int) -> None:
        """Use a sample: it and earlier ones are not used again."""
        self._used[source] = self._times[source][place]
        del self._times[source][: place + 1], self._values[source][: place + 1]

    def _forget(self) -> None:
        for times, values, retention in zip(self._times, self._values, self._retention, strict=True):
            oldest = self._newest - retention
            if times and times[0] < oldest:
                count = bisect_left(times, oldest)
                del times[:count], values[:count]
