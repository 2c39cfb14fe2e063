"""Services of ROS 2."""

import asyncio
import time
from collections.abc import Callable
from typing import Any

from jacaros.robots.ros.drivers.ros2.graph import mismatch, service_servers
from jacaros.robots.ros.drivers.ros2.node import Ros2Node
from jacaros.robots.ros.errors import CallFailed, ServiceUnavailable
from jacaros.robots.ros.handoff import post
from jacaros.robots.ros.services import Handler, ServerWatch, ServiceClient, ServiceServer
from jacaros.robots.ros.waiting import settle, within

SETTLING = 0.5
"""Seconds between discovering a server and the first request: answers before it has discovered the client are lost."""

REPEATED = 2.0
"""Seconds without a response after which a repeatable request is sent again; each further wait is twice as long."""

COMPARING = 1.0
"""Seconds between two checks of who offers a called service."""


DOUBTED, DOUBTED_AGAIN = 2.0, 5.0
"""Seconds without an answer after which the server's liveness is checked, and then between checks."""


class _AskedServers:
    """The servers of a service when it was called, and whether one of them is still there."""

    def __init__(self, node: Ros2Node, name: str) -> None:
        self._node = node
        self._name = name
        self._dead: frozenset[bytes] = frozenset()
        self._doubt_at = time.monotonic() + DOUBTED
        self.known = service_servers(node.rcl, name)

    def there(self) -> bool:
        """Return whether one of them is there, as far as is known; a long call starts liveness checks."""
        now = time.monotonic()
        if now >= self._doubt_at:
            self._doubt_at = now + DOUBTED_AGAIN
            self._node.check_liveness(
                lambda rcl: service_servers(rcl, self._name), self.known, self._note_dead
            )
        return not self.known.isdisjoint(service_servers(self._node.rcl, self._name) - self._dead)

    def _note_dead(self, missing: frozenset[bytes]) -> None:
        self._dead = missing


class LateService:
    """A service whose response may be sent at any time.

    rclpy expects the response when its callback returns. Here the callback returns the request instead, and *sending*
    it passes it to the loop; the loop sends the real response when it is ready. So a handler does not block the
    executor, and any number of calls run concurrently.

    Args:
        node: the backend.
        service_class: rclpy's class of the service type.
        name: absolute name.
        take: called on the loop with each request and the function that sends the response.
    """

    def __init__(
        self,
        node: Ros2Node,
        service_class: Any,
        name: str,
        take: Callable[[Any, Callable[[Any], None]], None],
    ) -> None:
        self._node = node
        self._take = take
        self._service: Any = node.rcl.create_service(service_class, name, lambda request, _: request)
        self._send = self._service.send_response
        self._service.send_response = self._hand_over
        self._closed = False

    def close(self, late: bool = False) -> None:
        """Stop offering the service; *late*: after the last responses have arrived."""
        if not self._closed:
            self._closed = True
            destroy_entity = self._node.destroy_entity_later if late else self._node.destroy_entity
            destroy_entity(self._node.rcl.destroy_service, self._service)

    def _hand_over(self, request: Any, header: Any) -> None:
        def respond(response: Any) -> None:
            if self._closed or self._node.ended:
                return
            try:
                self._send(response, header)
            except Exception as problem:  # the client has gone, which is not our fault
                self._node.log(f"a response could not be sent: {problem}")

        post(self._node.loop, self._take, request, respond)


class Ros2Service(ServiceServer[Ros2Node]):
    """Service of the ``ros2`` backend."""

    def __init__(self, node: Ros2Node, name: str, type_name: str, handler: Handler) -> None:
        super().__init__(node, name, type_name, handler)
        self._service = LateService(node, node.schema.message_class(type_name), name, self._answer)

    def _leave(self) -> None:
        self._service.close()

    def _answer(self, request: Any, respond: Callable[[Any], None]) -> None:
        def done(response: Any, problem: CallFailed | None) -> None:
            # ROS 2 cannot report a failure to a client: its call times out.
            if problem is None:
                respond(response)

        self.answer(request, done)


