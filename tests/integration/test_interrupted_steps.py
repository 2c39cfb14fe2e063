"""Ctrl-C and SIGTERM end a run in the middle of a step that never ends, and leave the robot still."""

import signal
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from subprocess import PIPE

import pytest

LONG = "warning: a step has been running for more than 2 seconds"
ENDLESS = {
    "body": "!g. +!g <- .print(begun); ?(.range(I, 1, 1e15) & I < 0).",
    "context": "!g. +!g <- .print(begun); !find(3).\n+!find(X) : .range(I, X, 1e15) & I < 0 <- .print(found).",
    "rule": "p(N) :- N > 0 & p(N - 1) & q.\np(N) :- N > 0 & p(N - 1).\np(0).\n!g. +!g <- .print(begun); ?p(200) & 1 > 2.",
    "findall": "!g. +!g <- .print(begun); .findall(I, .range(I, 1, 1e15) & I < 0, L).",
    "python": "!g. +!g <- .print(begun); tools.stay(1).",
    "sleeping": "!g. +!g <- .print(begun); tools.sleep_on(1).",
    "operation": '!g. +!g <- .print(begun); makeArtifact("a", "artifacts.Endless", [], A); focus(A); spin.',
    "coroutine": '!g. +!g <- .print(begun); makeArtifact("a", "artifacts.Endless", [], A); focus(A); later.',
    "regex": f'!g. +!g <- .print(begun); .replace("{"a" * 60}c", "(a+)+b", "", X).',
}
"""What is printed just before the step that never ends."""

TOOLS = """
import time
from jacaros import internal_action

@internal_action
def stay(n: float) -> None:
    while True:
        try:
            n += 1
        except Exception:
            pass

@internal_action
def sleep_on(n: float) -> None:
    time.sleep(1000)
"""
ARTIFACTS = """
import asyncio
from jacaros.robots.kit.ros_artifact import RosArtifact
from jacaros.artifacts import Artifact, operation

class Endless(Artifact):
    @operation
    def spin(self):
        while True:
            pass

    @operation
    async def later(self):
        await self.sleep(0.01)
        while True:
            pass

    @operation
    async def thread(self):
        await self.step(asyncio.to_thread(self.stay))

    def stay(self):
        print("[bob] begun", flush=True)
        while True:
            pass

class Wheels(RosArtifact):
    def open(self):
        self.subscription("cmd_vel", "geometry_msgs/msg/Twist", self.take)

    def take(self, sample):
        with open("velocities.txt", "a") as file:
            file.write(f"{sample.message.linear.x}\\n")
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "tools.py").write_text(TOOLS, encoding="utf-8")
    (tmp_path / "artifacts.py").write_text(ARTIFACTS, encoding="utf-8")
    return tmp_path


def command(folder: Path, program: str, *options: str) -> list[str]:
    (folder / "bob.asl").write_text(program, encoding="utf-8")
    return [sys.executable, "-m", "jacaros", "run", "bob.asl", *options]


def interrupted(
    folder: Path,
    program: str,
    number: signal.Signals = signal.SIGINT,
    options: Sequence[str] = (),
    in_the_step: bool = False,
) -> tuple[int, str, str]:
    """Exit code, further output and errors of a run that gets one signal when it has printed ``begun``.

    The step begins a moment later. With *in_the_step*, the signal arrives after the warning about the step.
    """
    with subprocess.Popen(
        command(folder, program, *options), stdout=PIPE, stderr=PIPE, text=True, cwd=folder
    ) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "[bob] begun\n"
        if in_the_step:
            assert process.stderr is not None
            assert process.stderr.readline().startswith(LONG)
        process.send_signal(number)
        try:
            output, errors = process.communicate(timeout=120)
        finally:
            process.kill()
    return process.returncode, output, errors


@pytest.mark.slow
@pytest.mark.parametrize("kind", ENDLESS)
def test_one_ctrl_c_ends_a_step_without_end(folder: Path, kind: str) -> None:
    code, output, errors = interrupted(folder, ENDLESS[kind])
    assert (code, output) == (130, "")
    assert "Traceback" not in errors
    assert "never retrieved" not in errors


@pytest.mark.slow
def test_sigterm_does_so_too_and_on_the_virtual_clock(folder: Path) -> None:
    code, _, errors = interrupted(
        folder, ENDLESS["context"], signal.SIGTERM, ["--clock", "fast"], in_the_step=True
    )
    assert code == 143
    assert "interrupted in the middle of a step: agent bob, plan +!find(X) (bob.asl:2)" in errors


@pytest.mark.slow
def test_the_interruption_is_logged(folder: Path) -> None:
    program = "!g.\n+!g\n  <- .print(begun);\n     tools.stay(1)."
    _, _, errors = interrupted(folder, program, in_the_step=True)
    place = f"bob.asl:4, in {folder / 'tools.py'}:"
    assert f"interrupted in the middle of a step: agent bob, plan +!g ({place}" in errors


@pytest.mark.slow
def test_a_thread_that_does_not_return_does_not_hold_an_interruption_up(folder: Path) -> None:
    program = '!g. +!g <- makeArtifact("a", "artifacts.Endless", [], A); focus(A); thread.'
    code, _, errors = interrupted(folder, program)
    assert code == 130
    assert errors == ""


@pytest.mark.slow
@pytest.mark.parametrize("clock", ["real", "fast"])
def test_a_thread_that_does_not_return_does_not_hold_the_end_up(folder: Path, clock: str) -> None:
    program = """!g. !end.
        +!g <- makeArtifact("a", "artifacts.Endless", [], A); focus(A); +ready; thread.
        +!end : ready <- .stopMAS(0, 3).
        +!end <- !end.  // jacaros: allow loop-without-wait"""
    call = command(folder, program, "--clock", clock)
    ended = subprocess.run(call, cwd=folder, capture_output=True, text=True, timeout=60, check=False)
    assert ended.returncode == 3
    assert ended.stderr == ""


