"""From scans and odometry to an occupancy grid and the robot's pose on it."""

import math
from collections import deque
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from jacaros.robots.map.cells import Cell, OccupancyCells
from jacaros.robots.map.doubt import PROBABLE, SURE, Doubt
from jacaros.robots.map.place_search import PlaceSearch
from jacaros.robots.map.scan_matching import Surfaces, match
from jacaros.robots.plane.pose import ORIGIN, Point, Pose, normalised

SAME_SURFACE = 0.5
"""Relative difference of the ranges of neighbouring beams up to which they are taken for echoes of one surface."""

LONGEST_GRAZE = 2.5
"""Maximum distance in metres for which a beam is assumed to run along a surface."""


class Scan(NamedTuple):
    """The content of a scan, in metres from the robot.

    Attributes:
        origin: position of the laser.
        echoes: positions of echoes.
        clear: for each beam, the end of the ground that it shows to be free.
    """

    origin: Point
    echoes: list[Point]
    clear: list[Point]


@dataclass(frozen=True, slots=True)
class ScanOptions:
    """How scans are read.

    Attributes:
        longest: metres at which beams are cut off.
        mount: pose of the laser on the robot.
        beside: metres from a surface within which a beam carries no information, such as the side of a cell: it may
            cross the same cell as the surface.
    """

    longest: float
    mount: Pose
    beside: float


def read_scan(message: Any, options: ScanOptions) -> Scan:
    """Read the points of a ``sensor_msgs/msg/LaserScan``.

    A beam without an echo is infinite or beyond the sensor's range (REP 117). A NaN, or a range below the sensor's
    minimum, is ignored.
    """
    mount, longest = options.mount, options.longest
    echoes: list[Point] = []
    clear: list[Point] = []
    least, most = float(message.range_min), float(message.range_max)
    angle, increment = float(message.angle_min) + mount.yaw, float(message.angle_increment)
    sine, cosine = math.sin(increment), math.cos(increment)
    dx, dy = math.cos(angle), math.sin(angle)
    before = math.inf
    for reading in message.ranges:
        reading = float(reading)
        reach = longest
        if least <= reading < most:
            if reading <= longest:
                echoes.append((mount.x + reading * dx, mount.y + reading * dy))
            reach = min(longest, reading - _beside(reading, before, sine, cosine, options.beside))
        if reading >= least and reach > 0.0:  # false for NaN
            clear.append((mount.x + reach * dx, mount.y + reach * dy))
        before = reading
        dx, dy = cosine * dx - sine * dy, sine * dx + cosine * dy
    return Scan((mount.x, mount.y), echoes, clear)


def _beside(reading: float, before: float, sine: float, cosine: float, near: float) -> float:
    """Return for how many metres before its echo a beam runs within *near* metres of the surface.

    The surface runs from the echo of the previous beam to this one; the flatter the angle, the longer the distance.
    """
    across = abs(before * sine)
    if across == 0.0 or not abs(reading - before) < SAME_SURFACE * reading:
        return near
    return min(LONGEST_GRAZE, near * math.hypot(reading - before * cosine, across) / across)


def moved(scan: Scan, pose: Pose) -> Scan:
    """Convert a scan to map coordinates, for a robot at *pose*."""
    return Scan(pose.point(*scan.origin), pose.points(scan.echoes), pose.points(scan.clear))


# The pose of a robot on the map: its odometry, and a correction.

REMEMBERED = 40
"""Number of odometry poses that are stored: two seconds at 20 Hz, for sensors that arrive late."""


