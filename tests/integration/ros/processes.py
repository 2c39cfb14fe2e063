"""The processes of a run: the world, and the agents."""

import json
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import IO

from jacaros.robots.world.data.ground_truth import GroundTruth

PATIENCE = 150.0
"""Seconds after which a test gives up; far more than any step takes on a busy machine."""

JACAROS = str(Path(sys.executable).parent / "jacaros")


def wait_until(condition: Callable[[], object], what: str) -> None:
    """Wait for a condition; its being late says nothing, its never coming fails the test."""
    deadline = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < deadline, f"not within {PATIENCE:g} s: {what}"
        time.sleep(0.1)


class Program:
    """A process whose output is read along.

    Attributes:
        lines, errors: what it wrote so far to standard output and standard error.
        code: the exit code, once it is known.
    """

    code: int | None = None

    def __init__(self, command: Sequence[str], environment: dict[str, str]) -> None:
        self._process = subprocess.Popen(
            command,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            env=os.environ | environment | {"PYTHONUNBUFFERED": "1"},
        )
        self.lines: list[str] = []
        self.errors: list[str] = []
        self._readers = [
            threading.Thread(target=read, args=pair, daemon=True)
            for pair in ((self._process.stdout, self.lines), (self._process.stderr, self.errors))
        ]
        for reader in self._readers:
            reader.start()

    @property
    def process(self) -> int:
        """The process id."""
        return self._process.pid

    @property
    def over(self) -> bool:
        """Whether the process has ended."""
        return self._process.poll() is not None

    @property
    def complaints(self) -> list[str]:
        """The lines of standard error, without those about late discovery and messages on a busy machine."""
        late = (
            "[ros] waiting for",
            "still trying",
            "[ros] found",
            "still listening",
            "later than earlier ones",
            "no other node is in the ROS",
            "[ros] /clock found",
        )
        return [line for line in self.errors if not any(text in line for text in late)]

    def until(self, condition: Callable[[], object], what: str) -> None:
        """Wait for a condition that the process brings about; fails at once when it ends before."""

        def met() -> bool:
            if condition():
                return True
            assert not self.over or condition(), self._story(f"the process ended before {what}")
            return False

        try:
            wait_until(met, what)
        except AssertionError as late:
            raise AssertionError(self._story(str(late))) from None

    def until_line(self, text: str) -> None:
        """Wait until standard output has a line with *text*."""
        self.until(lambda: any(text in line for line in list(self.lines)), f"the line {text!r}")

    def until_error(self, text: str) -> None:
        """Wait until standard error has a line with *text*."""
        self.until(lambda: any(text in line for line in list(self.errors)), f"the line {text!r}")

    def signal(self, number: signal.Signals) -> float:
        """Send a signal; when that was, in seconds since the Unix epoch."""
        now = time.time()
        self._process.send_signal(number)
        return now

    def end(self) -> int:
        """Wait for the end of the process; its exit code."""
        try:
            code = self._process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            raise AssertionError(self._story(f"the process does not end in {PATIENCE:g} s")) from None
        for reader in self._readers:
            reader.join()
        return code

    def stop(self) -> None:
        """End the process if it still runs, and let go of everything."""
        if not self.over:
            self.signal(signal.SIGTERM)
            try:
                self._process.wait(PATIENCE)
            except subprocess.TimeoutExpired:
                self._process.kill()
                self._process.wait()
        for reader in self._readers:
            reader.join()
        for stream in (self._process.stdout, self._process.stderr):
            assert stream is not None
            stream.close()

    def _story(self, beginning: str) -> str:
        output = "\n".join(["--- output:", *self.lines, "--- errors:", *self.errors])
        return f"{beginning}\n{' '.join(map(str, self._process.args))}\n{output}"  # type: ignore[arg-type]


def read(stream: IO[str], lines: list[str]) -> None:
    """Gather the lines of a stream."""
    for line in stream:
        lines.append(line.rstrip("\n"))


class Agents(Program):
    """``jacaros run`` on a real graph."""

    def __init__(self, project: Path, kind: str, environment: dict[str, str], *options: str) -> None:
        super().__init__(
            [JACAROS, "run", str(project), "--ros", kind, "--clock", "real", *options], environment
        )


class WorldProcess(Program):
    """``jacaros sim`` on a real graph, and what truly happens in it."""

    def __init__(
        self, world: str | Path, kind: str, environment: dict[str, str], folder: Path, *options: str
    ) -> None:
        self._file = folder / "ground_truth.jsonl"
        command = [JACAROS, "sim", str(world), "--ros", kind, "--ground-truth", str(self._file), *options]
        super().__init__(command, environment)

    def until_open(self) -> None:
        """Wait until the world runs."""
        self.until(lambda: self._file.exists() and self._file.stat().st_size, "the ground truth file")

    @property
    def truth(self) -> GroundTruth:
        """What has happened so far."""
        return GroundTruth.read(self._file)

    def until_truth(self, condition: Callable[[GroundTruth], object], what: str) -> None:
        """Wait until something has truly happened."""
        self.until(lambda: condition(self.truth), what)

    def time_of(self, moment: float) -> float:
        """The world's time at a moment of the machine's clock."""
        with self._file.open(encoding="utf-8") as lines:
            epoch: float = json.loads(lines.readline())["epoch"]
        return moment - epoch

    def close(self) -> GroundTruth:
        """End the world; everything that happened."""
        self.signal(signal.SIGTERM)
        assert self.end() == 0, self._story("the world did not end well")
        return self.truth
