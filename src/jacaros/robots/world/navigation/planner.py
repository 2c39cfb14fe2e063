"""Path planning from a pose to a goal, around walls and current obstacles."""

import itertools
import math
from collections.abc import Iterable, Sequence

from jacaros.robots.plane.path import cheapest_path
from jacaros.robots.plane.pose import Point, distance
from jacaros.robots.plane.shapes import Circle
from jacaros.robots.world.data.grid import Grid

MARGIN = 0.06
"""Minimum distance in metres of a planned path from walls, in addition to the robot's radius."""
COMFORT = 0.25
"""Distance in metres from walls beyond which a path does not get better."""
GOAL_MARGIN = 0.03
"""Minimum distance in metres of a goal from walls, in addition to the radius; the last part is driven slowly."""
_ESCAPE = 0.5
_DISLIKE = 3.0


FAILED_TO_MAKE_PROGRESS = 105
"""Nav2's ``FollowPath``: the robot makes no progress."""
START_OUTSIDE_MAP, GOAL_OUTSIDE_MAP, START_OCCUPIED, GOAL_OCCUPIED, NO_VALID_PATH = 203, 204, 205, 206, 208
"""Codes of Nav2's ``ComputePathToPose``, which Nav2's navigator passes on."""
TF_ERROR, TIMEOUT = 9002, 9003
"""Nav2's ``NavigateToPose``."""
NO_POSES = 309
"""Nav2's ``ComputePathThroughPoses``: no poses."""


def through_poses(code: int) -> int:
    """Return the code of the same failure in ``NavigateThroughPoses``, whose codes differ."""
    return code if code == FAILED_TO_MAKE_PROGRESS else code + 100


class NavigationFailure(Exception):
    """Raised when a goal cannot be reached, with one of Nav2's error codes (0 for none) and the reason."""

    def __init__(self, code: int, text: str) -> None:
        super().__init__(text)
        self.code, self.text = code, text


