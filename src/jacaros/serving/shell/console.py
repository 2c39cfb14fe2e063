"""The console of a running system: lines from a terminal, or from a script."""

import asyncio
import io
import sys
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, TextIO

from jacaros.runtime.errors import JacarosError
from jacaros.runtime.mas.system import System
from jacaros.serving.client import PATIENCE, Client, Unreachable
from jacaros.serving.shell.dialogue import Dialogue
from jacaros.serving.shell.wording import error_text

if TYPE_CHECKING:
    from jacaros.serving.shell.terminal import Terminal

LEAVING = 2.0
"""Seconds for restoring the terminal at the end of the run."""


class Console:
    """Reads lines of the standard input: with a prompt in a terminal, otherwise in turn.

    In a script, each goal has ended before the next line is read.
    """

    def __init__(self) -> None:
        self._terminal = _terminal() if is_interactive() else None
        self._leaves = False

    @property
    def stream(self) -> TextIO | None:
        """The stream for all other output of the process; None for the standard streams."""
        return None if self._terminal is None else self._terminal.stream

    def talk(self, client: Client) -> int:
        """Execute lines until the user leaves or the system ends. Return an exit code: 1 if a line of a script failed.

        Raises:
            JacarosError: the system does not answer.
        """
        if self._terminal is None:
            dialogue = Dialogue(client, _print, waits=True)
            failed = [line for line in _script() if not dialogue.execute(line)]
            return 1 if failed else 0
        dialogue = Dialogue(client, self._terminal.show, waits=False)
        dialogue.refresh()
        hears = threading.Event()
        listening = threading.Thread(
            target=self._listen, args=(client, dialogue, hears), name="jacaros events", daemon=True
        )
        listening.start()
        hears.wait(PATIENCE)
        dialogue.greet()
        self._terminal.read(dialogue)
        self._leaves = True
        self._terminal.close()
        return 0

    def leave(self) -> None:
        """End `talk`, if it reads from a terminal. Any thread may call it."""
        self._leaves = True
        if self._terminal is not None:
            self._terminal.leave()

    def _listen(self, client: Client, dialogue: Dialogue, hears: threading.Event) -> None:
        """Show events until the system ends."""
        terminal = self._terminal
        assert terminal is not None
        try:
            while not self._leaves:
                with client.events() as events:
                    hears.set()
                    for event in events:
                        if told := dialogue.event(event):
                            terminal.show(told)
                        if event["event"].startswith("agent_"):
                            dialogue.refresh()
        except JacarosError as error:
            if not self._leaves:
                terminal.show("the system has ended" if isinstance(error, Unreachable) else error_text(error))
                terminal.leave()

    def begin(self, system: System, url: str, token: str, certificate: Path | None) -> None:
        """Talk to a run of this process in a thread. The run ends when the user leaves."""
        client = Client(url, token, str(certificate or ""))
        system.input = None  # the console answers questions to a person, too
        loop = asyncio.get_running_loop()

        def end(code: int) -> None:
            loop.call_soon_threadsafe(system.stop_system, 0.0, code)

        thread = threading.Thread(
            target=self._talk_within, args=(client, end), name="jacaros console", daemon=True
        )

        async def leave() -> None:
            self.leave()
            if self._terminal is not None:
                await asyncio.to_thread(thread.join, LEAVING)

        system.close_last(leave)
        thread.start()

    def _talk_within(self, client: Client, end: Callable[[int], object]) -> None:
        try:
            end(self.talk(client))
        except RuntimeError:
            pass  # the run has ended
        except JacarosError as error:
            print(error, file=sys.stderr)
            end(1)


def is_interactive() -> bool:
    """Return whether a person sits at the terminal."""
    return all(each is not None and each.isatty() for each in (sys.stdin, sys.stdout))


def _terminal() -> "Terminal":
    from jacaros.serving.shell.terminal import Terminal  # here: it imports prompt_toolkit

    return Terminal()


def _print(text: str) -> None:
    print(text, flush=True)


def _script() -> Iterator[str]:
    """Yield the lines of the standard input until its end, or ``quit``."""
    # Without a buffer: its lock would be held when the process ends.
    lines = io.FileIO(0, closefd=False)
    while line := lines.readline():
        told = line.decode("utf-8", "replace").strip()
        if told in ("quit", "exit"):
            return
        yield told
