"""Join samples of several streams with nearby stamps, like ApproximateTime of message_filters."""

from bisect import bisect_left

from jacaros.streams.joining import Joining
from jacaros.streams.operator import Emit


class Together(Joining):
    """Shows the values of one sample of each stream, concatenated, if their times are close enough.

    A set is formed as soon as possible, from the new sample and the nearest ones of the other streams. No sample is used
    twice, nor after a newer one of its stream.

    Args:
        count: number of streams.
        within: maximum seconds between the first and the last sample of a set.
        lateness: further seconds for which a sample waits for those of other streams.
    """

    __slots__ = ("_within",)

    def __init__(self, emit: Emit, count: int, within: float, lateness: float) -> None:
        super().__init__(emit, [within + lateness] * count)
        self._within = within

    def join(self, source: int, place: int, time: float) -> None:
        chosen = self._nearest(source, place, time)
        if chosen is None:
            return
        made: list[object] = []
        for number, each in enumerate(chosen):
            made += self._values[number][each]
            self.use(number, each)
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


def _nearest_to(times: list[float], time: float) -> int | None:
    """Return the index of the time nearest to *time*, the earlier of two; None without times."""
    if not times:
        return None
    place = bisect_left(times, time)
    if place == len(times) or (place and time - times[place - 1] <= times[place] - time):
        return place - 1
    return place
