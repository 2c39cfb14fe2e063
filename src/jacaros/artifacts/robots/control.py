"""Pure control: pose and goal in, velocity command out.

Nothing here waits, publishes or knows the time of day; a controller is called once per period with the
newest pose and says what to command.  Lengths are metres, angles radians, counter-clockwise positive.
"""

import math
from dataclasses import dataclass
from typing import NamedTuple

DISTANCE_TOLERANCE = 0.005
"""A drive is at its end when so few metres remain."""

ANGLE_TOLERANCE = math.radians(0.3)
"""A turn is at its end when so few radians remain."""

LEAST_SPEED = 0.02
"""No drive creeps slower than this, metres per second: real wheels stick below it."""

LEAST_TURN_SPEED = 0.05
"""No turn creeps slower than this, radians per second."""

LATENCY = 0.1
"""Seconds from a pose being measured to its command taking effect; the controller looks so far ahead."""

BRAKING_SHARE = 0.6
"""Share of the robot's acceleration planned for slowing down; the rest is a reserve for disturbances."""

GAIN = 4.0
"""Speed per remaining way, 1/s, in the last centimetres; stable up to 0.3 s of latency."""

HOLDING_GAIN = 8.0
"""The same within the tolerances, where the least speeds do not count: wheels may stick there."""


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
    """What a robot can do, by default a TurtleBot 2.

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
        """The nearest velocity that the robot can drive."""
        return Velocity(
            clamp(velocity.linear, self.speed),
            clamp(velocity.angular, self.turn_speed),
        )


@dataclass(frozen=True, slots=True)
class Line:
    """A straight way: from *start*, along the start's heading, *length* metres (negative: in reverse)."""

    start: Pose
    length: float

    def along(self, pose: Pose) -> float:
        """Metres that *pose* lies ahead of the start."""
        dx, dy = pose.x - self.start.x, pose.y - self.start.y
        return dx * math.cos(self.start.heading) + dy * math.sin(self.start.heading)

    def aside(self, pose: Pose) -> float:
        """Metres that *pose* lies to the left of the way."""
        dx, dy = pose.x - self.start.x, pose.y - self.start.y
        return dy * math.cos(self.start.heading) - dx * math.sin(self.start.heading)

    def remaining(self, pose: Pose) -> float:
        """Signed metres still to drive from *pose*."""
        return self.length - self.along(pose)


def clamp(value: float, limit: float) -> float:
    """*value*, or the nearer end of [-limit, limit]."""
    return max(-limit, min(limit, value))


def unwrapped(angle: float) -> float:
    """The same direction in (-pi, pi]."""
    turned = math.remainder(angle, math.tau)
    return math.pi if turned == -math.pi else turned


def heading_of(x: float, y: float, z: float, w: float) -> float:
    """Heading of a robot whose orientation is the quaternion x, y, z, w, in (-pi, pi]."""
    return math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))


def distance(a: Pose, b: Pose) -> float:
    """Euclidean distance of two poses."""
    return math.hypot(b.x - a.x, b.y - a.y)


def bearing(origin: Pose, x: float, y: float) -> float:
    """Direction from *origin* to the point x, y."""
    return math.atan2(y - origin.y, x - origin.x)


def approach(
    remaining: float, speed: float, *, cruise: float, acceleration: float, least: float, period: float
) -> float:
    """Next speed of a trapezoid that ends exactly where nothing remains.

    Args:
        remaining: signed way still to go (metres or radians).
        speed: signed speed commanded before.
        cruise: highest speed.
        acceleration: what the robot can do; speeding up uses all of it, slowing down `BRAKING_SHARE`.
        least: lowest speed while something remains.
        period: seconds between two commands.
    """
    towards = math.copysign(1.0, remaining)
    ahead = abs(remaining) - max(0.0, speed * towards) * LATENCY
    braking = math.sqrt(2.0 * BRAKING_SHARE * acceleration * max(0.0, ahead))
    wanted = max(least, min(cruise, braking, GAIN * abs(remaining)))
    faster = max(least, speed * towards + acceleration * period)
    return towards * min(wanted, faster)


def drive_command(line: Line, pose: Pose, before: Velocity, limits: Limits, period: float) -> Velocity:
    """Command that follows *line*: the speed of `approach`, the heading pulled back to the line.

    The pull is a look-ahead: the robot aims at the point of the line 0.4 m on.  Close to the goal it only
    keeps its heading, as there is no way left on which to come back.
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
    """Command that turns on the spot until nothing of the signed angle *remaining* is left."""
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
    """Command that makes up for the little that remains within the tolerances: metres and radians."""
    return Velocity(
        clamp(HOLDING_GAIN * way, LEAST_SPEED),
        clamp(HOLDING_GAIN * angle, LEAST_TURN_SPEED),
    )
