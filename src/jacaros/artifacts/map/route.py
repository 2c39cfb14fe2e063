"""The shortest route over free cells, and the direction of its first step."""

import math
from collections import defaultdict
from collections.abc import Collection

from jacaros.artifacts.map.cells import Cell
from jacaros.plane.path import cheapest_path


def route(free: Collection[Cell], start: Cell, goal: Cell) -> list[Cell] | None:
    """Return the shortest route from *start* to *goal* over *free* cells, by A* with eight neighbours.

    A diagonal step needs both adjacent cells free, so that a robot does not cut corners. Start and goal count as
    free. If several routes are shortest, the result is the same each time.

    Args:
        free: cells that may be entered.
        start: first cell of the route.
        goal: last cell of the route.

    Returns:
        All cells from start to goal, inclusive; None if there is no route.
    """
    cells = {*free, start, goal}
    left = min(cells)[0] - 1
    width = max(cells)[0] - left + 2
    weights = defaultdict(float, {y * width + x - left: 1.0 for x, y in cells})
    begin, end = (y * width + x - left for x, y in (start, goal))
    path = cheapest_path(weights, width, begin, end, cuts_corners=False)
    return None if path is None else [(cell % width + left, cell // width) for cell in path]


_COMPASS = ("east", "northeast", "north", "northwest", "west", "southwest", "south", "southeast")
"""Directions in steps of 45 degrees, counter-clockwise from the x axis."""

DEGREES = {name: math.remainder(45.0 * number, 360.0) for number, name in enumerate(_COMPASS)}
"""Directions in degrees from the x axis, -180 to 180: east is 0, north 90."""


def compass(start: Cell, end: Cell) -> str:
    """Return the direction from one cell to another as one of the eight words of `DEGREES`."""
    degrees = math.degrees(math.atan2(end[1] - start[1], end[0] - start[0]))
    return _COMPASS[round(degrees / 45.0) % 8]
