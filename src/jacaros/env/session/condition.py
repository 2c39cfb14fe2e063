"""Conditions that tasks wait for, evaluated after every change."""

import asyncio
from collections.abc import Callable
from typing import Any, TypeVar

from jacaros.clock import Clock

T = TypeVar("T")


class Conditions:
    """The conditions that one session waits for, in the order of waiting."""

    def __init__(self) -> None:
        self._waiting: dict[asyncio.Future[Any], Callable[[], Any]] = {}

    async def wait(
        self, condition: Callable[[], T], clock: Clock | None = None, timeout: float | None = None
    ) -> T:
        """Wait until *condition* is true, at most *timeout* seconds. Return its value.

        Raises:
            TimeoutError: the time limit has passed.
        """
        true: asyncio.Future[T] = asyncio.get_running_loop().create_future()
        self._waiting[true] = condition
        timer = None
        if clock is not None and timeout is not None:
            error = TimeoutError(f"the condition was not true within {timeout:g} s")
            timer = clock.call_later(timeout, lambda: _fail(true, error))
        try:
            return await true
        finally:
            self._waiting.pop(true, None)
            if timer is not None:
                timer.cancel()

    def evaluate(self) -> None:
        """Wake the tasks whose condition is true or raises."""
        for future, condition in tuple(self._waiting.items()):
            if future.done():
                continue
            try:
                value = condition()
            except Exception as error:
                _fail(future, error)
            else:
                if value and not future.done():
                    future.set_result(value)

    def close(self, error: Exception) -> None:
        """Wake all tasks with *error*."""
        for future in tuple(self._waiting):
            _fail(future, error)


def _fail(future: "asyncio.Future[Any]", error: Exception) -> None:
    if not future.done():
        future.set_exception(error)
