"""Running Python code that embeds agents on an event loop with a clock."""

import asyncio
from collections.abc import Coroutine
from functools import partial
from typing import Any, Literal, TypeVar

from jacaros.clock import Clock, VirtualClock, WallClock, new_event_loop
from jacaros.errors import UsageError

T = TypeVar("T")


def run(main: Coroutine[Any, Any, T], *, clock: Literal["real", "fast"] = "real") -> T:
    """Run a coroutine to its end, as `asyncio.run` does, on a loop with a clock of its own; what it returns.

    Args:
        main: the coroutine, such as ``main()``.
        clock: ``real`` for the time of day; ``fast`` for the virtual clock, on which time jumps to the next timer as soon
            as everybody waits.  On that one ``asyncio.sleep`` and time-outs take no real time either.

    Raises:
        UsageError: a loop runs already, as in a notebook: ``await`` the coroutine there; or there is no such clock.
    """
    chosen: Clock
    try:
        if clock not in ("real", "fast"):
            raise UsageError(f"there is no clock {clock!r}; there are real and fast")
        if _is_running():
            raise UsageError(
                "an event loop runs here already (a notebook?): await the coroutine, without jacaros.run"
            )
    except UsageError:
        main.close()
        raise
    chosen = VirtualClock() if clock == "fast" else WallClock()
    with asyncio.Runner(loop_factory=partial(new_event_loop, chosen)) as runner:
        return runner.run(main)


def _is_running() -> bool:
    try:
        asyncio.get_running_loop()
    except RuntimeError:
        return False
    return True
