"""Judge from the ground truth whether the robot drove a square of one metre, corner by corner."""

import math
import sys
from itertools import pairwise

from jacaros.robots.world import GroundTruth
from jacaros.testing import Verdict, judge
from jacaros.testing.paths import angle_between, distance, seen_from, to_segment, turns

CORNERS = ((1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.0, 0.0))
"""Corners where the robot turns: metres ahead and to the left of its start."""


def check(truth: GroundTruth) -> Verdict:
    """Judge a run that starts with the robot at rest."""
    verdict = Verdict()
    path = [*truth.path(), truth.latest()]
    start, end = path[0], path[-1]

    corners = turns(path)
    verdict.expect(len(corners) == 4, f"the robot turned {len(corners)} times, not 4 times")
    for number, (turn, corner) in enumerate(zip(corners, CORNERS, strict=False), 1):
        place = seen_from(start, start._replace(x=turn.x, y=turn.y))
        verdict.at_most(f"metres from corner {number}", math.dist(place, corner), 0.05)
        off = abs(math.degrees(turn.angle) - 90.0)
        verdict.expect(off <= 5.0, f"at corner {number} it turned {math.degrees(turn.angle):.0f} degrees")

    sides = list(pairwise((CORNERS[-1], *CORNERS)))
    places = [start._replace(x=x, y=y) for x, y in (seen_from(start, sample) for sample in path)]
    aside = max(min(to_segment(place, *side) for side in sides) for place in places)
    verdict.at_most("metres beside the sides", aside, 0.05)
    verdict.at_most("metres from the start at the end", distance(end, start.x, start.y), 0.05)
    verdict.at_most("degrees off at the end", math.degrees(angle_between(end.yaw, start.yaw)), 3.0)
    verdict.expect(not truth.events_of("bump", "collision"), "the robot bumped into something")
    return verdict


if __name__ == "__main__":
    sys.exit(judge(check, sys.argv[1:]))
