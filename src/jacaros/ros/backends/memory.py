"""A ROS graph inside the process: nothing to install, deterministic, as fast as the loop.

Topics, services and quality of service behave as on ROS 2; the message classes are the genuine definitions
from ``rosbags``.  A published message is handed over by reference, one turn of the loop per message, in the
order of publishing; so messages are read-only from `publish` on.
"""

import asyncio
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, TypeVar

from jacaros.ros.backend import (
    QOS,
    SERVICE_ERRORS,
    SERVICES,
    TOPICS,
    TRANSFORMS,
    Backend,
    Handler,
    Sample,
    TopicEvent,
)
from jacaros.ros.errors import CallFailed, CallTimedOut, MessageMismatch, ServiceUnavailable
from jacaros.ros.names import message_type, request_type, service_type
from jacaros.ros.node import Node, NodeSettings
from jacaros.ros.qos import DEFAULT_QOS, QoS, incompatibility
from jacaros.ros.serving import PendingCalls, Responder, checked_message, settle
from jacaros.ros.typestore import RosbagsSchema
from jacaros.ros.waiting import Waiting, within

_M = TypeVar("_M", "MemoryPublisher", "MemorySubscription", "MemoryService", "MemoryClient")


@dataclass
class _Topic:
    type_name: str
    publishers: list["MemoryPublisher"] = field(default_factory=list)
    subscriptions: list["MemorySubscription"] = field(default_factory=list)


class MemoryGraph:
    """Topics and services shared by the nodes of one process."""

    def __init__(self) -> None:
        self._topics: dict[str, _Topic] = {}
        self._services: dict[str, MemoryService] = {}
        self._awaited: dict[str, list[asyncio.Future[None]]] = {}

    def topic(self, name: str, type_name: str) -> _Topic:
        """Give the topic called *name*.

        Raises:
            MessageMismatch: it carries messages of another type already.
        """
        topic = self._topics.setdefault(name, _Topic(type_name))
        if not topic.publishers and not topic.subscriptions:
            topic.type_name = type_name
        if topic.type_name != type_name:
            raise MessageMismatch(f"topic {name} carries {topic.type_name}, not {type_name}", type_name)
        return topic

    def topics(self) -> dict[str, str]:
        """Names of all topics in use with their types."""
        return {
            name: topic.type_name
            for name, topic in self._topics.items()
            if topic.publishers or topic.subscriptions
        }

    def offer(self, service: "MemoryService") -> None:
        """Make *service* reachable; a newer one of the same name takes over, as on ROS 1."""
        self._services[service.name] = service
        for future in self._awaited.pop(service.name, []):
            if not future.done():
                future.set_result(None)

    def withdraw(self, service: "MemoryService") -> None:
        """Take *service* out again."""
        if self._services.get(service.name) is service:
            del self._services[service.name]

    def server(self, name: str) -> "MemoryService | None":
        """The service called *name*, if it is offered."""
        return self._services.get(name)

    def arrival(self, name: str) -> asyncio.Future[None]:
        """A future that is done when a service called *name* is offered."""
        future: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        self._awaited.setdefault(name, []).append(future)
        return future


class MemoryPublisher:
    """Publisher of `MemoryBackend`."""

    def __init__(self, node: "MemoryBackend", topic: str, type_name: str, qos: QoS) -> None:
        self.topic = topic
        self.qos = qos
        self._node = node
        self._type_name = type_name
        self._class = node.factory.message_class(type_name)
        self._shared = node.graph.topic(topic, type_name)
        self._shared.publishers.append(self)
        self._receivers = [s for s in self._shared.subscriptions if s.matches(self)]
        self.kept: deque[Any] = deque(maxlen=qos.depth if qos.durability == "transient_local" else 0)

    @property
    def subscription_count(self) -> int:
        """How many subscriptions are connected now."""
        return len(self._receivers)

    def message(self, **fields: Any) -> Any:
        """Make a message of the topic's type."""
        return self._node.factory.make(self._type_name, fields)

    def publish(self, message: Any) -> None:
        """Hand *message* to all subscriptions."""
        if not isinstance(message, self._class):
            raise MessageMismatch(
                f"topic {self.topic} carries {self._type_name}, not {message!r}", self._type_name
            )
        if not self._node.exit_hooks.admits():
            return
        self.kept.append(message)
        for subscription in self._receivers:
            subscription.put(message)

    def connect(self, subscription: "MemorySubscription") -> None:
        """Send to a new subscription from now on, and what is kept for late ones at once."""
        self._receivers.append(subscription)
        if subscription.qos.durability == "transient_local":
            for message in self.kept:
                subscription.put(message)

    def disconnect(self, subscription: "MemorySubscription") -> None:
        """Send to a subscription no more."""
        if subscription in self._receivers:
            self._receivers.remove(subscription)

    def close(self) -> None:
        """Leave the topic."""
        if self in self._shared.publishers:
            self._shared.publishers.remove(self)
        self._receivers = []


