"""Cells of the ground with integer coordinates, and their labels."""

from collections.abc import Collection, Mapping

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
