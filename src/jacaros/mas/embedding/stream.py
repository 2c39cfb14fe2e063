"""What comes one after the other and is kept until somebody takes it: what agents print, what people are told, messages."""

import asyncio
from collections import deque
from collections.abc import Callable
from typing import Generic, NamedTuple, TypeVar

from jacaros.mas.console import StandardConsole
from jacaros.mas.embedding.errors import RunEnded
from jacaros.mas.embedding.waits import Waits
from jacaros.mas.python_agents.faults import place_of_fault, said

T = TypeVar("T")


class Stream(Generic[T]):
    """An asynchronous iterator over what comes; it ends with the run, when everything that came has been taken.

    Args:
        waits: of the run.
        what: what is missing while nothing has come, for errors.
    """

    def __init__(self, waits: Waits, what: str) -> None:
        self._waits = waits
        self._what = what
        self._items: deque[T] = deque()
        self._waiting: deque[asyncio.Future[None]] = deque()

    def put(self, item: T) -> None:
        """Let something come; it is for whoever asks first."""
        self._items.append(item)
        self._wake()

    def _wake(self) -> None:
        while self._waiting:
            future = self._waiting.popleft()
            if not future.done():
                future.set_result(None)
                return

    async def get(self, timeout: float | None = None) -> T:
        """The next one; waits until it comes.

        Args:
            timeout: seconds of the run's clock; None to wait as long as it takes.

        Raises:
            TimeoutError: nothing came in time.
            RunEnded: nothing will come any more.
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
        """All that has come and was not taken yet, without waiting."""
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
    """A line that an agent printed.

    Attributes:
        agent: its name.
        text: the line, without the name.
    """

    agent: str
    text: str

    def __str__(self) -> str:
        return f"[{self.agent}] {self.text}"


OnPrint = Callable[[str, str], None]
"""Called with the name of an agent and what it prints."""

OnLog = Callable[[str, str], None]
"""Called with a line for people and its level: ``debug``, ``info``, ``warning`` or ``error``."""


class PrintedConsole:
    """The console of an embedded system.

    Args:
        on_print: shows what agents print; on the standard output, as ``[agent] text``, unless given.
        on_log: tells people; on the standard error output unless given.
    """

    def __init__(self, on_print: OnPrint | None, on_log: OnLog | None) -> None:
        # Finds the standard outputs at the time of writing: tests and notebooks put others in their place.
        self._standard = StandardConsole()
        self._on_print = on_print or self._standard.print
        self._on_log = on_log or self._standard.log
        self._listeners: list[OnPrint] = []

    def listen(self, told: OnPrint) -> Callable[[], None]:
        """Tell *told* what is printed from now on, too; gives what ends that."""
        self._listeners.append(told)
        return lambda: self._listeners.remove(told) if told in self._listeners else None

    def print(self, agent: str, text: str) -> None:
        """Show a line of an agent's output."""
        for told in (self._on_print, *self._listeners):
            try:
                told(agent, text)
            except Exception as error:
                self.log(
                    f"error: an output callback failed: {said(error)}{place_of_fault(error)}",
                    "error",
                )

    def log(self, text: str, level: str = "info") -> None:
        """Tell people about what happens."""
        try:
            self._on_log(text, level)
        except Exception as error:
            self._standard.log(text, level)
            self._standard.log(
                f"error: a callback for logs failed: {said(error)}{place_of_fault(error)}", "error"
            )

    def close(self) -> None:
        """Write what waits for a slow reader."""
        self._standard.close()
