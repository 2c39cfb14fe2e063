"""A goal that repeats without waiting or acting is reported once; long computations are not."""

from pathlib import Path

import pytest

from jacaros.runtime.mas.scheduler import Scheduler
from jacaros.testing import run_project


@pytest.fixture(autouse=True)
def soon(monkeypatch: pytest.MonkeyPatch) -> None:
    """Look at a busy agent after 500 cycles."""
    monkeypatch.setattr(Scheduler, "TURNS_UNTIL_LOOK", 10)


@pytest.mark.parametrize("loop", ["!go", "!!go", "while (true) { X = 1 }"])
def test_a_loop_is_reported_once_with_its_plan(tmp_path: Path, loop: str) -> None:
    (line,) = [each for each in _errors(tmp_path, f"!go.\n+!go <- {loop}.") if "without waiting or" in each]
    assert line.startswith("[a] warning: goal `!go` (")
    assert "a.asl:2) repeats without waiting or acting: " in line
    assert "\n  help: wait in the loop" in line


@pytest.mark.parametrize(
    "program",
    [
        "!count(0). +!count(N) <- !count(N + 1).",
        "!go. +!go <- .wait(1); !go.",
        "!go. +!go <- for (.range(I, 1, 300)) { X = I }; .wait(1); !go.",
    ],
    ids=["a computation", "a wait", "a long turn before a wait"],
)
def test_what_ends_or_waits_is_not_reported(tmp_path: Path, program: str) -> None:
    assert [each for each in _errors(tmp_path, program) if "without waiting or" in each] == []


def _errors(folder: Path, program: str) -> list[str]:
    """Return what a run of 50,000 cycles logs."""
    path = folder / "a.asl"
    path.write_text(program, encoding="utf-8")
    return run_project(path, seconds=0.005).errors
