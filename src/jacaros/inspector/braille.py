"""A map of braille dots: two by four dots per character cell."""

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

_DOTS = ((0x01, 0x08), (0x02, 0x10), (0x04, 0x20), (0x40, 0x80))
_EMPTY = 0x2800


class BrailleMap:
    """A part of the plane on character cells, as large as possible.

    Attributes:
        columns, rows: character cells in use.

    Args:
        bounds: left, bottom, right, top in metres.
        columns, rows: available character cells.
    """

    def __init__(self, bounds: Iterable[float], columns: int, rows: int) -> None:
        self._left, bottom, right, self._top = bounds
        width, height = max(0.1, right - self._left), max(0.1, self._top - bottom)
        # One dot stays free at each edge, so that the border is visible.
        self._scale = min((columns * 2 - 2) / width, (rows * 4 - 2) / height)
        self.columns = min(columns, int(width * self._scale) // 2 + 1)
        self.rows = min(rows, int(height * self._scale) // 4 + 1)
        self._cells: dict[tuple[int, int], int] = {}

    def dot_of(self, x: float, y: float) -> tuple[int, int]:
        """Return column and row of the dot for a point (metres); it may be outside."""
        return round((x - self._left) * self._scale), round((self._top - y) * self._scale)

    def cell_of(self, x: float, y: float) -> tuple[int, int]:
        """Return column and row of the character cell for a point; it may be outside."""
        column, row = self.dot_of(x, y)
        return column // 2, row // 4

    def cells_between(self, ax: float, ay: float, bx: float, by: float) -> set[tuple[int, int]]:
        """Return the character cells of a straight line."""
        return {(column // 2, row // 4) for column, row in self._dots_between(ax, ay, bx, by)}

    def point(self, x: float, y: float) -> None:
        """Set the dot for a point."""
        self._set(*self.dot_of(x, y))

    def line(self, ax: float, ay: float, bx: float, by: float) -> None:
        """Set the dots of a straight line."""
        for column, row in self._dots_between(ax, ay, bx, by):
            self._set(column, row)

    def _dots_between(self, ax: float, ay: float, bx: float, by: float) -> Iterator[tuple[int, int]]:
        (first_column, first_row), (last_column, last_row) = self.dot_of(ax, ay), self.dot_of(bx, by)
        across, down = last_column - first_column, last_row - first_row
        steps = max(abs(across), abs(down), 1)
        for step in range(steps + 1):
            yield first_column + round(across * step / steps), first_row + round(down * step / steps)

    def _set(self, column: int, row: int) -> None:
        if 0 <= column < self.columns * 2 and 0 <= row < self.rows * 4:
            cell = (column // 2, row // 4)
            self._cells[cell] = self._cells.get(cell, 0) | _DOTS[row % 4][column % 2]

    def bits(self, column: int, row: int) -> int:
        """Return the dots of a character cell, 0 for none."""
        return self._cells.get((column, row), 0)

    def text(self) -> str:
        """Return the map as lines of text."""
        return "\n".join(
            "".join(character(self.bits(column, row)) for column in range(self.columns))
            for row in range(self.rows)
        )


def character(bits: int) -> str:
    """Return the braille character with these dots; a blank for none."""
    return chr(_EMPTY | bits) if bits else " "


def draw_world(world: Mapping[str, Any], columns: int, rows: int) -> BrailleMap:
    """Draw the walls and furniture of a world."""
    shown = BrailleMap(world["bounds"], columns, rows)
    for ax, ay, bx, by in world["walls"]:
        shown.line(ax, ay, bx, by)
    return shown