class MemorySubscription:
    """Subscription of `MemoryBackend`."""

    def __init__(
        self, node: "MemoryBackend", topic: str, type_name: str, callback: Callable[[Sample], None], qos: QoS
    ) -> None:
        self.topic = topic
        self.qos = qos
        self._node = node
        self._callback = callback
        self._waiting: deque[Any] = deque(maxlen=qos.depth)
        self._shared = node.graph.topic(topic, type_name)
        self._shared.subscriptions.append(self)
        for publisher in self._shared.publishers:
            if self.matches(publisher):
                publisher.connect(self)

    @property
    def publisher_count(self) -> int:
        """How many publishers are connected now."""
        return sum(1 for publisher in self._shared.publishers if not incompatibility(publisher.qos, self.qos))

    def matches(self, publisher: MemoryPublisher) -> bool:
        """Whether the publisher's offer meets the request; said in the log when not."""
        problem = incompatibility(publisher.qos, self.qos)
        if problem is not None:
            self._node.log(f"topic {self.topic}: not connected, because {problem}")
        return problem is None

    def put(self, message: Any) -> None:
        """Queue *message* for a turn of the loop; the oldest is dropped when the queue is full."""
        loop = self._node.loop
        if not loop.is_closed():
            self._waiting.append(message)
            loop.call_soon(self._deliver_next)

    def close(self) -> None:
        """Leave the topic."""
        if self in self._shared.subscriptions:
            self._shared.subscriptions.remove(self)
        for publisher in self._shared.publishers:
            publisher.disconnect(self)
        self._waiting.clear()

    def _deliver_next(self) -> None:
        # Empty when a later message pushed this turn's one out, or when the subscription was closed.
        if self._waiting:
            self._callback(self._node.sample(self._waiting.popleft(), self.topic))


class MemoryService:
    """Service of `MemoryBackend`."""

    def __init__(self, node: "MemoryBackend", name: str, type_name: str, handler: Handler) -> None:
        self.name = name
        self.type_name = type_name
        self._graph = node.graph
        self._responder = Responder(node.factory, name, type_name, handler, node.log)
        self._graph.offer(self)

    def handle(self, request: Any, answer: asyncio.Future[Any]) -> None:
        """Run the handler for one call."""
        self._responder.answer(request, lambda response, problem: settle(answer, response, problem))

    def close(self) -> None:
        """Stop to offer the service."""
        self._graph.withdraw(self)
        self._responder.close()


class MemoryClient:
    """Client of `MemoryBackend`."""

    def __init__(self, node: "MemoryBackend", name: str, type_name: str) -> None:
        self.name = name
        self._node = node
        self._type_name = type_name
        self._pending = PendingCalls(name)

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
        deadline = None if timeout is None else clock.now() + timeout
        server = await self._server(timeout)
        if server.type_name != self._type_name:
            raise CallFailed(f"service {self.name} is of type {server.type_name}, not {self._type_name}")
        answer = self._pending.new()
        server.handle(message, answer)
        try:
            return await within(clock, answer, None if deadline is None else deadline - clock.now())
        except TimeoutError:
            raise CallTimedOut(f"service {self.name} did not answer within {timeout:g} s") from None

    async def _server(self, timeout: float | None) -> MemoryService:
        graph, clock = self._node.graph, self._node.clock
        server = graph.server(self.name)
        if server is not None:
            return server
        what, cure = f"service {self.name} ({self._type_name})", "Is the node that offers it running?"
        deadline = None if timeout is None else clock.now() + timeout
        with Waiting(clock, self._node.log, what, cure):
            while server is None:
                rest = None if deadline is None else deadline - clock.now()
                try:
                    await within(clock, graph.arrival(self.name), rest)
                except TimeoutError:
                    raise ServiceUnavailable(f"nobody offered {what} within {timeout:g} s") from None
                server = graph.server(self.name)
        return server

    def close(self) -> None:
        """Give the client up."""
        self._pending.close()


class MemoryBackend(Node):
    """A node in a graph inside the process.

    Args:
        settings: names, clock and reports.
        graph: the graph to join; a new one without it.
    """

    name = "memory"
    capabilities = frozenset({TOPICS, SERVICES, SERVICE_ERRORS, TRANSFORMS, QOS})

    def __init__(self, settings: NodeSettings, graph: MemoryGraph | None = None) -> None:
        self._schema = RosbagsSchema(settings.interface_paths)
        super().__init__(settings, self._schema, finish=lambda: None, threaded_hooks=False)
        self.graph = graph if graph is not None else MemoryGraph()
        self._members: list[MemoryPublisher | MemorySubscription | MemoryService | MemoryClient] = []

    async def start(self) -> None:
        """Join the graph."""
        self._loop = asyncio.get_running_loop()
        self.set_connected(True)

    async def close(self) -> None:
        """Run the exit hooks and leave the graph."""
        self.exit_hooks.run()
        for member in self._members:
            member.close()
        self._members.clear()
        self.set_connected(False)

    def publisher(self, topic: str, type_name: str, qos: QoS = DEFAULT_QOS) -> MemoryPublisher:
        """Make a publisher."""
        return self._joined(MemoryPublisher(self, self.resolve(topic), message_type(type_name), qos))

    def subscription(
        self,
        topic: str,
        type_name: str,
        callback: Callable[[Sample], None],
        qos: QoS = DEFAULT_QOS,
        on_event: Callable[[TopicEvent], None] | None = None,
    ) -> MemorySubscription:
        """Have *callback* called for every message."""
        full_type = message_type(type_name)
        self.factory.fields(full_type)
        return self._joined(MemorySubscription(self, self.resolve(topic), full_type, callback, qos))

    def service(self, name: str, type_name: str, handler: Handler) -> MemoryService:
        """Offer a service."""
        full_type = service_type(type_name)
        self._schema.service(full_type)
        return self._joined(MemoryService(self, self.resolve(name), full_type, handler))

    def client(self, name: str, type_name: str) -> MemoryClient:
        """Make a client of a service."""
        full_type = service_type(type_name)
        self._schema.service(full_type)
        return self._joined(MemoryClient(self, self.resolve(name), full_type))

    def _joined(self, member: _M) -> _M:
        assert self.loop is not None
        self._members.append(member)
        return member


BACKEND: type[Backend] = MemoryBackend
