"""Judge whether all tasks were done in their rooms and in order, the rooms are clean, and the battery never ran empty.

Judged from the ground truth: the world logs every task with the room that the robot is actually in, and the dirt that
remains.
"""

import sys
from collections.abc import Mapping, Sequence

from jacaros.robots.world import GroundTruth
from jacaros.testing import Verdict, judge
from jacaros.testing.paths import distance, judge_recharging

Place = tuple[float, float]

ROUND = (
    ("living_room", "vacuum carpet"),
    ("kitchen", "mop floor"),
    ("bathroom", "scrub tub"),
    ("bathroom", "mop floor"),
)
"""Rooms of a round with their tasks; the hallway, where a round ends, has none."""

HALLWAY = (0.0, 0.0)
PLACES = {"living_room": (2.0, 0.0), "kitchen": (2.0, 2.0), "bathroom": (0.0, 2.0)}
"""Where the robot stands to clean each room, in metres."""

ROUNDS_TO_CLEAN = 4
"""Rounds after which all is clean: each removes at least a quarter of the dirt."""


def check(
    truth: GroundTruth,
    rounds: int = 4,
    recharges: int = 1,
    tasks_of_round: Sequence[tuple[str, str]] = ROUND,
    places: Mapping[str, Place] = PLACES,
) -> Verdict:
    """Judge a run of *rounds* rounds with at least *recharges* recharges."""
    verdict = Verdict()
    tasks = truth.events_of("task")
    verdict.measure("tasks", len(tasks))
    wanted = rounds * len(tasks_of_round)
    verdict.expect(len(tasks) == wanted, f"{len(tasks)} tasks, not {wanted}")
    for number, event in enumerate(tasks):
        room, task = tasks_of_round[number % len(tasks_of_round)]
        text, where = event.data["task"], event.data["room"]
        verdict.expect(text == f"{task} {room}", f"task {number + 1} was '{text}', not '{task} {room}'")
        verdict.expect(where == room, f"the robot did '{text}' in the {where}")
        far = distance(event, *places[room])
        verdict.expect(far <= 0.3, f"the robot did '{text}' {far:.1f} m from the corner of the {room}")

    judge_dirt(verdict, truth, rounds, places)

    # A round ends in the hallway, after its last task and before the first task of the next round.
    ends = [event.time for event in tasks[len(tasks_of_round) - 1 :: len(tasks_of_round)]]
    begins = [event.time for event in tasks[len(tasks_of_round) :: len(tasks_of_round)]]
    at_home = [sample.time for sample in truth.path() if distance(sample, *HALLWAY) <= 0.05]
    for end, begin in zip(ends, [*begins, float("inf")], strict=False):
        verdict.expect(
            any(end < time < begin for time in at_home), f"after {end:.1f} s the robot left the hallway out"
        )

    stays = judge_recharging(verdict, truth)
    verdict.expect(len(stays) >= recharges, f"{len(stays)} recharges, not {recharges}")
    verdict.expect(not truth.events_of("bump", "collision"), "the robot bumped into something")
    return verdict


def judge_dirt(
    verdict: Verdict, truth: GroundTruth, rounds: int, places: Mapping[str, Place] = PLACES
) -> None:
    """Judge how much dirt remains, and where the robot was when it removed the rest."""
    for room in truth.world["rooms"]:
        for dirt in room.get("dirt", []):
            kind, before = dirt["kind"], dirt["grams"]
            left = truth.dirt[room["name"], kind]
            most = before * max(0.0, 1.0 - rounds / ROUNDS_TO_CLEAN)
            verdict.expect(
                left <= most, f"{left:.1f} g of the {kind} in the {room['name']} are left, not {most:.1f}"
            )
    verdict.measure("grams_left", round(sum(truth.dirt.values()), 1))
    for event in truth.events_of("cleaned"):
        far = distance(event, *places[event.data["room"]])
        verdict.expect(far <= 0.3, f"the robot cleaned the {event.data['room']} {far:.1f} m from its corner")


if __name__ == "__main__":
    sys.exit(judge(check, sys.argv[1:]))
