"""``ArtSlamData``: the ground as labelled cells, of which an agent is told what lies in its range of view, and routes over
them.
"""

import heapq
import math
from collections.abc import Collection, Iterator
from typing import ClassVar

from jacaros.artifacts.kit.options import text
from jacaros.artifacts.kit.ros_artifact import RosArtifact
from jacaros.env.artifact import Out, operation
from jacaros.env.values import Atom, Structure

Cell = tuple[int, int]

_DIAGONAL = math.sqrt(2.0)


def route(free: Collection[Cell], start: Cell, goal: Cell) -> list[Cell] | None:
    """Shortest way from *start* to *goal* over *free* cells, by A* with eight neighbours.

    A diagonal step needs both cells beside it free, so that a robot does not cut corners.  Start and goal
    count as free.  Of several shortest ways the same one is found each time.

    Args:
        free: cells that may be entered; a set for speed.
        start: first cell of the way.
        goal: last cell of the way.

    Returns:
        All cells from start to goal, both included; None when there is no way.
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


GOAL = "goal"
"""Label of the cell to which `getRoute` leads when no other is named."""

OBSTACLE = "obstacle"
"""Label of cells that no route enters; cells without a label are unknown, and not entered either."""


class ArtSlamData(RosArtifact):
    """A map of cells with whole-number coordinates and a label each, such as free, obstacle, goal, home.

    It needs no ROS: agents write what they learn and read what is near (range of view), so that no belief
    base has to hold the whole map.

    Options:
        obstacle(Label): another label for cells that no route enters.

    Properties:
        pos2d(X, Y): the agent's cell, 0, 0 at first.
        cell(X, Y, Label): one for each labelled cell of the newest range of view.
        currentRange(List): the same as a list of ``cell(X, Y, Label)``.
        route(List): the newest route, a list of ``cell(X, Y)`` from the agent's cell to the goal.
        degrees(D): direction of the next cell of the route, degrees from the x axis in (-180, 180].
    """

    known_options: ClassVar = {"obstacle": text}

    def open(self) -> None:
        """Begin with an empty map."""
        self._labels: dict[Cell, str] = {}
        self._shown: list[Structure] = []
        self.define_property("pos2d", 0, 0)
        self.define_property("currentRange", [])
        self.define_property("route", [])
        self.define_property("degrees", 0)

    @operation(name="updateSlamData")
    def update_slam_data(self, x: int, y: int, label: str) -> None:
        """Label a cell; an earlier label is replaced."""
        self._labels[(x, y)] = label

    @operation(name="getSlamData")
    def get_slam_data(self, x: int, y: int, label: Out) -> None:
        """Give a cell's label, the atom ``unknown`` when it has none."""
        label.set(self._labels.get((x, y), Atom("unknown")))

    @operation
    @operation(name="clearSlamData")
    def clear(self) -> None:
        """Forget all labels, and the range of view and route that came from them."""
        self._labels.clear()
        self._show_range([])
        self.update_property("route", [])

    @operation(name="updatePos")
    def update_pos(self, x: int, y: int) -> None:
        """Note the agent's cell."""
        self.update_property("pos2d", x, y)

    @operation(name="getVisionRange")
    def get_vision_range(self, x: int, y: int, reach: int) -> None:
        """Show all labelled cells up to *reach* cells from *x*, *y*, and none of the range before."""
        near = self._near(x, y, max(0, reach))
        self._show_range([Structure("cell", (*cell, self._labels[cell])) for cell in near])

    def _near(self, x: int, y: int, reach: int) -> list[Cell]:
        if (2 * reach + 1) ** 2 > len(self._labels):
            return sorted(cell for cell in self._labels if max(abs(cell[0] - x), abs(cell[1] - y)) <= reach)
        columns, rows = range(x - reach, x + reach + 1), range(y - reach, y + reach + 1)
        return [(a, b) for a in columns for b in rows if (a, b) in self._labels]

    def _show_range(self, cells: list[Structure]) -> None:
        """Replace the cells shown; one that stays as it was gives no event."""
        for old in self._shown:
            if old not in cells:
                self.remove_property("cell", *old.arguments)
        for new in cells:
            if new not in self._shown:
                self.define_property("cell", *new.arguments)
        self._shown = cells
        self.update_property("currentRange", cells)

    @operation(name="getRoute")
    def get_route(self) -> None:
        """Show the shortest route from the agent's cell to the nearest cell labelled ``goal``.

        Fails with ``no_goal``, or with ``no_route(X, Y)`` when the goal cannot be reached over known cells.
        """
        self._find_route(self._goal())

    @operation(name="getRoute")
    def give_route(self, found: Out) -> None:
        """As `get_route`, and give the route to the caller."""
        found.set(self._find_route(self._goal()))

    @operation(name="getRoute")
    def get_route_to(self, x: int, y: int) -> None:
        """Show the shortest route from the agent's cell to the cell *x*, *y*."""
        self._find_route((x, y))

    @operation(name="getRoute")
    def give_route_to(self, x: int, y: int, found: Out) -> None:
        """As `get_route_to`, and give the route to the caller."""
        found.set(self._find_route((x, y)))

    def _here(self) -> Cell:
        x, y = self.values("pos2d")
        return int(x), int(y)

    def _goal(self) -> Cell:
        x, y = self._here()
        goals = [cell for cell, label in self._labels.items() if label == GOAL]
        if not goals:
            self.fail("no cell is labelled goal", "no_goal")
        return min(goals, key=lambda cell: (math.hypot(cell[0] - x, cell[1] - y), cell))

    def _find_route(self, goal: Cell) -> list[Structure]:
        blocked = self.options.get("obstacle", OBSTACLE)
        free = {cell for cell, label in self._labels.items() if label != blocked}
        if goal not in free:
            self.fail(f"cell {goal[0]}, {goal[1]} is not free", "no_route", *goal)
        way = route(free, self._here(), goal)
        if way is None:
            self.fail(f"there is no route to cell {goal[0]}, {goal[1]}", "no_route", *goal)
        cells = [Structure("cell", cell) for cell in way]
        self.update_property("route", cells)
        if len(way) > 1:
            (x, y), (next_x, next_y) = way[:2]
            self.update_property("degrees", math.degrees(math.atan2(next_y - y, next_x - x)))
        return cells
