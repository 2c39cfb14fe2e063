"""Rigid motions in space, as in tf: applied to points and headings, and looked up by frames and time.

The rules are tf2's: every frame has one parent, a look-up goes up from both frames to their common ancestor, times
between two known ones are interpolated, times outside the known interval are refused.
"""

import math
from bisect import bisect_left
from collections.abc import Callable
from dataclasses import dataclass

from jacaros.robots.plane.pose import yaw_of
from jacaros.robots.ros.errors import TransformUnavailable
from jacaros.runtime.files.texts import aside

HISTORY = 10.0
"""Seconds for which moving transforms are kept, as in tf2."""
OLD_IN_A_ROW = 3
"""Number of consecutive outdated transforms of a frame that mean that time has restarted."""
_UNIT = 0.01
"""Tolerance of the square of a quaternion's length."""

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


class TransformBuffer:
    """Transforms by frame and time.

    Args:
        log: called with one line when the buffer is cleared.
        history: seconds for which moving transforms are kept.
    """

    def __init__(self, log: Callable[[str], None], history: float = HISTORY) -> None:
        self._log = log
        self._history = history
        self._links: dict[str, _Link] = {}
        self._parents: set[str] = set()
        self._old: dict[str, int] = {}

    @property
    def frames(self) -> list[str]:
        """Return all known frames, sorted."""
        return sorted(self._parents | set(self._links))

    def insert(self, parent: str, child: str, transform: Transform, static: bool = False) -> str | None:
        """Add the transform from *child* to *parent*.

        Args:
            parent, child: frames; a leading slash, as in ROS 1's tf, is dropped.
            transform: takes points of *child* to *parent*; its stamp is the time for which it holds.
            static: it always holds.

        Returns:
            Why it was refused, or None.
        """
        parent, child = parent.lstrip("/"), child.lstrip("/")
        fault = _fault(parent, child, transform)
        if fault is not None:
            return fault
        self._parents.add(parent)
        if static:
            self._links[child] = _Link(parent, Transform(transform.translation, transform.rotation), True)
            return None
        link = self._links.get(child)
        if link is None or link.static:
            self._links[child] = _Link(parent, transform, False)
        elif transform.stamp >= link.newest - self._history:
            self._old.pop(child, None)
            link.insert(parent, transform, self._history)
        else:
            self._outdated(parent, child, transform)
        return None

    def clear(self, why: str) -> None:
        """Forget all moving transforms and log it; static ones stay."""
        self._links = {child: link for child, link in self._links.items() if link.static}
        self._parents = {parent for link in self._links.values() for parent, _ in link.known}
        self._old.clear()
        self._log(f"{why}; the transforms known so far are forgotten")

    def lookup(self, target: str, source: str, stamp: float | None = None) -> Transform:
        """Return the transform from *source* to *target*; see `Backend.tf_lookup`."""
        target, source = target.lstrip("/"), source.lstrip("/")
        what = f"no transform from {source} to {target}"
        for frame in (target, source):
            if frame not in self._links and frame not in self._parents:
                raise TransformUnavailable(f"{what}: {self._unknown(frame)}", "unknown_frame")
        up, down = self._ways(what, target, source, stamp)
        moving = [link for link in up + down if not self._links[link].static]
        if stamp is None:
            stamp = min((self._links[child].newest for child in moving), default=0.0)
        for child in moving:
            self._links[child].require(what, child, stamp)
        result = self._along(up, stamp)
        if down:
            result = self._along(down, stamp).inverse().after(result)
        return Transform(result.translation, result.rotation, stamp if moving else 0.0)

    def _along(self, way: list[str], stamp: float) -> Transform:
        result = Transform()
        for child in way:
            result = self._links[child].at(stamp)[1].after(result)
        return result

    def _ways(self, what: str, target: str, source: str, stamp: float | None) -> tuple[list[str], list[str]]:
        """Return the frames from *source* up to the common ancestor, and those from *target* up to it."""
        from_source, from_target = self._ancestors(what, source, stamp), self._ancestors(what, target, stamp)
        shared = set(from_target)
        for steps, frame in enumerate(from_source):
            if frame in shared:
                return from_source[:steps], from_target[: from_target.index(frame)]
        raise TransformUnavailable(
            f"{what}: they are not connected; the root of {source} is {from_source[-1]}, "
            f"the root of {target} is {from_target[-1]}",
            "not_connected",
        )

    def _ancestors(self, what: str, frame: str, stamp: float | None) -> list[str]:
        found = [frame]
        while (link := self._links.get(frame)) is not None:
            frame = link.parent_near(stamp)
            if frame in found:
                raise TransformUnavailable(
                    f"{what}: the frames {', '.join(found)} form a cycle", "not_connected"
                )
            found.append(frame)
        return found

    def _unknown(self, frame: str) -> str:
        known = self.frames
        if not known:
            return "no transforms have arrived"
        return f"unknown frame {frame}{aside(frame, known) or '.'} Known: {', '.join(known)}"

    def _outdated(self, parent: str, child: str, transform: Transform) -> None:
        """Drop a transform older than all others; if only such ones arrive, begin again with them."""
        self._old[child] = self._old.get(child, 0) + 1
        if self._old[child] < OLD_IN_A_ROW:
            return
        back = self._links[child].newest - transform.stamp
        self.clear(f"the stamps of frame {child} went back by {back:.3g} s")
        self._parents.add(parent)
        self._links[child] = _Link(parent, transform, False)