class _Requests:
    """The requests of one call: one, or more if it may be repeated.

    A response is lost if the server discovered the client later than `SETTLING`, as on a busy machine, and neither
    side learns that. A repeated request is the only remedy, and only for a service that may be called twice.
    """

    def __init__(self, node: Ros2Node, client: Any, message: Any, finished: Callable[[Any], None]) -> None:
        self._node, self._client, self._message, self._finished = node, client, message, finished
        self._futures: list[Any] = []
        self._timer: asyncio.TimerHandle | None = None

    def send(self, again_after: float | None) -> None:
        """Send the request, and again after so many seconds; None: only once."""
        future = self._client.call_async(self._message)
        future.add_done_callback(self._finished)
        self._futures.append(future)
        if again_after is not None:
            self._timer = self._node.loop.call_later(again_after, self.send, 2 * again_after)

    def close(self) -> None:
        if self._timer is not None:
            self._timer.cancel()
        for future in self._futures:
            self._client.remove_pending_request(future)


class Ros2Client(ServiceClient[Ros2Node]):
    """Client of the ``ros2`` backend.

    Args:
        node: the backend.
        name: absolute name of the service.
        type_name: service type in full form.
        repeatable: whether the server may receive a request twice.
    """

    def __init__(self, node: Ros2Node, name: str, type_name: str, repeatable: bool = False) -> None:
        super().__init__(node, name, type_name)
        self._again_after = REPEATED if repeatable else None
        self._client: Any = node.rcl.create_client(node.schema.message_class(type_name), name)
        self._servers: frozenset[bytes] = frozenset()
        self._compared = 0.0
        self._acquainted = False

    @property
    def ready(self) -> bool:
        """Whether a node offers the service."""
        return not self._closed and bool(self._client.service_is_ready())

    async def _attempt(self, message: Any, rest: float | None) -> Any:
        node, clock = self._node, self._node.clock
        deadline = None if rest is None else clock.elapsed + rest
        if not self.ready:
            self._acquainted = False
            # A server of another type is never ready for us.
            self._require_type()
            raise ServiceUnavailable(f"no node offers service {self.name}")
        if self._is_new():
            await clock.sleep(SETTLING if rest is None else min(SETTLING, rest / 4))
            if self._closed:
                raise CallFailed(f"the client of service {self.name} was closed during the call")
            self._require_type()
            self._acquainted = True
        answer = self._new_answer()

        def finished(future: Any) -> None:
            problem = future.exception()
            failure = None if problem is None else CallFailed(f"service {self.name}: {problem}")
            post(node.loop, settle, answer, None if problem else future.result(), failure)

        requests = _Requests(node, self._client, message, finished)
        requests.send(self._again_after)
        asked = _AskedServers(node, self.name)

        def is_there() -> bool:
            if self._closed or node.ended:
                return True  # then the call ends in another way
            return asked.there() if asked.known else self.ready

        try:
            with ServerWatch(clock, self.name, answer, is_there):
                return await within(clock, answer, None if deadline is None else deadline - clock.elapsed)
        finally:
            requests.close()

    def _require_type(self) -> None:
        problem = mismatch(self._node, "service", self.name, self.type_name)
        if problem is not None:
            raise CallFailed(problem)

    def _is_new(self) -> bool:
        """Return whether the server is new; after a crash, the next one takes over before the first counts as
        missing."""
        now = time.monotonic()
        if self._acquainted and now < self._compared + COMPARING:
            return False
        self._compared = now
        servers = service_servers(self._node.rcl, self.name)
        fresh = not self._acquainted or not servers <= self._servers
        self._servers |= servers
        return fresh

    def _leave(self) -> None:
        self._node.destroy_entity_later(self._node.rcl.destroy_client, self._client)
