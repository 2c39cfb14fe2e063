"""`--orphans ask`: what becomes of goals of an earlier run is asked on the terminal, one question after the other."""

import asyncio
import os
import sys
from collections.abc import Iterator
from typing import TextIO

import pytest

from jacaros.runtime.cli.graph_options import orphan_policy

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="has no pseudo-terminals")


class Terminal:
    """A terminal with a user in front of it."""

    def __init__(self, person: int, typed: TextIO, shown: TextIO) -> None:
        self._person, self._streams = person, (typed, shown)
        self.shown = ""

    def attach(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """Make it the terminal of this process; in the test itself, because pytest replaces the streams before."""
        for name, stream in zip(("stdin", "stderr"), self._streams, strict=True):
            monkeypatch.setattr(sys, name, stream)

    async def read_until(self, text: str) -> None:
        """Wait until the terminal shows *text* after what was read before."""
        loop = asyncio.get_running_loop()
        self.shown = ""
        while text not in self.shown:
            self.shown += (await loop.run_in_executor(None, os.read, self._person, 1024)).decode()

    def type(self, keys: str) -> None:
        """Press keys."""
        os.write(self._person, keys.encode())


@pytest.fixture
def terminal() -> Iterator[Terminal]:
    pty = pytest.importorskip("pty", reason="needs a pseudo-terminal")

    person, program = pty.openpty()

    def stream(mode: str) -> TextIO:
        return open(os.dup(program), mode, encoding="utf-8")  # type: ignore[return-value]

    with stream("r") as typed, stream("w") as shown:
        yield Terminal(person, typed, shown)
    os.close(program)
    os.close(person)


@pytest.mark.parametrize(
    ("keys", "cancel"),
    [("\n", True), ("y\n", True), ("Yes\n", True), ("n\n", False), ("maybe\n", False), ("\x04", False)],
)
def test_an_answer_decides_about_the_goal(terminal: Terminal, monkeypatch, keys: str, cancel: bool):
    terminal.attach(monkeypatch)

    async def body() -> bool:
        policy = orphan_policy("ask")
        assert callable(policy)
        asking = asyncio.ensure_future(policy("/dock still pursues a goal. Cancel it?"))
        await terminal.read_until("/dock still pursues a goal. Cancel it? [Y/n] ")
        terminal.type(keys)
        return await asking

    assert asyncio.run(body()) is cancel


def test_the_second_question_waits_for_the_first_answer(terminal: Terminal, monkeypatch: pytest.MonkeyPatch):
    terminal.attach(monkeypatch)

    async def body() -> list[bool]:
        policy = orphan_policy("ask")
        assert callable(policy)
        asking = [asyncio.ensure_future(policy(text)) for text in ("First?", "Second?")]
        await terminal.read_until("First? [Y/n] ")
        assert "Second?" not in terminal.shown
        terminal.type("n\n")
        await terminal.read_until("Second? [Y/n] ")
        terminal.type("y\n")
        return await asyncio.gather(*asking)

    assert asyncio.run(body()) == [False, True]


def test_without_a_terminal_goals_are_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    with open(os.devnull, encoding="utf-8") as nothing:
        monkeypatch.setattr(sys, "stdin", nothing)
        assert orphan_policy("ask") == "keep"
