"""The baselines of the experiment on ROS 2 with the genuine rclpy: each in a process of its own, the world in another."""

import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from examples_lab import EXAMPLES, checker
from processes import Program, WorldProcess
from test_examples_on_graphs import HOUSE, PATROL_BATTERY, changed, is_back_on_patrol, judge, not_on_kilted

pytestmark = pytest.mark.only("ros2")

EXPERIMENT = EXAMPLES.parent / "experiment"

LOG = {
    "RCUTILS_CONSOLE_OUTPUT_FORMAT": "[{name}] {message}",
    "RCUTILS_LOGGING_USE_STDOUT": "1",
    "RCUTILS_LOGGING_BUFFERED_STREAM": "0",
}
"""What nodes log appears on standard output as agents' lines do."""

RunWorld = Callable[..., WorldProcess]
RunBaseline = Callable[..., Program]


@pytest.fixture
def run_baseline(kind: str, environment: dict[str, str]) -> Iterator[RunBaseline]:
    """Starts a baseline, given by its name or its file, as a process of its own; what follows are arguments of ROS."""
    started: list[Program] = []

    def run(program: str | Path, *arguments: str) -> Program:
        path = EXPERIMENT / "baseline" / f"{program}.py" if isinstance(program, str) else program
        command = [sys.executable, str(path), *(("--ros-args", *arguments) if arguments else ())]
        stand_ins = {"PYTHONPATH": str(EXPERIMENT / "stand_ins")}
        started.append(Program(command, environment | LOG | stand_ins))
        return started[-1]

    yield run
    for each in started:
        each.stop()


def test_the_robot_drives_out_and_back(run_world: RunWorld, run_baseline: RunBaseline) -> None:
    world = run_world("empty")
    baseline = run_baseline("out_and_back")
    assert baseline.end() == 0
    # As for the agent, which also drives by time: a late command makes the path 65 mm longer.
    judge(checker("01_out_and_back").check(world.close(), near=0.15), baseline)
    assert baseline.lines == ["[out_and_back] driving out", "[out_and_back] driving back"]


def test_the_robot_drives_the_square(run_world: RunWorld, run_baseline: RunBaseline) -> None:
    world = run_world("empty")
    baseline = run_baseline("square")
    assert baseline.end() == 0
    judge(checker("02_square").check(world.close()), baseline)


@not_on_kilted
def test_the_node_reports_every_state_of_the_robot_s_battery(
    run_world: RunWorld, run_baseline: RunBaseline
) -> None:
    # This robot does not move, so its world can be much faster.
    world = run_world(EXAMPLES / "03_fake_battery/weak_battery.yaml", "--speed", "5")
    baseline = run_baseline("fake_battery", "-p", "source:=robot")
    assert baseline.end() == 0
    # The node joins when the battery has begun to run down, as with a real robot.
    joined, *later = baseline.lines
    assert joined.endswith(" %: Full Battery")
    lines = ["[fake_battery] 100 %: Full Battery", *later]
    judge(checker("03_fake_battery").check(lines, world.close()), baseline)


@not_on_kilted
def test_the_patrol_continues_after_a_recharge(
    run_world: RunWorld, run_baseline: RunBaseline, tmp_path: Path
) -> None:
    world = run_world(changed(tmp_path, EXAMPLES / "04_patrol/patrol.yaml", PATROL_BATTERY))
    baseline = run_baseline("patrol")
    baseline.until(lambda: is_back_on_patrol(world.truth), "a corner after a recharge")
    truth = world.close()
    baseline.stop()
    print(*baseline.lines, sep="\n")
    assert checker("04_patrol").check(truth, cycles=1).complaints == []


@not_on_kilted
def test_the_house_is_cleaned_with_a_recharge(
    run_world: RunWorld, run_baseline: RunBaseline, tmp_path: Path
) -> None:
    program = changed(tmp_path, EXPERIMENT / "baseline/house_cleaning.py", {"ROUNDS = 4": "ROUNDS = 1"})
    battery = {"level: 100": "level: 37.8", "charge_per_second: 5": "charge_per_second: 40"}
    world = run_world(changed(tmp_path, HOUSE, battery))
    baseline = run_baseline(program)
    assert baseline.end() == 0
    judge(checker("05_house_cleaning").check(world.close(), rounds=1), baseline)
