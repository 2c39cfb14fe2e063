"""Laser scans as points in the frame of the robot."""

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

from jacaros.artifacts.map.poses import transformed
from jacaros.artifacts.robots.control import Pose

Point = tuple[float, float]


SAME_SURFACE = 0.5
"""How much the ranges of neighbouring beams may differ to be taken for echoes of one surface, as a share of the range."""

LONGEST_GRAZE = 2.5
"""Metres that a beam may be said to run beside a surface."""


class Scan(NamedTuple):
    """What a scan says, in metres from the robot.

    Attributes:
        origin: where the laser is.
        echoes: where there is something.
        clear: up to where each beam shows that the ground is free.
    """

    origin: Point
    echoes: list[Point]
    clear: list[Point]


@dataclass(frozen=True, slots=True)
class ScanOptions:
    """How scans are read.

    Attributes:
        longest: metres beyond which beams are cut off.
        mount: pose of the laser on the robot.
        beside: metres from a surface within which a beam says nothing, such as the side of a cell: it may pass through
            the same cell as the surface.
    """

    longest: float
    mount: Pose
    beside: float


def read_scan(message: Any, options: ScanOptions) -> Scan:
    """Take the points out of a ``sensor_msgs/msg/LaserScan``.

    A beam without an echo is infinite or beyond the sensor's range (REP 117).  One that is not a number, or nearer than the
    sensor can measure, says nothing.
    """
    mount, longest = options.mount, options.longest
    echoes: list[Point] = []
    clear: list[Point] = []
    least, most = float(message.range_min), float(message.range_max)
    angle, increment = float(message.angle_min) + mount.heading, float(message.angle_increment)
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

    The surface runs from the echo of the beam before to this one; the flatter the beam meets it, the longer it is beside.
    """
    across = abs(before * sine)
    if across == 0.0 or not abs(reading - before) < SAME_SURFACE * reading:
        return near
    return min(LONGEST_GRAZE, near * math.hypot(reading - before * cosine, across) / across)


def moved(scan: Scan, pose: Pose) -> Scan:
    """Return a scan in map coordinates, for a robot at *pose*."""
    sine, cosine = math.sin(pose.heading), math.cos(pose.heading)
    x, y = pose.x, pose.y

    def all_of(points: list[Point]) -> list[Point]:
        return [(x + cosine * a - sine * b, y + sine * a + cosine * b) for a, b in points]

    return Scan(transformed(pose, *scan.origin), all_of(scan.echoes), all_of(scan.clear))
