"""The values of streams at the times of another stream: a pose at the stamp of a scan."""

import math
from bisect import bisect_left, bisect_right
from collections.abc import Sequence

from jacaros.streams.joining import Joining
from jacaros.streams.operator import Emit, Values, number_at


class Interpolated(Joining):
    """Shows, for samples of the first stream, their values and those of the other streams at the same time.

    Numbers are interpolated linearly between the samples before and after, neither of which may be further away than
    *within*; other values are those of the sample before. A sample waits until the samples after it have arrived. Samples
    of the first stream that are older than one already shown are dropped.

    Args:
        count: number of streams.
        within: maximum seconds to the samples before and after.
        lateness: further seconds for which a sample waits.
        turns: for each value of the other streams, in order, the full turn of an angle in its unit; 0 or nothing for other
            values.
    """

    __slots__ = ("_turns", "_within")

    def __init__(
        self, emit: Emit, count: int, within: float, lateness: float, turns: Sequence[float] = ()
    ) -> None:
        super().__init__(emit, [within + lateness, *[within + lateness + within] * (count - 1)])
        self._within, self._turns = within, tuple(turns)

    def join(self, source: int, place: int, time: float) -> None:
        """Show the samples of the first stream whose neighbours have all arrived, in order."""
        for due, values in list(zip(self._times[0], self._values[0], strict=True)):
            made = self._made(due, values)
            if made is not None:
                self.use(0, bisect_right(self._times[0], due) - 1)
                self.show(made)

    def _made(self, time: float, values: Values) -> Values | None:
        made = list(values)
        offset = 0
        for times, samples in zip(self._times[1:], self._values[1:], strict=True):
            place = bisect_left(times, time)
            if place < len(times) and times[place] == time:
                found = samples[place]
            elif not 0 < place < len(times):
                return None
            else:
                before, after = times[place - 1], times[place]
                if time - before > self._within or after - time > self._within:
                    return None
                part = (time - before) / (after - before)
                found = self._between(samples[place - 1], samples[place], part, offset)
            offset += len(found)
            made += found
        return tuple(made)

    def _between(self, one: Values, other: Values, part: float, offset: int) -> Values:
        made = []
        for place, value in enumerate(one):
            first, last = number_at(one, place), number_at(other, place)
            if first is None or last is None or isinstance(value, bool):
                made.append(value)
                continue
            turn = self._turns[offset + place] if offset + place < len(self._turns) else 0.0
            made.append(_on_the_way(first, last, part, turn))
        return tuple(made)


def _on_the_way(first: float, last: float, part: float, turn: float) -> float:
    """Return the value between two numbers; for angles on the shorter arc, within half a turn of zero."""
    if not turn:
        return first + part * (last - first)
    way = math.remainder(last - first, turn)
    return math.remainder(first + part * way, turn)
