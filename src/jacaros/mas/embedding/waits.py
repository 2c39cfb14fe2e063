"""What Python code waits for in a run: each wait ends with what it is for, with its time, its agent or the run."""

import asyncio
import threading
from collections.abc import Callable
from typing import Any, TypeVar

from jacaros.clock import Clock
from jacaros.errors import UsageError
from jacaros.mas.embedding.errors import AgentEnded, RunEnded

T = TypeVar("T")


class Waits:
    """The waits of one run; made in the thread of its loop, the only one that may use the run.

    Args:
        clock: of the run; time-outs are counted on it.
    """

    def __init__(self, clock: Clock) -> None:
        self._clock = clock
        self._thread = threading.current_thread()
        self._open: dict[asyncio.Future[Any], tuple[str | None, Callable[[], str]]] = {}
        self._over: str | None = None

    async def wait(
        self,
        future: asyncio.Future[T],
        missing: Callable[[], str],
        timeout: float | None = None,
        agent: str | None = None,
    ) -> T:
        """Wait for *future*.

        Args:
            future: set by whoever brings it.
            missing: says what is still missing, for the text of an error.
            timeout: seconds of the run's clock; None to wait as long as it takes.
            agent: the agent without which it cannot come.

        Raises:
            TimeoutError: it did not come in time.
            AgentEnded: the agent ended before.
            RunEnded: the run ended before.
        """
        if self._over is not None:
            raise RunEnded(f"{missing()}: {self._over}")
        self._open[future] = agent, missing
        timer = None
        if timeout is not None:
            late = f" within {timeout:g} s"
            timer = self._clock.call_later(timeout, lambda: _fail(future, TimeoutError(missing() + late)))
        try:
            return await future
        finally:
            del self._open[future]
            if timer is not None:
                timer.cancel()

    def check_thread(self) -> None:
        """Check that the caller is in the thread of the run's loop.

        Raises:
            UsageError: it is in another one, where it would race with the agents.
        """
        if threading.current_thread() is not self._thread:
            raise UsageError(
                f"called in thread {threading.current_thread().name!r}, but the run belongs to thread "
                f"{self._thread.name!r}; from other threads use loop.call_soon_threadsafe(function) of its loop"
            )

    def check(self) -> None:
        """Check that the run continues and that the caller is in its thread.

        Raises:
            RunEnded: it has ended.
            UsageError: the caller is in another thread.
        """
        self.check_thread()
        if self._over is not None:
            raise RunEnded(self._over)

    def agent_ended(self, name: str) -> None:
        """An agent has ended: who waits for it waits in vain."""
        for future, (agent, missing) in tuple(self._open.items()):
            if agent == name:
                _fail(future, AgentEnded(f"{missing()}: agent {name} has ended"))

    def stuck(self) -> bool:
        """Nothing more will happen: who waits for something waits in vain.  Whether anybody did."""
        for future, (_, missing) in tuple(self._open.items()):
            _fail(future, TimeoutError(f"{missing()}, and nothing more will happen: all agents wait"))
        return bool(self._open)

    def run_ended(self, how: str) -> None:
        """The run has ended: so have all waits."""
        self._over = how
        for future, (_, missing) in tuple(self._open.items()):
            _fail(future, RunEnded(f"{missing()}: {how}"))


def _fail(future: asyncio.Future[Any], error: Exception) -> None:
    if not future.done():
        future.set_exception(error)
