"""Do two robots share the rooms of each round, each task done once, and do both recharge when they must?

Judged from the ground truth, with the figures of the example's checker.
"""

import runpy
import sys
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

from jacaros.robots.world import GroundTruth, RobotEvent
from jacaros.testing import Verdict, judge
from jacaros.testing.paths import distance, stays

house = runpy.run_path(str(Path(__file__).parents[3] / "examples" / "05_house_cleaning" / "check.py"))

ROUNDS = 4
TASKS = house["ROUND"]
HALLWAY = {"robot_1": (0.0, 0.0), "robot_2": (0.4, -0.7)}
DOCKS = {"robot_1": "dock_1", "robot_2": "dock_2"}
NEAR = 0.05
"""Metres from its place at which a robot is in the hallway."""


def check(truth: GroundTruth) -> Verdict:
    """Judge a run of four rounds."""
    verdict = Verdict()
    events = truth.events_of("task")
    verdict.expect(len(events) == ROUNDS * len(TASKS), f"{len(events)} tasks, not {ROUNDS * len(TASKS)}")
    rounds = [events[begin : begin + len(TASKS)] for begin in range(0, len(events), len(TASKS))]
    for number, done in enumerate(rounds, 1):
        judge_round(verdict, number, done)
    for before, after in pairwise(rounds):
        judge_end(verdict, truth, before[-1].time, after[0].time)
    for robot in HALLWAY:
        tasks = sum(event.robot == robot for event in events)
        verdict.measure(f"tasks of {robot}", tasks)
        verdict.expect(tasks > 0, f"{robot} did nothing")
        judge_recharging(verdict, truth, robot)
    house["judge_dirt"](verdict, truth, ROUNDS, house["PLACES"])
    verdict.expect(not truth.events_of("bump", "collision"), "a robot bumped into something")
    return verdict


def judge_round(verdict: Verdict, number: int, done: Sequence[RobotEvent]) -> None:
    """Expect every task once, in its room, and the tasks of a room in order and by one robot."""
    wanted = sorted(f"{task} {room}" for room, task in TASKS)
    found = sorted(event.data["task"] for event in done)
    verdict.expect(found == wanted, f"the tasks of round {number} were {', '.join(found)}")
    for room, place in house["PLACES"].items():
        here = [event for event in done if event.data["task"].endswith(f" {room}")]
        order = [event.data["task"] for event in here]
        verdict.expect(
            order == [f"{task} {room}" for where, task in TASKS if where == room],
            f"the tasks in the {room} were {', '.join(order)}",
        )
        verdict.expect(
            len({event.robot for event in here}) <= 1, f"two robots cleaned the {room} in round {number}"
        )
        for event in here:
            far = distance(event, *place)
            verdict.expect(
                event.data["room"] == room and far <= 0.3,
                f"{event.robot} did '{event.data['task']}' {far:.1f} m from the corner of the {room}",
            )


def judge_end(verdict: Verdict, truth: GroundTruth, end: float, begin: float) -> None:
    """Expect both robots in the hallway between the last task of a round and the first one of the next."""
    for robot, place in HALLWAY.items():
        # A robot at rest has one sample a second.
        there = any(
            end - 1.0 < sample.time < begin and distance(sample, *place) <= NEAR
            for sample in truth.path(robot)
        )
        verdict.expect(there, f"{robot} left the hallway out after {end:.1f} s")


def judge_recharging(verdict: Verdict, truth: GroundTruth, robot: str) -> None:
    """Expect that a robot charges in its own dock, when its battery is low, until it is full."""
    found = stays(truth, robot)
    verdict.measure(f"recharges of {robot}", len(found))
    verdict.expect(len(found) > 0, f"{robot} did not recharge")
    for stay in found:
        verdict.expect(stay.level <= 20.0, f"{robot} docked at {stay.begin:.1f} s with {stay.level:.0f} %")
        verdict.expect(stay.charged, f"{robot} left the dock before its battery was full")
    for event in truth.events_of("docked", robot=robot):
        charged = any(
            stay.begin <= event.time and (stay.end is None or event.time <= stay.end) for stay in found
        )
        verdict.expect(
            not charged or event.data["dock"] == DOCKS[robot], f"{robot} charged in {event.data['dock']}"
        )
    verdict.expect(not truth.events_of("battery_empty", robot=robot), f"the battery of {robot} was empty")


if __name__ == "__main__":
    sys.exit(judge(check, sys.argv[1:]))