class Localisation:
    """The pose of a robot on the map.

    Attributes:
        correction: pose of the odometry frame on the map; the origin until something corrects it.
        pose: the newest pose on the map; None before the first odometry.
        driven: metres driven, according to odometry.
    """

    def __init__(self) -> None:
        self.correction = ORIGIN
        self.pose: Pose | None = None
        self.driven = 0.0
        self._odometry: deque[tuple[float, Pose]] = deque(maxlen=REMEMBERED)

    def take_odometry(self, stamp: float, pose: Pose) -> None:
        """Take a pose from odometry; *stamp* in seconds."""
        if self._odometry:
            last, before = self._odometry[-1]
            self.driven += math.dist(before[:2], pose[:2])
            if stamp < last:  # the sender's clock was set back
                self._odometry.clear()
        self._odometry.append((stamp, pose))
        self.pose = self.correction.then(pose)

    def pose_at(self, stamp: float) -> Pose | None:
        """Return the pose on the map at *stamp* (0.0: now), the nearest known one; None before the first odometry."""
        found = self.odometry_at(stamp)
        return None if found is None else self.correction.then(found)

    def correct(self, stamp: float, pose: Pose) -> None:
        """Correct the pose: the robot was at *pose* on the map at *stamp*. No effect before the first odometry."""
        found = self.odometry_at(stamp)
        if found is not None:
            self.place(pose.then(found.inverse()))

    def place(self, correction: Pose) -> None:
        """Set the correction."""
        self.correction = correction
        if self._odometry:
            self.pose = correction.then(self._odometry[-1][1])

    def odometry_at(self, stamp: float) -> Pose | None:
        """Return the pose according to odometry at *stamp*, as `pose_at`."""
        if not self._odometry:
            return None
        later_stamp, later = self._odometry[-1]
        if stamp == 0.0 or stamp >= later_stamp:
            return later
        for before_stamp, before in reversed(self._odometry):
            if before_stamp <= stamp:
                return _between(before, later, (stamp - before_stamp) / (later_stamp - before_stamp))
            later_stamp, later = before_stamp, before
        return later


def _between(a: Pose, b: Pose, share: float) -> Pose:
    """Interpolate linearly between *a* (share 0) and *b* (share 1)."""
    turn = normalised(b.yaw - a.yaw)
    return Pose(a.x + share * (b.x - a.x), a.y + share * (b.y - a.y), a.yaw + share * turn)


# From scans and odometry to an occupancy grid and the robot's pose on it.

DRIVEN = 0.1
"""Metres after which the next scan is added to the map."""

TURNED = math.radians(6.0)
"""Radians after which the next scan is added to the map."""

STOOD = 2.0
"""Seconds after which a scan is also added without motion: something else may have moved."""

MATCHED = 120
"""Approximate number of points of a scan that are matched."""

HARDLY_ANY, DOUBTED = 99.0, 0.5
"""Quality of the pose below which a robot that stands looks again after the second number, in seconds."""

COMPARED, ELSEWHERE, CHANGED = 30, 0.2, 0.3
"""Approximate number of ranges that are compared while the robot stands, metres by which they must differ, and the share of
those that do, for a scan to be looked at."""


