"""`jacaros run PROJECT --all-nodes`: one process for each node."""

import os
import re
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

pytest.importorskip("zenoh")
pytestmark = pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")

AGENT = """
import os
from jacaros import PythonAgent

class Agent(PythonAgent):
    async def run(self):
        self.print("pid ", os.getpid())
        await self.sleep(1000)
"""
HOUSE = """
mas house {
  agent ann : a.py { node: base }
  agent bob : a.py { node: robot }
  node base
  node robot
}
"""
FAILING = """
mas failing {
  agent ann : ends.asl { node: base }
  agent bob : ends.asl { node: robot  beliefs: code(3) }
  node base
  node robot
}
"""
ENDS = "!end. +!end : code(C) <- .stopMAS(0, C). +!end <- .print(done); .stopMAS(0, 0)."
LIMIT = 60


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    for name, text in (("house.jcm", HOUSE), ("failing.jcm", FAILING), ("a.py", AGENT), ("ends.asl", ENDS)):
        (tmp_path / name).write_text(text, encoding="utf-8")
    return tmp_path


@contextmanager
def launched(folder: Path, project: str) -> Iterator["subprocess.Popen[str]"]:
    """The launcher of a project, in a fleet of its own."""
    command = [sys.executable, "-m", "jacaros", "run", project, "--all-nodes", "--fleet", f"f{os.getpid()}"]
    pipe = subprocess.PIPE
    with subprocess.Popen(command, stdout=pipe, stderr=pipe, text=True, cwd=folder) as launcher:
        try:
            yield launcher
        finally:
            launcher.terminate()


def processes(launcher: "subprocess.Popen[str]") -> dict[str, int]:
    """The processes of the nodes, as soon as an agent of each has printed its own."""
    assert launcher.stdout is not None
    lines = [launcher.stdout.readline() for _ in range(2)]
    found = [re.fullmatch(r"\[(\w+)\] \[\w+\] pid ([0-9]+)\n", line) for line in lines]
    assert all(found), lines
    return {each[1]: int(each[2]) for each in found if each is not None}


def exists(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    return True


def test_the_others_go_on_when_a_node_is_killed(folder: Path) -> None:
    with launched(folder, "house.jcm") as launcher:
        of_node = processes(launcher)
        os.kill(of_node["robot"], signal.SIGKILL)
        assert launcher.stderr is not None
        told = next(line for line in launcher.stderr if "killed" in line)
        assert told == "warning: node `robot` was killed by signal 9; still running: `base`\n"
        assert exists(of_node["base"])
        launcher.send_signal(signal.SIGINT)
        assert launcher.wait(LIMIT) == 128 + signal.SIGKILL
        assert not exists(of_node["base"])


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_all_nodes(folder: Path, number: signal.Signals) -> None:
    with launched(folder, "house.jcm") as launcher:
        of_node = processes(launcher)
        launcher.send_signal(number)
        _, errors = launcher.communicate(timeout=LIMIT)
        assert launcher.returncode == 128 + number
        assert not any(map(exists, of_node.values()))
        assert "still running" not in errors


def test_the_exit_code_is_that_of_the_first_node_that_failed(folder: Path) -> None:
    with launched(folder, "failing.jcm") as launcher:
        output, errors = launcher.communicate(timeout=LIMIT)
        assert launcher.returncode == 3
        assert "[base] [ann] done\n" in output
        assert "warning: node `robot` ended with exit code 3" in errors
