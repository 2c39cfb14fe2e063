"""A run whose output is not read: the agents continue."""

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from jacaros.look.records.recording import Recording

JACAROS = [sys.executable, "-m", "jacaros"]

pytestmark = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="asks Linux for its pipes")

FLOOD = """
// jacaros: ignore-file loop-without-wait
!count(0).
!work.
+!count(N) <- .print("line ", N, " of a text that fills the pipe soon"); !count(N + 1).
+!work <- .wait(300); .wait(300); .stopMAS(0, 7).
"""

THREE = """
!go.
+!go <- .print("one"); .wait(10); .print("two"); .stopMAS.
-!go <- .stopMAS(0, 3).
"""


def run(folder: Path, program: str, *arguments: str, **how: object) -> "subprocess.CompletedProcess[bytes]":
    (folder / "agent.asl").write_text(program, encoding="utf-8")
    command = [*JACAROS, "run", str(folder / "agent.asl"), *arguments]
    return subprocess.run(command, stderr=subprocess.PIPE, timeout=60, check=False, **how)  # type: ignore[call-overload, no-any-return]


@pytest.fixture
def unread() -> Iterator[int]:
    """A pipe without a reader."""
    reader, writer = os.pipe()
    yield writer
    os.close(reader)
    os.close(writer)


def in_shell(folder: Path, redirections: str) -> "subprocess.CompletedProcess[bytes]":
    """Run the program of a folder with redirected outputs."""
    command = f'"{sys.executable}" -m jacaros run "{folder}/agent.asl" {redirections}'
    return subprocess.run(command, shell=True, stderr=subprocess.PIPE, timeout=60, check=False)


def test_agents_continue_when_their_output_is_not_read(tmp_path: Path, unread: int) -> None:
    ended = run(tmp_path, FLOOD, stdout=unread)
    assert ended.returncode == 7
    assert b"lines could not be written to standard output" in ended.stderr


@pytest.mark.parametrize("target", ["/dev/full", "&-"])
def test_output_that_cannot_be_written_fails_no_step(tmp_path: Path, target: str) -> None:
    (tmp_path / "agent.asl").write_text(THREE, encoding="utf-8")
    ended = in_shell(tmp_path, f"--clock fast >{target}")
    assert ended.returncode == 0
    assert ended.stderr.count(b"warning: cannot write to standard output: ") == 1


BELL = """
import logging
import sys
from jacaros.artifacts import Artifact, operation

class Bell(Artifact):
    @operation
    def ring(self, times: int) -> None:
        for number in range(times):
            print("ring" * (1 if times < 9 else 30), number)
        print("never ended", end="")

    @operation
    def complain(self) -> None:
        logging.getLogger("bell").warning("a crack")
        sys.stderr.write("and rust\\n")
"""

RING = """
!go.
+!go
  <- makeArtifact(bell, "Bell", [], Id);
     focus(Id);
     .print("before");
     ring(TIMES);
     complain;
     .print("after");
     .stopMAS(0, 7).
-!go <- .stopMAS(0, 3).
"""


def ring(folder: Path, times: int, **how: object) -> "subprocess.CompletedProcess[bytes]":
    (folder / "artifacts.py").write_text(BELL, encoding="utf-8")
    return run(folder, RING.replace("TIMES", str(times)), **how)


def test_what_artifacts_print_stands_between_the_lines_of_agents(tmp_path: Path) -> None:
    ended = ring(tmp_path, 2, stdout=subprocess.PIPE)
    assert ended.returncode == 7
    assert ended.stdout == b"[agent] before\nring 0\nring 1\nnever ended[agent] after\n"
    assert ended.stderr.endswith(b"a crack\nand rust\n")


def test_an_artifact_can_print_without_a_reader(tmp_path: Path, unread: int) -> None:
    ended = ring(tmp_path, 90_000, stdout=unread)
    assert ended.returncode == 7
    assert b"lines could not be written to standard output" in ended.stderr


@pytest.mark.parametrize("target", [">/dev/full", ">&-", ">/dev/full 2>/dev/full", ">&- 2>&-"])
def test_what_an_artifact_prints_on_a_full_disk_fails_no_operation(tmp_path: Path, target: str) -> None:
    (tmp_path / "artifacts.py").write_text(BELL, encoding="utf-8")
    (tmp_path / "agent.asl").write_text(RING.replace("TIMES", "2"), encoding="utf-8")
    ended = in_shell(tmp_path, target)
    assert ended.returncode == 7
    assert ended.stderr.count(b"warning: cannot write to standard output: ") == ("2>" not in target)


def test_a_run_on_the_virtual_clock_ends_with_its_reader(tmp_path: Path) -> None:
    reader, writer = os.pipe()
    os.close(reader)
    ended = run(tmp_path, FLOOD.replace("!work.", "", 1), "--clock", "fast", stdout=writer)
    os.close(writer)
    assert (ended.returncode, ended.stderr) == (141, b"")


TALK = '!talk. +!talk <- .print("alive"); .wait(20); !talk.'


@pytest.mark.parametrize("name", ["SIGKILL", "SIGHUP", "SIGTERM"])
def test_a_recording_survives_signals(tmp_path: Path, name: str) -> None:
    (tmp_path / "agent.asl").write_text(TALK, encoding="utf-8")
    record, page = tmp_path / "run.jsonl", tmp_path / "run.html"
    call = [*JACAROS, "run", str(tmp_path / "agent.asl"), "--record", str(record), "--replay", str(page)]
    with subprocess.Popen(call, stdout=subprocess.PIPE) as run:
        assert run.stdout is not None
        while b"alive" not in (record.read_bytes() if record.exists() else b""):
            run.stdout.readline()
        run.send_signal(getattr(signal, name))
        run.stdout.read()
    assert Recording.read(record).texts[0][1:] == ("agent", "alive")
    assert page.exists() == (name != "SIGKILL")


def test_a_recording_on_a_full_disk_does_not_touch_the_goals(tmp_path: Path) -> None:
    ended = run(tmp_path, THREE, "--clock", "fast", "--record", "/dev/full", stdout=subprocess.PIPE)
    assert (ended.returncode, ended.stdout) == (0, b"[agent] one\n[agent] two\n")
    assert b"Traceback" not in ended.stderr
    assert ended.stderr.count(b"warning: cannot write to /dev/full: No space left on device") == 1