class Mapper:
    """Add scans to a grid, each from the robot's pose at its time.

    A scan that does not match the map changes neither the map nor the pose, but raises doubt about the pose.

    Args:
        cells: the grid.
        options: how scans are read.
        matching: correct the pose by matching scans with earlier ones.

    Attributes:
        localisation: the robot's pose.
        matching: as given.
        doubt: how sure the robot is of its pose, if scans are matched.
        search: the search of the robot for its place; None if it does not search. Meanwhile no scan is added.
    """

    def __init__(self, cells: OccupancyCells, options: ScanOptions, matching: bool) -> None:
        self.localisation = Localisation()
        self.matching, self.doubt = matching, Doubt(cells)
        self.search: PlaceSearch | None = None
        self._cells, self._options = cells, options
        self._surfaces = Surfaces()
        self._last: tuple[float, Pose] | None = None
        self._newest: tuple[float, Any] = (0.0, None)
        self._ranges: Sequence[float] = ()

    def take_scan(self, stamp: float, message: Any) -> bool:
        """Take a ``sensor_msgs/msg/LaserScan`` with the time *stamp*, in seconds.

        Returns:
            Whether it was added to the map: not before the first odometry, not if the robot has not moved, and not while
            the robot's place is in doubt.
        """
        self._newest = (stamp, message)
        pose = self.localisation.pose_at(stamp)
        if pose is None or self.search is not None or not self._is_news(stamp, pose, message.ranges):
            return False
        scan = read_scan(message, self._options)
        self._last, self._ranges = (stamp, pose), message.ranges
        if self.matching and self._surfaces:
            echoes = _some(scan.echoes)
            pose = match(self._surfaces, echoes, pose) or pose
            if not self.doubt.confirms(stamp, pose.points(echoes[::2])):
                return False
            self.localisation.correct(stamp, pose)
            self._last = (stamp, pose)
        scan = moved(scan, pose)
        self._cells.add_scan(scan.origin, scan.echoes, scan.clear)
        if self.matching:
            self._surfaces.add(scan.echoes)
        return True

    def _is_news(self, stamp: float, pose: Pose, ranges: Sequence[float]) -> bool:
        if self._last is None:
            return True
        before, last = self._last
        if math.dist(last[:2], pose[:2]) >= DRIVEN or abs(normalised(pose.yaw - last.yaw)) >= TURNED:
            return True
        certain = self.doubt.quality > HARDLY_ANY
        return not 0.0 <= stamp - before < (STOOD if certain else DOUBTED) or (
            certain and self._differs(ranges)
        )

    def _differs(self, ranges: Sequence[float]) -> bool:
        """Return whether a robot that has hardly moved sees something else than before: it was carried."""
        if len(ranges) != len(self._ranges):
            return True
        every = max(1, len(ranges) // COMPARED)
        pairs = zip(ranges[::every], self._ranges[::every], strict=True)
        return sum(abs(now - before) > ELSEWHERE for now, before in pairs) > CHANGED * COMPARED

    def newest_scan(self) -> Scan | None:
        """Return the newest scan; None before the first one."""
        message = self._newest[1]
        return None if message is None else read_scan(message, self._options)

    def begin_with(self, obstacles: Collection[Cell]) -> None:
        """Forget earlier scans, and match later ones with *obstacles*, such as those of a loaded map."""
        size = self._cells.size
        self._surfaces = Surfaces()
        self._surfaces.add((x * size, y * size) for x, y in sorted(obstacles))
        self._last = self.search = None
        self.doubt.begin(SURE)

    # ---- the robot does not know its place

    def begin_search(self, quality: float = 0.0, about: Pose | None = None) -> PlaceSearch:
        """Look for the robot's place, near the pose *about* if it is given; *quality* is that of the pose until then."""
        self.doubt.begin(quality)
        self.search = PlaceSearch(self._cells, self._surfaces, self._options.longest, about)
        return self.search

    def search_is_due(self) -> bool:
        """Return whether the search needs the newest scan."""
        odometry = None if self.search is None else self.localisation.odometry_at(self._newest[0])
        return self.search is not None and odometry is not None and self.search.is_due(odometry)

    def search_steps(self) -> Iterator[None]:
        """Continue the search with the newest scan, in short steps; it ends when one place is left."""
        stamp = self._newest[0]
        search, scan, odometry = self.search, self.newest_scan(), self.localisation.odometry_at(stamp)
        if search is None or scan is None or odometry is None:
            return
        yield from search.steps(_some(scan.echoes), odometry)
        if search is self.search and len(search.places) == 1:
            self.end_search(search.places[0][1])

    def end_search(self, correction: Pose) -> None:
        """Set the pose of odometry on the map; the scans that follow confirm it or not."""
        self.search = self._last = None
        self.localisation.place(correction)
        self.doubt.begin(PROBABLE)


def _some(echoes: Sequence[Point]) -> Sequence[Point]:
    """Return about `MATCHED` of the echoes."""
    return echoes[:: max(1, len(echoes) // MATCHED)]
