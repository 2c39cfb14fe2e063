"""Services independent of the middleware: checking messages, running handlers, and reporting their failures."""

import asyncio
import inspect
from collections.abc import Callable, Mapping
from typing import Any

from jacaros.ros.backend import Handler
from jacaros.ros.errors import CallFailed, MessageMismatch
from jacaros.ros.message import MessageFactory
from jacaros.ros.names import response_type


def published_message(factory: MessageFactory, topic: str, type_name: str, given: Any) -> Any:
    """Make the message for a publisher from a mapping.

    Raises:
        MessageMismatch: *given* is not a mapping, or does not match the type definition.
    """
    if not isinstance(given, Mapping):
        raise MessageMismatch(f"topic {topic}: expected a {type_name}, found {given!r}", type_name)
    return factory.make(type_name, given)


class Responder:
    """Runs the handler of one service on the loop, any number of calls at a time.

    Args:
        factory: makes the responses.
        name: absolute name of the service.
        type_name: service type in full form.
        handler: the user's function or coroutine function.
        log: called with one line about a failed handler.
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
        """Handle one request; *done* is called with the response or the failure."""
        task = asyncio.get_running_loop().create_task(self._answer(request, done))
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    def close(self) -> None:
        """Cancel the active calls; their clients are informed."""
        for task in list(self._tasks):
            task.cancel()

    async def _answer(self, request: Any, done: Callable[[Any, CallFailed | None], None]) -> None:
        try:
            result = self._handler(request)
            if inspect.isawaitable(result):
                result = await result
            response = self._factory.checked(self._response_type, result)
        except asyncio.CancelledError:
            done(None, CallFailed(f"service {self._name} was closed during the call"))
            raise
        except Exception as problem:  # the server keeps running, and the client receives the reason
            reason = f"{type(problem).__name__}: {problem}"
            self._log(f"the handler of service {self._name} failed: {reason}")
            done(None, CallFailed(f"service {self._name} failed: {reason}"))
        else:
            done(response, None)
