"""The loop that a browser pumps, and its clock, which follows real time."""

import asyncio
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest

from jacaros.browser.pumped_loop import BEHIND, PacedClock, PumpedLoop
from jacaros.runtime.clock import of_run, outside_run


class Lab:
    """A loop on a clock whose real time the test moves."""

    def __init__(self, speed: float = 1.0) -> None:
        self.real = 100.0
        self.clock = PacedClock(speed, lambda: self.real)
        self.loop = PumpedLoop(self.clock)

    def pass_by(self, seconds: float, step: float = 0.1) -> None:
        """Let real time pass, and pump after each step."""
        end = self.real + seconds
        while self.real < end - 1e-9:
            self.real += step
            self.loop.pump(0.05)


@contextmanager
def lab(speed: float = 1.0) -> Iterator[Lab]:
    made = Lab(speed)
    yield made
    made.loop.close()


async def ticks(clock: PacedClock, times: list[float]) -> None:
    while True:
        await clock.sleep(0.5)
        times.append(round(clock.elapsed, 3))


@pytest.mark.parametrize("speed", [0.5, 1.0, 10.0])
def test_the_clock_follows_real_time_at_its_speed(speed: float) -> None:
    with lab(speed) as it:
        times: list[float] = []
        task = it.loop.create_task(ticks(it.clock, times))
        it.pass_by(2.0)
        assert it.clock.elapsed == pytest.approx(2.0 * speed, abs=0.11 * speed)
        assert times == [0.5 * n for n in range(1, len(times) + 1)]
        assert len(times) >= int(2.0 * speed / 0.5) - 1
        task.cancel()
        it.loop.pump(0.0)


def test_a_machine_that_was_away_does_not_catch_up() -> None:
    with lab() as it:
        it.loop.pump(0.0)
        it.pass_by(60.0, step=60.0)
        assert it.clock.elapsed == pytest.approx(BEHIND)


def test_a_pump_returns_when_the_next_one_is_due() -> None:
    with lab(speed=2.0) as it:
        it.loop.call_soon(lambda: it.clock.call_later(3.0, lambda: None))
        assert it.loop.pump(0.05) == pytest.approx(1.5)
        it.pass_by(2.0)
        assert it.loop.pump(0.05) is None


def test_callbacks_without_end_do_not_keep_the_host() -> None:
    with lab() as it:
        calls: list[None] = []

        def again() -> None:
            calls.append(None)
            it.loop.call_soon(again)

        it.loop.call_soon(again)
        assert it.loop.pump(0.005) == 0.0
        before = len(calls)
        assert it.loop.pump(0.005) == 0.0
        assert len(calls) > before > 0


def test_a_pause_holds_the_run_and_nothing_else() -> None:
    with lab() as it:
        times: list[float] = []
        with of_run():
            task = it.loop.create_task(ticks(it.clock, times))
        it.pass_by(0.7)
        it.clock.pause()
        answered: list[int] = []
        with outside_run():
            it.loop.call_soon(answered.append, 1)
        it.pass_by(5.0)
        assert (times, answered) == ([0.5], [1])
        assert it.loop.pump(0.05) is None
        it.clock.resume()
        it.pass_by(0.5)
        assert times == [0.5, 1.0]
        task.cancel()
        it.loop.pump(0.0)


def test_a_speed_set_later_changes_nothing_before() -> None:
    with lab() as it:
        it.pass_by(1.0)
        before = it.clock.elapsed
        it.clock.speed = 10.0
        assert it.clock.elapsed == before
        it.pass_by(1.0)
        assert it.clock.elapsed == pytest.approx(before + 10.0, abs=1.1)


def test_work_for_threads_is_done_on_the_loop() -> None:
    with lab() as it:
        results: list[Any] = []

        async def ask() -> None:
            results.append(await asyncio.to_thread(lambda: 42))

        task = it.loop.create_task(ask())
        it.pass_by(0.3)
        assert results == [42]
        assert task.done()