class _Link:
    """The transforms of one frame to its parent, over time: sorted by their stamps, each with the parent."""

    def __init__(self, parent: str, transform: Transform, static: bool) -> None:
        self.static = static
        self.stamps = [transform.stamp]
        self.known = [(parent, transform)]

    @property
    def newest(self) -> float:
        return self.stamps[-1]

    def insert(self, parent: str, transform: Transform, history: float) -> None:
        stamps = self.stamps
        place = bisect_left(stamps, transform.stamp) if transform.stamp <= stamps[-1] else len(stamps)
        if place < len(stamps) and stamps[place] == transform.stamp:
            return  # a duplicate: the first one counts
        stamps.insert(place, transform.stamp)
        self.known.insert(place, (parent, transform))
        if stamps[0] < stamps[-1] - history:
            kept = bisect_left(stamps, stamps[-1] - history)
            del stamps[:kept], self.known[:kept]

    def parent_near(self, stamp: float | None) -> str:
        if self.static or stamp is None or stamp >= self.newest:
            return self.known[-1][0]
        return self.at(max(stamp, self.stamps[0]))[0]

    def require(self, what: str, child: str, stamp: float) -> None:
        """Refuse a time outside the known interval."""
        oldest, newest = self.stamps[0], self.newest
        if oldest <= stamp <= newest:
            return
        early = stamp < oldest
        raise TransformUnavailable(
            f"{what} at {stamp:.6f}: {child} is known from {oldest:.6f} to {newest:.6f} only, "
            f"{oldest - stamp if early else stamp - newest:.6f} s {'later' if early else 'earlier'}",
            "too_old" if early else "too_new",
        )

    def at(self, stamp: float) -> tuple[str, Transform]:
        """Return parent and transform at a known time."""
        place = 0 if self.static else bisect_left(self.stamps, stamp)
        if self.static or self.stamps[place] == stamp:
            return self.known[place]
        (old_parent, before), (parent, after) = self.known[place - 1 : place + 1]
        if old_parent != parent:
            return old_parent, before  # the parent changed meanwhile: the old one was valid
        return parent, interpolate(before, after, (stamp - before.stamp) / (after.stamp - before.stamp))


def _fault(parent: str, child: str, transform: Transform) -> str | None:
    if not child or not parent:
        return "a frame has an empty name"
    if child == parent:
        return f"frame {child} is its own parent"
    numbers = (*transform.translation, *transform.rotation, transform.stamp)
    if not all(map(math.isfinite, numbers)):
        return f"transform of frame {child} contains NaN or infinity"
    length = sum(part * part for part in transform.rotation)
    if abs(length - 1.0) > _UNIT:
        return f"rotation of frame {child} is not a unit quaternion: {transform.rotation}"
    return None
