"""Poses in the plane put one after the other, as the frames of REP 105 are.

The pose of odometry on the map, followed by the robot's pose in odometry, is the robot's pose on the map.
"""

import math

from jacaros.artifacts.robots.control import Pose

ORIGIN = Pose(0.0, 0.0, 0.0)


def followed_by(first: Pose, second: Pose) -> Pose:
    """Return the pose *second*, given in the frame at *first*, in the frame of *first*."""
    x, y = transformed(first, second.x, second.y)
    return Pose(x, y, math.remainder(first.heading + second.heading, math.tau))


def inverse(pose: Pose) -> Pose:
    """Return where the origin is, seen from *pose*."""
    sine, cosine = math.sin(pose.heading), math.cos(pose.heading)
    return Pose(-cosine * pose.x - sine * pose.y, sine * pose.x - cosine * pose.y, -pose.heading)


def transformed(frame: Pose, x: float, y: float) -> tuple[float, float]:
    """Return a point given in the frame at *frame*."""
    sine, cosine = math.sin(frame.heading), math.cos(frame.heading)
    return frame.x + cosine * x - sine * y, frame.y + sine * x + cosine * y


def between(a: Pose, b: Pose, share: float) -> Pose:
    """Return the pose between *a* (share 0) and *b* (share 1), on the straight line."""
    turn = math.remainder(b.heading - a.heading, math.tau)
    return Pose(a.x + share * (b.x - a.x), a.y + share * (b.y - a.y), a.heading + share * turn)
