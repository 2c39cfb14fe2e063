"""Judge whether the robot explored and mapped the flat, and drove to its goal and back home.

Judged from the ground truth: the saved map is compared with the world, and the places with the robot's true path.
"""

import math
import sys
from functools import partial
from pathlib import Path

from jacaros.robots.map.cells import OBSTACLE, Cell
from jacaros.robots.map.map_files import load
from jacaros.robots.world import GroundTruth, PathSample
from jacaros.testing import Verdict, judge
from jacaros.testing.paths import distance

SAVED = Path("runs/flat.yaml")
"""The map that the agent saved."""

SIZE = 0.1
"""Side length of a cell, in metres."""

REACHED = 0.15
"""Distance within which a place counts as reached, in metres."""

GOAL = (5.6, 4.1)
"""Position of the goal, in metres from the start of the robot."""

AGREEMENT = 0.95
"""Least share of the seen cells that must agree with the world."""


def check(truth: GroundTruth, saved: Path = SAVED) -> Verdict:
    """Judge a run and the map saved in it."""
    verdict = Verdict()
    path = [*truth.path(), truth.latest()]
    start = path[0]
    judge_map(verdict, truth, start, saved)
    goal_x, goal_y = in_world(start, *GOAL)
    at_goal = [sample.time for sample in path if distance(sample, goal_x, goal_y) <= REACHED]
    verdict.expect(bool(at_goal), "the robot was never at the goal")
    verdict.at_most("metres from home at the end", distance(path[-1], start.x, start.y), REACHED)
    verdict.expect(not truth.events_of("bump", "collision"), "the robot bumped into something")
    verdict.measure("metres driven", truth.odometer())
    return verdict


def judge_map(verdict: Verdict, truth: GroundTruth, start: PathSample, saved: Path) -> None:
    """Expect the seen cells to agree with the world, and most of the floor to be seen."""
    seen = load(saved).grid.labels(SIZE)
    wrong = sum(is_obstacle(truth, start, cell) != (label == OBSTACLE) for cell, label in seen.items())
    agreement = verdict.measure("share of cells that agree", 1.0 - wrong / max(1, len(seen)))
    verdict.expect(agreement >= AGREEMENT, f"only {agreement:.1%} of the cells agree with the world")
    floor = sum(label != OBSTACLE for label in seen.values()) * SIZE * SIZE
    share = verdict.measure("share of the floor that was seen", floor / open_floor(truth))
    verdict.expect(share >= 0.9, f"only {share:.0%} of the floor was seen")


def is_obstacle(truth: GroundTruth, start: PathSample, cell: Cell) -> bool:
    """Return whether a map cell has a wall or furniture in it; the origin of the map is the robot's start."""
    x, y = in_world(start, cell[0] * SIZE, cell[1] * SIZE)
    if any(left <= x <= right and low <= y <= high for left, low, right, high in truth.world["boxes"]):
        return True
    return any(is_in_square(start, x, y, *wall) for wall in truth.world["walls"])


def is_in_square(start: PathSample, x: float, y: float, ax: float, ay: float, bx: float, by: float) -> bool:
    """Return whether a wall segment crosses the cell around x, y (Liang-Barsky clipping)."""
    sine, cosine = math.sin(start.yaw), math.cos(start.yaw)
    ax, ay = cosine * (ax - x) + sine * (ay - y), cosine * (ay - y) - sine * (ax - x)
    bx, by = cosine * (bx - x) + sine * (by - y), cosine * (by - y) - sine * (bx - x)
    first, last = 0.0, 1.0
    for a, b in ((ax, bx), (ay, by)):
        if abs(b - a) < 1e-12:
            if abs(a) > 0.5 * SIZE:
                return False
            continue
        one, other = sorted(((-0.5 * SIZE - a) / (b - a), (0.5 * SIZE - a) / (b - a)))
        first, last = max(first, one), min(last, other)
    return first <= last


def in_world(start: PathSample, x: float, y: float) -> tuple[float, float]:
    """Convert a point of the map, whose origin is the robot's start, to world coordinates."""
    sine, cosine = math.sin(start.yaw), math.cos(start.yaw)
    return start.x + cosine * x - sine * y, start.y + sine * x + cosine * y


def open_floor(truth: GroundTruth) -> float:
    """Return the floor area without furniture, in square metres."""
    left, low, right, high = truth.world["bounds"]
    boxes = sum((c - a) * (d - b) for a, b, c, d in truth.world["boxes"])
    return float((right - left) * (high - low) - boxes)


if __name__ == "__main__":
    sys.exit(judge(partial(check, saved=Path(sys.argv[2]) if len(sys.argv) > 2 else SAVED), sys.argv[1:2]))
