"""Occupancy grids, as ``nav_msgs/msg/OccupancyGrid`` or the image of a map file, converted to labels of cells."""

import math
from dataclasses import dataclass
from typing import Any

from jacaros.artifacts.map.cells import FREE, OBSTACLE, Cell
from jacaros.files.maps import OCCUPIED, UNKNOWN, meanings
from jacaros.plane.pose import Pose


@dataclass(frozen=True, slots=True)
class Grid:
    """A grid of free, occupied and unknown cells.

    Attributes:
        resolution: side of a cell, in metres.
        width: cells per row.
        origin: pose of the corner of the first cell.
        cells: what each cell means (see `jacaros.files.maps`); rows from the bottom.
    """

    resolution: float
    width: int
    origin: Pose
    cells: bytes

    @staticmethod
    def of(message: Any) -> "Grid":
        """Read a ``nav_msgs/msg/OccupancyGrid``."""
        info = message.info
        return Grid(float(info.resolution), int(info.width), Pose.of(info.origin), meanings(message.data))

    def labels(self, size: float) -> dict[Cell, str]:
        """Return free cells and obstacles as cells of another *size* (metres), which must not be smaller.

        A cell is an obstacle if any part of it is, and free if its known parts are free.
        """
        found: dict[Cell, str] = {}
        corner, step = self.origin, self.resolution / size
        sine, cosine = step * math.sin(corner.yaw), step * math.cos(corner.yaw)
        for index, meaning in enumerate(self.cells):
            if meaning != UNKNOWN:
                row, column = divmod(index, self.width)
                u, v = column + 0.5, row + 0.5
                x = corner.x / size + cosine * u - sine * v
                y = corner.y / size + sine * u + cosine * v
                cell = (math.floor(x + 0.5), math.floor(y + 0.5))
                if meaning == OCCUPIED:
                    found[cell] = OBSTACLE
                else:
                    found.setdefault(cell, FREE)
        return found
