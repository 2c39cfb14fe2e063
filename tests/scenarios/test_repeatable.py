"""Two runs of an example with the same seed are identical."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from examples_lab import EXAMPLES, PROJECTS, run, run_of


@pytest.mark.slow
@pytest.mark.parametrize("project", PROJECTS)
def test_two_runs_print_and_move_the_same(project: str) -> None:
    first, second = run_of(project), run(project)
    assert second.lines == first.lines
    assert second.seconds == first.seconds
    if first.ground_truth is not None:
        assert second.ground_truth.digest() == first.ground_truth.digest()


@pytest.mark.slow
def test_two_processes_print_and_move_the_same(tmp_path: Path) -> None:
    told = []
    for number in (1, 2):
        truth = tmp_path / f"truth{number}.jsonl"
        command = [
            sys.executable,
            "-m",
            "jacaros",
            "run",
            str(EXAMPLES / "05_house_cleaning/house_cleaning.jcm"),
        ]
        command += ["--clock", "fast", "--seed", "1", "--ground-truth", str(truth)]
        # Another hash seed: the order of sets must not matter.
        environment = {**os.environ, "PYTHONHASHSEED": str(number)}
        done = subprocess.run(
            command, capture_output=True, text=True, timeout=120, check=True, env=environment
        )
        told.append((done.stdout, done.stderr, truth.read_text(encoding="utf-8")))
    assert told[0] == told[1]
    assert told[0][1] == ""
