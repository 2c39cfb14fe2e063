"""Judge whether the robots watched all places, also while one charged in its own dock, and never bumped.

Judged from the ground truth.
"""

import sys
from itertools import pairwise

from jacaros.robots.world import GroundTruth
from jacaros.testing import Verdict, judge
from jacaros.testing.paths import Stay, distance, stays

PLACES = {
    "robot_1": ((-1.5, 2.2), (3.2, 0.0)),
    "robot_2": ((-1.5, 0.0), (3.2, -2.2)),
    "robot_3": ((-1.5, -2.2), (3.2, 2.2)),
}
"""Places that each robot watches, in metres."""

DOCKS = {"robot_1": "dock_1", "robot_2": "dock_2", "robot_3": "dock_3"}

SEEN = 0.1
"""Distance within which a robot watches a place, in metres."""

UNSEEN = 180.0
"""Longest time without a robot at a place while all are on duty, in seconds."""


def check(truth: GroundTruth, recharges: int = 2) -> Verdict:
    """Judge a run in which each robot recharges at least *recharges* times."""
    verdict = Verdict()
    bumps = truth.events_of("bump", "collision")
    verdict.expect(not bumps, f"a robot bumped into something ({len(bumps)} times)")
    verdict.expect(not truth.events_of("battery_empty"), "a battery was empty")
    found = {robot: stays(truth, robot) for robot in PLACES}
    for robot, places in PLACES.items():
        judge_charging(verdict, truth, robot, found[robot], recharges)
        for place in places:
            verdict.expect(len(looks(truth, robot, place)) >= 2, f"{robot} was at {place} less than twice")
    on_duty = min(each[-1].begin for each in found.values() if each) if any(found.values()) else 0.0
    longest = max(unseen(truth, place, on_duty) for places in PLACES.values() for place in places)
    verdict.at_most("seconds without a look at a place", longest, UNSEEN)
    helped = sum(is_helped(truth, robot, stay) for robot in PLACES for stay in found[robot])
    verdict.measure("recharges with a helper", helped)
    verdict.expect(helped >= 2, f"other robots helped in only {helped} recharges")
    verdict.measure("metres between the closest two robots", nearest(truth))
    return verdict


def judge_charging(
    verdict: Verdict, truth: GroundTruth, robot: str, found: list[Stay], recharges: int
) -> None:
    """Expect at least *recharges* recharges, each from a low battery to a full one, in the robot's own dock."""
    verdict.expect(len(found) >= recharges, f"{robot}: {len(found)} recharges, not {recharges}")
    verdict.expect(
        all(stay.charged or stay.level < 20.5 for stay in found), f"{robot} left its dock too early"
    )
    for event in truth.events_of("docked", robot=robot):
        dock = event.data["dock"]
        verdict.expect(dock == DOCKS[robot], f"{robot} was in {dock}")
    for event in truth.events_of("charging", robot=robot):
        level = event.data["level"]
        verdict.expect(5 < level <= 20 or level > 90, f"{robot} charged at {level:.0f} %")


def looks(truth: GroundTruth, robot: str, place: tuple[float, float]) -> list[float]:
    """Return the times at which a robot came to a place and stopped or turned there; driving past does not count."""
    found: list[float] = []
    looked = False
    for before, sample in pairwise(truth.path(robot)):
        if distance(sample, *place) > SEEN:
            looked = False
        elif not looked and sample.time > before.time and sample.odometer - before.odometer < 1e-4:
            looked = True
            found.append(sample.time)
    return found


def unseen(truth: GroundTruth, place: tuple[float, float], end: float) -> float:
    """Return the longest time without a robot at a place, until *end* (s)."""
    times = sorted(time for robot in PLACES for time in looks(truth, robot, place) if time < end)
    gaps = zip([0.0, *times], [*times, end], strict=True)
    return max(later - sooner for sooner, later in gaps)


def is_helped(truth: GroundTruth, robot: str, stay: Stay) -> bool:
    """Return whether another robot was at a place of *robot* while that one charged."""
    end = stay.end if stay.end is not None else truth.latest(robot).time
    others = [other for other in PLACES if other != robot]
    return any(
        stay.begin < time < end
        for place in PLACES[robot]
        for other in others
        for time in looks(truth, other, place)
    )


def nearest(truth: GroundTruth) -> float:
    """Return the least distance between the centres of two robots, in metres."""
    paths = {robot: {round(s.time, 1): s for s in truth.path(robot)} for robot in PLACES}
    robots = list(PLACES)
    pairs = [(one, other) for n, one in enumerate(robots) for other in robots[n + 1 :]]
    return min(
        distance(sample, paths[other][time].x, paths[other][time].y)
        for one, other in pairs
        for time, sample in paths[one].items()
        if time in paths[other]
    )


if __name__ == "__main__":
    sys.exit(judge(check, sys.argv[1:]))
