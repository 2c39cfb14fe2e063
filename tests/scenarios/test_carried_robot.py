"""A robot over Nav2 that is carried away notices, finds its place, and works where it should (ground truth)."""

import math
from pathlib import Path

import pytest

from jacaros.testing import run_project

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
    program, faults = tmp_path / "robot.asl", tmp_path / "faults.yaml"
    program.write_text(CLEANING, encoding="utf-8")
    faults.write_text(f"faults:\n  carried: {{kind: kidnapped_robot, {pose}}}\n", encoding="utf-8")
    result = run_project(program, mappings=["nav2.yaml"], world="house", faults=faults, seconds=400)
    truth = result.ground_truth
    tasks = truth.events_of("task")
    assert len(tasks) == 12
    assert [each.data for each in tasks if not str(each.data["task"]).endswith(each.data["room"])] == []
    on, off = truth.events_of("tool_started"), truth.events_of("tool_stopped")
    astray = [
        sample
        for begin, end in zip(on, off, strict=True)
        for sample in truth.path()
        if begin.time < sample.time < end.time and math.dist((sample.x, sample.y), (begin.x, begin.y)) > 0.2
    ]
    assert len(astray) < 20, "at most two seconds, until it has noticed"
    assert (result.errors, result.exit_code) == ([], 0)
