"""Judge whether the driver patrolled and avoided the visitor, and the supervisor recharged in time and ended the shift.

Judged from the ground truth.  Only the driver knows the corners, and only the supervisor knows the dock: a robot that was
at both was driven by both.
"""

import sys
from bisect import bisect_right
from collections.abc import Sequence
from itertools import groupby, pairwise
from math import hypot, remainder, tau

from jacaros.robots.world import GroundTruth, PathSample
from jacaros.testing import Verdict, judge
from jacaros.testing.paths import distance, judge_recharging

CORNERS = ((2.0, 0.0), (2.0, 2.0), (0.0, 2.0), (0.0, 0.0))
"""Corners of the route, in metres; the robot starts and ends at the last one."""

REACHED = 0.05
"""Distance within which a corner counts as visited, in metres."""

APART = 0.4
"""Least distance between the centres of two robots, in metres: they do not touch, with a small margin."""


def check(truth: GroundTruth, rounds: int = 4, recharges: int = 2) -> Verdict:
    """Judge a run of *rounds* rounds with at least *recharges* recharges."""
    verdict = Verdict()
    path = [*truth.path("turtlebot"), truth.latest("turtlebot")]
    visits = corners_of(path)
    verdict.measure("corners", len(visits) - 1)
    route = [3, *(number % len(CORNERS) for number in range(rounds * len(CORNERS)))]
    verdict.expect(visits == route, f"the corners were visited in the order {visits}, not {route}")

    stays = judge_recharging(verdict, truth)
    verdict.expect(len(stays) >= recharges, f"{len(stays)} recharges, not {recharges}")

    nearest, waited = beside_the_visitor(path, truth.path("visitor"))
    verdict.measure("metres from the visitor", nearest)
    verdict.expect(nearest >= APART, f"the robot came within {nearest:.2f} m of the visitor")
    verdict.measure("seconds it waited for the visitor", waited)
    verdict.expect(waited >= 2.0, "the robot did not wait for the visitor")
    verdict.expect(not truth.events_of("bump", "collision"), "the robot bumped into something")

    speed, turning = speed_at_end(path)
    verdict.at_most("metres a second at the end", speed, 0.01)
    verdict.at_most("radians a second at the end", turning, 0.02)
    return verdict


def corners_of(path: Sequence[PathSample]) -> list[int]:
    """Return the corners in the order of their visits; consecutive visits to one corner count once."""
    near = (
        next((n for n, (x, y) in enumerate(CORNERS) if distance(sample, x, y) <= REACHED), None)
        for sample in path
    )
    return [corner for corner, _ in groupby(each for each in near if each is not None)]


def beside_the_visitor(path: Sequence[PathSample], visitor: Sequence[PathSample]) -> tuple[float, float]:
    """Return the least distance to the visitor (m), and how long the robot stood within a metre of it (s)."""
    times = [sample.time for sample in visitor]
    nearest, waited = float("inf"), 0.0
    for before, sample in pairwise(path):
        other = visitor[max(0, bisect_right(times, sample.time) - 1)]
        apart = hypot(sample.x - other.x, sample.y - other.y)
        nearest = min(nearest, apart)
        if apart <= 1.0 and sample.odometer - before.odometer < 0.001:
            waited += sample.time - before.time
    return nearest, waited


def speed_at_end(path: Sequence[PathSample]) -> tuple[float, float]:
    """Return the speed (m/s) and the turning rate (rad/s) at the end of the path."""
    last = path[-1]
    before = next(sample for sample in reversed(path) if sample.time < last.time)
    seconds = last.time - before.time
    turned = remainder(last.yaw - before.yaw, tau)
    return (last.odometer - before.odometer) / seconds, abs(turned) / seconds


if __name__ == "__main__":
    sys.exit(judge(check, sys.argv[1:]))
