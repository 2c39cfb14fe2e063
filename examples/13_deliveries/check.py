"""Judge whether parcels came from the hallway to their rooms, and whether the robot had the battery for it.

Judged from the ground truth and from what clients hear: the goals as the HTTP door lists them.
"""

import json
import sys
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from jacaros.robots.world import GroundTruth
from jacaros.testing import Verdict, judge
from jacaros.testing.paths import distance, judge_recharging

PLACES = {"hallway": (0.0, 0.0), "living_room": (2.0, 0.0), "kitchen": (2.0, 2.0), "bathroom": (0.0, 2.0)}
REACHED = 0.15
"""Distance within which the robot is at a place, in metres."""


class Delivery(NamedTuple):
    """A delivery that a client takes for done, from ``begin`` to ``end`` (s of the world's time)."""

    room: str
    begin: float
    end: float


def deliveries(goals: Iterable[dict[str, Any]], epoch: float) -> list[Delivery]:
    """Return the goals that were achieved.

    Args:
        goals: goals as JSON data.
        epoch: the time of the clock at which the world's time was 0.
    """
    return [
        Delivery(each["arguments"]["room"], each["began"] - epoch, each["ended"] - epoch)
        for each in goals
        if (each["goal"], each["state"]) == ("deliver", "achieved")
    ]


def check(truth: GroundTruth, done: Sequence[Delivery] = ()) -> Verdict:
    """Judge a run and its deliveries."""
    verdict = Verdict()
    verdict.measure("deliveries", len(done))
    judge_recharging(verdict, truth, low=21.0)
    verdict.expect(not truth.events_of("bump", "collision"), "the robot bumped into something")
    path = [*truth.path(), truth.latest()]
    for room, begin, end in done:
        way = [each for each in path if begin <= each.time <= end]
        loaded = next((each.time for each in way if distance(each, *PLACES["hallway"]) <= REACHED), None)
        verdict.expect(loaded is not None, f"no parcel was fetched between {begin:.1f} and {end:.1f} s")
        there = way and distance(way[-1], *PLACES[room]) <= REACHED
        verdict.expect(bool(there), f"the robot was not in the {room} at {end:.1f} s")
    return verdict


if __name__ == "__main__":
    done: list[Delivery] = []
    if len(sys.argv) > 2:
        with Path(sys.argv[1]).open(encoding="utf-8") as file:
            epoch = json.loads(file.readline())["epoch"]
        done = deliveries(json.loads(Path(sys.argv[2]).read_text(encoding="utf-8"))["goals"], epoch)
    sys.exit(judge(lambda truth: check(truth, done), sys.argv[1:2]))
