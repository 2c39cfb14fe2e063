"""Goals that nobody wants any more: cancelled while nobody waits."""

import asyncio
from collections.abc import Awaitable, Callable
from contextlib import suppress

from jacaros.ros.action import GoalHandle
from jacaros.ros.errors import CallTimedOut, ServiceError

ENDING = 5.0
"""Seconds that a server has for answering a request to cancel, and as many for ending the goal after it agreed."""

_cancelling: set["asyncio.Task[None]"] = set()
"""Requests to cancel that nobody waits for; the loop itself would forget them."""


def give_up(
    handle: GoalHandle, action: str, log: Callable[[str], None], afterwards: Callable[[], Awaitable[object]]
) -> None:
    """Have a goal cancelled without waiting for it; *log* is told when it goes on all the same.

    Args:
        handle: of the goal.
        action: its name, for the log.
        log: takes one line.
        afterwards: called when the goal has ended.
    """

    async def cancel() -> None:
        with suppress(
            ServiceError
        ):  # its server has gone, or its client was closed: nobody is left to be told
            try:
                await handle.cancel(ENDING)
                await handle.outcome(ENDING)
            except CallTimedOut:
                log(f"a goal of {action} was given up, but it has not ended yet: the robot may go on")
                return
            await afterwards()

    task = asyncio.get_running_loop().create_task(cancel())
    _cancelling.add(task)
    task.add_done_callback(_cancelling.discard)
