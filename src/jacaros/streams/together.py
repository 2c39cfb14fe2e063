"""Several streams as one: samples whose stamps are near each other, as message_filters' ApproximateTime gives them."""

from bisect import bisect_left

from jacaros.streams.joining import Joining
from jacaros.streams.operator import Emit


class Together(Joining):
    """Shows the values of one sample of each stream, one behind the other, when their times are within a bound.

    A set is made as soon as one can be: of the sample that has just come and the nearest ones of the other streams.  No
    sample is used twice, and none that is older than one used before.

    Args:
        count: number of streams.
        within: seconds between the first and the last sample of a set, at most.
        lateness: seconds for which a sample waits for those of other streams beyond that.
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
        """Return the place of one sample in each stream; None unless they are within the bound."""
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
    """Return the place of the time nearest to *time*, the earlier one of two; None without times."""
    if not times:
        return None
    place = bisect_left(times, time)
    if place == len(times) or (place and time - times[place - 1] <= times[place] - time):
        return place - 1
    return place
