"""What a robot's odometry says, taken out of the messages once for all artifacts that need it."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from jacaros.artifacts.ros.control import Pose, Velocity, heading_of
from jacaros.artifacts.ros.faults import Faults, Header
from jacaros.clock import Clock
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


def not_finite(sample: Sample) -> tuple[str, float] | None:
    """The first number of an odometry message that is NaN or infinite, with its field; None when there is none."""
    pose: Any = sample.message.pose.pose
    twist: Any = sample.message.twist.twist
    p, q = pose.position, pose.orientation
    # A sum is finite only if all that it is made of is: one test for nearly all messages.
    if math.isfinite(p.x + p.y + p.z + q.x + q.y + q.z + q.w + twist.linear.x + twist.angular.z):
        return None
    fields = [(f"pose.pose.position.{name}", getattr(p, name)) for name in "xyz"]
    fields += [(f"pose.pose.orientation.{name}", getattr(q, name)) for name in "xyzw"]
    fields += [("twist.twist.linear.x", twist.linear.x), ("twist.twist.angular.z", twist.angular.z)]
    return next(((name, number) for name, number in fields if not math.isfinite(number)), None)


class Odometer:
    """The newest odometry of one robot; what is wrong with a message is noted, and the message not used.

    Args:
        faults: where bad messages are noted.
        clock: measures how late messages are.
        on_reading: told of every good message.
        frame: see `Header`.

    Attributes:
        newest: None until the first message.
        count: good messages so far.
        trusted: False when the newest message was no odometry at all: where the robot is now is not known.
    """

    def __init__(
        self,
        faults: Faults,
        clock: Clock,
        on_reading: Callable[[Odometry], None] | None = None,
        frame: str = "",
    ) -> None:
        self.newest: Odometry | None = None
        self.count = 0
        self.trusted = True
        self._faults = faults
        self._header = Header(faults, clock, frame)
        self._on_reading = on_reading

    @property
    def faults(self) -> int:
        """How many messages were bad."""
        return self._faults.total

    @property
    def frame(self) -> str:
        """The frame of the newest poses; empty while it is not known."""
        return self._header.frame

    def take(self, sample: Sample) -> None:
        """Take a message; the callback of the subscription."""
        wrong = not_finite(sample)
        if wrong is not None:
            self.trusted = False
            self._faults.not_finite(*wrong)
            return
        if not self._header.accepts(sample):
            return
        self.newest = read_odometry(sample)
        self.trusted = True
        self.count += 1
        if self._on_reading is not None:
            self._on_reading(self.newest)

    def age(self, now: float) -> float | None:
        """Seconds since the newest message should have come; None when none did."""
        return None if self.newest is None else now - self.newest.sample.stamp + self._header.late
