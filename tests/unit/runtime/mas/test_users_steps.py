"""What an interruption names: a step of an agent or the user's Python, never the run itself."""

import asyncio
import sys
from types import FrameType

from jacaros.runtime.clock import VirtualClock, WallClock, run
from jacaros.runtime.mas.watchdog import is_of_user


def test_the_program_that_started_the_loop_is_not_a_step() -> None:
    found: list[bool] = []
    clock = VirtualClock()

    def look() -> None:
        own = sys._getframe()
        found.append(is_of_user(own))
        found.append(is_of_user(own.f_back))  # the code of asyncio that called it

    async def main() -> None:
        asyncio.get_running_loop().call_soon(look)
        await clock.sleep(1.0)

    run(main, clock)
    assert found == [True, False]


def test_code_of_the_run_alone_is_not_a_step() -> None:
    frames: list[FrameType | None] = []

    async def main() -> None:
        frames.append(sys._getframe())

    run(main, WallClock())
    [frame] = frames
    assert is_of_user(frame), "the coroutine of this test is the user's"
    assert not is_of_user(None)
