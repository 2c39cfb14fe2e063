"""Judge whether the robot patrolled the corners in order, recharged in time, and continued where it left off.

Judged from the ground truth.
"""

import sys
from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

from jacaros.robots.world import GroundTruth, PathSample
from jacaros.testing import Verdict, judge
from jacaros.testing.paths import Stay, distance, judge_recharging, to_segment

CORNERS = ((0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0))
"""Corners of the route, in metres; the robot starts at the first one."""

REACHED = 0.05
"""Distance within which a corner counts as visited, in metres."""

LEFT = 0.5
"""Distance from a corner at which a visit has ended."""


class Visit(NamedTuple):
    """A visit to a corner, from ``begin`` to ``end`` (s)."""

    corner: int
    begin: float
    end: float


def check(truth: GroundTruth, cycles: int = 10, near: float = REACHED) -> Verdict:
    """Judge a run with at least *cycles* recharges; a corner is visited within *near* metres."""
    verdict = Verdict()
    path = [*truth.path(), truth.latest()]
    found = visits(path, near)
    verdict.measure("corners", sum(before.corner != after.corner for before, after in pairwise(found)))

    stays = judge_recharging(verdict, truth)
    verdict.expect(len(stays) >= cycles, f"{len(stays)} recharges, not {cycles}")
    verdict.expect(
        bool(stays) and found[-1].begin > stays[-1].begin, "no corner was visited after the last recharge"
    )
    verdict.expect(found[0].corner == 0, "the robot did not begin at the first corner")
    for before, after in pairwise(found):
        judge_next(
            verdict, before, after, [stay for stay in stays if before.end < stay.begin < after.begin], path
        )
    verdict.expect(not truth.events_of("bump", "collision"), "the robot bumped into something")
    return verdict


def visits(path: Sequence[PathSample], near: float = REACHED) -> list[Visit]:
    """Return all visits to corners, oldest first.

    A robot that brakes late and returns has not left the corner.
    """
    found: list[Visit] = []
    at = None
    for sample in path:
        if at is not None and distance(sample, *CORNERS[at]) > LEFT:
            at = None
        corner = next((n for n, (x, y) in enumerate(CORNERS) if distance(sample, x, y) <= near), None)
        if corner is not None and corner != at:
            at = corner
            found.append(Visit(corner, sample.time, sample.time))
        elif corner is not None:
            found[-1] = found[-1]._replace(end=sample.time)
    return found


def judge_next(
    verdict: Verdict, before: Visit, after: Visit, between: Sequence[Stay], path: Sequence[PathSample]
) -> None:
    """Expect the visit *after* at the corner that the robot was heading for when it left *before*."""
    heading_for = [(before.corner + 1) % len(CORNERS)]
    if between and straight_to_dock(before, between[0], path):
        # It left from the corner itself, perhaps before driveTo noticed its arrival.
        heading_for.append(before.corner)
    verdict.expect(
        after.corner in heading_for,
        f"after corner {before.corner} came corner {after.corner} at {after.begin:.1f} s",
    )


def straight_to_dock(before: Visit, stay: Stay, path: Sequence[PathSample]) -> bool:
    """Return whether the robot drove straight from the corner to the dock."""
    way = [sample for sample in path if before.end <= sample.time <= stay.begin]
    dock = way[-1].x, way[-1].y
    return all(to_segment(sample, CORNERS[before.corner], dock) <= 2 * REACHED for sample in way)


if __name__ == "__main__":
    sys.exit(judge(check, sys.argv[1:]))
