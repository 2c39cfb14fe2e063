"""Composition of poses in the plane, as for the frames of REP 105.

The pose of odometry on the map, followed by the robot's pose in odometry, is the robot's pose on the map.
"""

import math

from jacaros.artifacts.robots.control import Pose

ORIGIN = Pose(0.0, 0.0, 0.0)


def followed_by(first: Pose, second: Pose) -> Pose:
    """Convert the pose *second* from the frame at *first* to the frame of *first*."""
    x, y = transformed(first, second.x, second.y)
    return Pose(x, y, math.remainder(first.heading + second.heading, math.tau))


def inverse(pose: Pose) -> Pose:
    """Return the pose of the origin, relative to *pose*."""
    sine, cosine = math.sin(pose.heading), math.cos(pose.heading)
    return Pose(-cosine * pose.x - sine * pose.y, sine * pose.x - cosine * pose.y, -pose.heading)


def transformed(frame: Pose, x: float, y: float) -> tuple[float, float]:
    """Convert a point from the frame at *frame*."""
    sine, cosine = math.sin(frame.heading), math.cos(frame.heading)
    return frame.x + cosine * x - sine * y, frame.y + sine * x + cosine * y


def between(a: Pose, b: Pose, share: float) -> Pose:
    """Interpolate linearly between *a* (share 0) and *b* (share 1)."""
    turn = math.remainder(b.heading - a.heading, math.tau)
    return Pose(a.x + share * (b.x - a.x), a.y + share * (b.y - a.y), a.heading + share * turn)
