"""Three robots share a passage that fits only one. The most urgent goes first."""

from pathlib import Path

import pytest
from examples_lab import LONGEST, checker, falsified, run, run_of, spoilt

from jacaros.robots.world import GroundTruth, PathSample, RobotEvent
from jacaros.testing import run_project

PROJECT = "11_narrow_passage/narrow_passage.jcm"
module = checker("11_narrow_passage")
check = module.check


def truth_of_example() -> GroundTruth:
    truth: GroundTruth = run_of(PROJECT).ground_truth
    return truth


def complaints_of_spoilt(folder: Path, old: str, new: str) -> list[str]:
    """Return the verdict of the checker on a run of a changed program."""
    result = run_project(spoilt(folder, PROJECT, old, new), seed=0, seconds=LONGEST)
    complaints: list[str] = check(result.ground_truth).complaints
    return complaints


@pytest.mark.parametrize(
    "seed", [0, pytest.param(1, marks=pytest.mark.slow), pytest.param(7, marks=pytest.mark.slow)]
)
def test_all_is_brought_by_one_robot_in_the_passage_at_a_time(seed: int) -> None:
    result = run_of(PROJECT) if seed == 0 else run(PROJECT, seed=seed)
    verdict = check(result.ground_truth)
    print(*verdict.lines(), sep="\n")
    assert verdict.complaints == []


def test_what_the_robots_print() -> None:
    result = run_of(PROJECT)
    for robot, what in (("robot_1", "linen"), ("robot_2", "meals"), ("robot_3", "medicine")):
        loads = [f"{what} {number} is in the ward" for number in (1, 2, 3)]
        assert result.of(robot) == [*loads, "everything is delivered"]


# The program without one of its annotations.


@pytest.mark.slow
def test_without_the_need_two_robots_meet_in_the_passage(tmp_path: Path) -> None:
    complaints = complaints_of_spoilt(tmp_path, "@cross[atomic, needs(passage)]", "@cross[atomic]")
    assert "two robots were in the passage at the same time" in complaints


@pytest.mark.slow
def test_a_crossing_that_can_be_preempted_stops_in_the_passage(tmp_path: Path) -> None:
    complaints = complaints_of_spoilt(tmp_path, "@cross[atomic, needs(passage)]", "@cross[needs(passage)]")
    assert "robot_3 brought 1 loads, not 3" in complaints


@pytest.mark.slow
def test_without_urgency_the_medicine_waits_for_its_turn(tmp_path: Path) -> None:
    complaints = complaints_of_spoilt(tmp_path, "@medicine[urgency(10)]", "@medicine")
    assert complaints == ["others went before the waiting medicine (5 times)"]


# The checker on runs that went otherwise.


def test_the_checker_sees_a_bump() -> None:
    bump = RobotEvent(3.0, "robot_2", "collision", 1.6, 0.0, 0.0, {"with": "robot_1", "side": "front"})
    assert check(falsified(truth_of_example(), more=[bump])).complaints == ["a robot bumped into something"]


def test_the_checker_sees_a_second_robot_in_the_passage() -> None:
    truth = truth_of_example()
    first = module.crossings(truth, "robot_1")[0]

    def moved(sample: PathSample) -> PathSample:
        if first.begin < sample.time < first.end and round(sample.y, 1) == module.LANES["robot_3"]:
            return sample._replace(x=0.9, y=0.0)
        return sample

    found = check(falsified(truth, sample=moved)).complaints
    assert "two robots were in the passage at the same time" in found


def test_the_checker_sees_too_few_loads() -> None:
    complaints = check(truth_of_example(), loads=4).complaints
    assert complaints == [f"robot_{number} brought 3 loads, not 4" for number in (1, 2, 3)]
