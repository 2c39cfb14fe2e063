"""What an interruption names: a step of an agent or the user's Python, never the run itself."""

import asyncio
import sys

from jacaros.runtime.mas.watchdog import is_of_user


async def test_the_run_and_the_program_that_started_the_loop_are_not_steps() -> None:
    found: list[bool] = []

    def look() -> None:
        own = sys._getframe()
        found.append(is_of_user(own))
        found.append(is_of_user(own.f_back))  # the code of asyncio that called it

    asyncio.get_running_loop().call_soon(look)
    await asyncio.sleep(1.0)
    assert found == [True, False]
    assert is_of_user(sys._getframe()), "the coroutine of this test is the user's"
    assert not is_of_user(None)
