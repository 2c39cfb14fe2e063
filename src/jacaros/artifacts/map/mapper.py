"""From scans and odometry to an occupancy grid and the robot's pose on it."""

import math
from collections.abc import Collection
from typing import Any

from jacaros.artifacts.map.cells import Cell
from jacaros.artifacts.map.localisation import Localisation
from jacaros.artifacts.map.occupancy import OccupancyCells
from jacaros.artifacts.map.scan_matching import Surfaces, match
from jacaros.artifacts.map.scans import ScanOptions, moved, read_scan
from jacaros.plane.pose import Pose, normalised

DRIVEN = 0.1
"""Metres after which the next scan is added to the map."""

TURNED = math.radians(6.0)
"""Radians after which the next scan is added to the map."""

STOOD = 2.0
"""Seconds after which a scan is also added without motion: something else may have moved."""

MATCHED = 120
"""Approximate number of points of a scan that are matched."""


class Mapper:
    """Add scans to a grid, each from the robot's pose at its time.

    Args:
        cells: the grid.
        options: how scans are read.
        matching: correct the pose by matching scans with earlier ones.

    Attributes:
        localisation: the robot's pose.
    """

    def __init__(self, cells: OccupancyCells, options: ScanOptions, matching: bool) -> None:
        self.localisation = Localisation()
        self._cells, self._options, self._matching = cells, options, matching
        self._surfaces = Surfaces()
        self._last: tuple[float, Pose] | None = None

    def take_scan(self, stamp: float, message: Any) -> bool:
        """Take a ``sensor_msgs/msg/LaserScan`` with the time *stamp*, in seconds.

        Returns:
            Whether it was added to the map: not before the first odometry, and not if the robot has not moved.
        """
        pose = self.localisation.pose_at(stamp)
        if pose is None or not self._is_news(stamp, pose):
            return False
        scan = read_scan(message, self._options)
        if self._matching:
            every = max(1, len(scan.echoes) // MATCHED)
            found = match(self._surfaces, scan.echoes[::every], pose) if self._surfaces else None
            if found is not None:
                pose = found
                self.localisation.correct(stamp, pose)
        scan = moved(scan, pose)
        self._cells.add_scan(scan.origin, scan.echoes, scan.clear)
        if self._matching:
            self._surfaces.add(scan.echoes)
        self._last = (stamp, pose)
        return True

    def _is_news(self, stamp: float, pose: Pose) -> bool:
        if self._last is None:
            return True
        before, last = self._last
        return (
            math.dist(last[:2], pose[:2]) >= DRIVEN
            or abs(normalised(pose.yaw - last.yaw)) >= TURNED
            or not 0.0 <= stamp - before < STOOD
        )

    def begin_with(self, obstacles: Collection[Cell]) -> None:
        """Forget earlier scans, and match later ones with *obstacles*, such as those of a loaded map."""
        size = self._cells.size
        self._surfaces = Surfaces()
        self._surfaces.add((x * size, y * size) for x, y in sorted(obstacles))
        self._last = None
