"""A run that uses its memory up ends with an exit code and a message, and the robot stands still."""

import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from jacaros.agents.mind.actions import internal_action
from jacaros.agents.mind.actions.internal_action import InternalAction
from jacaros.runtime.mas.system import OUT_OF_MEMORY, System
from jacaros.testing import run_project

MEGABYTE = 1 << 20
DOUBLING = """
!drive. !grow([1,2,3,4,5,6,7,8]).
+!drive <- makeArtifact("motion", "ArtCmdVelAndOdometry", [], M); focus(M); moveForward(1000).
+!grow(L) <- .concat(L, L, M); !grow(M).
"""
"""Needs twice as much memory with each step."""


def explode(ctx: object) -> None:
    """Ask for more memory than there is."""
    raise MemoryError


def test_the_first_lack_of_memory_stops_the_robot_and_ends_the_run(tmp_path: Path, monkeypatch) -> None:
    monkeypatch.setitem(internal_action._declared, ".explode", InternalAction(".explode", explode))
    program = tmp_path / "driver.asl"
    program.write_text(
        """
        !go. !drive.
        +!drive <- makeArtifact("motion", "ArtCmdVelAndOdometry", [], M); focus(M); +ready; moveForward(1000).
        +!go <- .wait(ready); .wait(3000); .explode; .print(never).
        -!go <- .print(never).
        """,
        encoding="utf-8",
    )
    velocities: list[float] = []

    def listen(mas: System) -> None:
        def note(sample: Any) -> None:
            velocities.append(sample.message.linear.x)

        mas.ros.backend().subscription("/cmd_vel", "geometry_msgs/msg/Twist", note)

    result = run_project(program, seconds=60, when_started=listen)
    assert result.exit_code == OUT_OF_MEMORY
    assert result.lines == []
    assert [line.partition("\n")[0] for line in result.errors] == [
        "[driver] error: out of memory; the run ends"
    ]
    assert velocities[-2] > 0
    assert velocities[-1] == 0


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="only Linux limits the address space of a process")
def test_a_process_without_memory_ends_by_itself_with_a_message(tmp_path: Path) -> None:
    (tmp_path / "driver.asl").write_text(DOUBLING, encoding="utf-8")
    done = limited_to(400 * MEGABYTE, tmp_path, "driver.asl")
    _, messages = done.communicate(timeout=120)
    assert done.returncode == OUT_OF_MEMORY, messages
    assert "[driver] error: out of memory; the run ends" in messages
    assert "Traceback" not in messages


@pytest.mark.slow
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_goals_without_end_are_interrupted_by_a_signal(tmp_path: Path, number: signal.Signals) -> None:
    (tmp_path / "bomb.asl").write_text(
        "!g. !count(5). +!g <- !!g; !!g. +!count(0) <- .print(counted). +!count(N) <- .wait(10); !count(N - 1).",
        encoding="utf-8",
    )
    process = limited_to(2048 * MEGABYTE, tmp_path, "bomb.asl")
    assert process.stdout is not None
    assert process.stdout.readline() == "[bomb] counted\n"
    process.send_signal(number)
    _, messages = process.communicate(timeout=60)
    assert process.returncode == 128 + number, messages


def limited_to(size: int, folder: Path, program: str) -> "subprocess.Popen[str]":
    """Run a program in a process that has *size* bytes of address space (on Linux)."""
    limit = (
        f"import resource; resource.setrlimit(resource.RLIMIT_AS, ({size},) * 2); "
        if sys.platform == "linux"
        else ""
    )
    command = (
        f"{limit}from jacaros.runtime.cli.main import main; import sys; sys.exit(main(['run', '{program}']))"
    )
    return subprocess.Popen(
        [sys.executable, "-c", command], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
