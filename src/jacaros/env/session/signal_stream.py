"""Signals as a stream that can be read with ``async for``."""

import asyncio
from collections import deque
from collections.abc import Callable
from contextlib import AbstractContextManager
from typing import NamedTuple

from jacaros.env.ids import ArtifactId


class ReceivedSignal(NamedTuple):
    """A signal that an observer received.

    Attributes:
        name: of the signal.
        arguments: plain values.
        artifact: where it comes from.
    """

    name: str
    arguments: tuple[object, ...]
    artifact: ArtifactId


class SignalStream:
    """The signals of focused artifacts from now on, in their order; none is lost while nobody reads.

    It ends (``async for`` is over) when it or its session is closed, after the signals that came before.

    Args:
        name: only signals of this name, None for all.
        artifact: only those of this artifact, None for all.
        waiting: surrounds each wait.
    """

    def __init__(
        self,
        name: str | None,
        artifact: ArtifactId | None,
        waiting: Callable[[], AbstractContextManager[None]],
    ) -> None:
        self._name, self._artifact, self._waiting = name, artifact, waiting
        self._received: deque[ReceivedSignal] = deque()
        self._news = asyncio.Event()
        self._closed = False

    def put(self, signal: ReceivedSignal) -> None:
        """Take a signal in, if it is of those that are wanted."""
        if self._closed or self._name not in (None, signal.name):
            return
        if self._artifact is not None and signal.artifact is not self._artifact:
            return
        self._received.append(signal)
        self._news.set()

    def close(self) -> None:
        """Take nothing in any more."""
        self._closed = True
        self._news.set()

    def __aiter__(self) -> "SignalStream":
        return self

    async def __anext__(self) -> ReceivedSignal:
        while not self._received:
            if self._closed:
                raise StopAsyncIteration
            self._news.clear()
            with self._waiting():
                await self._news.wait()
        return self._received.popleft()
