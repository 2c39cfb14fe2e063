"""Agents drive a robot of the embedded world, over the ROS graph inside the process."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from jacaros.testing import RunResult, run_project

DRIVE = """
!go.
+!go <- makeArtifact("motion", "ArtCmdVelAndOdometry", [], M); focus(M); !drive; .stopMAS.
"""


@pytest.fixture
def run(tmp_path: Path) -> Callable[..., RunResult]:
    """Runs a program."""
    file = tmp_path / "driver.asl"

    def run(program: str, **options: Any) -> RunResult:
        file.write_text(program, encoding="utf-8")
        return run_project(file, seconds=120, **options)

    return run


@pytest.fixture
def drive(run) -> Callable[..., RunResult]:
    """Runs a program whose goal is ``!drive`` when it has the wheels."""
    return lambda program, **options: run(DRIVE + program, **options)


def test_a_dropped_motion_stops_the_robot_immediately(drive) -> None:
    result = drive("""
        +!drive <- !!forward; .wait(2000); .drop_intention(forward); .wait(3000).
        +!forward <- moveForward(2); .print(late).
        """)
    assert result.lines == []
    assert 0.3 < result.ground_truth.latest().x < 1.3


def test_a_suspended_motion_stops_and_continues_with_the_rest(drive) -> None:
    result = drive("""
        +!drive <- !!forward; .wait(2000); .suspend(forward); .wait(20000); .print(paused);
                   .resume(forward); .wait({+arrived}).
        +!forward <- moveForward(2); .print(arrived); +arrived.
        """)
    assert result.of("driver") == ["paused", "arrived"]
    assert result.ground_truth.latest().x == pytest.approx(2, abs=0.05)
    standing = [s.x for s in result.ground_truth.path() if 5 < s.time < 20]
    assert max(standing) - min(standing) < 0.01
    assert 0.3 < standing[0] < 1.5


def test_an_aborted_motion_fails_with_the_distance_covered(drive) -> None:
    result = drive("""
        +!drive <- !!forward; .wait(2000); abortMoving; .wait(1000).
        +!forward <- moveForward(2); .print(late).
        -!forward[env_failure_reason(aborted(D))] : D > 0.3 & D < 1.3 <- .print(aborted).
        """)
    assert result.of("driver") == ["aborted"]


def test_the_same_seed_gives_the_same_path(drive) -> None:
    program = '+!drive <- moveForward(1); rotate(90); ?odom_cmd_vel(X,Y,_); .print(X," ",Y).'
    first, second = drive(program, seed=7), drive(program, seed=7)
    assert first.lines == second.lines
    assert first.seconds == second.seconds
    assert first.ground_truth.path() == second.ground_truth.path()


def test_a_program_without_robot_starts_no_world(run) -> None:
    assert run("!go. +!go <- .stopMAS.").ground_truth is None
