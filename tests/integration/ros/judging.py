"""Judgements about paths, from the ground truth alone."""

import math
from collections.abc import Mapping, Sequence

from jacaros.robots.world.data.ground_truth import GroundTruth, PathSample

Point = tuple[float, float]

NEAR = 0.05
"""Metres within which a robot is at a place."""


def distance(sample: PathSample, place: Point) -> float:
    """Metres between a robot and a place."""
    return math.hypot(sample.x - place[0], sample.y - place[1])


def visits(truth: GroundTruth, places: Mapping[str, Point]) -> list[str]:
    """The places that the robot came to, in order; staying at one, or coming back to it, counts once."""
    order: list[str] = []
    for sample in truth.path():
        for name, place in places.items():
            if distance(sample, place) <= NEAR and order[-1:] != [name]:
                order.append(name)
    return order


def nearest_pass(truth: GroundTruth, place: Point) -> float:
    """How near the robot came to a place, in metres."""
    return min(distance(sample, place) for sample in truth.path())


def heading_error(sample: PathSample, degrees: float) -> float:
    """Degrees between a robot's heading and the wanted one."""
    return abs((math.degrees(sample.yaw) - degrees + 180.0) % 360.0 - 180.0)


def stands(truth: GroundTruth, since: float) -> bool:
    """Whether the robot has rested from some moment after *since* (the world's time) to now."""
    path = truth.path()
    return len(path) >= 2 and path[-2].time > since and path[-2][1:4] == path[-1][1:4]


def standstill(truth: GroundTruth, braking: float) -> float:
    """When the robot came to its present rest at the latest, in the world's time.

    The path has ten samples a second; after the last one in motion the robot braked by *braking* metres per
    second squared, or harder.
    """
    last = truth.latest()
    moving: Sequence[PathSample] = [sample for sample in truth.path() if sample.odometer < last.odometer]
    rest = last.odometer - moving[-1].odometer
    return moving[-1].time + math.sqrt(2.0 * rest / braking)
