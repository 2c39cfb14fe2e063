"""The command on a simulated Windows (`simulated_windows.py`), and what depends on the system."""

import json
import os
import signal
import subprocess
import sys
import time
import urllib.error
import urllib.request
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from queue import SimpleQueue
from threading import Thread
from typing import Any

import pytest

from jacaros.runtime.files.texts import shown_from
from jacaros.runtime.output import PLAIN

ROOT = Path(__file__).parents[3]
SIMULATION = Path(__file__).with_name("simulated_windows.py")
SIGBREAK = 21
COMMAND = (sys.executable, "-X", "warn_default_encoding", str(SIMULATION))
MAIN_STACK = 1024
"""Kilobytes of the main thread's stack on Windows."""
SPEED = 0.7
"""Metres per second that the robot does not exceed."""
STOPPING = 0.6
"""Seconds after a signal in which the robot must have stopped."""
PATIENCE = 40.0
"""Seconds after which a process hangs."""

DRIVES = """\
{ include("$jacaros/artifacts.asl") }
!go.
+!go <- !use_artifact("wheels", "ArtCmdVel"); .print("started → ü"); moveForward(0.3); .print("arrived ☻"); .stopMAS.
"""
DRIVES_FAR = """\
{ include("$jacaros/artifacts.asl") }
!go.
+!go <- !use_artifact("wheels", "ArtCmdVel"); !!drive; .wait(1000); .print("drives").
+!drive <- moveForward(30).
"""
NEVER_ENDS = """\
!go.
+!go <- .print("started"); ?(.range(I, 1, 1e15) & I < 0).
"""
WAITS = """\
!go.
+!go <- .print("started"); .wait("+never").
"""

simulated = pytest.mark.skipif(
    sys.platform != "linux",
    reason="the simulation takes away what Linux has; the public CI has the true Windows",
)


def started(*arguments: str, folder: Path) -> "subprocess.Popen[str]":
    return subprocess.Popen(
        ["sh", "-c", f'ulimit -s {MAIN_STACK} && exec "$@"', "sh", *COMMAND, *arguments],
        cwd=folder,
        env={**os.environ, "PYTHONIOENCODING": "cp1252", "PYTHONUNBUFFERED": "1", "JACAROS_CACHE": "0"},
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        encoding="cp1252",
    )


def ended(*arguments: str, folder: Path, code: int = 0) -> tuple[str, str]:
    """Run a command to its end; what it wrote on both outputs."""
    with started(*arguments, folder=folder) as process:
        try:
            output, errors = process.communicate(timeout=PATIENCE)
        finally:
            process.kill()
    assert process.returncode == code, (output, errors)
    return output, errors


@pytest.fixture
def program(tmp_path: Path) -> Callable[[str], str]:
    def write(text: str) -> str:
        (tmp_path / "robot.asl").write_text(text, encoding="utf-8")
        return "robot.asl"

    return write


@contextmanager
def running(*arguments: str, folder: Path) -> Iterator[tuple["subprocess.Popen[str]", SimpleQueue[str]]]:
    """A command that continues, and its lines on both outputs."""
    lines: SimpleQueue[str] = SimpleQueue()
    with started(*arguments, folder=folder) as process:

        def read(stream: Iterator[str]) -> None:
            for line in stream:
                lines.put(line)

        readers = [Thread(target=read, args=(each,)) for each in (process.stdout, process.stderr)]
        for reader in readers:
            reader.start()
        try:
            yield process, lines
        finally:
            process.kill()
            for reader in readers:
                reader.join()


def next_with(lines: SimpleQueue[str], part: str) -> str:
    while part not in (line := lines.get(timeout=PATIENCE)):
        pass
    return line


def truth(file: Path) -> list[dict[str, Any]]:
    return [json.loads(line) for line in file.read_bytes().split(b"\n") if line]


# ---- the command on a simulated Windows


