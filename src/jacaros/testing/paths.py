"""Geometry of true paths, for checkers: metres and radians."""

import itertools
import math
from collections.abc import Iterable, Sequence
from typing import NamedTuple, Protocol

from jacaros.sim.ground_truth import Sample


class Placed(Protocol):
    """Anything with a pose: a sample, an event, a pose."""

    @property
    def x(self) -> float:
        """Metres."""

    @property
    def y(self) -> float:
        """Metres."""

    @property
    def yaw(self) -> float:
        """Radians."""


class Turn(NamedTuple):
    """The robot turned on the spot: where (the mean), by how much (signed), and when it began and ended."""

    x: float
    y: float
    angle: float
    begin: float
    end: float


def distance(one: Placed, x: float, y: float) -> float:
    """From a pose to a point."""
    return math.hypot(one.x - x, one.y - y)


def angle_between(one: float, other: float) -> float:
    """The smaller angle between two headings, not negative."""
    return abs(math.remainder(one - other, math.tau))


def seen_from(origin: Placed, point: Placed) -> tuple[float, float]:
    """How far ahead of a pose, and how far to its left, another one lies."""
    dx, dy = point.x - origin.x, point.y - origin.y
    cosine, sine = math.cos(origin.yaw), math.sin(origin.yaw)
    return dx * cosine + dy * sine, dy * cosine - dx * sine


def to_segment(one: Placed, a: tuple[float, float], b: tuple[float, float]) -> float:
    """From a pose to the nearest point between *a* and *b*."""
    dx, dy = b[0] - a[0], b[1] - a[1]
    share = ((one.x - a[0]) * dx + (one.y - a[1]) * dy) / (dx * dx + dy * dy)
    share = min(1.0, max(0.0, share))
    return distance(one, a[0] + share * dx, a[1] + share * dy)


def turns(path: Sequence[Sample], least: float = math.radians(20.0)) -> list[Turn]:
    """Where the robot turned on the spot by *least* or more; wobbling on the way is no turn."""
    found = [_turn(stretch) for stretch in _turning_stretches(path)]
    return [turn for turn in found if abs(turn.angle) >= least]


def _turning_stretches(path: Sequence[Sample]) -> Iterable[list[Sample]]:
    """Runs of samples between which the robot turned and hardly moved."""
    stretch: list[Sample] = []
    for before, after in itertools.pairwise(path):
        turned = angle_between(after.yaw, before.yaw)
        moved = after.odometer - before.odometer
        if turned > math.radians(0.2) and moved < 0.02:
            stretch = stretch or [before]
            stretch.append(after)
        elif stretch:
            yield stretch
            stretch = []
    if stretch:
        yield stretch


def _turn(stretch: Sequence[Sample]) -> Turn:
    angle = math.fsum(math.remainder(b.yaw - a.yaw, math.tau) for a, b in itertools.pairwise(stretch))
    count = len(stretch)
    return Turn(
        math.fsum(sample.x for sample in stretch) / count,
        math.fsum(sample.y for sample in stretch) / count,
        angle,
        stretch[0].time,
        stretch[-1].time,
    )
