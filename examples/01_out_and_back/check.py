"""Judge from the ground truth whether the robot drove out, turned around, came back and turned around again."""

import math
import sys

from jacaros.robots.world import GroundTruth
from jacaros.testing import Verdict, judge
from jacaros.testing.paths import angle_between, distance, seen_from, turns


def check(truth: GroundTruth, near: float = 0.05) -> Verdict:
    """Judge a run that starts with the robot at rest and must end at most *near* metres from the start."""
    verdict = Verdict()
    path = [*truth.path(), truth.latest()]
    start, end = path[0], path[-1]
    places = [seen_from(start, sample) for sample in path]

    out = verdict.measure("metres out", max(ahead for ahead, _ in places))
    verdict.expect(out >= 1.0, "the robot was never a metre out")
    verdict.at_most("metres beside the way", max(abs(left) for _, left in places), 0.05)
    verdict.at_most("metres from the start at the end", distance(end, start.x, start.y), near)
    verdict.at_most("degrees off at the end", math.degrees(angle_between(end.yaw, start.yaw)), 3.0)

    halves = [turn for turn in turns(path) if abs(abs(turn.angle) - math.pi) <= math.radians(10.0)]
    verdict.expect(len(halves) == 2, f"the robot turned around {len(halves)} times, not twice")
    verdict.expect(not truth.events_of("bump", "collision"), "the robot bumped into something")
    return verdict


if __name__ == "__main__":
    sys.exit(judge(check, sys.argv[1:]))
