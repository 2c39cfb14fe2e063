"""Programs written as the listings of the thesis run to a sensible end."""

import math
import re
from pathlib import Path
from typing import Any

import pytest

from jacaros.robots.world import GroundTruth
from jacaros.runtime.mas.launch import launch
from jacaros.runtime.mas.options import RunOptions
from jacaros.runtime.mas.system import System
from jacaros.testing import RunResult, run_project
from jacaros.testing.paths import angle_between, distance, turns

HERE = Path(__file__).parent
SEEDS = pytest.mark.parametrize("seed", range(5))


def run(name: str, seconds: float, **options: Any) -> RunResult:
    """Run a program; nothing may be complained about."""
    result = run_project(HERE / f"{name}.mas2j", seconds=seconds, **options)
    assert result.errors == []
    assert result.exit_code == 0
    return result


def in_the_map(name: str, folder: Path) -> Path:
    """The same program with the option that its drives follow the map."""
    text = (HERE / f"{name}.asl").read_text(encoding="utf-8")
    if "[]," in text and name != "house":
        changed = text.replace("[],", "[frame(map)],")
    else:  # the plan of the included library
        make = 'makeArtifact("Cmd_vel_mux_odom", "ArtCmdVelMuxAndOdometry", [frame(map)], _);'
        changed = text.replace("!create_cmd_vel_mux_odom;", make)
    assert changed != text
    (folder / f"{name}.asl").write_text(changed, encoding="utf-8")
    project = (HERE / f"{name}.mas2j").read_text(encoding="utf-8")
    (folder / f"{name}.mas2j").write_text(project, encoding="utf-8")
    return folder / f"{name}.mas2j"


def is_back(truth: GroundTruth) -> bool:
    start, end = truth.path()[0], truth.latest()
    return distance(end, start.x, start.y) <= 0.05 and angle_between(end.yaw, start.yaw) <= math.radians(3.0)


def test_odometry_is_created_found_and_perceived() -> None:
    result = run("odometry", 60.0)
    assert result.lines[0] == "[robot] looking the artifact up"
    assert "[robot] looking again" in result.lines
    assert "[robot] making the artifact of a robot without a name" in result.lines
    seen = result.lines.index("[robot] odometry came")
    assert result.lines[seen + 1 : seen + 4] == ["[robot] X: 0", "[robot] Y: 0", "[robot] Z: 0"]
    assert "[robot] the pose: 0 0 0" in result.lines
    assert result.lines[-2:] == ["[robot] making the artifact of robot_0", "[robot] no odometry for robot_0"]


def test_each_robot_has_odometry_of_its_own() -> None:
    result = run("odometry_of_robots", 60.0)
    assert result.lines == [
        *("[watcher] making Odom", "[watcher] looking up Odom", "[watcher] making Odomrobot_1"),
        *("[watcher] looking up Odomrobot_1", "[watcher] robot_1 is at 1 1", "[watcher] found what it made"),
    ]


@SEEDS
def test_out_and_back_by_time(seed: int) -> None:
    truth = run("out_and_back", 30.0, seed=seed).ground_truth
    assert max(sample.x for sample in truth.path()) > 1.0
    assert is_back(truth)


@SEEDS
@pytest.mark.parametrize("name", ["out_and_back", "square"])
def test_one_word_makes_a_program_robust_where_wheels_slip(name: str, seed: int, tmp_path: Path) -> None:
    result = run_project(in_the_map(name, tmp_path), seconds=40.0, seed=seed, noise=1.0)
    assert result.errors == []
    assert max(sample.x for sample in result.ground_truth.path()) > 0.9
    assert is_back(result.ground_truth)


def corners(truth: GroundTruth, *wanted: tuple[float, float]) -> None:
    """The first corners of the path are these, to 5 cm."""
    found = [(turn.x, turn.y) for turn in turns(truth.path())][: len(wanted)]
    assert [math.dist(*pair) <= 0.05 for pair in zip(found, wanted, strict=True)] == [True] * len(wanted), (
        found
    )


@SEEDS
def test_a_square_by_odometry(seed: int) -> None:
    truth = run("square", 40.0, seed=seed).ground_truth
    assert len(turns(truth.path())) == 4
    corners(truth, (1, 0), (1, 1), (0, 1), (0, 0))
    assert is_back(truth)


