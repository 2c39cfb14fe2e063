"""Does the robot stand, its tool off, as long as a person presses its bumper, and is all else as without people?

Judged from the ground truth, and the rest by the checker of the example.
"""

import runpy
import sys
from pathlib import Path

from jacaros.robots.world import GroundTruth, RobotEvent
from jacaros.testing import Verdict, judge
from jacaros.testing.paths import angle_between, distance

house = runpy.run_path(str(Path(__file__).parents[3] / "examples" / "05_house_cleaning" / "check.py"))

REACTION = 0.6
"""Seconds in which the robot must stand and its tool be off."""

PATIENCE = 5.0
"""Seconds after the release in which it must continue."""

PEOPLE = 4
MILLIMETRE = 0.001
MILLIRADIAN = 0.001
BUMPED = "the robot bumped into something"
"""The example's complaint about the bumps that this run is about."""


def check(truth: GroundTruth) -> Verdict:
    """Judge a run in which people walk into the robot."""
    verdict: Verdict = house["check"](truth)
    verdict.complaints = [complaint for complaint in verdict.complaints if complaint != BUMPED]
    bumps = truth.events_of("bump", "collision")
    verdict.expect(len(bumps) == PEOPLE, f"{len(bumps)} bumps, not {PEOPLE}")
    for bump in bumps:
        verdict.expect(bump.data["side"] != "back", f"no bumper was pressed at {bump.time:.1f} s")
        gone = (event.time for event in truth.events_of("person_goes") if event.time > bump.time)
        judge_stop(verdict, truth, bump, next(gone, bump.time))
    return verdict


def judge_stop(verdict: Verdict, truth: GroundTruth, bump: RobotEvent, released: float) -> None:
    """Expect that the robot stands until it is released, and then continues."""
    at = f"after the bump at {bump.time:.1f} s"
    stopped = bump.time + REACTION
    verdict.expect(released > stopped + 1.0, f"it was released too early to judge {at}")
    # At rest there is one sample a second: the last one before the stop tells where it stands unless one follows.
    path = truth.path()
    first = next(sample for sample in path if sample.time >= stopped)
    held = [sample for sample in path if stopped <= sample.time <= released]
    moved = any(
        distance(sample, first.x, first.y) > MILLIMETRE or angle_between(sample.yaw, first.yaw) > MILLIRADIAN
        for sample in held
    )
    verdict.expect(not moved, f"the robot moved {at}")
    for event in truth.events_of("cleaned", "tool_started", "task"):
        verdict.expect(not stopped < event.time < released, f"{event.kind} at {event.time:.1f} s, {at}")
    used = [event for event in truth.events_of("tool_started", "tool_stopped") if event.time <= stopped]
    verdict.expect(not used or used[-1].kind == "tool_stopped", f"the tool was not switched off {at}")
    verdict.expect(continues(truth, released), f"it did not continue {at}")


def continues(truth: GroundTruth, released: float) -> bool:
    """Whether the robot drives, turns, uses a tool or charges soon after its release."""
    soon = [sample for sample in truth.path() if released <= sample.time <= released + PATIENCE]
    tools = [
        event for event in truth.events_of("tool_started") if released <= event.time <= released + PATIENCE
    ]
    turned = angle_between(soon[0].yaw, soon[-1].yaw) > MILLIRADIAN
    return bool(tools) or turned or soon[-1].odometer > soon[0].odometer or soon[-1].charging


if __name__ == "__main__":
    sys.exit(judge(check, sys.argv[1:]))
