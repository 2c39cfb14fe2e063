"""Judge whether all loads arrived, with one robot in the passage at a time and no bump, and the medicine waited least.

Judged from the ground truth.
"""

import sys
from bisect import bisect_right
from itertools import pairwise
from typing import NamedTuple

from jacaros.robots.world import GroundTruth, PathSample
from jacaros.testing import Verdict, judge
from jacaros.testing.paths import distance

LANES = {"robot_1": 1.5, "robot_2": 0.0, "robot_3": -1.5}
"""The lane of each robot in the rooms: y, in metres."""

MEDICINE = "robot_3"

SHELF = 3.4
"""Distance from the middle of the passage to the shelves in both rooms, in metres."""

FRONT = 2.4
"""Distance from the middle of the passage to the waiting positions in both rooms, in metres."""

NEAR = 0.12
"""Distance within which a robot is at a place, in metres."""

RADIUS = 0.17
"""Radius of a robot, in metres."""

SOON = 1.0
"""Seconds a robot may take to leave once it has the passage; a robot that arrives meanwhile cannot go first."""


class Crossing(NamedTuple):
    """A crossing of the passage: when the robot came to its front, left it, was inside, and was out again (s)."""

    robot: str
    came: float
    left: float
    begin: float
    end: float

    @property
    def waited(self) -> float:
        """Waiting time in front of the passage, in seconds."""
        return self.left - self.came


def check(truth: GroundTruth, loads: int = 3) -> Verdict:
    """Judge a run in which each robot brings *loads* loads."""
    verdict = Verdict()
    verdict.expect(not truth.events_of("bump", "collision"), "a robot bumped into something")
    found = {robot: crossings(truth, robot) for robot in LANES}
    for robot in LANES:
        brought = loads_of(truth, robot)
        verdict.expect(brought == loads, f"{robot} brought {brought} loads, not {loads}")
        verdict.expect(not is_inside(truth, truth.latest(robot)), f"{robot} ended in the passage")
    together = seconds_together(truth)
    verdict.measure("seconds with two robots in the passage", together)
    verdict.expect(together == 0, "two robots were in the passage at the same time")
    judge_waiting(verdict, found)
    return verdict


def judge_waiting(verdict: Verdict, found: dict[str, list[Crossing]]) -> None:
    """Expect waiting medicine to be next through the passage, and so to have the shortest mean wait."""
    means = {robot: mean([each.waited for each in ways]) for robot, ways in found.items()}
    for robot, waited in means.items():
        verdict.measure(f"seconds that {robot} waited, mean", waited)
    others = [waited for robot, waited in means.items() if robot != MEDICINE]
    verdict.expect(means[MEDICINE] < min(others), "the medicine did not wait least")
    overtaken = sum(
        urgent.came + SOON < other.left < urgent.left
        for urgent in found[MEDICINE]
        for robot, ways in found.items()
        if robot != MEDICINE
        for other in ways
    )
    verdict.expect(not overtaken, f"others went before the waiting medicine ({overtaken} times)")
    met = sum(
        other.came < urgent.left < other.left and urgent.waited > SOON
        for urgent in found[MEDICINE]
        for robot, ways in found.items()
        if robot != MEDICINE
        for other in ways
    )
    verdict.measure("times that the medicine and another robot waited", met)
    verdict.expect(met >= 1, "no robot waited together with the medicine")


def is_inside(truth: GroundTruth, sample: PathSample) -> bool:
    """Return whether any part of a robot is in the passage."""
    (passage,) = (room for room in truth.world["rooms"] if room["name"] == "passage")
    west, south, east, north = passage["area"]
    return west - RADIUS < sample.x < east + RADIUS and south < sample.y < north


def crossings(truth: GroundTruth, robot: str) -> list[Crossing]:
    """Return all crossings of a robot, from one room to the other."""
    found: list[Crossing] = []
    came = left = 0.0
    begin: PathSample | None = None
    at_front = False
    for before, sample in pairwise(truth.path(robot)):
        was_at_front, at_front = at_front, distance(sample, front_of(sample), LANES[robot]) < NEAR
        if at_front and not was_at_front:
            came = sample.time
        elif was_at_front and not at_front:
            left = sample.time
        inside = is_inside(truth, sample)
        if inside and begin is None:
            begin = before
        elif begin is not None and not inside:
            if begin.x * sample.x < 0:
                found.append(Crossing(robot, came, left, begin.time, sample.time))
            begin = None
    return found


def front_of(sample: PathSample) -> float:
    """Return where robots wait in the room of a sample: x, in metres."""
    return -FRONT if sample.x < 0 else FRONT


def loads_of(truth: GroundTruth, robot: str) -> int:
    """Count how often a robot stood at its shelf in the store, and then at its shelf in the ward."""
    loads, loaded = 0, False
    for before, sample in pairwise(truth.path(robot)):
        if sample.odometer - before.odometer > 1e-4 or sample.time == before.time:
            continue
        if distance(sample, -SHELF, LANES[robot]) < NEAR:
            loaded = True
        elif loaded and distance(sample, SHELF, LANES[robot]) < NEAR:
            loads, loaded = loads + 1, False
    return loads


def seconds_together(truth: GroundTruth) -> float:
    """Return how long more than one robot was in the passage, in seconds."""
    paths = {robot: truth.path(robot) for robot in LANES}
    times = {robot: [sample.time for sample in path] for robot, path in paths.items()}
    moments = sorted({round(time, 1) for each in times.values() for time in each})

    def inside(robot: str, time: float) -> bool:
        last = max(bisect_right(times[robot], time + 1e-6) - 1, 0)
        return is_inside(truth, paths[robot][last])

    return sum(
        later - sooner
        for sooner, later in pairwise(moments)
        if sum(inside(robot, sooner) for robot in LANES) > 1
    )


def mean(values: list[float]) -> float:
    """Return the mean, or 0 for an empty list."""
    return sum(values) / len(values) if values else 0.0


if __name__ == "__main__":
    sys.exit(judge(check, sys.argv[1:]))
