"""A robot that is carried away finds its place and works where it should, or says that it cannot (ground truth)."""

import math
from pathlib import Path

import pytest

from jacaros.testing import RunResult, run_project

CLEANING = """
{ include("$jacaros/artifacts.asl") }
+!arrived(0).
+!arrived(Room) <- clean(Room).
{ include("$jacaros/navigation.asl") }
place(1, 2, 0, 0).
place(2, 2, 2, 0).
place(3, 0, 2, 0).
place(0, 0, 0, 0).
!start.
+!start <- !use_artifact("household", "ArtCleaning"); !patrol([1, 2, 3, 0], 3); .stopMAS.
"""
BY_MAP = CLEANING.replace(
    '{ include("$jacaros/nav', '{ include("$jacaros/driving_by_map.asl") }\n{ include("$jacaros/nav'
).replace(
    "+!start <-",
    '+!start <- !use_artifact("wheels", "ArtCmdVelMuxAndOdometry"); !use_artifact("map", "ArtMap");',
)
"""The same by the robot's own map, without localisation and Nav2."""
SQUARE = """
name: square
bounds: {from: [-2, -2], to: [2, 2]}
border: walls
robots: [{name: turtlebot, pose: {x: -1, y: -1}}]
"""
BETWEEN = """
{ include("$jacaros/artifacts.asl") }
+!arrived(Place) <- .print("work at ", Place); .wait(1000).
{ include("$jacaros/driving_by_map.asl") }
{ include("$jacaros/navigation.asl") }
place(a, 1, -1, 0).
place(b, -1, -1, 0).
!start.
+!start
  <- !use_artifact("wheels", "ArtCmdVelMuxAndOdometry"); !use_artifact("map", "ArtMap"); !patrol([a, b], 3).
"""


@pytest.mark.parametrize(
    "pose",
    [
        pytest.param(
            "at: 28, to: {x: 2, y: 0.3, yaw_degrees: 90}", id="before the bathroom, into the living room"
        ),
        pytest.param("at: 6, to: {x: 0, y: 2, yaw_degrees: 180}", id="while it vacuums, into the bathroom"),
        pytest.param("at: 12, to: {x: 0.5, y: 0.2}", id="on the way, into the hallway"),
        pytest.param("at: 29.5, to: {x: 2.2, y: 2.1}", id="out of the bathroom, into the kitchen"),
    ],
)
def test_a_carried_robot_cleans_no_room_in_another(pose: str, tmp_path: Path) -> None:
    result = run_with(tmp_path, CLEANING, f"kind: kidnapped_robot, {pose}", mappings=["nav2.yaml"])
    assert astray(result) < 20, "at most two seconds, until it has noticed"


@pytest.mark.parametrize(
    "fault",
    [
        pytest.param(
            "kind: kidnapped_robot, at: 57, to: {x: 2.4, y: 2.1, yaw_degrees: 90}",
            id="three metres, on the way",
        ),
        pytest.param("kind: kidnapped_robot, at: 43, to: {x: 2, y: 0.3}", id="out of the bathroom, at work"),
        pytest.param("kind: wheel_slip, at: 3, for: 20, share: 0.3", id="wheels slip"),
    ],
)
def test_a_robot_with_nothing_but_its_own_map_cleans_where_it_should(fault: str, tmp_path: Path) -> None:
    result = run_with(tmp_path, BY_MAP, fault)
    places = {"living_room": (2, 0), "kitchen": (2, 2), "bathroom": (0, 2)}
    for task in result.ground_truth.events_of("task"):
        assert math.dist((task.x, task.y), places[task.data["room"]]) < 0.1
    assert astray(result) < 20


def test_a_robot_in_a_square_room_says_that_it_cannot_find_its_place(tmp_path: Path) -> None:
    (tmp_path / "square.yaml").write_text(SQUARE, encoding="utf-8")
    fault = "kind: kidnapped_robot, at: 20, to: {x: 0.5, y: 1.3, yaw_degrees: 30}"
    result = started(tmp_path, BETWEEN, fault, tmp_path / "square.yaml")
    working = [line for line in result.lines if "work at" in line]
    assert [line.split("] ")[1] for line in result.lines if line not in working] == [
        "I am stuck: lost. I believe: lost. What would help: show me where I am. What shall I do?"
    ]
    assert len(working) == 1, "before it was carried away"
    path = [sample for sample in result.ground_truth.path() if sample.time > 200]
    assert {(sample.x, sample.y) for sample in path} == {(path[0].x, path[0].y)}


def started(folder: Path, text: str, fault: str, world: Path | str, **options: object) -> RunResult:
    """Run a program with one fault."""
    program, faults = folder / "robot.asl", folder / "faults.yaml"
    program.write_text(text, encoding="utf-8")
    faults.write_text(f"faults:\n  disturbed: {{{fault}}}\n", encoding="utf-8")
    return run_project(program, world=world, faults=faults, seconds=400, **options)


def run_with(folder: Path, text: str, fault: str, **options: object) -> RunResult:
    """Let the robot clean the house; all tasks must be done, each in its room."""
    result = started(folder, text, fault, "house", **options)
    tasks = result.ground_truth.events_of("task")
    assert len(tasks) == 12
    assert [each.data for each in tasks if not str(each.data["task"]).endswith(each.data["room"])] == []
    assert ([each for each in result.errors if "note: odometry" not in each], result.exit_code) == ([], 0)
    return result


def astray(result: RunResult) -> int:
    """Count the tenths of seconds in which a tool ran elsewhere than where it was started."""
    truth = result.ground_truth
    on, off = truth.events_of("tool_started"), truth.events_of("tool_stopped")
    return sum(
        math.dist((sample.x, sample.y), (begin.x, begin.y)) > 0.2
        for begin, end in zip(on, off, strict=True)
        for sample in truth.path()
        if begin.time < sample.time < end.time
    )
