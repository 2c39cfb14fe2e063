"""Callers whose connections belong to a door in a thread of its own: a session for each, while the caller is there."""

import asyncio
import time
from collections.abc import Callable, Coroutine, Iterator
from contextlib import contextmanager, suppress
from typing import Any, Generic, TypeVar

from jacaros.serving.callers import Caller, RequestError
from jacaros.serving.crossing import Crossing, Reply
from jacaros.serving.service import Service, Session

T = TypeVar("T")
LEASE = 15.0
"""Seconds after its last request or stream when a caller counts as gone."""


class RemoteCaller:
    """A caller. Methods that begin with an underscore belong to the loop of the run.

    Args:
        caller: who it is.
        crossing: the way to the run.
        service: the service of the run.
    """

    def __init__(self, caller: Caller, crossing: Crossing, service: Service) -> None:
        self.caller = caller
        self._crossing, self._service = crossing, service
        self._session: Session | None = None
        self._busy, self._seen = 0, time.monotonic()

    def came(self) -> None:
        """A request or stream begins."""
        self._busy += 1

    def went(self) -> None:
        """A request or stream has ended."""
        self._busy -= 1
        self._seen = time.monotonic()

    @contextmanager
    def present(self) -> Iterator[None]:
        """Count the caller as present."""
        self.came()
        try:
            yield
        finally:
            self.went()

    @property
    def is_gone(self) -> bool:
        """Whether it has had no request and no stream for some time."""
        return not self._busy and time.monotonic() - self._seen > LEASE

    async def leave(self) -> None:
        """End its session."""
        await self._crossing.call(self._close)

    def _close(self) -> None:
        if self._session is not None:
            self._session.close()

    def _opened(self) -> Session:
        if self._session is None or self._session.closed:
            self._session = self._service.open(self.caller)
        return self._session

    async def do(self, request: Callable[[Session], T]) -> T:
        """Call a function with the session, on the loop of the run."""
        with self.present():
            return await self._crossing.call(lambda: request(self._opened()))

    def ask(self, request: Callable[[Session, Reply[T]], object]) -> "asyncio.Future[T]":
        """Call a function with the session and what takes the answer, now or later, on the loop of the run."""
        answer: asyncio.Future[T] = self._crossing.ask(lambda reply: request(self._opened(), reply))
        self.came()
        answer.add_done_callback(lambda _: self.went())
        return answer

    async def wait(self, request: Callable[[Session], Coroutine[Any, Any, T]]) -> T:
        """Await a coroutine function with the session, on the loop of the run."""

        async def start() -> T:
            return await request(self._opened())

        with self.present():
            return await self._crossing.wait(start)


C = TypeVar("C", bound=RemoteCaller)


class RemoteCallers(Generic[C]):
    """The callers of a door.

    Args:
        new: makes what serves a caller.
    """

    def __init__(self, new: Callable[[Caller], C]) -> None:
        self._new, self._known = new, dict[Caller, C]()

    def __iter__(self) -> Iterator[C]:
        return iter(tuple(self._known.values()))

    def of(self, caller: Caller) -> C:
        """Return what serves a caller."""
        if caller not in self._known:
            self._known[caller] = self._new(caller)
        return self._known[caller]

    async def look(self) -> None:
        """End the sessions of callers that are gone, again and again."""
        while True:
            await asyncio.sleep(LEASE / 10)
            for each in self:
                if each.is_gone:
                    del self._known[each.caller]
                    with suppress(RequestError):
                        await each.leave()