class Planner:
    """Plans paths for robots of one size on one map.

    Args:
        grid: map.
        radius: radius of the robot, in metres.
    """

    def __init__(self, grid: Grid, radius: float) -> None:
        self.grid, self.radius = grid, radius
        self.weights = [self._weight(clearance) for clearance in grid.clearance]

    def _weight(self, clearance: float) -> float:
        room = clearance - self.radius
        if room < MARGIN:
            return 0.0
        if room >= COMFORT:
            return 1.0
        nearness = (COMFORT - room) / (COMFORT - MARGIN)
        return 1.0 + _DISLIKE * nearness * nearness

    def plan(self, start: Point, goal: Point, obstacles: Iterable[Circle] = ()) -> list[Point]:
        """Return a path of few straight segments from *start* to *goal*, both included.

        Raises:
            NavigationFailure: there is no path.
        """
        weights = self._around(obstacles)
        start_cell = self._start(start, weights)
        goal_cell = self._goal(goal, weights)
        cells = cheapest_path(weights, self.grid.width, start_cell, goal_cell)
        if cells is None:
            raise NavigationFailure(
                NO_VALID_PATH, f"no path from {coordinates(start)} to {coordinates(goal)}"
            )
        points = [start, *map(self.grid.centre, cells[1:-1] if len(cells) > 2 else cells[1:]), goal]
        if self.grid.cell(*goal) != goal_cell:
            points.insert(-1, self.grid.centre(goal_cell))
        if self.grid.cell(*start) != start_cell:
            points.insert(1, self.grid.centre(start_cell))
        return _distinct(self._straighten(points, weights))

    def free(self, a: Point, b: Point) -> bool:
        """Return whether the straight line keeps clear of walls."""
        return self._line_cost(a, b, self.weights) < math.inf

    def _around(self, obstacles: Iterable[Circle]) -> Sequence[float]:
        weights: Sequence[float] = self.weights
        for x, y, radius in obstacles:
            if weights is self.weights:
                weights = list(self.weights)
            _stamp(weights, self.grid, x, y, radius + self.radius + MARGIN)  # type: ignore[arg-type]
        return weights

    def _start(self, start: Point, weights: Sequence[float]) -> int:
        cell = self.grid.cell(*start)
        if cell is None:
            raise NavigationFailure(
                START_OUTSIDE_MAP, f"the robot is outside the map, at {coordinates(start)}"
            )
        free = self._nearest_free(start, weights, _ESCAPE)
        if free is None:
            raise NavigationFailure(START_OCCUPIED, f"no free floor around the robot at {coordinates(start)}")
        return free

    def _goal(self, goal: Point, weights: Sequence[float]) -> int:
        if self.grid.cell(*goal) is None:
            raise NavigationFailure(GOAL_OUTSIDE_MAP, f"the goal {coordinates(goal)} is outside of the map")
        if self.grid.clearance_at(*goal) < self.radius + GOAL_MARGIN:
            raise NavigationFailure(
                GOAL_OCCUPIED, f"the goal {coordinates(goal)} is inside or too near a wall"
            )
        free = self._nearest_free(goal, weights, MARGIN + 2.0 * self.grid.resolution)
        if free is None:
            raise NavigationFailure(NO_VALID_PATH, f"the goal {coordinates(goal)} is occupied")
        return free

    def _nearest_free(self, point: Point, weights: Sequence[float], reach: float) -> int | None:
        """Return the nearest cell, at most *reach* metres away, where the robot may be."""
        cell = self.grid.cell(*point)
        assert cell is not None
        if weights[cell]:
            return cell
        steps = math.ceil(reach / self.grid.resolution)
        best, best_apart = None, reach
        row, column = divmod(cell, self.grid.width)
        for other_row in range(max(0, row - steps), min(self.grid.height, row + steps + 1)):
            for other_column in range(max(0, column - steps), min(self.grid.width, column + steps + 1)):
                other = other_row * self.grid.width + other_column
                if weights[other]:
                    apart = distance(point, self.grid.centre(other))
                    if apart < best_apart:
                        best, best_apart = other, apart
        return best

    def _straighten(self, points: list[Point], weights: Sequence[float]) -> list[Point]:
        """Remove points where the straight line costs at most the same."""
        costs = [0.0]
        for before, after in itertools.pairwise(points):
            cost = self._line_cost(before, after, weights)
            costs.append(
                costs[-1] + (cost if cost < math.inf else distance(before, after) * (1.0 + _DISLIKE))
            )
        kept, here = [points[0]], 0
        while here < len(points) - 1:
            there, misses = here + 1, 0
            for candidate in range(here + 2, len(points)):
                cost = self._line_cost(points[here], points[candidate], weights)
                if cost <= costs[candidate] - costs[here] + 1e-9:
                    there, misses = candidate, 0
                else:
                    misses += 1
                    if misses > 10:
                        break
            kept.append(points[there])
            here = there
        return kept

    def _line_cost(self, a: Point, b: Point, weights: Sequence[float]) -> float:
        """Return the cost of the straight line, in metres of open floor; infinite if it is blocked."""
        grid, length = self.grid, distance(a, b)
        if grid.cell(*a) is None or grid.cell(*b) is None:
            return math.inf
        pieces = max(1, math.ceil(length / (0.5 * grid.resolution)))
        # In cells; this is the busiest loop of navigation, so it calls nothing.
        scale, width = 1.0 / grid.resolution, grid.width
        x, y = (a[0] - grid.x_min) * scale + 1.0, (a[1] - grid.y_min) * scale + 1.0
        dx, dy = (b[0] - a[0]) * scale / pieces, (b[1] - a[1]) * scale / pieces
        total = 0.0
        for piece in range(pieces + 1):
            weight = weights[int(y + piece * dy) * width + int(x + piece * dx)]
            if not weight:
                return math.inf
            total += weight
        return total * length / (pieces + 1)


def _stamp(weights: list[float], grid: Grid, x: float, y: float, radius: float) -> None:
    # In cells, from the centre of the first one.
    across, up = (x - grid.x_min) / grid.resolution + 0.5, (y - grid.y_min) / grid.resolution + 0.5
    reach = radius / grid.resolution
    for row in range(max(0, math.ceil(up - reach)), min(grid.height - 1, math.floor(up + reach)) + 1):
        half = math.sqrt(max(0.0, reach * reach - (row - up) * (row - up)))
        first = max(0, math.ceil(across - half))
        last = min(grid.width - 1, math.floor(across + half))
        if first <= last:
            begin = row * grid.width
            weights[begin + first : begin + last + 1] = [0.0] * (last - first + 1)


def _distinct(points: list[Point]) -> list[Point]:
    kept = points[:1]
    for point in points[1:]:
        if distance(kept[-1], point) > 1e-6:
            kept.append(point)
    return kept


def coordinates(point: Point) -> str:
    return f"({point[0]:.2f}, {point[1]:.2f})"
