"""Cells of the ground with integer coordinates, and their labels; an occupancy grid; a map as text."""

import math
from collections.abc import Collection, Iterable, Mapping

from jacaros.robots.plane.pose import Point

Cell = tuple[int, int]

FREE = "free"
"""Label of a cell that can be entered."""

OBSTACLE = "obstacle"
"""Label of a cell that no route enters."""

UNKNOWN = "unknown"
"""Label of a cell that nothing is known about; no route enters it."""

GOAL = "goal"
"""Label of the destination of ``getRoute``."""


class LabelledCells:
    """Cells with one label each.

    Args:
        obstacle: the label of cells that no route enters.

    Attributes:
        obstacle: the label of obstacles.
    """

    def __init__(self, obstacle: str = OBSTACLE) -> None:
        self.obstacle = obstacle
        self._labels: dict[Cell, str] = {}
        self._places: dict[Cell, str] = {}

    def put(self, cell: Cell, label: str) -> bool:
        """Label a cell, replacing an earlier label. Return whether that changed the places."""
        self._labels[cell] = label
        before = self._places.pop(cell, None)
        if label not in (FREE, UNKNOWN, OBSTACLE, self.obstacle):
            self._places[cell] = label
        return self._places.get(cell) != before

    def label(self, cell: Cell) -> str | None:
        """Return the label of a cell, None if it has none."""
        return self._labels.get(cell)

    def clear(self) -> None:
        """Forget all labels."""
        self._labels.clear()
        self._places.clear()

    def load(self, labels: Mapping[Cell, str]) -> None:
        """Replace all free cells and obstacles by those of a complete map; places stay."""
        self._labels = {cell: self.obstacle if label == OBSTACLE else label for cell, label in labels.items()}
        self._labels.update(self._places)

    def known(self) -> Collection[Cell]:
        """Return all cells with a label."""
        return self._labels

    def near(self, centre: Cell, reach: int) -> list[Cell]:
        """Return the labelled cells at most *reach* columns and rows from *centre*, sorted."""
        x, y = centre
        if (2 * reach + 1) ** 2 > len(self._labels):
            return sorted(cell for cell in self._labels if max(abs(cell[0] - x), abs(cell[1] - y)) <= reach)
        columns, rows = range(x - reach, x + reach + 1), range(y - reach, y + reach + 1)
        return [(a, b) for a in columns for b in rows if (a, b) in self._labels]

    def places(self) -> Mapping[Cell, str]:
        """Return the cells with a label other than free, obstacle and unknown."""
        return self._places

    def blocked(self) -> set[Cell]:
        """Return the obstacles."""
        return {cell for cell, label in self._labels.items() if label == self.obstacle}

    def passable(self) -> set[Cell]:
        """Return the cells that a route may enter."""
        return {cell for cell, label in self._labels.items() if label not in (self.obstacle, UNKNOWN)}


# An occupancy grid, filled from laser scans or a map.

HIT = 0.9
"""Log odds that an echo adds to its cell."""

MISS = -0.4
"""Log odds that a beam adds to each cell that it crosses."""

SUREST = 3.5
"""Limit of the log odds of a cell, in both directions, so that an opened door is noticed after a few scans."""


