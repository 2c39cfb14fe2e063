"""Laser scans as points in the frame of the robot."""

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

from jacaros.plane.pose import Point, Pose

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
    sine, cosine = math.sin(pose.yaw), math.cos(pose.yaw)
    x, y = pose.x, pose.y

    def all_of(points: list[Point]) -> list[Point]:
        return [(x + cosine * a - sine * b, y + sine * a + cosine * b) for a, b in points]

    return Scan(pose.point(*scan.origin), all_of(scan.echoes), all_of(scan.clear))
