"""The checkers as programs, on ground truth files."""

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from examples_lab import EXAMPLES, run_of

from jacaros.robots.world import GroundTruth
from jacaros.robots.world.data.ground_truth import header

CHECKED = {
    "01_out_and_back": "01_out_and_back/out_and_back.jcm",
    "02_square": "02_square/square.jcm",
    "04_patrol": "04_patrol/patrol.jcm",
    "05_house_cleaning": "05_house_cleaning/house_cleaning.jcm",
}


def write(truth: GroundTruth, path: Path) -> None:
    """Write a ground truth file."""
    records = [header(truth.world, 0, 0.0)]
    for robot in truth.robots:
        samples = [*truth.path(robot), truth.latest(robot)]
        records += [{"kind": "sample", "robot": robot, **sample._asdict()} for sample in samples]
    records += [{**event._asdict(), "kind": "event", "event": event.kind} for event in truth.events]
    path.write_text("".join(json.dumps(record) + "\n" for record in records), encoding="utf-8")


def judged(folder: str, *arguments: str) -> subprocess.CompletedProcess[str]:
    """Run the checker of an example."""
    command = [sys.executable, str(EXAMPLES / folder / "check.py"), *arguments]
    return subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)


@pytest.mark.slow
@pytest.mark.parametrize("folder", CHECKED)
def test_a_good_run_passes(folder: str, tmp_path: Path) -> None:
    write(run_of(CHECKED[folder]).ground_truth, tmp_path / "truth.jsonl")
    done = judged(folder, str(tmp_path / "truth.jsonl"))
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.endswith("passed\n")


@pytest.mark.skipif(sys.platform == "win32", reason="the command is for a POSIX shell")
@pytest.mark.slow
def test_the_commands_of_the_readme_work(tmp_path: Path) -> None:
    readme = (EXAMPLES / "02_square" / "README.md").read_text(encoding="utf-8")
    (command,) = re.findall(r"^To judge a run: `(.*)`", readme, re.MULTILINE)
    shutil.copytree(EXAMPLES / "02_square", tmp_path / "square")
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    done = subprocess.run(
        ["sh", "-c", command],
        cwd=tmp_path / "square",
        env={**os.environ, "PATH": path},
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.endswith("passed\n")


@pytest.mark.slow
def test_the_run_of_another_scenario_fails(tmp_path: Path) -> None:
    write(run_of(CHECKED["01_out_and_back"]).ground_truth, tmp_path / "truth.jsonl")
    done = judged("02_square", str(tmp_path / "truth.jsonl"))
    assert done.returncode == 1
    assert "FAILED" in done.stdout


@pytest.mark.slow
def test_the_output_of_the_battery_is_judged(tmp_path: Path) -> None:
    result = run_of("03_fake_battery/robot_battery.jcm")
    (tmp_path / "output.txt").write_text("\n".join(result.lines) + "\n", encoding="utf-8")
    write(result.ground_truth, tmp_path / "truth.jsonl")
    lines = "\n".join(run_of("03_fake_battery/fake_battery.jcm").lines)
    (tmp_path / "timer.txt").write_text(lines + "\n", encoding="utf-8")
    assert judged("03_fake_battery", str(tmp_path / "timer.txt")).returncode == 0
    assert (
        judged("03_fake_battery", str(tmp_path / "output.txt"), str(tmp_path / "truth.jsonl")).returncode == 0
    )


@pytest.mark.slow
def test_wrong_usage_is_reported(tmp_path: Path) -> None:
    assert judged("02_square").returncode == 2
    assert judged("03_fake_battery").returncode == 2
    missing = judged("02_square", str(tmp_path / "missing"))
    assert (missing.returncode, missing.stderr) == (1, "")
