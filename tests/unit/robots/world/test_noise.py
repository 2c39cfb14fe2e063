"""The noise of a world: as its file says, switched off and on, or scaled."""

from collections.abc import Callable
from pathlib import Path

import pytest

from jacaros.robots.world import World
from jacaros.robots.world.data.robot import SLIPPING, OdometrySettings
from jacaros.runtime.mas.options import RunOptions
from jacaros.testing import run_project

NOISY = "robots: [{odometry: {origin: start, noise_per_metre: 0.03, noise_degrees_per_turn: 1}, laser: {noise: 0.02}}]\n\n"
EXACT = "robots: [{name: turtlebot}]\n\n"


def settings(text: str, noise: float | None) -> tuple[OdometrySettings, float]:
    robot = World.load(text, noise=noise).description.robots[0]
    return robot.odometry, robot.laser.noise


def test_without_a_factor_the_noise_is_that_of_the_file() -> None:
    assert settings(NOISY, None) == settings(NOISY, 1.0)
    assert not settings(EXACT, None)[0].noisy


def test_noise_can_be_switched_off() -> None:
    assert settings(NOISY, 0.0) == (OdometrySettings(from_start=True), 0.0)
    assert settings("house", 0.0) == (OdometrySettings(), 0.0)


def test_a_factor_scales_the_noise_of_the_file() -> None:
    odometry, laser = settings(NOISY, 0.5)
    whole, _ = settings(NOISY, None)
    assert odometry.per_metre == 0.5 * whole.per_metre == 0.015
    assert odometry.per_radian == 0.5 * whole.per_radian > 0.0
    assert laser == 0.01


def test_a_robot_without_noise_gets_that_of_slipping_wheels() -> None:
    assert settings(EXACT, 1.0) == (SLIPPING, 0.0)
    # That of the shipped worlds, which say it in a file.
    assert settings("house", None)[0] == SLIPPING


DRIVE = """
{ include("$jacaros/artifacts.asl") }
!start.
+!start <- !use_artifact("wheels", "ArtCmdVel"); moveForward(2); .stopMAS.
"""


Miss = Callable[..., float]


@pytest.fixture
def off_course(tmp_path: Path) -> Miss:
    """Metres by which a robot misses the point 2 m ahead, with the options of a run."""
    (tmp_path / "drive.asl").write_text(DRIVE, encoding="utf-8")

    def miss(**options: object) -> float:
        result = run_project(tmp_path / "drive.asl", seconds=60.0, seed=2, **options)
        pose = result.ground_truth.pose()
        return float(((pose.x - 2.0) ** 2 + pose.y**2) ** 0.5)

    return miss


def test_a_run_in_which_no_world_is_named_has_an_exact_floor(off_course: Miss) -> None:
    assert off_course() < 0.006
    assert off_course(noise=1.0) > 0.01


@pytest.mark.parametrize("world", ["empty", "house"])
def test_a_world_that_is_named_keeps_its_noise_unless_it_is_switched_off(
    world: str, off_course: Miss
) -> None:
    assert off_course(world=world) > 0.01
    assert off_course(world=world, noise=0.0) < 0.006


def test_noise_is_a_field_of_the_options_of_a_run() -> None:
    assert RunOptions().noise is None
