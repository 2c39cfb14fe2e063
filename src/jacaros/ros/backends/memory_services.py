"""Services and their clients of `jacaros.ros.backends.memory`."""

import asyncio
from functools import partial
from typing import Any

from jacaros.ros.action import SERVER_LOST_AFTER
from jacaros.ros.backend import Handler
from jacaros.ros.backends.memory_members import GraphService
from jacaros.ros.backends.memory_node import MemoryNode
from jacaros.ros.calling import PendingCalls, server_gone, settle
from jacaros.ros.errors import CallFailed, CallTimedOut, ServiceUnavailable
from jacaros.ros.names import request_type
from jacaros.ros.serving import Responder, checked_message
from jacaros.ros.waiting import Absence, Waiting, within


class MemoryService:
    """Service of `MemoryBackend`."""

    def __init__(self, node: MemoryNode, name: str, type_name: str, handler: Handler) -> None:
        self.name = name
        self.type_name = type_name
        self._node = node
        self._graph = node.graph
        self._responder = Responder(node.factory, name, type_name, handler, node.log)
        self._vanished = False
        self._clock = node.clock
        self._answers: set[asyncio.Future[Any]] = set()
        self._graph.offer(self)

    def handle(self, request: Any, answer: asyncio.Future[Any]) -> None:
        """Run the handler for one call."""

        def done(response: Any, problem: CallFailed | None) -> None:
            if self._vanished:
                return
            self._answers.discard(answer)
            if self._graph.up:
                settle(answer, response, problem)
            else:
                self._graph.tell(settle, answer, response, problem)

        self._answers.add(answer)
        self._responder.answer(request, done)

    def close(self) -> None:
        """Stop to offer the service."""
        self._graph.withdraw(self)
        self._responder.close()
        self._node.forget(self)

    def vanish(self) -> None:
        """Be gone without a word: its clients find that out after a while."""
        self._vanished = True
        for answer in self._answers:
            self._clock.call_later(SERVER_LOST_AFTER, partial(settle, answer, None, server_gone(self.name)))
        self._answers.clear()
        self.close()


class MemoryClient:
    """Client of `MemoryBackend`."""

    def __init__(self, node: MemoryNode, name: str, type_name: str) -> None:
        self.name = name
        self._node = node
        self._type_name = type_name
        self._pending = PendingCalls(name)
        self._absence = Absence()

    @property
    def ready(self) -> bool:
        """Whether somebody offers the service."""
        return self._node.graph.server(self.name) is not None

    def request(self, **fields: Any) -> Any:
        """Make a request message."""
        return self._node.factory.make(request_type(self._type_name), fields)

    async def call(self, request: Any = None, timeout: float | None = None) -> Any:
        """Call the service and give its response."""
        clock = self._node.clock
        message = checked_message(self._node.factory, request_type(self._type_name), request)
        deadline = None if timeout is None else clock.elapsed + timeout
        server = await self._server(timeout)
        if server.type_name != self._type_name:
            raise CallFailed(f"service {self.name} is of type {server.type_name}, not {self._type_name}")
        answer = self._pending.new()
        server.handle(message, answer)
        try:
            return await within(clock, answer, None if deadline is None else deadline - clock.elapsed)
        except TimeoutError:
            raise CallTimedOut(f"service {self.name} did not answer within {timeout:g} s") from None

    async def _server(self, timeout: float | None) -> GraphService:
        graph = self._node.graph
        what = f"service {self.name} ({self._type_name})"
        server = graph.server(self.name)
        while server is None:
            await come(self._node, f"service {self.name}", what, timeout, self._absence)
            server = graph.server(self.name)
        self._absence.end(self._node.log, what)
        return server

    def close(self) -> None:
        """Give the client up."""
        self._pending.close()
        self._node.forget(self)


async def come(node: MemoryNode, thing: str, what: str, timeout: float | None, absence: Absence) -> None:
    """Wait until something has come to the graph, with a report.

    Args:
        node: who waits.
        thing: what `MemoryGraph.arrival` calls it.
        what: what people call it.
        timeout: seconds.
        absence: how often it was awaited before, see `Waiting`.

    Raises:
        ServiceUnavailable: it has not come in time.
    """
    with Waiting(node.clock, node.log, what, "Is the node that offers it running?", absence=absence):
        try:
            await within(node.clock, node.graph.arrival(thing), timeout)
        except TimeoutError:
            raise ServiceUnavailable(f"nobody offered {what} within {timeout:g} s") from None
