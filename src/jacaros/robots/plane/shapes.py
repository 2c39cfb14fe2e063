"""Shapes in the plane: segments, rectangles and discs, in metres."""

import math
from typing import NamedTuple


class Segment(NamedTuple):
    """A straight piece, such as a wall without thickness, in metres."""

    ax: float
    ay: float
    bx: float
    by: float

    def distance(self, x: float, y: float) -> float:
        """Return the distance in metres from a point to the segment."""
        dx, dy = self.bx - self.ax, self.by - self.ay
        place = ((x - self.ax) * dx + (y - self.ay) * dy) / (dx * dx + dy * dy)
        place = 0.0 if place < 0.0 else 1.0 if place > 1.0 else place
        ex, ey = x - (self.ax + place * dx), y - (self.ay + place * dy)
        return math.sqrt(ex * ex + ey * ey)

    def gap(self, other: "Segment") -> float:
        """Return the smallest distance in metres between two segments; 0 if they cross."""
        if self.crosses(other):
            return 0.0
        return min(
            self.distance(other.ax, other.ay),
            self.distance(other.bx, other.by),
            other.distance(self.ax, self.ay),
            other.distance(self.bx, self.by),
        )

    def crosses(self, *others: "Segment") -> bool:
        """Return whether it crosses one of some other segments."""
        ax, ay, dx, dy = self.ax, self.ay, self.bx - self.ax, self.by - self.ay
        for cx, cy, ex, ey in others:
            of_c, of_e = dx * (cy - ay) - dy * (cx - ax), dx * (ey - ay) - dy * (ex - ax)
            if (of_c > 0.0) == (of_e > 0.0):
                continue
            wx, wy = ex - cx, ey - cy
            if (wx * (ay - cy) - wy * (ax - cx) > 0.0) != (wx * (self.by - cy) - wy * (self.bx - cx) > 0.0):
                return True
        return False


class Rectangle(NamedTuple):
    """An axis-aligned rectangle, in metres."""

    x_min: float
    y_min: float
    x_max: float
    y_max: float

    def contains(self, x: float, y: float) -> bool:
        """Return whether a point is inside or on the edge."""
        return self.x_min <= x <= self.x_max and self.y_min <= y <= self.y_max

    def edges(self) -> tuple[Segment, Segment, Segment, Segment]:
        """Return the four sides, counter-clockwise."""
        a, b, c, d = self
        return Segment(a, b, c, b), Segment(c, b, c, d), Segment(c, d, a, d), Segment(a, d, a, b)


Circle = tuple[float, float, float]
"""A disc: centre and radius, in metres."""
