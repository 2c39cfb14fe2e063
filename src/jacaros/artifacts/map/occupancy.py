"""An occupancy grid, filled from laser scans or a map.

Each scan that covers a cell changes its log odds of being occupied (Moravec and Elfes 1985): an echo in it raises
them, a beam through it lowers them. Labels of agents are stored separately.
"""

import math
from collections.abc import Iterable, Mapping

from jacaros.artifacts.map.cells import FREE, OBSTACLE, UNKNOWN, Cell, LabelledCells
from jacaros.plane.pose import Point

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
