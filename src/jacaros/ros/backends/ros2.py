"""ROS 2 through rclpy: a context and an executor thread of our own, callbacks handed to the loop.

Domain, discovery range and the middleware below are ROS 2's own business: ``ROS_DOMAIN_ID``,
``ROS_AUTOMATIC_DISCOVERY_RANGE``, ``RMW_IMPLEMENTATION``.
"""

import asyncio
import os
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from typing import Any

# Unless this is set before their import, rclpy's messages take whatever is assigned and publish it misread.
os.environ.setdefault("ROS_PYTHON_CHECK_FIELDS", "1")

import rclpy  # type: ignore[import-not-found]
import rclpy.duration  # type: ignore[import-not-found]
import rclpy.executors  # type: ignore[import-not-found]
import rclpy.qos  # type: ignore[import-not-found]
import rclpy.signals  # type: ignore[import-not-found]
import rclpy.task  # type: ignore[import-not-found]

from jacaros.ros.backend import QOS, SERVICES, TOPICS, TRANSFORMS, Backend, Handler, Sample, TopicEvent
from jacaros.ros.backends.ros2_output import leave_standard_output_alone
from jacaros.ros.backends.ros2_types import RosidlSchema
from jacaros.ros.errors import CallFailed, MessageMismatch, ServiceUnavailable, UnknownInterface
from jacaros.ros.handoff import Handoff, in_thread, post
from jacaros.ros.names import message_type, request_type, service_type
from jacaros.ros.node import Node, NodeSettings
from jacaros.ros.qos import DEFAULT_QOS, QoS
from jacaros.ros.serving import PendingCalls, Responder, call_when_offered, checked_message, settle
from jacaros.ros.tf import MESSAGE as TRANSFORM_MESSAGE
from jacaros.ros.waiting import within

SENDING = 0.5
"""Seconds that closing waits for the last messages to be acknowledged; a dead receiver never does it."""
STOPPING = 1.0
"""Seconds that closing waits for the executor's thread."""


SETTLING = 0.5
"""Seconds between finding a server and the first request: what it answers before it knows the client is lost."""


COURTESY = 0.002
"""Seconds that rclpy's executor lets the agents go first: it computes for long (in Python) before it waits again."""


class Ros2Publisher:
    """Publisher of `Ros2Backend`."""

    def __init__(self, node: "Ros2Backend", topic: str, type_name: str, qos: QoS) -> None:
        self.topic = topic
        self._node = node
        self._type_name = type_name
        self._class = node.factory.message_class(type_name)
        self._publisher: Any = node.rcl.create_publisher(self._class, topic, _profile(qos))
        self._closed = False

    @property
    def subscription_count(self) -> int:
        """How many subscriptions are connected now."""
        return 0 if self._closed else int(self._publisher.get_subscription_count())

    def message(self, **fields: Any) -> Any:
        """Make a message of the topic's type."""
        return self._node.factory.make(self._type_name, fields)

    def publish(self, message: Any) -> None:
        """Send *message*."""
        if not isinstance(message, self._class):
            raise MessageMismatch(
                f"topic {self.topic} carries {self._type_name}, not {message!r}", self._type_name
            )
        if not self._closed and self._node.exit_hooks.admits():
            self._publisher.publish(message)

    def finish(self, seconds: float) -> None:
        """Wait until the reliable subscriptions have what was published, but not longer than *seconds*."""
        if not self._closed:
            self._publisher.wait_for_all_acked(rclpy.duration.Duration(seconds=max(0.0, seconds)))

    def close(self) -> None:
        """Leave the topic."""
        if not self._closed:
            self._closed = True
            self._node.rcl.destroy_publisher(self._publisher)


class Ros2Subscription:
    """Subscription of `Ros2Backend`."""

    def __init__(
        self, node: "Ros2Backend", topic: str, type_name: str, callback: Callable[[Sample], None], qos: QoS
    ) -> None:
        self.topic = topic
        self._node = node
        self._queue: Handoff[Any] = Handoff(
            node.loop, qos.depth, lambda message: callback(node.sample(message, topic)), COURTESY
        )
        kind = node.factory.message_class(type_name)
        self._subscription: Any = node.rcl.create_subscription(kind, topic, self._queue.put, _profile(qos))
        self._closed = False

    @property
    def publisher_count(self) -> int:
        """How many publishers of the topic are known now."""
        return 0 if self._closed else int(self._node.rcl.count_publishers(self.topic))

    def close(self) -> None:
        """Leave the topic."""
        self._queue.close()
        if not self._closed:
            self._closed = True
            self._node.rcl.destroy_subscription(self._subscription)