class OccupancyCells(LabelledCells):
    """Cells that a robot sees, and cells that agents label.

    The centre of cell x, y is x and y times the size of a cell from the origin.

    Args:
        obstacle: the label of cells that no route enters.
        size: side of a cell, in metres.

    Attributes:
        size: side of a cell, in metres.
        odds: log odds of being occupied of all observed cells.
    """

    def __init__(self, obstacle: str, size: float) -> None:
        super().__init__(obstacle)
        self.size = size
        self.odds: dict[Cell, float] = {}

    def resize(self, size: float) -> None:
        """Change the size of cells, in metres. If it differs, all observations are forgotten."""
        if size != self.size:
            self.size = size
            self.odds.clear()

    def cell_at(self, x: float, y: float) -> Cell:
        """Return the cell of a point, in metres."""
        return math.floor(x / self.size + 0.5), math.floor(y / self.size + 0.5)

    def add_scan(self, origin: Point, echoes: Iterable[Point], clear: Iterable[Point]) -> None:
        """Add the observations of a scan; a cell counts once, as occupied if any beam had its echo there.

        Args:
            origin: position of the laser.
            echoes: positions of echoes.
            clear: for each beam, the end of the ground that it shows to be free.
        """
        passed: set[Cell] = set()
        hit = {self.cell_at(x, y) for x, y in echoes}
        for x, y in clear:
            self._trace(origin, x, y, passed)
        odds = self.odds
        for cell in passed - hit:
            odds[cell] = max(-SUREST, odds.get(cell, 0.0) + MISS)
        for cell in hit:
            odds[cell] = min(SUREST, odds.get(cell, 0.0) + HIT)

    def _trace(self, origin: Point, x: float, y: float, passed: set[Cell]) -> None:
        """Add the cells between two points, except the last, to *passed* (Amanatides and Woo 1987)."""
        size = self.size
        u, v = origin[0] / size + 0.5, origin[1] / size + 0.5
        du, dv = x / size + 0.5 - u, y / size + 0.5 - v
        column, row = math.floor(u), math.floor(v)
        step_u, step_v = (1 if du > 0.0 else -1), (1 if dv > 0.0 else -1)
        # Position of the next border of a column and of a row, as a fraction of the line.
        delta_u = abs(1.0 / du) if du else math.inf
        delta_v = abs(1.0 / dv) if dv else math.inf
        next_u = ((column + (du > 0.0)) - u) / du if du else math.inf
        next_v = ((row + (dv > 0.0)) - v) / dv if dv else math.inf
        while True:
            if next_u < next_v:
                at = next_u
                next_u += delta_u
                if at >= 1.0:
                    return
                passed.add((column, row))
                column += step_u
            else:
                at = next_v
                next_v += delta_v
                if at >= 1.0:
                    return
                passed.add((column, row))
                row += step_v

    def load(self, labels: Mapping[Cell, str]) -> None:
        """Replace all observations by those of a complete map; labels of agents stay."""
        self.odds = {cell: -SUREST if label == FREE else SUREST for cell, label in labels.items()}

    def label(self, cell: Cell) -> str | None:
        """Return the label that an agent gave a cell, else the observation, None if there is neither."""
        return super().label(cell) or self.seen(cell)

    def seen(self, cell: Cell) -> str | None:
        """Return what was observed in a cell, whatever agents say: free or obstacle, None if nothing is known."""
        odds = self.odds.get(cell, 0.0)
        return None if odds == 0.0 else self.obstacle if odds > 0.0 else FREE

    def clear(self) -> None:
        """Forget all observations and labels."""
        super().clear()
        self.odds.clear()

    def known(self) -> set[Cell]:
        """Return all cells that were observed or have a label."""
        return {cell for cell, odds in self.odds.items() if odds} | set(super().known())

    def near(self, centre: Cell, reach: int) -> list[Cell]:
        """Return the known cells at most *reach* columns and rows from *centre*, sorted."""
        x, y = centre
        columns, rows = range(x - reach, x + reach + 1), range(y - reach, y + reach + 1)
        return [(a, b) for a in columns for b in rows if self.label((a, b)) is not None]

    def blocked(self) -> set[Cell]:
        """Return the obstacles: observed, or labelled by an agent."""
        seen = {cell for cell, odds in self.odds.items() if odds > 0.0}
        return {cell for cell in seen if self.label(cell) == self.obstacle} | super().blocked()

    def passable(self) -> set[Cell]:
        """Return the cells that a route may enter: observed to be free, or labelled free by an agent."""
        free = {cell for cell, odds in self.odds.items() if odds < 0.0}
        for cell in super().known():
            label = super().label(cell)
            if label == FREE:
                free.add(cell)
            elif label in (OBSTACLE, UNKNOWN, self.obstacle):
                free.discard(cell)
        return free


# A map of labelled cells as lines of text.

WIDEST = 200
"""Maximum number of columns and rows, around the agent."""

_SIGNS = {FREE: ".", OBSTACLE: "#", UNKNOWN: " "}


def picture(cells: LabelledCells, things: Mapping[Cell, str], here: Cell) -> list[str]:
    """Draw a map, the highest y first.

    Args:
        cells: the cells to draw.
        things: names of further objects, by cell.
        here: the agent's cell, drawn as ``@``.

    Returns:
        The lines; each begins with the y of its cells, and the last has the x of the first column.
    """
    labels = {cell: cells.label(cell) or UNKNOWN for cell in cells.known()} | dict(things)
    signs = {cell: "#" if label == cells.obstacle else _sign(label) for cell, label in labels.items()}
    signs[here] = "@"
    half = WIDEST // 2
    shown = [cell for cell in signs if max(abs(cell[0] - here[0]), abs(cell[1] - here[1])) <= half]
    left, right = min(x for x, _ in shown), max(x for x, _ in shown)
    bottom, top = min(y for _, y in shown), max(y for _, y in shown)
    lines = [
        f"{y:>4} " + "".join(signs.get((x, y), " ") for x in range(left, right + 1)).rstrip()
        for y in range(top, bottom - 1, -1)
    ]
    return [*lines, f"   x {left}"]


def _sign(label: str) -> str:
    return _SIGNS.get(label) or label[:1].upper() or "?"
