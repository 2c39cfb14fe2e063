"""A robot all of whose messages are late, by faults of the embedded world; judged by the ground truth."""

import math
import re
from pathlib import Path

import pytest
from click.testing import CliRunner

from jacaros.runtime.cli.main import call
from jacaros.runtime.cli.recordings import why
from jacaros.testing import run_project

PROGRAMS = Path(__file__).parent / "programs"
FAULTS = """
faults:
  commands: {kind: delayed, topic: /cmd_vel, seconds: 0.13, jitter: 0.02, at: 0}
  odometry: {kind: delayed, topic: /odom, seconds: 0.13, jitter: 0.02, at: 0}
  frames: {kind: delayed, topic: /tf, seconds: 0.13, jitter: 0.02, at: 0}
"""


@pytest.mark.parametrize("seed", range(5))
def test_a_robot_whose_messages_are_late_arrives(seed: int, tmp_path: Path) -> None:
    faults = tmp_path / "late.yaml"
    faults.write_text(FAULTS, encoding="utf-8")
    result = run_project(
        PROGRAMS / "late.asl", seed=seed, world="empty", noise=0.0, faults=str(faults), seconds=60
    )
    assert (result.exit_code, result.errors) == (0, [])
    assert result.lines == ["[late] forward", "[late] turned"]
    assert result.ground_truth is not None
    last = result.ground_truth.latest()
    assert math.hypot(last.x - 1.0, last.y) <= 0.05
    assert abs(math.degrees(last.yaw) - 90.0) <= 2.0
    begun = {event.data["fault"] for event in result.ground_truth.events_of("fault")}
    assert begun == {"commands", "odometry", "frames"}


def test_why_tells_what_was_measured_of_a_robot_at_a_wall(tmp_path: Path) -> None:
    run, world = tmp_path / "run.jsonl", str(PROGRAMS / "closet.yaml")
    options = ("--world", world, "--clock", "fast", "--for", "20", "--quiet", "--record", str(run))
    assert call(["run", str(PROGRAMS / "wall.asl"), *options]) == 0
    asked = CliRunner().invoke(why, [str(run), "!forth"], catch_exceptions=False)
    [failed] = [line for line in asked.stdout.splitlines() if "!forth failed" in line]
    assert re.search(r"the robot is stuck \(measured: \d\.\d\d s of delay, [\d.]+ m/s2\)", failed), failed
    assert "env_failure_reason(blocked(" in asked.stdout
