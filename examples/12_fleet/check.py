"""Judge whether the robots cleaned the whole building together, and never bumped.

Judged from the ground truth of the worlds of all robots that ended by themselves.
"""

import sys
from collections.abc import Sequence

from jacaros.robots.world import GroundTruth
from jacaros.testing import Verdict

ROOMS = ("library", "office", "studio", "gallery", "kitchen", "pantry", "archive", "workshop")


def check(truths: Sequence[GroundTruth]) -> Verdict:
    """Judge a run by the ground truth of each robot's world."""
    verdict = Verdict()
    cleaned = [{room for (room, _), grams in truth.dirt.items() if grams == 0} for truth in truths]
    for room in ROOMS:
        verdict.expect(any(room in rooms for rooms in cleaned), f"no robot cleaned the {room}")
    verdict.measure("rooms cleaned again", sum(map(len, cleaned)) - len(set().union(*cleaned)))
    bumps = sum(len(truth.events_of("bump", "collision")) for truth in truths)
    verdict.expect(bumps == 0, f"a robot bumped into something ({bumps} times)")
    return verdict


if __name__ == "__main__":
    result = check([GroundTruth.read(each) for each in sys.argv[1:]])
    print(*result.lines(), sep="\n")
    sys.exit(not result.passed)
