"""The example without a robot: Mastermind, with Python code of the project."""

import subprocess
import sys
from pathlib import Path

import pytest
from examples_lab import EXAMPLES, checker

from jacaros.testing import run_project

PROJECT = EXAMPLES / "06_mastermind" / "mastermind.mas2j"
check = checker("06_mastermind").check


@pytest.mark.parametrize("seed", [0, 3, 8])
def test_the_code_is_broken_by_fair_guesses(seed: int) -> None:
    result = run_project(PROJECT, seed=seed, seconds=600)
    assert (result.errors, result.exit_code) == ([], 0)
    verdict = check(result.lines)
    assert verdict.complaints == []
    assert result.seconds == 2 * verdict.measured["guesses"]


def test_the_checker_sees_an_unfair_guess_a_wrong_answer_and_a_game_without_end(tmp_path: Path) -> None:
    lines = run_project(PROJECT, seed=3, seconds=600).lines
    assert not check(lines[:-1]).passed
    assert not check([line.replace("1 right, 1", "1 right, 2") for line in lines]).passed
    assert not check([line.replace("timeout", "secret") for line in lines]).passed
    (tmp_path / "output.txt").write_text("\n".join(lines[:-1]), encoding="utf-8")
    command = [sys.executable, str(PROJECT.with_name("check.py")), str(tmp_path / "output.txt")]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert (done.returncode, done.stderr) == (1, "")
    assert "FAILED: the code was not found" in done.stdout
