"""The plans of ``$jacaros/navigation.asl``: with faked robots, and with the ready mappings in the embedded world."""

import subprocess
import sys
from itertools import pairwise
from pathlib import Path

import pytest

from jacaros.testing import RunResult, run_project
from jacaros.testing.suites import collect
from jacaros.testing.trial import run_suite

TESTS = Path(__file__).parent / "navigation_library"
TINY = """
name: room
bounds: {from: [-1, -1], to: [3, 3]}
border: walls
docks: [{name: dock, x: 1, y: 1, yaw_degrees: 0, radius: 0.25}]
robots:
  - name: turtlebot
    pose: {x: 0, y: 0, yaw_degrees: 0}
    battery: {level: 33, drain_per_second: 0.3, drain_per_metre: 1.5, charge_per_second: 10}
"""
PATROL = """
{ include("$jacaros/navigation.asl") }
place(a, 2, 0, 0).
place(b, 2, 2, 90).
place(c, 0, 2, 180).
place(d, 0, 0, 270).
!start.
+!start <- .wait(pose(_, _, _)); !!keep_charged; !patrol([a, b, c, d], 2); .stopMAS.
"""


def patrol(folder: Path, program: str, *mappings: str, faults: str | None = None) -> RunResult:
    (folder / "room.yaml").write_text(TINY, encoding="utf-8")
    (folder / "robot.asl").write_text(program, encoding="utf-8")
    focus = ", ".join(f"main.{Path(each).stem}" for each in mappings)
    keys = ", ".join(f'"{each}"' for each in mappings)
    (folder / "system.jcm").write_text(
        f'mas system {{ agent robot {{ focus: {focus} }} world: "room.yaml" mapping: {keys} }}',
        encoding="utf-8",
    )
    return run_project(folder / "system.jcm", seconds=600, faults=faults)


def test_the_plans_with_faked_robots() -> None:
    suites = collect([TESTS])
    assert [suite.error for suite in suites if suite.error is not None] == []
    outcomes = [outcome for suite in suites for outcome in run_suite(suite)]
    assert len(outcomes) == 59
    assert [outcome.test.name for outcome in outcomes if not outcome.passed] == []


@pytest.mark.parametrize(
    ("beliefs", "mappings"),
    [
        pytest.param('dock_id("dock").', ("nav2.yaml", "turtlebot3.yaml"), id="nav2 docks"),
        pytest.param("place(dock, 0.4, 1, 0).", ("nav2.yaml", "turtlebot4.yaml"), id="turtlebot 4 docks"),
        pytest.param("place(dock, 0.4, 1, 0).", ("move_base.yaml", "turtlebot2.yaml"), id="move_base"),
    ],
)
def test_a_patrol_charges_in_between(tmp_path: Path, beliefs: str, mappings: tuple[str, ...]) -> None:
    result = patrol(tmp_path, PATROL + beliefs, *mappings)
    assert (result.lines, result.errors, result.exit_code) == ([], [], 0)
    truth = result.ground_truth
    assert truth.events_of("bump", "collision", "battery_empty") == []
    (charging,) = truth.events_of("charging")
    assert 5 < charging.data["level"] <= 20
    assert len(truth.events_of("charging")) == 1
    path = truth.path()
    for place in ((2, 0), (2, 2), (0, 2)):
        near = [abs(sample.x - place[0]) < 0.06 and abs(sample.y - place[1]) < 0.06 for sample in path]
        visits = sum(now and not before for before, now in pairwise(near))
        assert visits >= 2


@pytest.mark.parametrize("mapping", ["turtlebot3.yaml", "turtlebot4.yaml"])
def test_a_dock_without_current_is_reported_in_time(tmp_path: Path, mapping: str) -> None:
    """A robot that drives into its dock by itself: the library finds out."""
    program = "+!drive_into_dock <- !go_to(1, 1, 0).  -!keep_charged <- .stopMAS(0, 1)." + PATROL
    dead = "faults:\n  dead: {kind: dead_dock, dock: dock, at: 0}\n"
    result = patrol(tmp_path, program, "nav2.yaml", mapping, faults=dead)
    assert result.exit_code == 1
    assert any(line.startswith("[robot] I am stuck: no_current.") for line in result.lines)
    assert result.ground_truth.path()[-1].time < 120
    assert result.ground_truth.events_of("battery_empty", "bump") == []


@pytest.mark.parametrize(
    ("end", "resumed"),
    [("", False), (".resume(patrol(_)); ", True)],
    ids=["suspended", "suspended and resumed"],
)
def test_a_patrol_that_is_suspended_stops_the_robot(tmp_path: Path, end: str, resumed: bool) -> None:
    program = PATROL.replace(
        "!!keep_charged; !patrol([a, b, c, d], 2);",
        f"!!patrol([a, b]); .wait(3000); .suspend(patrol(_)); .wait(4000); {end} .wait(6000);",
    )
    path = patrol(tmp_path, program, "nav2.yaml").ground_truth.path()
    at = {second: next((s.x, s.y) for s in path if s.time >= second) for second in (2, 4, 6)}
    assert at[4][0] > at[2][0] + 0.2
    assert at[6] == pytest.approx(at[4], abs=1e-3)
    assert (abs(path[-1].x - at[6][0]) > 0.2) == resumed


def test_a_patrol_that_is_dropped_stops_the_robot(tmp_path: Path) -> None:
    program = PATROL.replace(
        "!!keep_charged; !patrol([a, b, c, d], 2);",
        "!!patrol([a, b]); .wait(3000); .drop_desire(patrol(_)); .wait(4000);",
    )
    path = patrol(tmp_path, program, "nav2.yaml").ground_truth.path()
    still = [(s.x, s.y) for s in path if s.time >= 4]
    assert still[0][0] > 0.3
    assert still[0] == pytest.approx(still[-1], abs=1e-3)


def test_the_namespace_of_the_command_line_is_that_of_names_and_frames() -> None:
    program = Path(__file__).parents[1] / "integration/ros/programs/two_stops.asl"
    words = [sys.executable, "-m", "jacaros", "run", str(program), "--mapping", "nav2.yaml"]
    words += ["--world", "three_robots", "--namespace", "robot_2", "--clock", "fast", "--for", "60"]
    told = subprocess.run(words, capture_output=True, text=True, check=True)
    assert (told.stdout, told.stderr) == ("[two_stops] is there\n", "")
