"""How long a tripped guard cancels goals, and how long it stops the robot after a signal to end."""

import asyncio
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any

from jacaros.robots.ros.guard import CANCELLED, CANCELLING, ENDING, PERIOD, Guard
from jacaros.robots.ros.open import open_backend
from jacaros.runtime.clock import VirtualClock, run


class FakeBrakes:
    """Note when goals were cancelled and zero was sent."""

    described = "brakes"
    simulated_time = False

    def __init__(self) -> None:
        self.found: dict[str, int] = {}
        self.stops: list[float] = []
        self.cancels: list[float] = []

    def stop(self) -> None:
        self.stops.append(asyncio.get_running_loop().time())

    def cancel(self) -> None:
        self.cancels.append(asyncio.get_running_loop().time())

    def cover(self, topics: object, actions: object) -> None:
        """Nothing to open."""


def with_tripped_guard(
    tmp_path: Path, body: Callable[[Any, asyncio.AbstractEventLoop], Awaitable[None]]
) -> FakeBrakes:
    """Run *body* with a guard that has just lost its agents, on a virtual clock."""
    clock, brakes = VirtualClock(), FakeBrakes()

    async def main() -> None:
        backend = open_backend("memory", clock, "guard", log=lambda text: None)
        await backend.start()
        guard: Any = Guard(backend, "/robot", tmp_path / "socket", 0.3, False, lambda text: None)
        guard._brakes = brakes
        loop = asyncio.get_running_loop()
        guard._watch.connect(loop.time())
        guard._watch.armed = True
        guard._watch.lose()
        await body(guard, loop)
        await backend.close()

    run(main, clock)
    return brakes


def test_goals_are_cancelled_for_two_seconds_and_zero_is_sent_until_the_agents_return(tmp_path: Path) -> None:
    async def body(guard: Any, loop: asyncio.AbstractEventLoop) -> None:
        watching = asyncio.ensure_future(guard._guard(loop))
        await asyncio.sleep(10.0)
        watching.cancel()

    brakes = with_tripped_guard(tmp_path, body)
    began = brakes.stops[0]
    assert brakes.cancels[-1] - began < CANCELLED
    assert len(brakes.cancels) >= CANCELLED / CANCELLING - 2
    assert brakes.stops[-1] - began > 9.0
    assert len(brakes.stops) >= 0.9 * 10.0 / PERIOD


def test_a_signal_to_end_does_not_end_the_braking_that_has_just_begun(tmp_path: Path) -> None:
    async def body(guard: Any, loop: asyncio.AbstractEventLoop) -> None:
        guard._ending = True
        began = loop.time()
        await guard._guard(loop)
        assert ENDING <= loop.time() - began < ENDING + 1.0

    assert len(with_tripped_guard(tmp_path, body).stops) >= ENDING / PERIOD
