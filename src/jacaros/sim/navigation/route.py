"""A way of straight pieces, and how far along it a robot is."""

import itertools
import math
from bisect import bisect_right
from collections.abc import Sequence

from jacaros.sim.navigation.placement import Point, distance


class Route:
    """Straight pieces from point to point.

    Attributes:
        points: where they begin and end.
        length: of all of them, in metres.
        done: metres along the way that the robot has come; it never goes back.
    """

    def __init__(self, points: Sequence[Point]) -> None:
        self.points = list(points)
        self._at = [0.0]
        for before, after in itertools.pairwise(self.points):
            self._at.append(self._at[-1] + distance(before, after))
        self.length = self._at[-1]
        self.done = 0.0

    @property
    def remaining(self) -> float:
        """Metres that are left."""
        return self.length - self.done

    def advance(self, place: Point, window: float = 0.8) -> float:
        """Note that the robot is at *place*; gives how far it is beside the way, in metres.

        Only the next *window* metres are looked at: a way may come back to where it was.
        """
        best, best_at = math.inf, self.done
        first = max(0, bisect_right(self._at, self.done) - 1)
        for index in range(first, len(self.points) - 1):
            if self._at[index] > self.done + window:
                break
            (ax, ay), (bx, by) = self.points[index], self.points[index + 1]
            dx, dy = bx - ax, by - ay
            if dx == 0.0 and dy == 0.0:
                continue
            share = ((place[0] - ax) * dx + (place[1] - ay) * dy) / (dx * dx + dy * dy)
            share = 0.0 if share < 0.0 else 1.0 if share > 1.0 else share
            apart = distance(place, (ax + share * dx, ay + share * dy))
            at = self._at[index] + share * (self._at[index + 1] - self._at[index])
            if at >= self.done and apart < best:
                best, best_at = apart, at
        if best == math.inf:
            best = distance(place, self.point(self.done))
        self.done = best_at
        return best

    def point(self, at: float) -> Point:
        """The point *at* so many metres from the beginning; the end for more than there are."""
        if at >= self.length:
            return self.points[-1]
        index = max(0, bisect_right(self._at, at) - 1)
        piece = self._at[index + 1] - self._at[index]
        share = (at - self._at[index]) / piece
        (ax, ay), (bx, by) = self.points[index], self.points[index + 1]
        return ax + share * (bx - ax), ay + share * (by - ay)

    def samples(self, ahead: float, step: float = 0.1) -> list[Point]:
        """Points of the next *ahead* metres of the way, its end among them if it is so near."""
        count = math.floor(min(ahead, self.remaining) / step)
        points = [self.point(self.done + index * step) for index in range(count + 1)]
        return [*points, self.points[-1]] if ahead >= self.remaining else points
