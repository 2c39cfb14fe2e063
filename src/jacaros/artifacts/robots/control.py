"""Motion control: pose and goal in, velocity command out.

Nothing here waits, publishes or reads a clock. A controller is called once per period with the newest pose and
returns the next command. Lengths are in metres, angles in radians, positive counter-clockwise.
"""

import math
from dataclasses import dataclass
from typing import NamedTuple

from jacaros.plane.pose import Pose, clamp, normalised


class Velocity(NamedTuple):
    """A command or a measurement: metres per second ahead, radians per second to the left."""

    linear: float = 0.0
    angular: float = 0.0


STANDSTILL = Velocity()
"""The command that stops a robot."""


@dataclass(frozen=True, slots=True)
class Limits:
    """What a robot can do; the defaults are those of a TurtleBot 2.

    Attributes:
        speed: metres per second.
        turn_speed: radians per second.
        acceleration: metres per second squared.
        turn_acceleration: radians per second squared.
    """

    speed: float = 0.65
    turn_speed: float = math.pi
    acceleration: float = 0.8
    turn_acceleration: float = 5.0

    def clip(self, velocity: Velocity) -> Velocity:
        """Return the nearest velocity that the robot can drive."""
        return Velocity(
            clamp(velocity.linear, self.speed),
            clamp(velocity.angular, self.turn_speed),
        )


@dataclass(frozen=True, slots=True)
class Line:
    """A straight line: from *start*, along its heading, *length* metres (negative: in reverse)."""

    start: Pose
    length: float

    def along(self, pose: Pose) -> float:
        """Return how many metres *pose* is ahead of the start."""
        return self.start.local(pose.x, pose.y)[0]

    def aside(self, pose: Pose) -> float:
        """Return how many metres *pose* is to the left of the line."""
        return self.start.local(pose.x, pose.y)[1]

    def remaining(self, pose: Pose) -> float:
        """Return the remaining distance from *pose*, in signed metres."""
        return self.length - self.along(pose)


def distance(a: Pose, b: Pose) -> float:
    """Return the Euclidean distance of two poses."""
    return math.hypot(b.x - a.x, b.y - a.y)


def bearing(origin: Pose, x: float, y: float) -> float:
    """Return the direction from *origin* to the point x, y."""
    return math.atan2(y - origin.y, x - origin.x)


def steer(line: Line, pose: Pose, speed: float, jitter: float, most: float) -> float:
    """Return the turn rate that leads back to *line*.

    The robot aims at the point of the line 0.4 m ahead (look-ahead). Close to the goal it only keeps its heading,
    because there is no distance left for returning to the line.

    Args:
        line: the line.
        pose: pose at which the command takes effect.
        speed: signed speed.
        jitter: seconds by which the command may come early or late.
        most: greatest turn rate of the robot.
    """
    pull = math.atan2(line.aside(pose), 0.4) if abs(line.remaining(pose)) > 0.05 else 0.0
    aim = line.start.yaw - math.copysign(1.0, speed) * pull
    gain = min(2.0, 0.4 / jitter) if jitter else 2.0
    return clamp(gain * normalised(aim - pose.yaw), 0.5 * most)