@SEEDS
def test_the_diagnoses_of_the_battery(seed: int) -> None:
    assert run("battery", 110.0, seed=seed).lines == [
        "[robot] Full Battery",
        "[robot] Medium Battery",
        "[robot] Low Battery",
    ]


def patrols(result: RunResult) -> None:
    """The robot patrols, recharges and resumes its patrol, twice."""
    told = [line.removeprefix("[robot] ") for line in result.lines]
    story = re.sub(r"(side )+", "sides ", " ".join(line.replace(" ", "_") for line in told) + " ")
    cycle = (
        "Current_Diagnostic:_Medium_Battery sides Current_Diagnostic:_Low_Battery recharging "
        "Current_Diagnostic:_Medium_Battery Current_Diagnostic:_Full_Battery returned sides "
    )
    assert story.startswith(f"Current_Diagnostic:_Full_Battery sides {cycle}{cycle}")
    # Before the first stop, the corners are those of the square; afterwards the relative moves lead elsewhere.
    corners(result.ground_truth, *[(2, 0), (2, 2), (0, 2), (0, 0)] * 2)


@SEEDS
@pytest.mark.slow
@pytest.mark.parametrize("slips", [False, True], ids=["", "in the map where wheels slip"])
@pytest.mark.parametrize("name", ["patrol", "house"])
def test_a_patrol_and_a_household_recharge(name: str, slips: bool, seed: int, tmp_path: Path) -> None:
    seconds, judge = {"patrol": (300.0, patrols), "house": (200.0, keeps_house)}[name]
    if not slips:
        judge(run(name, seconds, seed=seed))
        return
    result = run_project(in_the_map(name, tmp_path), seconds=seconds, seed=seed, noise=1.0)
    assert result.errors == []
    judge(result)


class Odometer:
    """A console that notes how far the robot has driven at each line."""

    def begin(self, mas: System) -> None:
        """Take the run."""
        self.mas, self.driven = mas, dict[str, float]()

    def print(self, agent: str, text: str) -> None:
        """Note the metres of the newest line of this text."""
        self.driven[text] = self.mas.ros.world.ground_truth.odometer()

    def log(self, text: str, level: str = "info") -> None:
        """Nothing is to be said."""
        raise AssertionError(text)


@pytest.mark.slow
def test_the_patrol_stands_still_while_it_is_suspended() -> None:
    # All that the robot drives between "Low Battery" and "returned" are the four metres of the way to the dock.
    console = Odometer()
    options = RunOptions(fast=True, seed=0, seconds=140.0)
    launch(HERE / "patrol.mas2j", options, console, console.begin, own_process=False)
    driven = console.driven["returned"] - console.driven["Current Diagnostic: Low Battery"]
    assert driven == pytest.approx(4.0, abs=0.3)


def keeps_house(result: RunResult) -> None:
    """The robot does the tasks of each room in the room, and resumes them after it has recharged."""
    tasks = [event.data["task"] for event in result.ground_truth.events_of("task")]
    round_ = ["vacuum carpet living_room", "mop floor kitchen", "scrub tub bathroom", "mop floor bathroom"]
    assert len(tasks) >= 8
    assert tasks == [round_[number % 4] for number in range(len(tasks))]
    places = [(2, 0), (2, 2), (0, 2), (0, 2)]
    for event, place in zip(result.ground_truth.events_of("task")[:4], places, strict=True):
        assert distance(event, *place) <= 0.05
    assert "[robot] recharging" in result.lines
    assert "[robot] returned" in result.lines
    after = result.lines[result.lines.index("[robot] returned") :]
    assert any("Vacuum" in line or "Mop" in line for line in after)


def test_the_range_of_view_and_the_way_to_the_goal() -> None:
    lines = run("map", 10.0).lines
    # Signals are events: those of the range of view are handled while the agent continues.
    seen = ["[robot] 0 0 home", "[robot] 0 1 free", "[robot] 1 0 obstacle", "[robot] 1 1 free"]
    assert [line for line in lines if line in seen] == seen
    went = ["[robot] north, turn 90", "[robot] east, turn -90", "[robot] east, turn 0", "[robot] at the goal"]
    assert [line for line in lines if line not in seen] == went
