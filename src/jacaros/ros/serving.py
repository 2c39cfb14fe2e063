"""Services apart from the middleware: making requests, running handlers, and what their failures become."""

import asyncio
import inspect
import sys
from collections.abc import Awaitable, Callable, Mapping
from typing import Any

from jacaros.clock import Clock, Timer
from jacaros.ros.action import SERVER_LOST_AFTER
from jacaros.ros.backend import Handler
from jacaros.ros.errors import CallFailed, CallTimedOut, MessageMismatch, ServerGone, ServiceUnavailable
from jacaros.ros.message import MessageFactory
from jacaros.ros.names import response_type
from jacaros.ros.waiting import Waiting

LOOK = 1.0
"""Seconds between two looks whether the server of a call is still there."""

RETRY = 0.1
"""Seconds between two attempts to call a service that is not there."""


def checked_message(factory: MessageFactory, type_name: str, given: Any) -> Any:
    """Give *given* as a message of a type: itself, or made from a mapping, or all defaults for None.

    Raises:
        MessageMismatch: it does not fit the type's definition.
    """
    if given is None or isinstance(given, Mapping):
        return factory.make(type_name, given)
    if not isinstance(given, factory.message_class(type_name)):
        raise MessageMismatch(f"a {type_name} is needed, not {given!r}", type_name)
    return given


def published_message(factory: MessageFactory, topic: str, type_name: str, given: Any) -> Any:
    """Make the message that a publisher sends of the mapping that it was given.

    Raises:
        MessageMismatch: *given* is no mapping, or does not fit the type's definition.
    """
    if not isinstance(given, Mapping):
        raise MessageMismatch(f"topic {topic} carries {type_name}, not {given!r}", type_name)
    return factory.make(type_name, given)


class Responder:
    """Runs the handler of one service on the loop, any number of calls at a time.

    Args:
        factory: makes the responses.
        name: absolute name of the service.
        type_name: service type in full form.
        handler: the user's function or coroutine function.
        log: takes one line about a handler that failed.
    """

    def __init__(
        self, factory: MessageFactory, name: str, type_name: str, handler: Handler, log: Callable[[str], None]
    ) -> None:
        self._factory = factory
        self._name = name
        self._response_type = response_type(type_name)
        self._handler = handler
        self._log = log
        self._tasks: set[asyncio.Task[None]] = set()

    def answer(self, request: Any, done: Callable[[Any, CallFailed | None], None]) -> None:
        """Handle one request; *done* gets the response, or the failure."""
        task = asyncio.get_running_loop().create_task(self._answer(request, done))
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    def close(self) -> None:
        """Cancel the calls under way; their clients are told."""
        for task in list(self._tasks):
            task.cancel()

    async def _answer(self, request: Any, done: Callable[[Any, CallFailed | None], None]) -> None:
        try:
            result = self._handler(request)
            if inspect.isawaitable(result):
                result = await result
            response = checked_message(self._factory, self._response_type, result)
        except asyncio.CancelledError:
            done(None, CallFailed(f"service {self._name} was closed during the call"))
            raise
        except Exception as problem:  # the server lives on, and the client learns of it
            reason = f"{type(problem).__name__}: {problem}"
            self._log(f"the handler of service {self._name} failed: {reason}")
            done(None, CallFailed(f"service {self._name} failed: {reason}"))
        else:
            done(response, None)


class PendingCalls:
    """The futures of a client's calls under way, so that closing the client ends them.

    Args:
        name: absolute name of the service.
    """

    def __init__(self, name: str) -> None:
        self._name = name
        self._futures: set[asyncio.Future[Any]] = set()

    def new(self) -> asyncio.Future[Any]:
        """Make the future of one call."""
        future: asyncio.Future[Any] = asyncio.get_running_loop().create_future()
        self._futures.add(future)
        future.add_done_callback(self._futures.discard)
        return future

    def close(self) -> None:
        """Fail what is under way."""
        for future in list(self._futures):
            settle(future, None, CallFailed(f"the client of service {self._name} was closed during the call"))


class ServerWatch:
    """Fails a call whose server has gone, where the middleware does not tell; a context manager around the wait.

    A server is gone when it has been seen and then not been there for `SERVER_LOST_AFTER`.

    Args:
        clock: measures the patience.
        name: absolute name of the service.
        answer: the future of the call.
        is_there: whether the server that was asked is still in the graph, as far as is known.
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
    """What a call fails with whose server has gone."""
    return ServerGone(
        f"the server of service {name} went away during the call; whether it was done is not known"
    )


def settle(future: asyncio.Future[Any], response: Any, problem: Exception | None) -> None:
    """Give a call its response or failure, unless it is over: timed out or given up."""
    if future.done():
        return
    if problem is not None:
        future.set_exception(problem)
    else:
        future.set_result(response)


async def call_when_offered(
    clock: Clock,
    log: Callable[[str], None],
    what: str,
    attempt: Callable[[float | None], Awaitable[Any]],
    timeout: float | None,
) -> Any:
    """Call a service whose arrival cannot be awaited: try, and try again while nobody offers it.

    Args:
        clock: measures the time-out.
        log: is told of waiting.
        what: the service with its type.
        attempt: calls the service once; takes the seconds that are left, raises `ServiceUnavailable` when
            nobody
            offers it and `TimeoutError` when there is no answer.
        timeout: seconds for everything; None tries for ever.

    Raises:
        ServiceUnavailable: nobody offered the service in time.
        CallTimedOut: it was called but did not answer in time.
    """
    deadline = None if timeout is None else clock.elapsed + timeout
    waiting: Waiting | None = None
    try:
        while True:
            try:
                return await attempt(None if deadline is None else deadline - clock.elapsed)
            except TimeoutError:
                raise CallTimedOut(f"{what} did not answer within {timeout:g} s") from None
            except ServiceUnavailable:
                if deadline is not None and clock.elapsed + RETRY > deadline:
                    raise ServiceUnavailable(f"nobody offered {what} within {timeout:g} s") from None
            if waiting is None:
                waiting = Waiting(clock, log, what, "Is the node that offers it running?").__enter__()
            await clock.sleep(RETRY)
    finally:
        if waiting is not None:
            waiting.__exit__(*sys.exc_info())
