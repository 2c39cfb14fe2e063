"""Real time for a test: a loop whose waiting moves the machine's clocks instead of taking time."""

import asyncio
import selectors
from collections.abc import Callable, Coroutine
from typing import Any

import pytest

NOON = 1_700_000_000.0


class _Selector(selectors.DefaultSelector):
    """Moves time when the loop would sleep."""

    def __init__(self) -> None:
        super().__init__()
        self.now = 1000.0

    def select(self, timeout: float | None = None) -> list[tuple[selectors.SelectorKey, int]]:
        events = super().select(0)
        if events or timeout == 0:
            return events
        assert timeout is not None, "everything waits, and no timer is left"
        self.now += timeout
        return []


class FakeTimeLoop(asyncio.SelectorEventLoop):
    """A loop on fake time."""

    def __init__(self) -> None:
        self.selector = _Selector()
        super().__init__(self.selector)

    def time(self) -> float:
        return self.selector.now


def in_fake_time(
    monkeypatch: pytest.MonkeyPatch, main: Callable[[FakeTimeLoop], Coroutine[Any, Any, None]]
) -> None:
    """Run *main* with the clocks of the machine following the loop."""
    loop = FakeTimeLoop()
    monkeypatch.setattr("time.monotonic", lambda: loop.selector.now)
    monkeypatch.setattr("time.time", lambda: NOON + loop.selector.now)
    with asyncio.Runner(loop_factory=lambda: loop) as runner:
        runner.run(main(loop))


def play_in_fake_time(main: Callable[[FakeTimeLoop], Coroutine[Any, Any, None]]) -> None:
    """Run *main* in fake time, as the body of a test."""
    with pytest.MonkeyPatch.context() as monkeypatch:
        in_fake_time(monkeypatch, main)
