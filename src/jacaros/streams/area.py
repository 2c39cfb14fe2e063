"""Whether a pose is in an area."""

import math
from dataclasses import dataclass

from jacaros.streams.operator import Emit, Operator, Values, number_at


@dataclass(frozen=True, slots=True)
class Circle:
    """A circle, in metres."""

    x: float
    y: float
    radius: float

    def distance(self, x: float, y: float) -> float:
        """Return the distance to the area in metres, 0 inside."""
        return max(0.0, math.hypot(x - self.x, y - self.y) - self.radius)


@dataclass(frozen=True, slots=True)
class Rectangle:
    """An axis-aligned rectangle, in metres."""

    left: float
    bottom: float
    right: float
    top: float

    def distance(self, x: float, y: float) -> float:
        """Return the distance to the area in metres, 0 inside."""
        across = max(self.left - x, 0.0, x - self.right)
        along = max(self.bottom - y, 0.0, y - self.top)
        return math.hypot(across, along)


class Inside(Operator):
    """Starts when the first two values are in the area, ends when they are more than *margin* metres outside."""

    __slots__ = ("_area", "_margin", "_place")

    def __init__(self, emit: Emit, area: Circle | Rectangle, margin: float, place: int) -> None:
        super().__init__(emit)
        self._area, self._margin, self._place = area, margin, place

    def take(self, source: int, time: float, values: Values | None) -> None:
        if values is None:
            self.hide()
            return
        x, y = number_at(values, self._place), number_at(values, self._place + 1)
        if x is None or y is None:
            return
        distance = self._area.distance(x, y)
        if distance <= 0.0:
            self.show(())
        elif distance > self._margin:
            self.hide()

    def advance(self, time: float) -> None:
        self.deadline = math.inf
