"""Streams of output, log lines and messages, which are kept until they are read."""

import asyncio
from collections import deque
from collections.abc import Callable
from typing import Generic, NamedTuple, TypeVar

from jacaros.artifacts.kernel.faults import error_text
from jacaros.mas.console import StandardConsole
from jacaros.mas.embedding.errors import RunEnded
from jacaros.mas.embedding.waits import Waits
from jacaros.mas.python_agents.faults import place_of_fault

T = TypeVar("T")


class Stream(Generic[T]):
    """An asynchronous iterator over items as they arrive. It ends with the run, once all items have been read.

    Args:
        waits: waits of the run.
        what: what is missing while there is no item, for errors.
    """

    def __init__(self, waits: Waits, what: str) -> None:
        self._waits = waits
        self._what = what
        self._items: deque[T] = deque()
        self._waiting: deque[asyncio.Future[None]] = deque()

    def put(self, item: T) -> None:
        """Add an item, for the first waiting reader."""
        self._items.append(item)
        self._wake()

    def _wake(self) -> None:
        while self._waiting:
            future = self._waiting.popleft()
            if not future.done():
                future.set_result(None)
                return

    async def get(self, timeout: float | None = None) -> T:
        """Return the next item, waiting until it arrives.

        Args:
            timeout: time limit in seconds of the run's clock. None: no limit.

        Raises:
            TimeoutError: no item arrived in time.
            RunEnded: the run has ended, so no item will arrive.
        """
        while not self._items:
            arrived: asyncio.Future[None] = asyncio.get_running_loop().create_future()
            self._waiting.append(arrived)
            try:
                await self._waits.wait(arrived, lambda: self._what, timeout)
            except asyncio.CancelledError:
                if arrived.done() and not arrived.cancelled():
                    self._wake()
                raise
        return self._items.popleft()

    def take(self) -> list[T]:
        """Return all items that have not been read yet, without waiting."""
        taken = list(self._items)
        self._items.clear()
        return taken

    def __len__(self) -> int:
        return len(self._items)

    def __bool__(self) -> bool:
        return True

    def __aiter__(self) -> "Stream[T]":
        return self

    async def __anext__(self) -> T:
        try:
            return await self.get()
        except RunEnded:
            raise StopAsyncIteration from None


class PrintedLine(NamedTuple):
    """A line of an agent's output.

    Attributes:
        agent: name of the agent.
        text: the line, without the name.
    """

    agent: str
    text: str

    def __str__(self) -> str:
        return f"[{self.agent}] {self.text}"


OnPrint = Callable[[str, str], None]
"""Called with the name of an agent and its output."""

OnLog = Callable[[str, str], None]
"""Called with a line of the log and its level: ``debug``, ``info``, ``warning`` or ``error``."""


class PrintedConsole:
    """The console of an embedded system.

    Args:
        on_print: prints the output of agents. Default: print ``[agent] text`` to standard output.
        on_log: logs lines. Default: standard error.
    """

    def __init__(self, on_print: OnPrint | None, on_log: OnLog | None) -> None:
        # Looks up the standard streams on each write: tests and notebooks replace them.
        self._standard = StandardConsole()
        self._on_print = on_print or self._standard.print
        self._on_log = on_log or self._standard.log
        self._listeners: list[OnPrint] = []

    def listen(self, callback: OnPrint) -> Callable[[], None]:
        """Also call *callback* with all output from now on. Return a function that ends this."""
        self._listeners.append(callback)
        return lambda: self._listeners.remove(callback) if callback in self._listeners else None

    def print(self, agent: str, text: str) -> None:
        """Print a line of an agent's output."""
        for callback in (self._on_print, *self._listeners):
            try:
                callback(agent, text)
            except Exception as error:
                self.log(
                    f"error: an on_print callback raised {error_text(error)}{place_of_fault(error)}",
                    "error",
                )

    def log(self, text: str, level: str = "info") -> None:
        """Log a line."""
        try:
            self._on_log(text, level)
        except Exception as error:
            self._standard.log(text, level)
            self._standard.log(
                f"error: an on_log callback raised {error_text(error)}{place_of_fault(error)}", "error"
            )

    def close(self) -> None:
        """Write what waits for a slow reader."""
        self._standard.close()
