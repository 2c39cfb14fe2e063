"""Routes over free cells for a robot with a size, their straight legs, and the border of unknown ground."""

import math
from collections import defaultdict, deque
from collections.abc import Collection, Iterator, Sequence
from typing import NamedTuple

from jacaros.robots.map.cells import Cell
from jacaros.robots.plane.path import cheapest_path
from jacaros.robots.plane.pose import Point, Pose, normalised
from jacaros.robots.plane.pose_search import disc


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


# Clearance for the robot: routes avoid cells that are too close to an obstacle.


def inflated(passable: set[Cell], blocked: Collection[Cell], radius: float, here: Cell) -> set[Cell]:
    """Return the passable cells whose centres are farther than *radius* from those of obstacles.

    A robot that is already too close to an obstacle may drive away: the passable cells around it stay.

    Args:
        passable: cells that a point could enter.
        blocked: the obstacles.
        radius: in cells; 0 keeps all passable cells.
        here: the robot's cell.
    """
    if radius <= 0.0:
        return passable
    near = {(x + dx, y + dy) for dx, dy in disc(radius) for x, y in blocked}
    wide = passable - near
    if here not in wide:
        x, y = here
        around = {(x + dx, y + dy) for dx, dy in disc(2.0 * radius)}
        wide |= passable & around
    return wide


# Straight legs of a route, for a robot that turns on the spot and drives straight ahead.


class Leg(NamedTuple):
    """Limits of legs.

    Attributes:
        size: side of a cell, in metres.
        longest: maximum length, in metres.
    """

    size: float
    longest: float


def next_leg(way: Sequence[Cell], free: Collection[Cell], pose: Pose, leg: Leg) -> tuple[float, float]:
    """Return the turn (radians, positive to the left) and the distance (metres) to the farthest cell in a straight
    line.

    Args:
        way: cells from start to goal.
        free: cells that may be entered.
        pose: pose of the robot, in metres; it may be slightly off the route.
        leg: size of cells, and maximum length.
    """
    size = leg.size
    at = min(range(len(way)), key=lambda i: (math.dist(pose[:2], (way[i][0] * size, way[i][1] * size)), i))
    target = min(at + 1, len(way) - 1)
    for i in range(target + 1, len(way)):
        x, y = way[i][0] * size, way[i][1] * size
        if math.dist(pose[:2], (x, y)) > leg.longest or not _clear(pose, x, y, free, size):
            break
        target = i
    x, y = way[target][0] * size, way[target][1] * size
    metres = math.dist(pose[:2], (x, y))
    if metres < 0.5 * size:
        return 0.0, 0.0
    turn = normalised(math.atan2(y - pose.y, x - pose.x) - pose.yaw)
    return turn, metres


def _clear(pose: Pose, x: float, y: float, free: Collection[Cell], size: float) -> bool:
    """Return whether the straight line to a point crosses only free cells; the robot's own cell is not checked."""
    steps = max(1, math.ceil(math.dist(pose[:2], (x, y)) / (0.5 * size)))
    here = (math.floor(pose.x / size + 0.5), math.floor(pose.y / size + 0.5))
    for step in range(1, steps + 1):
        share = step / steps
        px, py = pose.x + share * (x - pose.x), pose.y + share * (y - pose.y)
        cell = (math.floor(px / size + 0.5), math.floor(py / size + 0.5))
        if cell != here and cell not in free:
            return False
    return True


def open_ground(echoes: Collection[Point], radius: float, longest: float) -> tuple[float, float]:
    """Return the turn (radians) and the distance (metres) of the longest drive straight ahead that a scan shows to be free.

    Args:
        echoes: positions in the frame of the robot.
        radius: clearance of the robot, in metres.
        longest: maximum distance, in metres.
    """
    best = (0.0, 0.0)
    for number in sorted(range(-11, 13), key=abs):
        turn = math.tau * number / 24.0
        ahead = Pose(0.0, 0.0, -turn).points(echoes)
        metres = min((x for x, y in ahead if x > 0.0 and abs(y) < radius), default=math.inf) - radius
        if min(metres, longest) > best[1]:
            best = (turn, min(metres, longest))
    return best


# Frontier exploration: the border between known free ground and unknown ground (Yamauchi 1997).

_NEXT = ((1, 0), (0, 1), (-1, 0), (0, -1))
_AROUND = (*_NEXT, (1, 1), (-1, 1), (-1, -1), (1, -1))


def frontier(free: Collection[Cell], known: Collection[Cell], least: int) -> set[Cell]:
    """Return the free cells next to an unknown one, without connected pieces of fewer than *least* cells."""
    edge = {
        (x, y)
        for x, y in free
        # Unrolled: a loop over the four neighbours takes three times as long, and maps have 100,000 cells.
        if (x + 1, y) not in known
        or (x - 1, y) not in known
        or (x, y + 1) not in known
        or (x, y - 1) not in known
    }
    kept: set[Cell] = set()
    rest = set(edge)
    while rest:
        piece = set(_spread({rest.pop()}, edge, len(edge), _AROUND))
        rest -= piece
        if len(piece) >= least:
            kept |= piece
    return kept


def around(cells: Collection[Cell], free: Collection[Cell], reach: int) -> set[Cell]:
    """Return the free cells at most *reach* steps over free cells from some cells."""
    return set(_spread(set(cells), free, reach, _AROUND))


def nearest(start: Cell, enterable: Collection[Cell], wanted: Collection[Cell]) -> Cell | None:
    """Return the nearest wanted cell that can be reached over enterable cells, None if none exists."""
    return next((cell for cell in _spread({start}, enterable, len(enterable), _NEXT) if cell in wanted), None)


def _spread(seeds: set[Cell], over: Collection[Cell], reach: int, steps: tuple[Cell, ...]) -> Iterator[Cell]:
    """Yield the cells reached from *seeds*, nearest first, in the same order in every run."""
    seen = set(seeds)
    waiting = deque((cell, 0) for cell in sorted(seeds))
    while waiting:
        (x, y), depth = waiting.popleft()
        yield x, y
        if depth == reach:
            continue
        for dx, dy in steps:
            cell = (x + dx, y + dy)
            if cell in over and cell not in seen:
                seen.add(cell)
                waiting.append((cell, depth + 1))
