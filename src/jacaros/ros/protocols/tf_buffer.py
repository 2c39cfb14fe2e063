"""What is known of the frames' positions: ten seconds of each, and what follows from them for other pairs of frames.

The rules are tf2's: every frame hangs on one parent, a look-up goes up from both frames to where the ways meet, times
between two known ones are interpolated, times outside of what is known are refused.
"""

import difflib
import math
from bisect import bisect_left
from collections.abc import Callable

from jacaros.ros.errors import TransformUnavailable
from jacaros.ros.protocols.transform import Transform, interpolate

HISTORY = 10.0
"""Seconds for which moving transforms are kept, as in tf2."""
OLD_IN_A_ROW = 3
"""So many outdated transforms of a frame, one after the other, mean that time has begun again."""
_UNIT = 0.01
"""How far the square of a quaternion's length may be from 1."""


class TransformBuffer:
    """Transforms by frame and time.

    Args:
        log: takes one line when the buffer is emptied.
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
        """All frames that are known, sorted."""
        return sorted(self._parents | set(self._links))

    def insert(self, parent: str, child: str, transform: Transform, static: bool = False) -> str | None:
        """Note where *child* is in *parent*.

        Args:
            parent, child: frames; a slash in front, as ROS 1's tf wrote, is dropped.
            transform: takes points of *child* to *parent*; its stamp is the time for which it holds.
            static: it holds always.

        Returns:
            why it was not taken, or None.
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
        """Forget all that moves and say so; what is static stays."""
        self._links = {child: link for child, link in self._links.items() if link.static}
        self._parents = {parent for link in self._links.values() for parent in link.parents}
        self._old.clear()
        self._log(f"{why}: the transforms known so far are forgotten")

    def lookup(self, target: str, source: str, stamp: float | None = None) -> Transform:
        """Give the transform that takes points in *source* to *target*; see `Backend.tf_lookup`."""
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
        """The frames from *source* up to where both ways meet, and those from *target* up to there."""
        from_source, from_target = self._ancestors(what, source, stamp), self._ancestors(what, target, stamp)
        shared = set(from_target)
        for steps, frame in enumerate(from_source):
            if frame in shared:
                return from_source[:steps], from_target[: from_target.index(frame)]
        raise TransformUnavailable(
            f"{what}: they are not connected; {source} hangs below {from_source[-1]}, "
            f"{target} below {from_target[-1]}",
            "not_connected",
        )

    def _ancestors(self, what: str, frame: str, stamp: float | None) -> list[str]:
        found = [frame]
        while (link := self._links.get(frame)) is not None:
            frame = link.parent_near(stamp)
            if frame in found:
                raise TransformUnavailable(
                    f"{what}: the frames {', '.join(found)} hang on each other in a circle", "not_connected"
                )
            found.append(frame)
        return found

    def _unknown(self, frame: str) -> str:
        known = self.frames
        if not known:
            return "no transforms have come so far"
        close = difflib.get_close_matches(frame, known, 1)
        help = f"; did you mean {close[0]}?" if close else ""
        return f"no frame {frame} is known{help or '.'} Known: {', '.join(known)}"

    def _outdated(self, parent: str, child: str, transform: Transform) -> None:
        """Leave out what is older than anything kept; when nothing else comes any more, begin again with it."""
        self._old[child] = self._old.get(child, 0) + 1
        if self._old[child] < OLD_IN_A_ROW:
            return
        back = self._links[child].newest - transform.stamp
        self.clear(f"the stamps of frame {child} went back by {back:.3g} s")
        self._parents.add(parent)
        self._links[child] = _Link(parent, transform, False)


class _Link:
    """How one frame hangs on its parent, over time."""

    __slots__ = ("parents", "stamps", "static", "transforms")

    def __init__(self, parent: str, transform: Transform, static: bool) -> None:
        self.static = static
        self.stamps = [transform.stamp]
        self.parents = [parent]
        self.transforms = [transform]

    @property
    def newest(self) -> float:
        return self.stamps[-1]

    def insert(self, parent: str, transform: Transform, history: float) -> None:
        stamps = self.stamps
        place = bisect_left(stamps, transform.stamp) if transform.stamp <= stamps[-1] else len(stamps)
        if place < len(stamps) and stamps[place] == transform.stamp:
            return  # said twice: the first word counts
        stamps.insert(place, transform.stamp)
        self.parents.insert(place, parent)
        self.transforms.insert(place, transform)
        if stamps[0] < stamps[-1] - history:
            kept = bisect_left(stamps, stamps[-1] - history)
            del stamps[:kept], self.parents[:kept], self.transforms[:kept]

    def parent_near(self, stamp: float | None) -> str:
        if self.static or stamp is None or stamp >= self.newest:
            return self.parents[-1]
        return self.at(max(stamp, self.stamps[0]))[0]

    def require(self, what: str, child: str, stamp: float) -> None:
        """Refuse a time outside of what is known."""
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
        """Parent and transform at a time that is known."""
        if self.static:
            return self.parents[0], self.transforms[0]
        place = bisect_left(self.stamps, stamp)
        if self.stamps[place] == stamp:
            return self.parents[place], self.transforms[place]
        before, after = self.transforms[place - 1], self.transforms[place]
        if self.parents[place - 1] != self.parents[place]:
            return self.parents[place - 1], before  # it changed hands meanwhile: the old hands held it
        ratio = (stamp - before.stamp) / (after.stamp - before.stamp)
        return self.parents[place], interpolate(before, after, ratio)


def _fault(parent: str, child: str, transform: Transform) -> str | None:
    if not child or not parent:
        return "a frame has no name"
    if child == parent:
        return f"frame {child} hangs on itself"
    numbers = (*transform.translation, *transform.rotation, transform.stamp)
    if not all(map(math.isfinite, numbers)):
        return f"the transform of frame {child} has a number that is none (NaN or infinite)"
    length = sum(part * part for part in transform.rotation)
    if abs(length - 1.0) > _UNIT:
        return f"the rotation of frame {child} is no unit quaternion: {transform.rotation}"
    return None
