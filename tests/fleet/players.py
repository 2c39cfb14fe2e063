"""Processes that `player.py` runs in, as the tests see them."""

import json
import re
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import Any

PATIENCE = 20.0
"""Seconds to wait for what has no limit of its own."""
_SCRIPT = Path(__file__).with_name("player.py")


class Player:
    """A session of Zenoh in another process, or a command of `jacaros`."""

    def __init__(self, command: Sequence[str] = (), **given: Any) -> None:
        words = ["-m", "jacaros", *command] if command else [str(_SCRIPT), json.dumps(given, default=str)]
        self.process = subprocess.Popen(
            [sys.executable, *words],
            stderr=subprocess.STDOUT,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        self.lines: list[str] = []
        self._more = threading.Condition()
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self) -> None:
        assert self.process.stdout is not None
        for line in self.process.stdout:
            with self._more:
                self.lines.append(line.rstrip("\n"))
                self._more.notify_all()

    def until(self, pattern: str, seconds: float = PATIENCE, after: int = 0) -> float:
        """Wait for a line, and return how long that took.

        Args:
            pattern: regular expression for the whole line.
            seconds: limit.
            after: number of lines that do not count.
        """
        return self.wait(
            lambda: any(re.fullmatch(pattern, line) for line in self.lines[after:]),
            seconds,
            f"no line {pattern}",
        )

    def wait(self, fulfilled: Callable[[], bool], seconds: float, otherwise: str) -> float:
        """Wait for lines, and return how long that took."""
        began = time.monotonic()
        with self._more:
            assert self._more.wait_for(fulfilled, seconds), f"{otherwise} in {seconds} s, but {self.lines}"
        return time.monotonic() - began

    def do(self, *words: object) -> "Player":
        """Let the session do something, and wait until it has."""
        assert self.process.stdin is not None
        before = len(self.lines)
        print(*words, file=self.process.stdin, flush=True)
        self.until(f"done {words[0]}", after=before)
        return self

    def opened(self) -> "Player":
        """Wait until the session is open."""
        self.until("open")
        return self

    def heard(self) -> list[str]:
        """Return the lines of messages."""
        return [line for line in self.lines if line.startswith("heard ")]

    def kill(self) -> None:
        """End the process without any chance to say so."""
        self.process.kill()

    def interrupt(self) -> None:
        """Press Ctrl+C."""
        self.process.send_signal(signal.SIGINT)

    def freeze(self) -> None:
        """Stop the process as if its computer hung."""
        self.process.send_signal(signal.SIGSTOP)

    def thaw(self) -> None:
        """Let the process go on."""
        self.process.send_signal(signal.SIGCONT)

    def __enter__(self) -> "Player":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.process.kill()
        self._reader.join()
        assert self.process.stdin is not None
        with suppress(BrokenPipeError):
            self.process.stdin.close()
        assert self.process.stdout is not None
        self.process.stdout.close()
        self.process.wait()


class Member(Player):
    """A member that announces itself, prints who comes and goes, and hears what is for it."""

    def __init__(self, fleet: str, name: str, changes: dict[str, Any] | None = None, **fields: Any) -> None:
        super().__init__(network={"fleet": fleet, "member": name, **fields}, changes=changes or {})
        self.fleet, self.name = fleet, name

    def joined(self) -> "Member":
        """Wait until the session is open and has declared everything."""
        self.opened()
        self.do("see", f"jacaros/{self.fleet}/member/**")
        self.do("hear", f"jacaros/{self.fleet}/to/{self.name}/1/**")
        self.do("token", f"jacaros/{self.fleet}/member/{self.name}/1")
        return self

    def sees(self, name: str, seconds: float = PATIENCE) -> float:
        """Wait until another member is there, and return how long that took."""
        return self._until_last("came", name, seconds)

    def misses(self, name: str, seconds: float = PATIENCE) -> float:
        """Wait until another member, which was there, has gone."""
        return self._until_last("went", name, seconds)

    def _until_last(self, what: str, name: str, seconds: float) -> float:
        key = f" jacaros/{self.fleet}/member/{name}/1"
        return self.wait(
            lambda: [line for line in self.lines if line.endswith(key)][-1:] == [what + key],
            seconds,
            f"{self.name}: no {what}{key}",
        )

    def send(self, to: str, text: str) -> None:
        """Send a datagram to another member."""
        self.do("put", f"jacaros/{self.fleet}/to/{to}/1/from/{self.name}/1", text)

    def hears(self, sender: str, text: str, seconds: float = PATIENCE) -> float:
        """Wait for a datagram of another member."""
        return self.until(f"heard jacaros/{self.fleet}/to/{self.name}/1/from/{sender}/1 {text}", seconds)
