"""What a robot's odometry says, taken out of the messages once for all artifacts that need it."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from jacaros.artifacts.ros.control import Pose, Velocity, heading_of
from jacaros.ros.backend import Sample

ODOMETRY = "nav_msgs/msg/Odometry"

STANDING = Velocity(0.02, 0.05)
"""A robot slower than this (metres and radians per second) stands still."""


@dataclass(slots=True)
class Odometry:
    """One odometry message; nobody changes it.

    Attributes:
        position: x, y, z in metres.
        pose: x, y and heading.
        velocity: ahead and turning.
        sample: the message it was taken from.
    """

    position: tuple[float, float, float]
    pose: Pose
    velocity: Velocity
    sample: Sample

    @property
    def standing(self) -> bool:
        """Whether the robot stands still."""
        moves = abs(self.velocity.linear) > STANDING.linear
        return not moves and abs(self.velocity.angular) <= STANDING.angular


def read_odometry(sample: Sample) -> Odometry:
    """Take the fields that matter out of a ``nav_msgs/msg/Odometry``."""
    pose: Any = sample.message.pose.pose
    twist: Any = sample.message.twist.twist
    position = (float(pose.position.x), float(pose.position.y), float(pose.position.z))
    q = pose.orientation
    return Odometry(
        position,
        Pose(position[0], position[1], heading_of(q.x, q.y, q.z, q.w)),
        Velocity(float(twist.linear.x), float(twist.angular.z)),
        sample,
    )


class Odometer:
    """The newest odometry of one robot.

    Args:
        on_reading: told of every message.

    Attributes:
        newest: None until the first message.
        count: messages so far.
    """

    def __init__(self, on_reading: Callable[[Odometry], None] | None = None) -> None:
        self.newest: Odometry | None = None
        self.count = 0
        self._on_reading = on_reading

    def take(self, sample: Sample) -> None:
        """Take a message; the callback of the subscription."""
        self.newest = read_odometry(sample)
        self.count += 1
        if self._on_reading is not None:
            self._on_reading(self.newest)

    def age(self, now: float) -> float | None:
        """Seconds since the newest message came; None when none did."""
        return None if self.newest is None else now - self.newest.sample.stamp