@simulated
def test_a_robot_drives_and_the_console_lacks_characters(
    tmp_path: Path, program: Callable[[str], str]
) -> None:
    outputs = ("--record", "run.jsonl", "--ground-truth", "truth.jsonl", "--replay", "run.html")
    output, errors = ended("run", program(DRIVES), "--clock", "fast", *outputs, folder=tmp_path)
    assert output == "[robot] started > ü\n[robot] arrived @\n"
    assert errors == ""
    assert truth(tmp_path / "truth.jsonl")[-1]["kind"] == "end"
    assert (tmp_path / "run.html").read_text(encoding="utf-8").startswith("<!doctype html>")
    printed = [each["text"] for each in truth(tmp_path / "run.jsonl") if each["kind"] == "text"]
    assert printed == ["started → ü", "arrived ☻"]
    why, _ = ended("why", "run.jsonl", "robot", "!go", folder=tmp_path)
    assert "(robot.asl:3)" in why


@simulated
def test_programs_are_checked_tested_and_formatted(tmp_path: Path) -> None:
    (tmp_path / "tests").mkdir()
    (tmp_path / "tests" / "sum_test.asl").write_text(
        "@[test]\n+!adds <- X = 1 + 1; !assert_equals(2, X).\n", encoding="utf-8"
    )
    ugly = tmp_path / "ugly.asl"
    ugly.write_bytes('!go.\r\n+!go<-.print("→").\r\n'.encode())
    (tmp_path / "tests" / "wrong.asl").write_text("!go.\n+!go <- .prnt(1).\n", encoding="utf-8")
    output, _ = ended("check", "tests/wrong.asl", "--strict", folder=tmp_path, code=1)
    assert output.startswith("tests/wrong.asl:2:9: warning: ")
    output, _ = ended("test", "tests", folder=tmp_path)
    assert "tests/sum_test.asl\n  ok      adds\n" in output
    ended("fmt", "ugly.asl", folder=tmp_path)
    assert ugly.read_bytes().startswith('!go.\n+!go <- .print("→").\n'.encode())
    _, errors = ended("run", "tests", folder=tmp_path, code=2)
    assert "`tests` is a folder" in errors


@simulated
def test_the_world_runs_as_a_process_of_its_own(tmp_path: Path) -> None:
    arguments = "sim patrol --ros memory --clock fast --for 5 --ground-truth t.jsonl"
    output, _ = ended(*arguments.split(), folder=tmp_path)
    assert output == "running the world patrol with turtlebot; press Ctrl+C to stop\n"
    assert truth(tmp_path / "t.jsonl")[-1] == {"kind": "end", "time": 5.0}
    output, _ = ended("ros", "list", folder=tmp_path)
    assert "topic /cmd_vel geometry_msgs/msg/Twist" in output
    picture, _ = ended("world", "show", "patrol", folder=tmp_path)
    assert "::::" in picture  # in place of dots in braille


