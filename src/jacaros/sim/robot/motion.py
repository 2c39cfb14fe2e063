"""Differential drive: the motion of a base with limits in one time step. Pure functions on numbers.

Odometry is a second pose, integrated from the motion of the wheels, with optional seeded errors.
"""

import math
import random

from jacaros.plane.pose import Placement, Pose, clamp, wrap
from jacaros.plane.trigonometry import sine_cosine
from jacaros.sim.description import OdometrySettings, RobotLimits


def approach(now: float, wanted: float, most: float) -> float:
    """Move *now* towards *wanted* by at most *most*."""
    if wanted > now + most:
        return now + most
    if wanted < now - most:
        return now - most
    return wanted


def ramp(
    speed: float,
    turn_rate: float,
    wanted_speed: float,
    wanted_turn_rate: float,
    limits: RobotLimits,
    dt: float,
) -> tuple[float, float]:
    """Return speed and turn rate (m/s, rad/s) after *dt* seconds of approaching the wanted ones within *limits*."""
    return (
        approach(speed, clamp(wanted_speed, limits.speed), limits.acceleration * dt),
        approach(turn_rate, clamp(wanted_turn_rate, limits.turn_rate), limits.turn_acceleration * dt),
    )


def advance(x: float, y: float, yaw: float, distance: float, turn: float) -> tuple[float, float, float]:
    """Return the pose after *distance* metres along an arc of *turn* radians, by the midpoint rule."""
    if distance != 0.0:
        sine, cosine = sine_cosine(yaw + 0.5 * turn)
        x += distance * cosine
        y += distance * sine
    return x, y, (wrap(yaw + turn) if turn != 0.0 else yaw)


# A uniform number of width sqrt(12) has variance 1. Not a Gaussian, whose logarithm comes from the C library.
_WIDTH = math.sqrt(12.0)


class Odometry:
    """The pose estimated from the wheels.

    The standard deviation of errors grows with the square root of the distance in the step, hence of its duration: the
    error accumulated over a metre does not depend on the length of the steps.

    Attributes:
        x, y, yaw: the estimated pose (metres, radians).
        rolled, turned: total signed distance (m) and rotation (rad) of the wheels.
    """

    __slots__ = ("_draw", "rolled", "settings", "turned", "x", "y", "yaw")

    def __init__(self, settings: OdometrySettings, start: Pose, seed: str) -> None:
        self.settings = settings
        self.x, self.y, self.yaw = (0.0, 0.0, 0.0) if settings.from_start else start
        self.rolled = self.turned = 0.0
        self._draw = random.Random(seed).random

    @property
    def placement(self) -> Placement:
        """The estimated pose, with the cosine and sine of the heading."""
        return Placement.at(self.x, self.y, self.yaw)

    def step(self, distance: float, turn: float) -> None:
        """Add *distance* metres and *turn* radians made by the wheels in one step."""
        settings = self.settings
        self.rolled += distance
        self.turned += turn
        if settings.noisy:
            way, angle = abs(distance), abs(turn)
            distance += self._error(settings.per_metre, way)
            turn += self._error(settings.per_radian, angle) + self._error(settings.turn_per_metre, way)
        self.x, self.y, self.yaw = advance(self.x, self.y, self.yaw, distance, turn)

    def _error(self, deviation: float, way: float) -> float:
        return (self._draw() - 0.5) * _WIDTH * deviation * math.sqrt(way) if deviation and way else 0.0
