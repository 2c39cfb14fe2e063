"""The examples work with the odometry noise of a real TurtleBot."""

from pathlib import Path

import pytest
from examples_lab import EXAMPLES, checker, run, spoilt

from jacaros.robots.world.files.world import load_world
from jacaros.runtime.mas.launch import load_deployment
from jacaros.testing import run_project

DRIVING = {
    "01_out_and_back": "out_and_back.jcm",
    "02_square": "square.jcm",
    "04_patrol": "patrol.jcm",
    "05_house_cleaning": "house_cleaning.jcm",
}


@pytest.mark.parametrize("folder", DRIVING)
def test_the_world_of_an_example_has_noise(folder: str) -> None:
    world = load_deployment(EXAMPLES / folder / DRIVING[folder]).world
    assert world is not None
    assert load_world(str(world)).robots[0].odometry.noisy


@pytest.mark.slow
@pytest.mark.parametrize("seed", [1, 17, 24, 31])
@pytest.mark.parametrize("folder", DRIVING)
def test_an_example_passes_its_checker_whatever_the_noise(folder: str, seed: int) -> None:
    result = run(f"{folder}/{DRIVING[folder]}", seed=seed)
    assert checker(folder).check(result.ground_truth).complaints == []


def test_by_odometry_alone_the_patrol_gets_lost(tmp_path: Path) -> None:
    project = spoilt(tmp_path, "04_patrol/patrol.jcm", "frame(map), ", "")
    result = run_project(project, seed=1, seconds=1000)
    assert checker("04_patrol").check(result.ground_truth).complaints != []
