"""The shortest route over free cells, and the direction of its first step."""

import heapq
import math
from collections.abc import Collection, Iterator

from jacaros.artifacts.map.cells import Cell

_DIAGONAL = math.sqrt(2.0)


def route(free: Collection[Cell], start: Cell, goal: Cell) -> list[Cell] | None:
    """Return the shortest route from *start* to *goal* over *free* cells, by A* with eight neighbours.

    A diagonal step needs both adjacent cells free, so that a robot does not cut corners. Start and goal count as
    free. If several routes are shortest, the result is the same each time.

    Args:
        free: cells that may be entered; a set, for speed.
        start: first cell of the route.
        goal: last cell of the route.

    Returns:
        All cells from start to goal, inclusive; None if there is no route.
    """
    open_cells: list[tuple[float, float, Cell]] = [(_octile(start, goal), 0.0, start)]
    costs = {start: 0.0}
    came_from: dict[Cell, Cell] = {}
    while open_cells:
        _, cost, cell = heapq.heappop(open_cells)
        if cell == goal:
            return _way(came_from, goal)
        if cost > costs[cell]:
            continue
        for neighbour, length in _steps(free, cell, start, goal):
            better = cost + length
            if better < costs.get(neighbour, math.inf) - 1e-9:
                costs[neighbour] = better
                came_from[neighbour] = cell
                heapq.heappush(open_cells, (better + _octile(neighbour, goal), better, neighbour))
    return None


def _steps(free: Collection[Cell], cell: Cell, start: Cell, goal: Cell) -> Iterator[tuple[Cell, float]]:
    def passable(candidate: Cell) -> bool:
        return candidate in free or candidate in (start, goal)

    x, y = cell
    for dx in (-1, 0, 1):
        for dy in (-1, 0, 1):
            if (dx, dy) == (0, 0) or not passable((x + dx, y + dy)):
                continue
            if dx and dy:
                if passable((x + dx, y)) and passable((x, y + dy)):
                    yield (x + dx, y + dy), _DIAGONAL
            else:
                yield (x + dx, y + dy), 1.0


def _octile(a: Cell, b: Cell) -> float:
    dx, dy = abs(a[0] - b[0]), abs(a[1] - b[1])
    return max(dx, dy) + (_DIAGONAL - 1.0) * min(dx, dy)


def _way(came_from: dict[Cell, Cell], goal: Cell) -> list[Cell]:
    way = [goal]
    while way[-1] in came_from:
        way.append(came_from[way[-1]])
    return way[::-1]


_COMPASS = ("east", "northeast", "north", "northwest", "west", "southwest", "south", "southeast")
"""Directions in steps of 45 degrees, counter-clockwise from the x axis."""

DEGREES = {name: math.remainder(45.0 * number, 360.0) for number, name in enumerate(_COMPASS)}
"""Directions in degrees from the x axis, -180 to 180: east is 0, north 90."""


def compass(start: Cell, end: Cell) -> str:
    """Return the direction from one cell to another as one of the eight words of `DEGREES`."""
    degrees = math.degrees(math.atan2(end[1] - start[1], end[0] - start[0]))
    return _COMPASS[round(degrees / 45.0) % 8]
