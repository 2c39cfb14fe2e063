"""Straight legs of a route, for a robot that turns on the spot and drives straight ahead."""

import math
from collections.abc import Collection, Sequence
from typing import NamedTuple

from jacaros.artifacts.map.cells import Cell
from jacaros.plane.pose import Pose, normalised


class Leg(NamedTuple):
    """Limits of legs.

    Attributes:
        size: side of a cell, in metres.
        longest: maximum length, in metres.
    """

    size: float
    longest: float


def next_leg(way: Sequence[Cell], free: Collection[Cell], pose: Pose, leg: Leg) -> tuple[float, float]:
    """Return the turn (radians, positive to the left) and the distance (metres) to the farthest cell in a straight
    line.

    Args:
        way: cells from start to goal.
        free: cells that may be entered.
        pose: pose of the robot, in metres; it may be slightly off the route.
        leg: size of cells, and maximum length.
    """
    size = leg.size
    at = min(range(len(way)), key=lambda i: (math.dist(pose[:2], (way[i][0] * size, way[i][1] * size)), i))
    target = min(at + 1, len(way) - 1)
    for i in range(target + 1, len(way)):
        x, y = way[i][0] * size, way[i][1] * size
        if math.dist(pose[:2], (x, y)) > leg.longest or not _clear(pose, x, y, free, size):
            break
        target = i
    x, y = way[target][0] * size, way[target][1] * size
    metres = math.dist(pose[:2], (x, y))
    if metres < 0.5 * size:
        return 0.0, 0.0
    turn = normalised(math.atan2(y - pose.y, x - pose.x) - pose.yaw)
    return turn, metres


def _clear(pose: Pose, x: float, y: float, free: Collection[Cell], size: float) -> bool:
    """Return whether the straight line to a point crosses only free cells; the robot's own cell is not checked."""
    steps = max(1, math.ceil(math.dist(pose[:2], (x, y)) / (0.5 * size)))
    here = (math.floor(pose.x / size + 0.5), math.floor(pose.y / size + 0.5))
    for step in range(1, steps + 1):
        share = step / steps
        px, py = pose.x + share * (x - pose.x), pose.y + share * (y - pose.y)
        cell = (math.floor(px / size + 0.5), math.floor(py / size + 0.5))
        if cell != here and cell not in free:
            return False
    return True