@simulated
@pytest.mark.parametrize(
    ("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143), (SIGBREAK, 149)], ids=str
)
def test_signals_end_a_run_and_the_robot_stops(
    tmp_path: Path, program: Callable[[str], str], number: int, code: int
) -> None:
    arguments = ("run", program(DRIVES_FAR), "--ground-truth", "truth.jsonl")
    with running(*arguments, folder=tmp_path) as (process, lines):
        next_with(lines, "drives")
        at = time.time()
        process.send_signal(number)
        assert process.wait(PATIENCE) == code
    world, *records, end = truth(tmp_path / "truth.jsonl")
    assert end["kind"] == "end"
    at -= world["epoch"]
    samples = [each for each in records if each["kind"] == "sample"]
    before = [each for each in samples if each["time"] <= at][-1]
    assert samples[-1]["odometer"] > 0.0
    after = samples[-1]["odometer"] - before["odometer"]
    assert after <= SPEED * (at - before["time"] + STOPPING)


@simulated
@pytest.mark.parametrize("clock", ["real", "fast"])
def test_a_step_without_end_is_interrupted(tmp_path: Path, program: Callable[[str], str], clock: str) -> None:
    with running("run", program(NEVER_ENDS), "--clock", clock, folder=tmp_path) as (process, lines):
        next_with(lines, "started")
        process.send_signal(signal.SIGINT)
        next_with(lines, "interrupted in the middle of a step")
        assert process.wait(PATIENCE) == 130


@simulated
@pytest.mark.parametrize("clock", ["real", "fast"])
def test_a_run_that_waits_serves_its_page_and_ends_at_a_signal(
    tmp_path: Path, program: Callable[[str], str], clock: str
) -> None:
    view = ("--view", "--view-token", "a-token-that-tests-know")
    with running("run", program(WAITS), "--clock", clock, *view, folder=tmp_path) as (process, lines):
        address = next_with(lines, "view: ").split()[1]
        with urllib.request.urlopen(address, timeout=PATIENCE) as page:
            assert page.read().startswith(b"<!doctype html>")
        with pytest.raises(urllib.error.HTTPError):
            urllib.request.urlopen(address.replace("that-tests-know", "of-no-user-here"), timeout=PATIENCE)
        process.send_signal(signal.SIGINT)
        assert process.wait(PATIENCE) == 130


@simulated
def test_the_simulator_ends_at_a_signal(tmp_path: Path) -> None:
    arguments = ("sim", "patrol", "--ros", "memory", "--ground-truth", "truth.jsonl")
    with running(*arguments, folder=tmp_path) as (process, lines):
        next_with(lines, "running the world patrol")
        process.send_signal(signal.SIGINT)
        assert process.wait(PATIENCE) == 0
    assert truth(tmp_path / "truth.jsonl")[-1]["kind"] == "end"


@simulated
def test_deep_terms_fit_a_small_stack(tmp_path: Path, program: Callable[[str], str]) -> None:
    deep = """\
!go(0, [], 150).
!go(0, [], 5000).
+!go(N, L, N) <- +deep(L); ?deep(M); if (M == L) { .length(M, K); .print("length ", K) }.
+!go(N, L, D) <- !go(N + 1, [L], D).
-!go(_, _, _)[error(E)] <- .print(E).
"""
    output, _ = ended("run", program(deep), "--clock", "fast", "--until-idle", folder=tmp_path)
    assert sorted(output.splitlines()) == ["[robot] length 1", "[robot] too_deep"]
    brackets = "!go.\n+!go <- .print(" + "[" * 3000 + "]" * 3000 + ").\n"
    output, _ = ended("check", program(brackets), folder=tmp_path, code=1)
    assert "robot.asl:2:" in output
    assert "nested" in output


@simulated
def test_a_guard_says_what_it_needs(tmp_path: Path, program: Callable[[str], str]) -> None:
    _, errors = ended("guard", "robot", "--ros", "rosbridge", folder=tmp_path, code=2)
    assert errors == (
        "error: a guard needs Unix sockets, which Python does not have on Windows\n"
        "  = help: run the agents in WSL 2, on Linux or on macOS, or start them without --guard\n"
    )


# ---- what depends on the system


def test_paths_in_files_have_forward_slashes() -> None:
    assert shown_from(Path("/robots/worlds"), Path("/robots/maps/house.pgm")) == "../maps/house.pgm"
    assert shown_from(Path("/robots/worlds"), Path("/robots/worlds/a/b.pgm")) == "a/b.pgm"


def test_characters_that_a_console_lacks_are_replaced() -> None:
    assert "→ ü ☻ ⣿".encode("cp1252", PLAIN).decode("cp1252") == "> ü @ :"
    assert "20 °C, 3 m/s², … 漢".encode("ascii", PLAIN) == b"20 C, 3 m/s2, ... \\u6f22"
    with pytest.raises(UnicodeDecodeError):
        b"\xff".decode("utf-8", PLAIN)


def test_no_posix_name_is_evaluated_at_import() -> None:
    """Each module of the package, imported where the names are missing."""
    code = (
        "import importlib, pathlib, sys, simulated_windows; simulated_windows.become_windows()\n"
        "root = pathlib.Path(sys.argv[1])\n"
        "for file in sorted((root / 'jacaros').rglob('*.py')):\n"
        "    name = '.'.join(file.relative_to(root).with_suffix('').parts).removesuffix('.__init__')\n"
        # The SDK of MCP imports modules that only a real Windows has.
        "    if not name.startswith(('jacaros.robots.ros.drivers.', 'jacaros.serving.mcp.', 'jacaros.__main__')):\n"
        "        importlib.import_module(name)\n"
    )
    subprocess.run(
        [sys.executable, "-c", code, str(ROOT / "src")],
        cwd=SIMULATION.parent,
        env={**os.environ, "PYTHONPATH": f"{ROOT / 'src'}{os.pathsep}{SIMULATION.parent}"},
        check=True,
        timeout=PATIENCE,
    )
