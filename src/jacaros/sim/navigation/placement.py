"""Poses in the plane without angles: sums, products and square roots only, so that results are equal on every machine.

A heading is stored as cosine and sine. An arctangent would come from the C library, whose last bit may differ between
machines (see `jacaros.sim.trigonometry`).
"""

import math
from typing import NamedTuple

from jacaros.sim.trigonometry import sine_cosine

Point = tuple[float, float]


class Placement(NamedTuple):
    """The pose of a frame in another frame: metres, and the cosine and sine of the heading."""

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


def distance(a: Point, b: Point) -> float:
    """Return the distance of two points, in metres."""
    dx, dy = b[0] - a[0], b[1] - a[1]
    return math.sqrt(dx * dx + dy * dy)
