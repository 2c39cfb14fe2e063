"""Coroutines of internal actions, which run beside the waiting agents."""

import asyncio
from collections.abc import Callable, Coroutine
from typing import Any

from jacaros.mas.idleness import Activity

Ended = Callable[[object, BaseException | None], None]
"""Called with the result of a coroutine, or the exception that ended it."""

_PATIENCE = 5.0
"""Seconds that coroutines have for their clean-up at the end of a run."""


class Coroutines:
    """The coroutines of one agent.

    Args:
        activity: counts the running ones.
    """

    def __init__(self, activity: Activity) -> None:
        self._activity = activity
        self._running: set[AgentCoroutine] = set()

    def start(self, coroutine: Coroutine[Any, Any, Any], ended: Ended) -> "AgentCoroutine":
        """Run a coroutine. *ended* is called at its end unless it is cancelled before."""
        running = AgentCoroutine(coroutine, ended, self._activity, self._running.discard)
        self._running.add(running)
        return running

    def cancel(self) -> None:
        """Cancel all."""
        for running in list(self._running):
            running.cancel()

    async def close(self) -> None:
        """Cancel all, and wait for their clean-up."""
        self.cancel()
        if self._running:
            await asyncio.wait([running.task for running in self._running], timeout=_PATIENCE)


class AgentCoroutine:
    """One running coroutine.

    Attributes:
        task: the task that runs it.
    """

    def __init__(
        self,
        coroutine: Coroutine[Any, Any, Any],
        ended: Ended,
        activity: Activity,
        over: "Callable[[AgentCoroutine], None]",
    ) -> None:
        self._ended, self._activity, self._over = ended, activity, over
        self._wanted = True
        activity.begin()
        self.task = asyncio.get_running_loop().create_task(without_exit(coroutine))
        self.task.add_done_callback(self._done)

    def cancel(self) -> None:
        """Cancel it: its ``finally`` blocks run, and its end is not reported."""
        if self._wanted:
            self._wanted = False
            self._activity.end()
            self.task.cancel()

    def _done(self, task: "asyncio.Task[Any]") -> None:
        self._over(self)
        error = asyncio.CancelledError("cancelled") if task.cancelled() else task.exception()
        if not self._wanted:
            return
        self._wanted = False
        self._activity.end()
        self._ended(None if error is not None else task.result(), error)


async def without_exit(work: Coroutine[Any, Any, Any]) -> Any:
    """Await a coroutine. Turn its ``sys.exit``, which would end the event loop, into an error."""
    try:
        return await work
    except SystemExit as error:
        raise RuntimeError(f"SystemExit: {error}") from error
