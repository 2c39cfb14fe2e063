"""Runs that are interrupted at random moments leave the robot still."""

import subprocess
import sys
from pathlib import Path

import pytest

TOOL = Path(__file__).parents[2] / "tools" / "interruptions.py"


@pytest.mark.slow
def test_the_last_velocity_is_zero_at_whatever_moment_a_run_is_interrupted() -> None:
    command = [sys.executable, str(TOOL), "memory", "--count", "5"]
    done = subprocess.run(command, stdout=subprocess.PIPE, text=True, timeout=300, check=False)
    assert done.returncode == 0, done.stdout
