"""Is the study cleaned in every round, after the bathroom? Judged from the ground truth by the checker of the example."""

import runpy
import sys
from pathlib import Path

from jacaros.robots.world import GroundTruth
from jacaros.testing import Verdict, judge

house = runpy.run_path(str(Path(__file__).parents[3] / "examples" / "05_house_cleaning" / "check.py"))

ROUND = (*house["ROUND"], ("study", "vacuum carpet"))
PLACES = {**house["PLACES"], "study": (3.8, 0.0)}


def check(truth: GroundTruth) -> Verdict:
    """Judge a run of four rounds."""
    verdict: Verdict = house["check"](truth, tasks_of_round=ROUND, places=PLACES)
    return verdict


if __name__ == "__main__":
    sys.exit(judge(check, sys.argv[1:]))