class _Call:
    """A request on its way through rclpy's executor; see `Ros2Service`."""

    def __init__(self, request: Any) -> None:
        self.request = request


class Ros2Service:
    """Service of `Ros2Backend`.

    rclpy wants the response when its callback returns.  The callback returns the request instead, and
    *sending* it passes it to the loop; the loop sends the real response when there is one.  So a handler may
    take its time without holding up the executor, and any number of calls go on at once.
    """

    def __init__(self, node: "Ros2Backend", name: str, type_name: str, handler: Handler) -> None:
        self.name = name
        self._node = node
        self._responder = Responder(node.factory, name, type_name, handler, node.log)
        kind = node.schema.message_class(type_name)
        self._service: Any = node.rcl.create_service(kind, name, lambda request, _: _Call(request))
        self._respond = self._service.send_response
        self._service.send_response = self._take
        self._closed = False

    def close(self) -> None:
        """Stop to offer the service."""
        self._responder.close()
        if not self._closed:
            self._closed = True
            self._node.rcl.destroy_service(self._service)

    def _take(self, call: _Call, header: Any) -> None:
        def done(response: Any, problem: CallFailed | None) -> None:
            # ROS 2 has no way to tell a client of a failure: its call times out.
            if problem is None and not self._closed:
                self._respond(response, header)

        post(self._node.loop, self._responder.answer, call.request, done)


class Ros2Client:
    """Client of `Ros2Backend`."""

    def __init__(self, node: "Ros2Backend", name: str, type_name: str) -> None:
        self.name = name
        self._node = node
        self._type_name = type_name
        self._client: Any = node.rcl.create_client(node.schema.message_class(type_name), name)
        self._pending = PendingCalls(name)
        self._acquainted = False
        self._closed = False

    @property
    def ready(self) -> bool:
        """Whether somebody offers the service."""
        return not self._closed and bool(self._client.service_is_ready())

    def request(self, **fields: Any) -> Any:
        """Make a request message."""
        return self._node.factory.make(request_type(self._type_name), fields)

    async def call(self, request: Any = None, timeout: float | None = None) -> Any:
        """Call the service and give its response."""
        node = self._node
        message = checked_message(node.factory, request_type(self._type_name), request)
        what = f"service {self.name} ({self._type_name})"

        async def attempt(rest: float | None) -> Any:
            return await self._attempt(message, rest)

        return await call_when_offered(node.clock, node.log, what, attempt, timeout)

    async def _attempt(self, message: Any, rest: float | None) -> Any:
        clock = self._node.clock
        deadline = None if rest is None else clock.now() + rest
        if not self.ready:
            self._acquainted = False
            raise ServiceUnavailable(f"nobody offers service {self.name}")
        if not self._acquainted:
            await clock.sleep(SETTLING if rest is None else min(SETTLING, rest / 4))
            self._acquainted = True
        if self._closed:
            raise CallFailed(f"the client of service {self.name} was closed during the call")
        answer = self._pending.new()

        def finished(future: Any) -> None:
            problem = future.exception()
            failure = None if problem is None else CallFailed(f"service {self.name}: {problem}")
            post(self._node.loop, settle, answer, None if problem else future.result(), failure)

        call = self._client.call_async(message)
        call.add_done_callback(finished)
        try:
            return await within(clock, answer, None if deadline is None else deadline - clock.now())
        finally:
            self._client.remove_pending_request(call)

    def close(self) -> None:
        """Give the client up."""
        self._pending.close()
        if not self._closed:
            self._closed = True
            self._node.rcl.destroy_client(self._client)


