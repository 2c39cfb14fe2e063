"""Systems in processes of their own, which serve callers; and a terminal."""

import os
import re
import select
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from jacaros.serving import running
from jacaros.serving.client import Client

PROGRAM = """
{ offer(goal, deliver(parcel(string), room([kitchen, office])), doc("Bring a parcel to a room.")) }
{ offer(goal, count(n(number(0, 10)), next(out(number)))) }
{ offer(goal, search, when_busy(replace)) }
{ offer(goal, lose) }
{ offer(goal, halt) }
{ offer(belief, battery(level(number))) }
{ offer(question, double(x(number), y(out(number)))) }
{ offer(tell, closed(room(atom))) }
{ offer(event, delivered(parcel(string))) }
battery(80).
double(X, 2 * X).
+!deliver(_, Room) : closed(Room) <- .refuse(closed(Room)).
+!deliver(Parcel, _) <- .progress(0.5, "half way"); .wait(100); -+battery(50); .announce(delivered(Parcel)).
+!count(N, N + 1).
+!search <- .wait(100000).
+!lose <- .wait(10); .fail(error(lost), error_msg("nothing found")).
+!halt <- .wait(50); .stopMAS(0, 7).
"""
PATIENCE = 30.0
"""Seconds for anything to happen on a busy machine."""
_STYLE = re.compile(r"\x1b\[[0-9;?]*[a-zA-Z]")


def program(folder: Path, text: str = PROGRAM, name: str = "bob") -> Path:
    """Write a program."""
    path = folder / f"{name}.asl"
    path.write_text(text)
    return path


def command(*arguments: str) -> list[str]:
    """Return the command line of ``jacaros``."""
    return [sys.executable, "-m", "jacaros", *arguments]


class ServedRun:
    """A run that serves callers.

    Attributes:
        client: a client with the token of an operator.
    """

    def __init__(self, process: "subprocess.Popen[str]", client: Client) -> None:
        self._process, self.client = process, client

    def kill(self) -> None:
        """Kill it."""
        self._process.kill()
        self._process.wait()


@contextmanager
def served(file: Path) -> Iterator[ServedRun]:
    """Run a program that serves callers."""
    process = subprocess.Popen(
        command("run", str(file), "--serve", "0"), stderr=subprocess.PIPE, stdin=subprocess.DEVNULL, text=True
    )
    try:
        assert process.stderr is not None
        for line in process.stderr:
            if line.startswith("serve: the token"):
                break
        else:
            raise AssertionError("it does not serve")
        service = next(each for each in running.services() if each.pid == process.pid)
        yield ServedRun(process, Client.of(service))
    finally:
        process.terminate()
        process.communicate(timeout=PATIENCE)


class Screen:
    """A terminal of a command.

    Attributes:
        text: what has appeared in it, without styles.
    """

    def __init__(self, *arguments: str) -> None:
        import pty  # here: Windows has none

        self._own, child = pty.openpty()
        self._child = child
        environment = {**os.environ, "TERM": "xterm", "PROMPT_TOOLKIT_NO_CPR": "1"}
        self._process = subprocess.Popen(
            command(*arguments),
            stdin=child,
            stdout=child,
            stderr=child,
            env=environment,
            start_new_session=True,
        )
        self.text = ""

    def type(self, keys: str) -> None:
        """Type keys."""
        os.write(self._own, keys.encode())

    def wait_for(self, expected: str) -> None:
        """Wait until a text appears behind those that were waited for before."""
        deadline = time.monotonic() + PATIENCE
        while expected not in self.text:
            assert time.monotonic() < deadline, f"no `{expected}` in:\n{self.text}"
            if select.select([self._own], [], [], 0.1)[0]:
                self.text += _STYLE.sub("", os.read(self._own, 65536).decode())
        self.text = self.text.partition(expected)[2]

    def terminate(self) -> None:
        """Send SIGTERM."""
        self._process.terminate()

    def end(self) -> int:
        """Wait for the end of the command. Return its exit code."""
        deadline = time.monotonic() + PATIENCE
        while self._process.poll() is None and time.monotonic() < deadline:
            if select.select([self._own], [], [], 0.05)[0]:  # otherwise its last lines would wait
                self.text += _STYLE.sub("", os.read(self._own, 65536).decode())
        return self._process.wait(0)

    @property
    def echoes(self) -> bool:
        """Whether the terminal shows what is typed, as it does for a shell."""
        import termios

        return bool(termios.tcgetattr(self._child)[3] & termios.ECHO)

    def close(self) -> None:
        """Close it."""
        if self._process.poll() is None:
            self._process.kill()
            self._process.wait()
        os.close(self._own)
        os.close(self._child)
