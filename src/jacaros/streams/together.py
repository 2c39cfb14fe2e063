"""Join samples of several streams with nearby stamps, like ApproximateTime of message_filters."""

import math
from bisect import bisect_left, bisect_right

from jacaros.streams.operator import Emit, Operator, Values


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
