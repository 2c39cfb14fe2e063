"""Motion control: pose and goal in, velocity command out.

Nothing here waits, publishes or reads a clock. A controller is called once per period with the newest pose and
returns the next command. Lengths are in metres, angles in radians, positive counter-clockwise.
"""

import math
from dataclasses import dataclass
from typing import NamedTuple

DISTANCE_TOLERANCE = 0.005
"""Remaining metres at which a drive is at its goal."""

ANGLE_TOLERANCE = math.radians(0.3)
"""Remaining radians at which a turn is at its goal."""

LEAST_SPEED = 0.02
"""Minimum speed of a drive, metres per second: real wheels stick below it."""

LEAST_TURN_SPEED = 0.05
"""Minimum speed of a turn, radians per second."""

LATENCY = 0.1
"""Seconds from the measurement of a pose until its command takes effect; the controller predicts by this time."""

BRAKING_SHARE = 0.6
"""Fraction of the robot's acceleration used for slowing down; the rest is a reserve for disturbances."""

GAIN = 4.0
"""Speed per remaining distance, 1/s, in the last centimetres; stable up to 0.3 s of latency."""

HOLDING_GAIN = 8.0
"""The same within the tolerances, where the minimum speeds do not apply: wheels may stick there."""


class Pose(NamedTuple):
    """Where a robot is: x and y in metres, heading in radians."""

    x: float
    y: float
    heading: float


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
        dx, dy = pose.x - self.start.x, pose.y - self.start.y
        return dx * math.cos(self.start.heading) + dy * math.sin(self.start.heading)

    def aside(self, pose: Pose) -> float:
        """Return how many metres *pose* is to the left of the line."""
        dx, dy = pose.x - self.start.x, pose.y - self.start.y
        return dy * math.cos(self.start.heading) - dx * math.sin(self.start.heading)

    def remaining(self, pose: Pose) -> float:
        """Return the remaining distance from *pose*, in signed metres."""
        return self.length - self.along(pose)


def clamp(value: float, limit: float) -> float:
    """Return *value*, limited to [-limit, limit]."""
    return max(-limit, min(limit, value))


def unwrapped(angle: float) -> float:
    """Return the same direction in (-pi, pi]."""
    turned = math.remainder(angle, math.tau)
    return math.pi if turned == -math.pi else turned


def heading_of(x: float, y: float, z: float, w: float) -> float:
    """Return the heading of a robot with the orientation x, y, z, w (a quaternion), in (-pi, pi]."""
    return math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))


def distance(a: Pose, b: Pose) -> float:
    """Return the Euclidean distance of two poses."""
    return math.hypot(b.x - a.x, b.y - a.y)


def bearing(origin: Pose, x: float, y: float) -> float:
    """Return the direction from *origin* to the point x, y."""
    return math.atan2(y - origin.y, x - origin.x)


def approach(
    remaining: float, speed: float, *, cruise: float, acceleration: float, least: float, period: float
) -> float:
    """Return the next speed of a trapezoidal profile that ends exactly at the goal.

    Args:
        remaining: signed remaining distance (metres or radians).
        speed: the previous signed speed.
        cruise: maximum speed.
        acceleration: limit of the robot; speeding up uses all of it, slowing down `BRAKING_SHARE`.
        least: minimum speed while the goal is not reached.
        period: seconds between two commands.
    """
    towards = math.copysign(1.0, remaining)
    ahead = abs(remaining) - max(0.0, speed * towards) * LATENCY
    braking = math.sqrt(2.0 * BRAKING_SHARE * acceleration * max(0.0, ahead))
    wanted = max(least, min(cruise, braking, GAIN * abs(remaining)))
    faster = max(least, speed * towards + acceleration * period)
    return towards * min(wanted, faster)


def drive_command(line: Line, pose: Pose, before: Velocity, limits: Limits, period: float) -> Velocity:
    """Return the command that follows *line*: the speed of `approach`, the heading steered back to the line.

    The robot aims at the point of the line 0.4 m ahead (look-ahead). Close to the goal it only keeps its heading,
    because there is no distance left for returning to the line.
    """
    remaining = line.remaining(pose)
    linear = approach(
        remaining,
        before.linear,
        cruise=limits.speed,
        acceleration=limits.acceleration,
        least=min(LEAST_SPEED, limits.speed),
        period=period,
    )
    pull = math.atan2(line.aside(pose), 0.4) if abs(remaining) > 0.05 else 0.0
    aim = line.start.heading - math.copysign(1.0, linear) * pull
    angular = clamp(2.0 * unwrapped(aim - pose.heading), 0.5 * limits.turn_speed)
    return limits.clip(Velocity(linear, angular))


def turn_command(remaining: float, before: Velocity, limits: Limits, period: float) -> Velocity:
    """Return the command that turns on the spot until the signed angle *remaining* is zero."""
    angular = approach(
        remaining,
        before.angular,
        cruise=limits.turn_speed,
        acceleration=limits.turn_acceleration,
        least=min(LEAST_TURN_SPEED, limits.turn_speed),
        period=period,
    )
    return limits.clip(Velocity(0.0, angular))


def hold_command(way: float, angle: float) -> Velocity:
    """Return the command that corrects the rest within the tolerances: metres and radians."""
    return Velocity(
        clamp(HOLDING_GAIN * way, LEAST_SPEED),
        clamp(HOLDING_GAIN * angle, LEAST_TURN_SPEED),
    )