class Ros2Backend(Node):
    """A ROS 2 node.

    Args:
        settings: names, clock and reports.
        domain_id: the DDS domain; ``ROS_DOMAIN_ID`` without it.
    """

    name = "ros2"

    def __init__(self, settings: NodeSettings, domain_id: int | None = None) -> None:
        self.schema = RosidlSchema()
        super().__init__(settings, self.schema, finish=self._leave, threaded_hooks=True)
        self._domain_id = domain_id
        self._context: Any = rclpy.Context()
        self._executor: Any = None
        self._thread: threading.Thread | None = None
        self._stopped: Any = rclpy.task.Future()
        self.rcl: Any = None
        self._members: list[Ros2Publisher | Ros2Subscription | Ros2Service | Ros2Client] = []

    @property
    def capabilities(self) -> frozenset[str]:  # type: ignore[override]
        """What works here; transforms only where ``tf2_msgs`` is installed."""
        try:
            self.schema.message_class(TRANSFORM_MESSAGE)
        except UnknownInterface:
            return frozenset({TOPICS, SERVICES, QOS})
        return frozenset({TOPICS, SERVICES, QOS, TRANSFORMS})

    async def start(self) -> None:
        """Join the graph."""
        self._loop = asyncio.get_running_loop()
        self.exit_hooks.watch_thread()
        await in_thread(self._loop, self._join, "joining")
        self.set_connected(True)

    async def close(self) -> None:
        """Run the exit hooks and leave the graph."""
        await in_thread(self.loop, self.exit_hooks.run, "closing")
        self.exit_hooks.stop_watching()
        self._members.clear()
        self.set_connected(False)

    def publisher(self, topic: str, type_name: str, qos: QoS = DEFAULT_QOS) -> Ros2Publisher:
        """Make a publisher."""
        publisher = Ros2Publisher(self, self.resolve(topic), message_type(type_name), qos)
        self._members.append(publisher)
        return publisher

    def subscription(
        self,
        topic: str,
        type_name: str,
        callback: Callable[[Sample], None],
        qos: QoS = DEFAULT_QOS,
        on_event: Callable[[TopicEvent], None] | None = None,
    ) -> Ros2Subscription:
        """Have *callback* called for every message."""
        subscription = Ros2Subscription(self, self.resolve(topic), message_type(type_name), callback, qos)
        self._members.append(subscription)
        return subscription

    def service(self, name: str, type_name: str, handler: Handler) -> Ros2Service:
        """Offer a service."""
        service = Ros2Service(self, self.resolve(name), service_type(type_name), handler)
        self._members.append(service)
        return service

    def client(self, name: str, type_name: str) -> Ros2Client:
        """Make a client of a service."""
        client = Ros2Client(self, self.resolve(name), service_type(type_name))
        self._members.append(client)
        return client

    def _join(self) -> None:
        leave_standard_output_alone()
        # Signals are ours: rclpy's handlers would end the context before the exit hooks have published.
        no_signals = rclpy.signals.SignalHandlerOptions.NO
        rclpy.init(
            args=[], context=self._context, domain_id=self._domain_id, signal_handler_options=no_signals
        )
        self.rcl = rclpy.create_node(
            self.names.node_name,
            namespace=self.names.namespace or "/",
            context=self._context,
            use_global_arguments=False,
            start_parameter_services=False,
        )
        self._executor = rclpy.executors.SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self.rcl)
        self._thread = threading.Thread(target=self._spin, name="rclpy executor", daemon=True)
        self._thread.start()

    def _spin(self) -> None:
        while self._context.ok() and not self._stopped.done():
            try:
                self._executor.spin_until_future_complete(self._stopped)
            except rclpy.executors.ExternalShutdownException:
                return
            except Exception as problem:  # a fault in one callback must not make the node deaf
                if self._context.ok():
                    post(self.loop, self.log, f"rclpy: {type(problem).__name__}: {problem}")

    def _leave(self) -> None:
        """Wait until the last messages have arrived, then end rclpy before the interpreter ends."""
        if self.rcl is None:
            return
        deadline = time.monotonic() + SENDING
        for member in list(self._members):
            if isinstance(member, Ros2Publisher):
                member.finish(deadline - time.monotonic())
        time.sleep(0.02)  # best-effort messages are acknowledged by nobody
        # The executor's thread stops itself: shutting an executor down under a spinning thread is a race.
        self._executor.create_task(self._stopped.set_result, None)
        if self._thread is not None:
            self._thread.join(STOPPING)
        self._executor.shutdown(timeout_sec=0.0)
        for member in self._members:
            with suppress(Exception):  # whatever is wrong with one, the others are to be closed
                member.close()
        self.rcl.destroy_node()
        self._context.try_shutdown()


def _profile(qos: QoS) -> Any:
    reliable = qos.reliability == "reliable"
    kept = qos.durability == "transient_local"
    reliability, durability = rclpy.qos.ReliabilityPolicy, rclpy.qos.DurabilityPolicy
    return rclpy.qos.QoSProfile(
        depth=qos.depth,
        reliability=reliability.RELIABLE if reliable else reliability.BEST_EFFORT,
        durability=durability.TRANSIENT_LOCAL if kept else durability.VOLATILE,
    )


BACKEND: type[Backend] = Ros2Backend
