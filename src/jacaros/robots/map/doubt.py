"""How sure a robot is of its pose on a map that its scans are matched with."""

import math
from collections.abc import Iterable, Sequence

from jacaros.robots.map.cells import Cell, OccupancyCells
from jacaros.robots.plane.pose import Point
from jacaros.robots.plane.pose_search import disc

SURE, PROBABLE = 100.0, 75.0
"""Quality of a pose that scans confirm, and of one that was just found or that a person gives."""

LOST, FOUND = 50.0, 70.0
"""Quality below which the robot is lost, and above which it no longer is, as in the mappings of Nav2 and move_base."""

_NO_MATCH, _FULL_MATCH = 0.5, 0.9
"""Shares of the echoes on obstacles that mean a quality of 0 and of 100. At wrong poses it is rarely above 0.5."""

NEAR = 0.15
"""Distance from an obstacle within which an echo lies on it, in metres; at least one and a half cells."""

ENOUGH = 12
"""Number of echoes in known cells below which a scan says nothing."""


def on_obstacles(cells: OccupancyCells, echoes: Iterable[Point], around: Sequence[Cell]) -> tuple[int, int]:
    """Return how many echoes lie in or *around* the cells of obstacles, and how many in other known cells."""
    odds = cells.odds
    on = off = 0
    for x, y in echoes:
        cell = column, row = cells.cell_at(x, y)
        seen = odds.get(cell, 0.0)  # usually the cell itself
        if seen > 0.0 or any(odds.get((column + dx, row + dy), 0.0) > 0.0 for dx, dy in around):
            on += 1
        elif seen:
            off += 1
    return on, off


class Doubt:
    """How sure the robot is of its pose, by the share of its echoes that lie where the map has obstacles.

    Echoes in cells of which nothing is known do not count.

    Args:
        cells: the map.

    Attributes:
        quality: 100 without doubt, 0 if the scans do not match at all.
        lost: whether the quality has fallen below `LOST`, and not risen above `FOUND` since.
    """

    def __init__(self, cells: OccupancyCells) -> None:
        self._cells, self._around = cells, disc(max(NEAR / cells.size, 1.5))
        self._stamp = -math.inf
        self.quality, self.lost = SURE, False

    def begin(self, quality: float) -> None:
        """Set the quality; the scans that follow change it."""
        self.quality, self.lost = quality, quality < LOST

    def confirms(self, stamp: float, echoes: Sequence[Point]) -> bool:
        """Take a scan in map coordinates; return whether it may change the map.

        The quality is a mean of about a second, so a person who walks by makes no doubt.
        """
        on, off = on_obstacles(self._cells, echoes, self._around)
        passed, self._stamp = stamp - self._stamp, stamp
        if on + off < ENOUGH:
            return not self.lost
        share = (on / (on + off) - _NO_MATCH) / (_FULL_MATCH - _NO_MATCH)
        fits = SURE * min(1.0, max(0.0, share))
        self.quality += min(0.5, max(0.0, passed)) * (fits - self.quality)
        self.lost = self.quality < (FOUND if self.lost else LOST)
        return fits >= PROBABLE and not self.lost
