"""Service calls independent of the middleware: how long they are tried, and how they end."""

import asyncio
import sys
from collections.abc import Awaitable, Callable
from typing import Any

from jacaros.ros.action import SERVER_LOST_AFTER
from jacaros.ros.errors import CallFailed, CallTimedOut, ServerGone, ServiceUnavailable
from jacaros.ros.names import request_type
from jacaros.ros.node import Node
from jacaros.ros.waiting import RETRY, Absence, Deadline, Waiting, settle
from jacaros.runtime.clock import Clock, Timer

LOOK = 1.0
"""Seconds between two checks whether the server of a call is still there."""


class AttemptingClient:
    """Client of a service on a graph that does not report new services: a call is attempted until the service is
    offered.

    Args:
        node: the node.
        name: absolute name of the service.
        type_name: service type in full form.
    """

    _node: Node

    def __init__(self, node: Node, name: str, type_name: str) -> None:
        self.name = name
        self._node = node
        self._type_name = type_name
        self._pending = PendingCalls(name)
        self._absence = Absence()

    def request(self, **fields: Any) -> Any:
        """Make a request message."""
        return self._node.factory.make(request_type(self._type_name), fields)

    async def call(self, request: Any = None, timeout: float | None = None) -> Any:
        """Call the service and return its response."""
        node = self._node
        message = node.factory.checked(request_type(self._type_name), request)
        what = f"service {self.name} ({self._type_name})"

        async def attempt(rest: float | None) -> Any:
            return await self._attempt(message, rest)

        return await call_when_offered(
            node.clock, node.log, what, attempt, timeout, self._may_be_called, self._absence
        )

    def _may_be_called(self) -> bool:
        """Whether an unanswered attempt may have reached a server, see `call_when_offered`."""
        return True

    async def _attempt(self, message: Any, rest: float | None) -> Any:
        """Call the service once, see `call_when_offered`."""
        raise NotImplementedError


async def call_when_offered(
    clock: Clock,
    log: Callable[[str], None],
    what: str,
    attempt: Callable[[float | None], Awaitable[Any]],
    timeout: float | None,
    may_be_called: Callable[[], bool] = lambda: True,
    absence: Absence | None = None,
) -> Any:
    """Call a service whose appearance is not reported: retry until it is offered.

    Args:
        clock: measures the time-out.
        log: called when it waits.
        what: the service with its type.
        attempt: calls the service once; takes the remaining seconds, raises `ServiceUnavailable` if no node offers it
            and `TimeoutError` if there is no answer.
        timeout: seconds in total; None: no limit.
        may_be_called: whether an unanswered attempt may have reached a server. If another process has to be asked for
            the server, the last attempt may time out before it reports that none exists.
        absence: number of earlier calls without a server, see `Waiting`.

    Raises:
        ServiceUnavailable: no node offered the service in time.
        CallTimedOut: it was called but did not answer in time.
    """
    deadline = Deadline(clock, timeout)
    waiting: Waiting | None = None

    def nobody() -> ServiceUnavailable:
        return ServiceUnavailable(f"no node offered {what} within {timeout:g} s")

    try:
        while True:
            try:
                response = await attempt(deadline.left)
            except TimeoutError:
                if waiting is not None and not may_be_called():
                    raise nobody() from None
                raise CallTimedOut(f"{what} did not answer within {timeout:g} s") from None
            except ServiceUnavailable:
                if deadline.comes_within(RETRY):
                    raise nobody() from None
            else:
                if waiting is None and absence is not None:
                    absence.end(log, what)
                return response
            if waiting is None:
                help = "is the node that offers it running?"
                waiting = Waiting(clock, log, what, help, absence=absence).__enter__()
            await clock.sleep(RETRY)
    finally:
        if waiting is not None:
            waiting.__exit__(*sys.exc_info())


class PendingCalls:
    """The futures of a client's pending calls, so that closing the client ends them.

    Args:
        name: absolute name of the service.
    """

    def __init__(self, name: str) -> None:
        self._name = name
        self._futures: set[asyncio.Future[Any]] = set()

    def new(self) -> asyncio.Future[Any]:
        """Return the future of a new call."""
        future: asyncio.Future[Any] = asyncio.get_running_loop().create_future()
        self._futures.add(future)
        future.add_done_callback(self._futures.discard)
        return future

    def close(self) -> None:
        """Fail the pending calls."""
        for future in list(self._futures):
            settle(future, None, CallFailed(f"the client of service {self._name} was closed during the call"))


class ServerWatch:
    """Fail a call whose server has disappeared, if the middleware does not report that; a context manager around the
    wait.

    A server has disappeared if it was seen and then missing for `SERVER_LOST_AFTER`.

    Args:
        clock: measures the time.
        name: absolute name of the service.
        answer: the future of the call.
        is_there: whether the called server is still in the graph, as far as is known.
    """

    def __init__(
        self, clock: Clock, name: str, answer: "asyncio.Future[Any]", is_there: Callable[[], bool]
    ) -> None:
        self._clock, self._name, self._answer, self._is_there = clock, name, answer, is_there
        self._seen = False
        self._missed = 0.0
        self._timer: Timer | None = None

    def __enter__(self) -> "ServerWatch":
        self._seen = self._is_there()
        self._look_later()
        return self

    def __exit__(self, *_: object) -> None:
        if self._timer is not None:
            self._timer.cancel()

    def _look_later(self) -> None:
        self._timer = self._clock.call_later(LOOK, self._look)

    def _look(self) -> None:
        if self._is_there():
            self._seen, self._missed = True, 0.0
        elif self._seen:
            self._missed += LOOK
        if self._missed > SERVER_LOST_AFTER:
            settle(self._answer, None, server_gone(self._name))
        else:
            self._look_later()


def server_gone(name: str) -> ServerGone:
    """Return the failure of a call whose server has disappeared."""
    return ServerGone(
        f"the server of service {name} went away during the call; it is unknown whether it was executed"
    )
