"""Poses in the plane (the frames of REP 105), directions, and the angles of a quaternion.

Lengths are in metres, angles in radians, positive counter-clockwise.
"""

import math
from collections.abc import Iterable
from typing import Any, NamedTuple

from jacaros.robots.plane.trigonometry import PI, sine_cosine

Point = tuple[float, float]
"""x and y, in metres."""


class Pose(NamedTuple):
    """The pose of a robot or of a frame in another frame: x and y in metres, and the heading in radians.

    The pose of odometry on the map, `then` the robot's pose in odometry, is the robot's pose on the map.
    """

    x: float
    y: float
    yaw: float

    @classmethod
    def of(cls, message: Any) -> "Pose":
        """Read a ``geometry_msgs/msg/Pose``."""
        place, turn = message.position, message.orientation
        return cls(float(place.x), float(place.y), yaw_of(turn.x, turn.y, turn.z, turn.w))

    def point(self, x: float, y: float) -> Point:
        """Transform a point of this frame to the outer frame."""
        return self._placement().point(x, y)

    def points(self, points: Iterable[Point]) -> list[Point]:
        """Transform points of this frame to the outer frame."""
        x, y, sine, cosine = self.x, self.y, math.sin(self.yaw), math.cos(self.yaw)
        return [(x + cosine * a - sine * b, y + sine * a + cosine * b) for a, b in points]

    def local(self, x: float, y: float) -> Point:
        """Transform a point of the outer frame to this frame: metres ahead, and to the left."""
        return self._placement().local(x, y)

    def then(self, inner: "Pose") -> "Pose":
        """Transform a pose in this frame to the outer frame."""
        return Pose(*self.point(inner.x, inner.y), normalised(self.yaw + inner.yaw))

    def inverse(self) -> "Pose":
        """Return the outer frame in this frame."""
        return Pose(*self.local(0.0, 0.0), -self.yaw)

    def _placement(self) -> "Placement":
        return Placement(self.x, self.y, math.cos(self.yaw), math.sin(self.yaw))


ORIGIN = Pose(0.0, 0.0, 0.0)


class Placement(NamedTuple):
    """The pose of a frame in another frame: metres, and the cosine and sine of the heading.

    Sums, products and square roots only, so that results are equal on every machine: the last bit of an arctangent from
    the C library may differ (see `jacaros.robots.plane.trigonometry`). The world uses these.
    """

    x: float
    y: float
    cosine: float = 1.0
    sine: float = 0.0

    @classmethod
    def at(cls, x: float, y: float, yaw: float) -> "Placement":
        """Return a placement with a heading in radians."""
        sine, cosine = sine_cosine(yaw)
        return cls(x, y, cosine, sine)

    @classmethod
    def from_quaternion(cls, x: float, y: float, rotation: tuple[float, float, float, float]) -> "Placement":
        """Return a placement with the heading of a quaternion (x, y, z, w), which need not be normalised."""
        qx, qy, qz, qw = rotation
        sine = 2.0 * (qw * qz + qx * qy)
        cosine = qw * qw + qx * qx - qy * qy - qz * qz
        length = math.sqrt(sine * sine + cosine * cosine)
        if length < 1e-9:
            return cls(x, y)
        return cls(x, y, cosine / length, sine / length)

    def point(self, x: float, y: float) -> Point:
        """Transform a point of this frame to the outer frame."""
        return self.x + self.cosine * x - self.sine * y, self.y + self.sine * x + self.cosine * y

    def local(self, x: float, y: float) -> Point:
        """Transform a point of the outer frame to this frame."""
        dx, dy = x - self.x, y - self.y
        return self.cosine * dx + self.sine * dy, self.cosine * dy - self.sine * dx

    def then(self, inner: "Placement") -> "Placement":
        """Transform a placement in this frame to the outer frame."""
        x, y = self.point(inner.x, inner.y)
        return Placement(
            x,
            y,
            self.cosine * inner.cosine - self.sine * inner.sine,
            self.sine * inner.cosine + self.cosine * inner.sine,
        )

    def inverse(self) -> "Placement":
        """Return the outer frame in this frame."""
        x, y = self.local(0.0, 0.0)
        return Placement(x, y, self.cosine, -self.sine)

    def quaternion(self) -> tuple[float, float]:
        """Return z and w of the quaternion; x and y are 0."""
        half = math.sqrt(max(0.0, 0.5 * (1.0 + self.cosine)))
        if half < 1e-6:
            return 1.0, 0.0
        return 0.5 * self.sine / half, half


def normalised(angle: float, turn: float = math.tau) -> float:
    """Return the same direction, more than minus half a *turn* and at most half a turn."""
    rest = math.remainder(angle, turn)
    return -rest if rest == -0.5 * turn else rest


def wrap(angle: float) -> float:
    """Return the same direction in the range from -pi (included) to pi (excluded), in radians."""
    return angle if -PI <= angle < PI else -normalised(-angle)


def distance(a: Point, b: Point) -> float:
    """Return the distance of two points, in metres."""
    dx, dy = b[0] - a[0], b[1] - a[1]
    return math.sqrt(dx * dx + dy * dy)


def clamp(value: float, most: float) -> float:
    """Limit the magnitude of *value* to *most*."""
    if value > most:
        return most
    if value < -most:
        return -most
    return value


def roll_of(x: float, y: float, z: float, w: float) -> float:
    """Return the rotation of a unit quaternion about the x axis."""
    return math.atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y))


def pitch_of(x: float, y: float, z: float, w: float) -> float:
    """Return the rotation of a unit quaternion about the y axis."""
    # Rounding may put the sine slightly beyond 1.
    return math.asin(max(-1.0, min(1.0, 2.0 * (w * y - z * x))))


def yaw_of(x: float, y: float, z: float, w: float) -> float:
    """Return the rotation of a unit quaternion about the z axis: the heading of a robot."""
    return math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))
