"""Does the robot charge fully between the third and the fourth round? Judged from the ground truth."""

import runpy
import sys
from pathlib import Path

from jacaros.robots.world import GroundTruth
from jacaros.testing import Verdict, judge

house = runpy.run_path(str(Path(__file__).parents[4] / "examples" / "05_house_cleaning" / "check.py"))

TASKS_BEFORE = 3 * len(house["ROUND"])
FULL = 99.0
"""Percent that count as full."""


def check(truth: GroundTruth) -> Verdict:
    """Judge a run of four rounds."""
    verdict: Verdict = house["check"](truth)
    # The example's checker wants the robot to dock when its battery is low; here it docks once before that.
    verdict.complaints = [each for each in verdict.complaints if not each.startswith("it docked at")]
    times = [event.time for event in truth.events_of("task")]
    if len(times) > TASKS_BEFORE:
        begin, end = times[TASKS_BEFORE - 1], times[TASKS_BEFORE]
        levels = [each.battery for each in truth.path() if begin < each.time < end]
        verdict.expect(max(levels, default=0.0) >= FULL, "it did not charge until full before the last round")
    return verdict


if __name__ == "__main__":
    sys.exit(judge(check, sys.argv[1:]))
