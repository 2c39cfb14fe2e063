"""Waits of Python code in a run. Each ends with its result, or with an error:

JacarosError
├── UnknownAgent        no participant has this name
├── AgentEnded          the agent has ended, so the call is not possible
├── RunEnded            the run has ended, or has not begun
└── GoalFailed          an awaited goal failed, or was dropped
"""

import asyncio
import threading
from collections.abc import Callable, Iterable
from typing import Any, TypeVar

from jacaros.runtime.clock import Clock
from jacaros.runtime.errors import JacarosError, UsageError
from jacaros.runtime.files.texts import suggestion

T = TypeVar("T")


class UnknownAgent(JacarosError):
    """No participant has this name. The text suggests similar names."""

    def __init__(self, name: str, known: Iterable[str]) -> None:
        names = list(known)
        listed = ", ".join(names[:10]) + (", …" if len(names) > 10 else "")
        help = suggestion(name, names, f"agents: {listed}" if names else "", 3)
        super().__init__(f"unknown agent `{name}`{'; ' * bool(help)}{help}")
        self.name = name


class AgentEnded(JacarosError):
    """The agent has ended."""


class RunEnded(JacarosError):
    """The run has ended, or has not begun."""


class GoalFailed(JacarosError):
    """An awaited goal failed without a plan for its failure, or was dropped.

    Attributes:
        goal: the goal as text.
        message: the message of the failure.
        reasons: its terms as plain values (see `jacaros.artifacts.env.values`), such as ``error(no_relevant)``.
    """

    def __init__(self, text: str, goal: str, message: str = "", reasons: tuple[object, ...] = ()) -> None:
        super().__init__(text)
        self.goal, self.message, self.reasons = goal, message, reasons

    def reason(self, functor: str) -> object:
        """Return the argument of the first reason with this functor (a tuple of several), or None."""
        for term in self.reasons:
            if getattr(term, "functor", None) == functor:
                arguments: tuple[object, ...] = term.arguments  # type: ignore[attr-defined]
                return arguments[0] if len(arguments) == 1 else arguments
        return None


class RunWaits:
    """The waits of one run, created in the thread of its event loop, the only one that may use the run.

    Args:
        clock: clock of the run, for time limits.
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
            future: the result.
            missing: returns what is missing, for the text of an error.
            timeout: time limit in seconds of the run's clock. None: no limit.
            agent: the agent without which the result cannot arrive.

        Raises:
            TimeoutError: the result did not arrive in time.
            AgentEnded: the agent ended first.
            RunEnded: the run ended first.
        """
        if self._over is not None:
            raise RunEnded(f"{missing()}: {self._over}")
        self._open[future] = agent, missing
        timer = None
        if timeout is not None:
            late = f" within {timeout:g} s"
            timer = self._clock.call_later(timeout, lambda: fail(future, TimeoutError(missing() + late)))
        try:
            return await future
        finally:
            del self._open[future]
            if timer is not None:
                timer.cancel()

    def check_thread(self) -> None:
        """Check that the caller is in the thread of the run's event loop.

        Raises:
            UsageError: it is in another thread, where it would race with the agents.
        """
        if threading.current_thread() is not self._thread:
            raise UsageError(
                f"called in thread {threading.current_thread().name!r}, but the run belongs to thread "
                f"{self._thread.name!r}; from other threads, use loop.call_soon_threadsafe(function)"
            )

    def check(self) -> None:
        """Check that the run has not ended, and that the caller is in its thread.

        Raises:
            RunEnded: it has ended.
            UsageError: the caller is in another thread.
        """
        self.check_thread()
        if self._over is not None:
            raise RunEnded(self._over)

    def agent_ended(self, name: str) -> None:
        """End the waits for an agent that has ended."""
        for future, (agent, missing) in tuple(self._open.items()):
            if agent == name:
                fail(future, AgentEnded(f"{missing()}: agent {name} has ended"))

    def stuck(self) -> bool:
        """End all waits, because all agents are idle. Return whether there were any."""
        for future, (_, missing) in tuple(self._open.items()):
            fail(future, TimeoutError(f"{missing()}, and never will: all agents are idle"))
        return bool(self._open)

    def run_ended(self, how: str) -> None:
        """End all waits, because the run has ended."""
        self._over = how
        for future, (_, missing) in tuple(self._open.items()):
            fail(future, RunEnded(f"{missing()}: {how}"))


def fail(future: "asyncio.Future[Any]", error: Exception) -> None:
    """End a wait with an error, unless it has ended."""
    if not future.done():
        future.set_exception(error)
