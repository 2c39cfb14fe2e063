"""Is the kitchen cleaned first in every round? Judged from the ground truth by the checker of the example."""

import runpy
import sys
from pathlib import Path

from jacaros.robots.world import GroundTruth
from jacaros.testing import Verdict, judge

house = runpy.run_path(str(Path(__file__).parents[4] / "examples" / "05_house_cleaning" / "check.py"))

LIVING_ROOM, KITCHEN, *BATHROOM = house["ROUND"]


def check(truth: GroundTruth) -> Verdict:
    """Judge a run of four rounds."""
    verdict: Verdict = house["check"](truth, tasks_of_round=(KITCHEN, LIVING_ROOM, *BATHROOM))
    return verdict


if __name__ == "__main__":
    sys.exit(judge(check, sys.argv[1:]))
