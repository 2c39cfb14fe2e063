"""Dirt on the floor: a grid of cells of about 10 cm for each kind of dirt in a room."""

import math
from collections.abc import Sequence

from jacaros.sim.description import Dirt, Rectangle, Room

CELL = 0.1
"""Approximate side of a cell, in metres: a whole number of cells fills the area."""


class DirtField:
    """One kind of dirt in one room.

    Attributes:
        room: name of the room.
        kind: kind of dirt.
        grams: remaining amount.
    """

    def __init__(self, room: Room, dirt: Dirt, boxes: Sequence[Rectangle] = ()) -> None:
        """Create the field; dirt without an area of its own is not spread below the furniture *boxes*."""
        self.room, self.kind, self.grams = room.name, dirt.kind, dirt.grams
        self._all = dirt.grams
        self._area = dirt.area or room.area
        self._boxes = () if dirt.area is not None else tuple(boxes)
        self._columns = max(1, round((self._area.x_max - self._area.x_min) / CELL))
        self._rows = max(1, round((self._area.y_max - self._area.y_min) / CELL))
        self._width = (self._area.x_max - self._area.x_min) / self._columns
        self._height = (self._area.y_max - self._area.y_min) / self._rows
        self._cells: list[float] = []
        self._dirty = 0

    @property
    def percent(self) -> int:
        """Remaining percent, rounded up: 0 means clean."""
        return math.ceil(100.0 * self.grams / self._all) if self.grams > 0.0 else 0

    def near(self, x: float, y: float, reach: float) -> list[tuple[float, int]]:
        """Return the dirty cells with their centres within *reach* metres of a point, as squared distance and number."""
        if not self._cells:
            self._spread()
        area, columns = self._area, self._columns
        first = max(0, math.floor((x - reach - area.x_min) / self._width))
        last = min(columns, math.floor((x + reach - area.x_min) / self._width) + 1)
        bottom = max(0, math.floor((y - reach - area.y_min) / self._height))
        top = min(self._rows, math.floor((y + reach - area.y_min) / self._height) + 1)
        found = []
        for row in range(bottom, top):
            dy = area.y_min + (row + 0.5) * self._height - y
            for column in range(first, last):
                dx = area.x_min + (column + 0.5) * self._width - x
                apart2 = dx * dx + dy * dy
                if apart2 <= reach * reach and self._cells[row * columns + column] > 0.0:
                    found.append((apart2, row * columns + column))
        return found

    def take(self, cell: int, most: float) -> float:
        """Remove up to *most* grams of dirt from a cell; return the amount removed, in grams."""
        here = self._cells[cell]
        if here > most:
            self._cells[cell] = here - most
            self.grams -= most
            return most
        if here > 0.0:
            self._cells[cell] = 0.0
            self._dirty -= 1
            # Exactly 0: repeated differences leave rounding errors.
            self.grams = self.grams - here if self._dirty else 0.0
        return here

    def is_clean(self, cell: int) -> bool:
        """Return whether a cell is clean."""
        return self._cells[cell] <= 0.0

    def _spread(self) -> None:
        """Create the cells when a tool comes near: fields that are never cleaned cost nothing."""
        centres = [
            (self._area.x_min + (column + 0.5) * self._width, self._area.y_min + (row + 0.5) * self._height)
            for row in range(self._rows)
            for column in range(self._columns)
        ]
        free = [not any(box.contains(x, y) for box in self._boxes) for x, y in centres]
        self._dirty = sum(free) or len(free)
        share = self._all / self._dirty
        self._cells = [share if lies or not any(free) else 0.0 for lies in free]
        if share == 0.0:
            self._dirty = 0
