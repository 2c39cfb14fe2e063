"""Search of a whole map for the poses at which a laser scan fits (correlative scan matching: Olson 2009).

A set of cells is one integer with a bit for each cell, so one operation handles all positions: the walls, shifted by an
echo, are the positions from which that echo lies on a wall. The shifted sets are summed in binary counters, bit by bit.
"""

import math
from collections.abc import Collection, Iterable, Iterator, Sequence
from typing import NamedTuple

from jacaros.robots.plane.pose import Point, Pose

Cell = tuple[int, int]

HEADINGS = 120
"""Number of headings that are tried: three degrees apart."""

MOST = 200
"""Number of positions per heading above which more echoes must fit: along a corridor, half the map can fit."""


class Fit(NamedTuple):
    """The number of echoes that lie on walls at a pose."""

    echoes: int
    pose: Pose


class PoseSearch:
    """The walls and the floor of a map.

    Args:
        walls: cells with a wall.
        floor: cells in which the robot can be.
        size: side of a cell, in metres; the centre of cell x, y is x and y times the size from the origin.
        near: distance from the centre of a wall's cell within which an echo lies on the wall, in metres.
        longest: largest distance of an echo, in metres.
    """

    def __init__(
        self, walls: Iterable[Cell], floor: Collection[Cell], size: float, near: float, longest: float
    ) -> None:
        self._size = size
        # Echoes beside the map must not come out on the other side, in the next row.
        beyond = math.ceil((longest + near) / size) + 1
        self._left = min((x for x, _ in floor), default=0) - beyond
        self._low = min((y for _, y in floor), default=0) - beyond
        self._width = max((x for x, _ in floor), default=0) + beyond + 1 - self._left
        self._height = max((y for _, y in floor), default=0) + beyond + 1 - self._low
        self._floor, exact = self._bits(floor), self._bits(walls)
        self._walls = 0
        for dx, dy in disc(near / size):
            self._walls |= _shifted(exact, dx + dy * self._width)

    def _bits(self, cells: Iterable[Cell]) -> int:
        found = bytearray(self._width * self._height // 8 + 1)
        for x, y in cells:
            column, row = x - self._left, y - self._low
            if 0 <= column < self._width and 0 <= row < self._height:
                index = row * self._width + column
                found[index >> 3] |= 1 << (index & 7)
        return int.from_bytes(found, "little")

    def poses(self, echoes: Sequence[Point], least: float) -> Iterator[list[Fit]]:
        """Yield the poses at which at least the share *least* of the echoes lies on walls, heading by heading.

        Args:
            echoes: positions in the frame of the robot; a few dozen are enough.
            least: 0 to 1.
        """
        for number in range(HEADINGS):
            yaw = math.remainder(number * math.tau / HEADINGS, math.tau)
            needed = math.ceil(least * len(echoes))
            yield self._fits(self._counted(echoes, yaw), needed, len(echoes), yaw)

    def _counted(self, echoes: Sequence[Point], yaw: float) -> list[int]:
        """Count the echoes on walls for all positions: the bits of the counts, the lowest first."""
        sine, cosine = math.sin(yaw) / self._size, math.cos(yaw) / self._size
        planes: list[int] = []
        for x, y in echoes:
            column, row = round(cosine * x - sine * y), round(sine * x + cosine * y)
            carry = _shifted(self._walls, row * self._width + column) & self._floor
            for place, plane in enumerate(planes):
                planes[place], carry = plane ^ carry, plane & carry
            if carry:
                planes.append(carry)
        return planes

    def _fits(self, planes: Sequence[int], needed: int, most: int, yaw: float) -> list[Fit]:
        """Return the positions with at least *needed* counts, or more if those are too many."""
        left = self._at_least(planes, needed)
        while left.bit_count() > MOST and needed < most:
            needed += 1
            left = self._at_least(planes, needed)
        found: list[Fit] = []
        while left:
            index = left.bit_length() - 1
            left ^= 1 << index
            row, column = divmod(index, self._width)
            count = sum((plane >> index & 1) << place for place, plane in enumerate(planes))
            x, y = (column + self._left) * self._size, (row + self._low) * self._size
            found.append(Fit(count, Pose(x, y, yaw)))
        return found

    def _at_least(self, planes: Sequence[int], needed: int) -> int:
        """Return the positions whose counts are larger than *needed* - 1: compared from the highest bit on."""
        above, equal = 0, self._floor if needed - 1 < 1 << len(planes) else 0
        for place in reversed(range(len(planes))):
            if (needed - 1) >> place & 1:
                equal &= planes[place]
            else:
                above |= equal & planes[place]
                equal &= ~planes[place]
        return above


def disc(radius: float) -> list[Cell]:
    """Return the cells of a disc around 0, 0, the nearest first; *radius* in cells."""
    reach = math.floor(radius + 1e-9)
    span = range(-reach, reach + 1)
    cells = [(dx, dy) for dx in span for dy in span if math.hypot(dx, dy) <= radius + 1e-9]
    return sorted(cells, key=lambda cell: math.hypot(*cell))


def _shifted(cells: int, offset: int) -> int:
    return cells >> offset if offset >= 0 else cells << -offset
