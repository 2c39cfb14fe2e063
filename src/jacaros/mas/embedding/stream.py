"""What comes one after the other and is kept until somebody takes it: printed lines, messages."""

import asyncio
from collections import deque
from typing import Generic, TypeVar

from jacaros.mas.embedding.errors import RunEnded
from jacaros.mas.embedding.waits import Waits

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
