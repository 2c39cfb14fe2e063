"""Three robots with one program, which take over for each other while they charge."""

from pathlib import Path

import pytest
from examples_lab import checker, falsified, passed, run_of, spoilt, truth_of

from jacaros.robots.world import RobotEvent
from jacaros.testing import run_project

PROJECT = "09_three_robots/three_robots.jcm"
module = checker("09_three_robots")
check = module.check


def test_all_places_are_watched_while_each_robot_charges() -> None:
    passed(check(truth_of(PROJECT)))


def test_the_output_of_the_robots() -> None:
    result = run_of(PROJECT)
    assert result.lines.count("[robot_3] battery low, robot_1 has my places") >= 1
    assert any(line.endswith(" for robot_3") for line in result.of("robot_1"))
    assert sum("my shift is over" in line for line in result.lines) == 3


def test_one_robot_alone_in_its_process(tmp_path: Path) -> None:
    alone = run_project(
        Path(checker("09_three_robots").__file__).parent / "robot_2.jcm", world="three_robots", seconds=60
    )
    assert alone.errors == []
    looks = [module.looks(alone.ground_truth, "robot_2", place) for place in module.PLACES["robot_2"]]
    assert all(looks)
    assert alone.ground_truth.odometer("robot_1") == 0


# The checker on runs that went otherwise.


@pytest.mark.slow
def test_the_checker_sees_robots_that_do_not_help(tmp_path: Path) -> None:
    project = spoilt(tmp_path, PROJECT, "Percent > 40", "Percent > 100")
    result = run_project(project, seed=0, seconds=1500)
    assert any("helped in only 0 recharges" in each for each in check(result.ground_truth).complaints)


def test_the_checker_sees_a_bump() -> None:
    bump = RobotEvent(3.0, "robot_2", "collision", 1.6, 0.0, 0.0, {"with": "robot_1", "side": "front"})
    assert check(falsified(truth_of(PROJECT), more=[bump])).complaints == [
        "a robot bumped into something (1 times)"
    ]


def test_the_checker_sees_a_robot_in_the_dock_of_another() -> None:
    def moved(event: RobotEvent) -> RobotEvent:
        if event.kind == "docked" and event.robot == "robot_2":
            return event._replace(data={**event.data, "dock": "dock_1"})
        return event

    assert "robot_2 was in dock_1" in check(falsified(truth_of(PROJECT), event=moved)).complaints
    assert len(check(truth_of(PROJECT), recharges=3).complaints) == 3