@pytest.mark.slow
def test_an_import_leaves_nothing_behind(folder: Path) -> None:
    (folder / "artifacts.py").write_text("import time\nprint('[bob] begun', flush=True)\ntime.sleep(60)\n")
    code, _, errors = interrupted(folder, '!g. +!g <- makeArtifact("a", "artifacts.Slow", [], _).')
    assert code == 130
    assert errors == ""


@pytest.mark.slow
@pytest.mark.parametrize("options", [(), ("--clock", "fast")])
def test_the_robot_is_left_still(folder: Path, options: tuple[str, ...]) -> None:
    program = """
        !g.
        +!g <- makeArtifact("m", "ArtCmdVelAndOdometry", [], M); focus(M);
               makeArtifact("w", "artifacts.Wheels", []); !!drive; .wait(500); .print(begun);
               ?(.range(I, 1, 1e15) & I < 0).
        +!drive <- moveForward(1000).
        """
    code, _, _ = interrupted(folder, program, options=options)
    assert code == 130
    velocities = [float(line) for line in (folder / "velocities.txt").read_text().split()]
    assert velocities[-1] == 0
    while velocities and velocities[-1] == 0:  # a publisher that left late is followed by a second one
        del velocities[-1]
    assert len(velocities) > 3


@pytest.mark.slow
def test_a_recording_is_finished(folder: Path) -> None:
    interrupted(folder, ENDLESS["body"], options=["--replay", "run.html", "--record", "run.jsonl"])
    assert (folder / "run.html").stat().st_size > 1000
    assert "begun" in (folder / "run.jsonl").read_text()


@pytest.mark.slow
def test_a_step_that_blocks_all_agents_is_logged(folder: Path) -> None:
    call = command(folder, ENDLESS["context"])
    with subprocess.Popen(call, stderr=PIPE, text=True, cwd=folder) as process:
        assert process.stderr is not None
        told = process.stderr.readline()
        process.kill()
    assert told == f"{LONG} and blocks all agents: agent bob, plan +!find(X) (bob.asl:2)\n"
