"""Signals as a stream for ``async for``."""

import asyncio
from collections import deque
from collections.abc import Callable
from contextlib import AbstractContextManager
from typing import NamedTuple

from jacaros.env.ids import ArtifactId


class ReceivedSignal(NamedTuple):
    """A signal that an observer received.

    Attributes:
        name: name of the signal.
        arguments: plain values.
        artifact: the source.
    """

    name: str
    arguments: tuple[object, ...]
    artifact: ArtifactId


class SignalStream:
    """The signals of focused artifacts from now on, in order. Signals are kept until they are read.

    The stream ends when it or its session is closed, after the signals that arrived before.

    Args:
        name: only signals of this name. None for all.
        artifact: only signals of this artifact. None for all.
        waiting: context of each wait.
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
        """Add a signal, if it matches."""
        if self._closed or self._name not in (None, signal.name):
            return
        if self._artifact is not None and signal.artifact is not self._artifact:
            return
        self._received.append(signal)
        self._news.set()

    def close(self) -> None:
        """End the stream."""
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
