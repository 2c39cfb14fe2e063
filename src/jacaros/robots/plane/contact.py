"""Contact of robots with walls and with each other: push-out along the normal, and no other effect.

Simplified physics: only robots are pushed, nothing slips, and a robot must move less than its radius in a step (at 50 Hz
and 0.65 m/s it moves 13 mm).
"""

import math
from collections.abc import Iterable

from jacaros.robots.plane.shapes import Segment

CELL = 0.5
"""Side of a cell of the wall index, in metres."""
TOUCHING = 0.001
"""Distance in metres at which a robot touches an object without being pushed; keeps bumps from flickering."""
_MARGIN = 0.02

Wall = tuple[float, float, float, float, float]
"""A wall prepared for nearest-point queries: its first end, its direction, and the squared length."""


class WallIndex:
    """The walls that a robot can touch, by the cell of its centre; built once for robots up to *radius*."""

    def __init__(self, segments: Iterable[Segment], radius: float) -> None:
        cells: dict[tuple[int, int], list[Wall]] = {}
        reach = radius + _MARGIN
        for ax, ay, bx, by in segments:
            dx, dy = bx - ax, by - ay
            wall = (ax, ay, dx, dy, dx * dx + dy * dy)
            for column in range(_cell(min(ax, bx) - reach), _cell(max(ax, bx) + reach) + 1):
                for row in range(_cell(min(ay, by) - reach), _cell(max(ay, by) + reach) + 1):
                    cells.setdefault((column, row), []).append(wall)
        self._cells = {cell: tuple(walls) for cell, walls in cells.items()}

    def near(self, x: float, y: float) -> tuple[Wall, ...]:
        """Return the walls that a robot with its centre at the point may touch."""
        return self._cells.get((_cell(x), _cell(y)), ())


def _cell(value: float) -> int:
    return math.floor(value / CELL)


def push_out(
    x: float, y: float, radius: float, walls: Iterable[Wall]
) -> tuple[float, float, tuple[float, float] | None]:
    """Move a disc out of *walls*.

    Returns:
        The new centre, and the unit vector towards the last wall touched, or None.
    """
    towards = None
    for ax, ay, dx, dy, length2 in walls:
        place = ((x - ax) * dx + (y - ay) * dy) / length2
        place = 0.0 if place < 0.0 else 1.0 if place > 1.0 else place
        ex, ey = x - (ax + place * dx), y - (ay + place * dy)
        distance2 = ex * ex + ey * ey
        if distance2 >= (radius + TOUCHING) * (radius + TOUCHING):
            continue
        distance = math.sqrt(distance2)
        if distance == 0.0:  # on the wall: either side is correct, but it must always be the same one
            distance = math.sqrt(length2)
            ex, ey = -dy, dx
            nearness = radius
        else:
            nearness = radius - distance
        nx, ny = ex / distance, ey / distance
        if nearness > 0.0:
            x += nx * nearness
            y += ny * nearness
        towards = (-nx, -ny)
    return x, y, towards


Push = tuple[float, float, float, float]
"""The displacement of a disc in metres, and the unit vector towards what pushes it."""


def push_apart(ax: float, ay: float, bx: float, by: float, distance: float) -> Push | None:
    """Separate two discs whose centres are nearer than *distance*, moving each by half.

    Returns:
        The push of the first disc (that of the second is the opposite); None if they do not touch.
    """
    ex, ey = bx - ax, by - ay
    apart2 = ex * ex + ey * ey
    if apart2 >= (distance + TOUCHING) * (distance + TOUCHING):
        return None
    apart = math.sqrt(apart2)
    nx, ny = (ex / apart, ey / apart) if apart > 0.0 else (1.0, 0.0)
    half = 0.5 * (distance - apart) if apart < distance else 0.0
    return -nx * half, -ny * half, nx, ny
