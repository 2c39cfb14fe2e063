"""A rigid motion in space: what tf looks up, applied to points and headings."""

import math
from dataclasses import dataclass

from jacaros.plane.pose import yaw_of

Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]


@dataclass(frozen=True, slots=True)
class Transform:
    """Takes points from one frame to another: rotation, then translation (REP 105's frames, tf2's convention).

    Attributes:
        translation: x, y, z in metres.
        rotation: unit quaternion x, y, z, w.
        stamp: the time for which it holds, in seconds since the epoch; 0 if it always holds (static).
    """

    translation: Vector = (0.0, 0.0, 0.0)
    rotation: Quaternion = (0.0, 0.0, 0.0, 1.0)
    stamp: float = 0.0

    @property
    def yaw(self) -> float:
        """Heading of the rotated x axis in the plane, in radians, counter-clockwise."""
        return yaw_of(*self.rotation)

    def apply(self, point: Vector) -> Vector:
        """Convert *point* from the source frame to the target frame."""
        x, y, z = rotate(self.rotation, point)
        dx, dy, dz = self.translation
        return (x + dx, y + dy, z + dz)

    def after(self, first: "Transform") -> "Transform":
        """Return the transform that applies *first* and then this one; it holds for the older of the two times."""
        stamps = [stamp for stamp in (self.stamp, first.stamp) if stamp > 0.0]
        return Transform(
            self.apply(first.translation), multiply(self.rotation, first.rotation), min(stamps, default=0.0)
        )

    def inverse(self) -> "Transform":
        """Return the inverse transform."""
        x, y, z, w = self.rotation
        back = (-x, -y, -z, w)
        dx, dy, dz = rotate(back, self.translation)
        return Transform((-dx, -dy, -dz), back, self.stamp)


def multiply(a: Quaternion, b: Quaternion) -> Quaternion:
    """Return the rotation *b* followed by *a*."""
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    )


def rotate(q: Quaternion, v: Vector) -> Vector:
    """Rotate a vector."""
    x, y, z, w = q
    # v + 2 w (u x v) + 2 u x (u x v), with u the quaternion's vector part
    tx, ty, tz = (
        2.0 * (y * v[2] - z * v[1]),
        2.0 * (z * v[0] - x * v[2]),
        2.0 * (x * v[1] - y * v[0]),
    )
    return (
        v[0] + w * tx + y * tz - z * ty,
        v[1] + w * ty + z * tx - x * tz,
        v[2] + w * tz + x * ty - y * tx,
    )


def interpolate(first: Transform, second: Transform, ratio: float) -> Transform:
    """Interpolate between two transforms: linear translation, rotation the short way (slerp).

    Args:
        first, second: the two ends.
        ratio: from 0 (*first*) to 1 (*second*).
    """
    ax, ay, az = first.translation
    bx, by, bz = second.translation
    return Transform(
        (ax + (bx - ax) * ratio, ay + (by - ay) * ratio, az + (bz - az) * ratio),
        _slerp(first.rotation, second.rotation, ratio),
        first.stamp + (second.stamp - first.stamp) * ratio,
    )


def _slerp(a: Quaternion, b: Quaternion, ratio: float) -> Quaternion:
    cosine = sum(p * q for p, q in zip(a, b, strict=True))
    if cosine < 0.0:  # q and -q are the same rotation; one of them is the short way
        b, cosine = (-b[0], -b[1], -b[2], -b[3]), -cosine
    if cosine > 0.9995:  # so close that the sine below loses precision
        weight_a, weight_b = 1.0 - ratio, ratio
    else:
        angle = math.acos(cosine)
        weight_a = math.sin((1.0 - ratio) * angle) / math.sin(angle)
        weight_b = math.sin(ratio * angle) / math.sin(angle)
    x, y, z, w = (weight_a * p + weight_b * q for p, q in zip(a, b, strict=True))
    length = math.sqrt(x * x + y * y + z * z + w * w)
    return (x / length, y / length, z / length, w / length)
