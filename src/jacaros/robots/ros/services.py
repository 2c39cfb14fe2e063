"""Services independent of the middleware: how a handler answers, how long a call is tried, and how it ends."""

import asyncio
import inspect
from collections.abc import Awaitable, Callable
from typing import Any

from jacaros.robots.ros.action import SERVER_LOST_AFTER
from jacaros.robots.ros.errors import CallFailed, CallTimedOut, ServerGone, ServiceUnavailable
from jacaros.robots.ros.names import request_type, response_type
from jacaros.robots.ros.node import Entity, N
from jacaros.robots.ros.waiting import RETRY, Deadline, WaitLog, settle
from jacaros.runtime.clock import Clock, Timer

LOOK = 1.0
"""Seconds between two checks whether the server of a call is still there."""
Handler = Callable[[Any], Any | Awaitable[Any]]
"""Takes a request; returns a response message, a mapping of its fields or None for the defaults."""


class ServiceServer(Entity[N]):
    """Answers the calls of a service on the loop, any number at a time; a driver passes them to `answer`.

    Args:
        node: its node.
        name: absolute name of the service.
        type_name: service type in full form.
        handler: the user's function or coroutine function.
    """

    def __init__(self, node: N, name: str, type_name: str, handler: Handler) -> None:
        super().__init__(node, name, type_name)
        self._handler = handler
        self._tasks: set[asyncio.Task[None]] = set()

    def answer(self, request: Any, done: Callable[[Any, CallFailed | None], None]) -> None:
        """Handle one request; *done* is called with the response or the failure."""
        task = asyncio.get_running_loop().create_task(self._handle(request, done))
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    def close(self) -> None:
        """Stop offering the service; the clients of active calls are informed."""
        super().close()
        for task in list(self._tasks):
            task.cancel()

    async def _handle(self, request: Any, done: Callable[[Any, CallFailed | None], None]) -> None:
        try:
            result = self._handler(request)
            if inspect.isawaitable(result):
                result = await result
            response = self._node.factory.checked(response_type(self.type_name), result)
        except asyncio.CancelledError:
            done(None, CallFailed(f"service {self.name} was closed during the call"))
            raise
        except Exception as problem:  # the server keeps running, and the client receives the reason
            reason = f"{type(problem).__name__}: {problem}"
            self._node.log(f"the handler of service {self.name} failed: {reason}")
            done(None, CallFailed(f"service {self.name} failed: {reason}"))
        else:
            done(response, None)


class ServiceClient(Entity[N]):
    """Calls a service. If the graph does not report new services, a call is attempted until the service is offered.

    Args:
        node: the node.
        name: absolute name of the service.
        type_name: service type in full form.
    """

    def __init__(self, node: N, name: str, type_name: str) -> None:
        super().__init__(node, name, type_name)
        self._waiting = WaitLog(node.clock, node.log, f"service {name} ({type_name})")
        self._answers: set[asyncio.Future[Any]] = set()

    @property
    def ready(self) -> bool:
        """Whether a node offers the service, as far as is known."""
        raise NotImplementedError

    def request(self, **fields: Any) -> Any:
        """Make a request message; see `Backend.message`."""
        return self._node.factory.make(request_type(self.type_name), fields)

    async def call(self, request: Any = None, timeout: float | None = None) -> Any:
        """Call the service and return its response.

        Args:
            request: a request message, a mapping of its fields, or None for the defaults.
            timeout: seconds to wait for the server and for the response, in total; None: no limit.

        Raises:
            MessageMismatch: the request does not match the type definition.
            ServiceUnavailable: no node offered the service in time.
            CallTimedOut: the server did not answer in time.
            CallFailed: the server's handler failed (only with `Capability.SERVICE_ERRORS`), or the connection broke.
        """
        message = self._node.factory.checked(request_type(self.type_name), request)

        async def attempt(rest: float | None) -> Any:
            return await self._attempt(message, rest)

        return await call_when_offered(self._waiting, attempt, timeout, self._may_be_called)

    def close(self) -> None:
        """Close the client; pending calls fail with `CallFailed`."""
        super().close()
        for answer in list(self._answers):
            settle(answer, None, CallFailed(f"the client of service {self.name} was closed during the call"))

    def _new_answer(self) -> asyncio.Future[Any]:
        answer: asyncio.Future[Any] = asyncio.get_running_loop().create_future()
        self._answers.add(answer)
        answer.add_done_callback(self._answers.discard)
        return answer

    def _may_be_called(self) -> bool:
        """Whether an unanswered attempt may have reached a server, see `call_when_offered`."""
        return True

    async def _attempt(self, message: Any, rest: float | None) -> Any:
        """Call the service once, see `call_when_offered`."""
        raise NotImplementedError


Service = ServiceServer[Any]
Client = ServiceClient[Any]


async def call_when_offered(
    waiting: WaitLog,
    attempt: Callable[[float | None], Awaitable[Any]],
    timeout: float | None,
    may_be_called: Callable[[], bool] = lambda: True,
) -> Any:
    """Call a service whose appearance is not reported: retry until it is offered.

    Args:
        waiting: has the clock and the name of the service with its type, and logs the waits for it.
        attempt: calls the service once; takes the remaining seconds, raises `ServiceUnavailable` if no node offers it
            and `TimeoutError` if there is no answer.
        timeout: seconds in total; None: no limit.
        may_be_called: whether an unanswered attempt may have reached a server. If another process has to be asked for
            the server, the last attempt may time out before it reports that none exists.

    Raises:
        ServiceUnavailable: no node offered the service in time.
        CallTimedOut: it was called but did not answer in time.
    """
    deadline = Deadline(waiting.clock, timeout)
    end: Callable[[bool], None] | None = None
    found = False
    try:
        while True:
            try:
                response = await attempt(deadline.left)
            except TimeoutError:
                if end is None or may_be_called():
                    raise CallTimedOut(f"{waiting.what} did not answer within {timeout:g} s") from None
                missing = True
            except ServiceUnavailable:
                missing = deadline.comes_within(RETRY)
            else:
                found = True
                return response
            if missing:
                raise ServiceUnavailable(f"no node offered {waiting.what} within {timeout:g} s") from None
            end = end or waiting.begin()
            await waiting.clock.sleep(RETRY)
    finally:
        if end is not None:
            end(found)
        elif found:
            waiting.found()


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
