"""Judge whether every parcel reached its room, on a short route, and the battery never ran empty.

Judged from the ground truth: the world logs loading and unloading with the room that the robot is actually in.
"""

import sys
from itertools import pairwise
from math import dist

from jacaros.robots.world import GroundTruth
from jacaros.testing import Verdict, judge
from jacaros.testing.paths import judge_recharging

PLACES = {"hallway": (0, 0), "living_room": (2, 0), "kitchen": (2, 2), "bathroom": (0, 2)}
PARCELS = (
    ("kitchen", "hallway"),
    ("bathroom", "living_room"),
    ("hallway", "kitchen"),
    ("living_room", "bathroom"),
    ("kitchen", "bathroom"),
    ("bathroom", "kitchen"),
    ("hallway", "living_room"),
    ("living_room", "hallway"),
    ("kitchen", "living_room"),
    ("hallway", "bathroom"),
    ("bathroom", "hallway"),
    ("bathroom", "kitchen"),
    ("kitchen", "living_room"),
    ("hallway", "bathroom"),
)
"""Origin and destination of each parcel, in the order of the customer's orders."""


def check(truth: GroundTruth, recharges: int = 1) -> Verdict:
    """Judge a run that delivers all parcels, with at least *recharges* recharges."""
    verdict = Verdict()
    done = [(event.data["task"], event.data["room"]) for event in truth.events_of("task")]
    for number, (start, goal) in enumerate(PARCELS, 1):
        loaded, unloaded = rooms(done, f"load {number}"), rooms(done, f"unload {number}")
        verdict.expect(loaded == [start], f"parcel {number} was loaded in {loaded}, not in the {start}")
        verdict.expect(unloaded == [goal], f"parcel {number} was unloaded in {unloaded}, not in the {goal}")
        if loaded and unloaded:
            before = done.index((f"load {number}", loaded[0])) < done.index((f"unload {number}", unloaded[0]))
            verdict.expect(before, f"parcel {number} was unloaded before it was loaded")

    stays = judge_recharging(verdict, truth)
    verdict.expect(len(stays) >= recharges, f"{len(stays)} recharges, not {recharges}")
    verdict.expect(not truth.events_of("bump", "collision"), "the robot bumped into something")
    # Driving to the dock and back does not count.
    verdict.measure("metres for one parcel at a time", one_by_one())
    verdict.at_most("metres driven", truth.odometer() - 3.0 * len(stays), one_by_one() * 2 / 3)
    return verdict


def rooms(done: list[tuple[str, str]], task: str) -> list[str]:
    """Return the rooms in which a task was done."""
    return [room for each, room in done if each == task]


def one_by_one() -> float:
    """Return the length of the route that carries one parcel at a time, in metres."""
    way = ["hallway", *(room for parcel in PARCELS for room in parcel)]
    return sum(dist(PLACES[here], PLACES[there]) for here, there in pairwise(way))


if __name__ == "__main__":
    sys.exit(judge(check, sys.argv[1:]))
