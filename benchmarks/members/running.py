"""Processes that measure what their orders say."""

import contextlib
import json
import os
import subprocess
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROS_2 = HERE.parent.parent / ".venv-ros2-jazzy" / "bin" / "python"
"""Created by tools/install_ros2.sh."""


def commands() -> dict[str, list[str]]:
    """Return the command of each way that this machine has, without the names of the processes."""
    number = os.getpid()
    found = {
        "fleet": [sys.executable, str(HERE / "agents.py"), f"bench{number}"],
        "zenoh": [sys.executable, str(HERE / "plain.py"), f"plain{number}"],
    }
    if ROS_2.exists():
        found["ros2"] = [str(ROS_2), str(HERE / "topics.py"), str(1 + number % 100)]
    return found


class Process:
    """One of them.

    Args:
        command: its command.
    """

    def __init__(self, command: Sequence[str]) -> None:
        self._process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._input, self._output = self._process.stdin, self._process.stdout

    def _line(self) -> str:
        line = self._output.readline()
        if not line:
            raise RuntimeError(f"{self._process.args!r}: ended")
        return line

    def wait(self) -> None:
        """Wait until it is ready."""
        if self._line() != "ready\n":
            raise RuntimeError(f"{self._process.args!r}: not ready")

    def order(self, what: str, amount: float) -> None:
        """Tell it what to measure."""
        self._input.write(f"{what} {amount}\n")
        self._input.flush()

    def answer(self) -> list[float]:
        """Return what it has measured."""
        found: list[float] = json.loads(self._line())
        return found

    def close(self) -> None:
        """End it."""
        with contextlib.suppress(BrokenPipeError):
            self._input.close()

    def wait_for_end(self) -> None:
        """Wait, but not for long."""
        try:
            self._process.wait(5)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()


def ordered(processes: Sequence[Process], what: str, amount: float) -> list[list[float]]:
    """Let all of them measure at the same time, and return what each found."""
    for each in processes:
        each.order(what, amount)
    return [each.answer() for each in processes]


def begun(commands: Sequence[Sequence[str]], stack: contextlib.ExitStack) -> list[Process]:
    """Start processes, which end with *stack*, and wait until they are ready."""
    processes = [Process(command) for command in commands]
    stack.enter_context(_ending(processes))
    for each in processes:
        each.wait()
    return processes


@contextlib.contextmanager
def _ending(processes: Sequence[Process]) -> Iterator[None]:
    try:
        yield
    finally:
        for each in processes:
            each.close()
        for each in processes:
            each.wait_for_end()


def asking_halves(command: Sequence[str], pairs: int, stack: contextlib.ExitStack) -> list[Process]:
    """Start pairs of processes that belong together. Return that of each pair which asks."""
    begun([[*command, f"b{number}"] for number in range(pairs)], stack)
    return begun([[*command, f"a{number}", f"b{number}"] for number in range(pairs)], stack)
