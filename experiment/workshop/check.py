"""Is everything where it should be, are the closets closed, and was all of that done fairly?

Judged from the ground truth.  Each setting has a `Goal`; the rules hold for all settings.
"""

import sys
from functools import partial
from math import dist
from typing import Final, NamedTuple

from jacaros.robots.world import GroundTruth, RobotEvent
from jacaros.testing import Verdict, judge

NEAR: Final = 1.0
"""Metres from the middle of a door within which the robot must be when the door moves."""


class Goal(NamedTuple):
    """What a setting wants.

    Attributes:
        places: for each thing the room of the world where it must lie in the end.
        closed: doors that must be closed in the end.
        recharges: how often the robot must have been charged at least.
    """

    places: dict[str, str]
    closed: tuple[str, ...] = ()
    recharges: int = 0


FETCH = Goal({"tea": "counter"})
WASTE = Goal({"can": "waste_closet", "box": "waste_closet"}, ("waste_closet",))
SEARCH = Goal({"milk": "counter", "flour": "counter"}, ("cold_closet", "dry_closet"))
BATTERY = Goal(SEARCH.places | WASTE.places, SEARCH.closed + WASTE.closed, 1)

GOALS: Final = {"1_fetch": FETCH, "2_waste": WASTE, "3_search": SEARCH, "4_battery": BATTERY}
"""The goals by the folders of the settings."""


def check(truth: GroundTruth, goal: Goal) -> Verdict:
    """Judge a run."""
    verdict = Verdict()
    judge_things(verdict, truth, goal.places)
    judge_doors(verdict, truth, goal.closed)
    verdict.expect(not truth.events_of("bump", "collision"), "the robot bumped into something")
    verdict.expect(not truth.events_of("battery_empty"), "the battery was empty")
    recharges = len(truth.events_of("charging"))
    verdict.expect(recharges >= goal.recharges, f"{recharges} recharges, not {goal.recharges}")
    verdict.measure("recharges", recharges)
    verdict.measure("least percent", min(sample.battery for sample in truth.path()))
    verdict.measure("metres driven", truth.odometer())
    verdict.measure("seconds", truth.latest().time)
    return verdict


def judge_things(verdict: Verdict, truth: GroundTruth, places: dict[str, str]) -> None:
    """Expect all things in their places, and that none was moved through a closed door."""
    moves = truth.events_of("picked", "placed")
    for thing, room in places.items():
        last = next((move for move in reversed(moves) if move.data["object"] == thing), None)
        found = [] if last is None else rooms_of(truth, last)
        laid = last is not None and last.kind == "placed" and room in found
        verdict.expect(laid, f"the {thing} is not in the {room}")
    doors = [door["name"] for door in truth.world["doors"]]
    for move in moves:
        for door in set(rooms_of(truth, move)).intersection(doors):
            through = f"the {move.data['object']} was {move.kind} through the closed door of the {door}"
            verdict.expect(is_open(truth, door, move.time), through)


def rooms_of(truth: GroundTruth, move: RobotEvent) -> list[str]:
    """The rooms in which a thing was taken or put down."""
    x, y = move.data["x"], move.data["y"]
    areas = ((room["name"], room["area"]) for room in truth.world["rooms"])
    return [name for name, (left, low, right, high) in areas if left <= x <= right and low <= y <= high]


def judge_doors(verdict: Verdict, truth: GroundTruth, closed: tuple[str, ...]) -> None:
    """Expect doors to be closed in the end, and that the robot was before a door whenever it moved."""
    for door in closed:
        verdict.expect(not is_open(truth, door, truth.latest().time), f"the door of the {door} is open")
    for moved in truth.events_of("door_opened", "door_closed"):
        robot = min(truth.path(), key=lambda sample: abs(sample.time - moved.time))
        far = dist((robot.x, robot.y), (moved.x, moved.y))
        verdict.expect(
            far <= NEAR, f"the door of the {moved.data['door']} moved with the robot {far:.1f} m away"
        )


def is_open(truth: GroundTruth, door: str, time: float) -> bool:
    """Whether a door was open at a time."""
    (state,) = (each["open"] for each in truth.world["doors"] if each["name"] == door)
    for event in truth.events_of("door_opened", "door_closed"):
        if event.data["door"] == door and event.time <= time:
            state = event.kind == "door_opened"
    return bool(state)


if __name__ == "__main__":
    if len(sys.argv) < 2 or sys.argv[1] not in GOALS:
        print(f"usage: check.py SETTING GROUND_TRUTH_FILE    (settings: {', '.join(GOALS)})")
        sys.exit(2)
    sys.exit(judge(partial(check, goal=GOALS[sys.argv[1]]), sys.argv[2:]))
