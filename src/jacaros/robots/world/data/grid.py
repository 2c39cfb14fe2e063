"""The map of a robot: the distance of every cell of the floor from the nearest wall."""

import math

from jacaros.robots.plane.shapes import Rectangle, Segment
from jacaros.robots.world.data.world import WorldDescription

RESOLUTION = 0.05
"""Side of a cell in metres; doubled until a large world has at most `MOST_CELLS`."""
MOST_CELLS = 250_000
REACH = 0.6
"""Maximum distance in metres that is computed: larger distances make no difference."""


class Grid:
    """Cells in rows from the bottom, with a ring of blocked cells around the map.

    Attributes:
        resolution: side of a cell, in metres.
        width, height: columns and rows, including the ring.
        x_min, y_min: corner of the map without the ring, in metres.
        clearance: distance in metres from the centre of each cell to the nearest wall or cliff, at most `REACH`; 0 inside
            furniture and cliffs, and in the ring.
    """

    def __init__(self, world: WorldDescription) -> None:
        xs = [world.bounds.x_min, world.bounds.x_max]
        ys = [world.bounds.y_min, world.bounds.y_max]
        for ax, ay, bx, by in world.segments:
            xs += (ax, bx)
            ys += (ay, by)
        self.x_min, self.y_min = min(xs), min(ys)
        across, up = max(xs) - self.x_min, max(ys) - self.y_min
        self.resolution = RESOLUTION
        while (across / self.resolution) * (up / self.resolution) > MOST_CELLS:
            self.resolution *= 2.0
        self.width = math.ceil(across / self.resolution - 1e-9) + 2
        self.height = math.ceil(up / self.resolution - 1e-9) + 2
        self.clearance = [REACH] * (self.width * self.height)
        for segment in world.segments:
            self._measure(segment)
        for box in world.boxes:
            self._fill(box)
        for cliff in world.cliffs:
            for edge in cliff.edges():
                self._measure(edge)
            self._fill(cliff)
        self._close_ring()

    def _measure(self, segment: Segment) -> None:
        """Lower the clearance of the cells near a wall."""
        ax, ay, bx, by = segment
        dx, dy = bx - ax, by - ay
        length2 = dx * dx + dy * dy
        columns = range(
            max(1, self._column(min(ax, bx) - REACH)),
            min(self.width - 2, self._column(max(ax, bx) + REACH)) + 1,
        )
        rows = range(
            max(1, self._row(min(ay, by) - REACH)), min(self.height - 2, self._row(max(ay, by) + REACH)) + 1
        )
        clearance = self.clearance
        for row in rows:
            py = self.y_min + (row - 0.5) * self.resolution - ay
            for column in columns:
                px = self.x_min + (column - 0.5) * self.resolution - ax
                place = (px * dx + py * dy) / length2
                place = 0.0 if place < 0.0 else 1.0 if place > 1.0 else place
                ex, ey = px - place * dx, py - place * dy
                index = row * self.width + column
                apart = ex * ex + ey * ey
                if apart < clearance[index] * clearance[index]:
                    clearance[index] = math.sqrt(apart)

    def _fill(self, box: Rectangle) -> None:
        for row in range(max(1, self._row(box.y_min)), min(self.height - 2, self._row(box.y_max)) + 1):
            first, last = max(1, self._column(box.x_min)), min(self.width - 2, self._column(box.x_max))
            for cell in range(row * self.width + first, row * self.width + last + 1):
                if box.contains(*self.centre(cell)):
                    self.clearance[cell] = 0.0

    def _close_ring(self) -> None:
        for column in range(self.width):
            self.clearance[column] = self.clearance[-1 - column] = 0.0
        for row in range(self.height):
            self.clearance[row * self.width] = self.clearance[(row + 1) * self.width - 1] = 0.0

    def _column(self, x: float) -> int:
        return math.floor((x - self.x_min) / self.resolution) + 1

    def _row(self, y: float) -> int:
        return math.floor((y - self.y_min) / self.resolution) + 1

    def cell(self, x: float, y: float) -> int | None:
        """Return the cell of a point; None outside the map."""
        column, row = self._column(x), self._row(y)
        if 0 < column < self.width - 1 and 0 < row < self.height - 1:
            return row * self.width + column
        return None

    def centre(self, cell: int) -> tuple[float, float]:
        """Return the centre of a cell."""
        row, column = divmod(cell, self.width)
        return self.x_min + (column - 0.5) * self.resolution, self.y_min + (row - 0.5) * self.resolution

    def clearance_at(self, x: float, y: float) -> float:
        """Return the distance in metres to the nearest wall, interpolated between four cells; 0 outside."""
        across, up = (x - self.x_min) / self.resolution + 0.5, (y - self.y_min) / self.resolution + 0.5
        column, row = math.floor(across), math.floor(up)
        if not (0 <= column < self.width - 1 and 0 <= row < self.height - 1):
            return 0.0
        u, v = across - column, up - row
        index = row * self.width + column
        below = (1.0 - u) * self.clearance[index] + u * self.clearance[index + 1]
        index += self.width
        above = (1.0 - u) * self.clearance[index] + u * self.clearance[index + 1]
        return (1.0 - v) * below + v * above

    def occupancy(self) -> list[int]:
        """Return the data of a ``nav_msgs/msg/OccupancyGrid``: rows from the bottom, 0 free, 100 wall or furniture."""
        edge = 0.5 * self.resolution + 1e-9
        return [
            100 if self.clearance[row * self.width + column] <= edge else 0
            for row in range(1, self.height - 1)
            for column in range(1, self.width - 1)
        ]
