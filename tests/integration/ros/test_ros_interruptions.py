"""Runs on real graphs that are interrupted at random moments leave the robot still and their goals cancelled."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

TOOL = Path(__file__).parents[3] / "tools" / "interruptions.py"


def interrupt(kind: str, environment: dict[str, str], *options: str) -> None:
    """Interrupt a few runs; a robot of the tool's own, written with the client library alone, judges."""
    done = subprocess.run(
        [sys.executable, str(TOOL), kind, *options],
        stdout=subprocess.PIPE,
        text=True,
        timeout=300,
        check=False,
        env=os.environ | environment,
    )
    assert done.returncode == 0, done.stdout


@pytest.mark.parametrize("busy", ["0", "2"])
def test_the_last_velocity_is_zero_at_whatever_moment_a_run_is_interrupted(kind, environment, busy) -> None:
    interrupt(kind, environment, "--count", "3", "--program", "motion,rolling,pushing", "--busy", busy)


@pytest.mark.only("ros2")
def test_goals_are_cancelled_at_whatever_moment_a_run_is_interrupted(kind: str, environment) -> None:
    interrupt(kind, environment, "--count", "2", "--program", "goal", "--busy", "1")
