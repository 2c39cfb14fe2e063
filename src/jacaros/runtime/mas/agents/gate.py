"""Hold the tasks of an agent in Python between two of their steps."""

import asyncio
from collections.abc import Coroutine, Generator
from types import coroutine
from typing import Any


class Gate:
    """Lets tasks pass while it is open. It is open at first."""

    def __init__(self) -> None:
        self._opened = asyncio.Event()
        self._opened.set()

    @property
    def is_closed(self) -> bool:
        """Whether it holds tasks."""
        return not self._opened.is_set()

    def close(self) -> None:
        """Hold tasks before their next step."""
        self._opened.clear()

    def open(self) -> None:
        """Let them continue."""
        self._opened.set()

    async def passed(self) -> None:
        """Wait while it is closed."""
        await self._opened.wait()

    @coroutine
    def through(self, work: Coroutine[Any, Any, Any]) -> Generator[Any, None, Any]:
        """Await *work*, and hold each of its steps while the gate is closed. A cancellation passes."""
        error: BaseException | None = None
        while True:
            try:
                if error is None:
                    yield from self.passed()
            except asyncio.CancelledError as cancelled:
                error = cancelled
            try:
                awaited = work.send(None) if error is None else work.throw(error)
            except StopIteration as end:
                return end.value
            error = None
            try:
                yield awaited
            except BaseException as raised:  # as `await` does
                error = raised
