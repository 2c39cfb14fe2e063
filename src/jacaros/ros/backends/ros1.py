"""ROS 1 through rospy: one node per process, callbacks handed to the loop, registrations looked after.

Nothing here waits on the loop: joining, registering and calling services happen in threads, see
`jacaros.ros.backends.ros1_master`.  The addresses are rospy's: ``ROS_MASTER_URI``, ``ROS_IP``,
``ROS_HOSTNAME``; with none given and a master on this machine everything stays on the loopback interface.
"""

import asyncio
import os
import threading
import time
from collections import deque
from collections.abc import Callable
from typing import Any

import rospy  # type: ignore[import-not-found]
import rospy.impl.registration as registration  # type: ignore[import-not-found]

from jacaros.ros.backend import (
    REGISTRATION,
    SERVICE_ERRORS,
    SERVICES,
    TOPICS,
    TRANSFORMS,
    Backend,
    Handler,
    Sample,
    TopicEvent,
)
from jacaros.ros.backends.ros1_master import MasterLink, NodeActions, Offers, call_failure, stay_local
from jacaros.ros.backends.ros1_repairs import (
    leave_standard_output_alone,
    let_closed_nodes_rest,
    let_subscribers_hear,
)
from jacaros.ros.backends.ros1_types import GenpySchema
from jacaros.ros.errors import CallFailed, MessageMismatch, RosError
from jacaros.ros.handoff import Handoff, LoopEnded, ask, in_thread, post
from jacaros.ros.names import message_type, request_type, service_type
from jacaros.ros.node import Node, NodeSettings
from jacaros.ros.qos import DEFAULT_QOS, QoS
from jacaros.ros.serving import PendingCalls, Responder, call_when_offered, checked_message, settle
from jacaros.ros.waiting import Waiting, within

SENDING = 0.5
"""Seconds that closing waits for the messages published last to leave."""


class Ros1Publisher:
    """Publisher of `Ros1Backend`."""

    def __init__(self, node: "Ros1Backend", topic: str, type_name: str, qos: QoS) -> None:
        self.topic = topic
        self._node = node
        self._type_name = type_name
        self._class = node.factory.message_class(type_name)
        self._qos = qos
        self._lock = threading.Lock()
        self._early: deque[Any] = deque(maxlen=qos.depth)
        self._publisher: Any = None
        self._closed = False
        node.link.do(self._register)

    @property
    def subscription_count(self) -> int:
        """How many subscriptions are connected now."""
        publisher = self._publisher
        return 0 if publisher is None else int(publisher.get_num_connections())

    def message(self, **fields: Any) -> Any:
        """Make a message of the topic's type."""
        return self._node.factory.make(self._type_name, fields)

    def publish(self, message: Any) -> None:
        """Queue *message* for sending."""
        if not isinstance(message, self._class):
            raise MessageMismatch(
                f"topic {self.topic} carries {self._type_name}, not {message!r}", self._type_name
            )
        if self._closed or not self._node.exit_hooks.admits():
            return
        with self._lock:
            if self._publisher is None:
                self._early.append(message)
                return
        try:
            self._publisher.publish(message)
        except rospy.ROSSerializationException as problem:
            raise MessageMismatch(f"topic {self.topic}: {problem}", self._type_name) from None
        except rospy.ROSException:  # the node was shut down while this message was on its way
            self._closed = True

    def close(self) -> None:
        """Leave the topic."""
        self._closed = True
        self._node.link.do(self._unregister)

    def sent(self) -> bool:
        """Whether nothing waits in the queues to the subscriptions."""
        implementation = getattr(self._publisher, "impl", None)
        connections = list(getattr(implementation, "connections", None) or ())
        return not any(getattr(connection, "_queue", None) for connection in connections)

    def _register(self) -> None:
        latch = self._qos.durability == "transient_local"
        publisher = rospy.Publisher(self.topic, self._class, latch=latch, queue_size=self._qos.depth)
        with self._lock:
            for message in self._early:
                publisher.publish(message)
            self._early.clear()
            self._publisher = publisher

    def _unregister(self) -> None:
        if self._publisher is not None:
            self._publisher.unregister()


class _TopicFeed:
    """The process's one rospy subscriber of a topic, shared by our subscriptions.

    rospy itself shows a latched message only to the first subscriber in a process.
    """

    def __init__(self, node: "Ros1Backend", topic: str, type_name: str) -> None:
        self._node = node
        self._topic = topic
        self._class = node.factory.message_class(type_name)
        self._subscriptions: tuple[Ros1Subscription, ...] = ()
        self._lock = threading.Lock()
        self._latched: dict[str, Any] = {}
        self._subscriber: Any = None
        node.link.do(self._register)

    @property
    def publisher_count(self) -> int:
        subscriber = self._subscriber
        return 0 if subscriber is None else int(subscriber.get_num_connections())

    def add(self, subscription: "Ros1Subscription") -> None:
        with self._lock:
            self._subscriptions = (*self._subscriptions, subscription)
            for message in self._latched.values():
                subscription.queue.put(message)

    def remove(self, subscription: "Ros1Subscription") -> bool:
        """Forget *subscription*; True when it was the last."""
        with self._lock:
            self._subscriptions = tuple(other for other in self._subscriptions if other is not subscription)
            return not self._subscriptions

    def close(self) -> None:
        self._node.link.do(self._unregister)

    def _register(self) -> None:
        self._subscriber = rospy.Subscriber(self._topic, self._class, self._receive, tcp_nodelay=True)

    def _unregister(self) -> None:
        if self._subscriber is not None:
            self._subscriber.unregister()

    def _receive(self, message: Any) -> None:
        header = message._connection_header or {}
        with self._lock:
            if header.get("latching") == "1":
                self._latched[header.get("callerid", "")] = message
            for subscription in self._subscriptions:
                subscription.queue.put(message)


class Ros1Subscription:
    """Subscription of `Ros1Backend`."""

    def __init__(
        self, node: "Ros1Backend", topic: str, type_name: str, callback: Callable[[Sample], None], qos: QoS
    ) -> None:
        self.topic = topic
        self._node = node
        self.queue: Handoff[Any] = Handoff(
            node.loop, qos.depth, lambda message: callback(node.sample(message, topic))
        )
        self._feed = node.feed(topic, type_name)
        self._feed.add(self)
        self._closed = False

    @property
    def publisher_count(self) -> int:
        """How many publishers are connected now."""
        return self._feed.publisher_count

    def close(self) -> None:
        """Leave the topic."""
        self.queue.close()
        if not self._closed and self._feed.remove(self):
            self._node.drop_feed(self.topic)
        self._closed = True


class Ros1Service:
    """Service of `Ros1Backend`."""

    def __init__(self, node: "Ros1Backend", name: str, type_name: str, handler: Handler) -> None:
        self.name = name
        self._node = node
        self._class = node.schema.service_class(type_name)
        self._responder = Responder(node.factory, name, type_name, handler, node.log)
        self._service: Any = None
        node.link.do(self._register)

    def close(self) -> None:
        """Stop to offer the service."""
        self._responder.close()
        self._node.link.do(self._unregister)

    def _register(self) -> None:
        self._service = rospy.Service(self.name, self._class, self._serve)

    def _unregister(self) -> None:
        if self._service is not None:
            self._service.shutdown("closed")

    def _serve(self, request: Any) -> Any:
        """Have the loop answer; on rospy's thread of this connection."""
        node = self._node
        try:
            return ask(
                node.loop, lambda done: self._responder.answer(request, done), lambda: node.exit_hooks.ran
            )
        except CallFailed as problem:
            raise rospy.ServiceException(str(problem)) from None
        except LoopEnded:
            raise rospy.ServiceException(f"service {self.name}: the node is shutting down") from None


class Ros1Client:
    """Client of `Ros1Backend`."""

    def __init__(self, node: "Ros1Backend", name: str, type_name: str) -> None:
        self.name = name
        self._node = node
        self._type_name = type_name
        self._class = node.schema.service_class(type_name)
        self._pending = PendingCalls(name)

    @property
    def ready(self) -> bool:
        """Whether somebody offers the service, as the master said a quarter of a second ago at most."""
        return self.name in self._node.link.services

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
        answer = self._pending.new()

        def finished(work: asyncio.Future[Any]) -> None:
            problem = work.exception()
            settle(answer, None if problem else work.result(), call_failure(self.name, problem))

        # A proxy of its own for each call: rospy's is not made for several calls at a time.
        in_thread(
            self._node.loop, lambda: rospy.ServiceProxy(self.name, self._class)(message), f"call {self.name}"
        ).add_done_callback(finished)
        return await within(self._node.clock, answer, rest)

    def close(self) -> None:
        """Give the client up."""
        self._pending.close()


class Ros1Backend(Node):
    """The ROS 1 node of this process.

    Args:
        settings: names, clock and reports; the namespace is ``ROS_NAMESPACE`` when none is given.
    """

    name = "ros1"
    ros_version = 1
    capabilities = frozenset({TOPICS, SERVICES, SERVICE_ERRORS, TRANSFORMS, REGISTRATION})
    _started = False

    def __init__(self, settings: NodeSettings) -> None:
        self.schema = GenpySchema(settings.interface_paths)
        super().__init__(settings, self.schema, finish=self._leave, threaded_hooks=True)
        self.master_uri = os.environ.setdefault("ROS_MASTER_URI", "http://localhost:11311")
        actions = NodeActions(
            self._join, _offers, _register_again, self._note_state, self._note_again, self._note_problem
        )
        self.link = MasterLink(self.master_uri, self.node_name, actions)
        self._feeds: dict[str, _TopicFeed] = {}
        self._members: list[Ros1Publisher | Ros1Subscription | Ros1Service | Ros1Client] = []
        self._waiting: Waiting | None = None
        self._first_look: asyncio.Future[None] | None = None

    async def start(self) -> None:
        """Join the graph, or say that the master is awaited and go on trying in the background."""
        if Ros1Backend._started:
            raise RosError("ROS 1 allows one node per process, and this process has had one already")
        Ros1Backend._started = True
        self._loop = asyncio.get_running_loop()
        stay_local(self.master_uri)
        let_subscribers_hear()
        let_closed_nodes_rest()
        self.exit_hooks.watch_thread()
        self._first_look = self._loop.create_future()
        self.link.start()
        await self._first_look

    async def close(self) -> None:
        """Run the exit hooks and leave the graph."""
        await in_thread(self.loop, self.exit_hooks.run, "closing")
        self.exit_hooks.stop_watching()
        for member in self._members:
            member.close()
        self._members.clear()
        if self._waiting is not None:
            self._waiting.__exit__(RosError, None, None)
        self.set_connected(False)

    def publisher(self, topic: str, type_name: str, qos: QoS = DEFAULT_QOS) -> Ros1Publisher:
        """Make a publisher."""
        publisher = Ros1Publisher(self, self.resolve(topic), message_type(type_name), qos)
        self._members.append(publisher)
        return publisher

    def subscription(
        self,
        topic: str,
        type_name: str,
        callback: Callable[[Sample], None],
        qos: QoS = DEFAULT_QOS,
        on_event: Callable[[TopicEvent], None] | None = None,
    ) -> Ros1Subscription:
        """Have *callback* called for every message."""
        subscription = Ros1Subscription(self, self.resolve(topic), message_type(type_name), callback, qos)
        self._members.append(subscription)
        return subscription

    def service(self, name: str, type_name: str, handler: Handler) -> Ros1Service:
        """Offer a service."""
        service = Ros1Service(self, self.resolve(name), service_type(type_name), handler)
        self._members.append(service)
        return service

    def client(self, name: str, type_name: str) -> Ros1Client:
        """Make a client of a service."""
        client = Ros1Client(self, self.resolve(name), service_type(type_name))
        self._members.append(client)
        return client

    def feed(self, topic: str, type_name: str) -> _TopicFeed:
        """The process's subscriber of *topic*, made at its first use."""
        if topic not in self._feeds:
            self._feeds[topic] = _TopicFeed(self, topic, type_name)
        return self._feeds[topic]

    def drop_feed(self, topic: str) -> None:
        """Leave *topic*: nobody here listens to it any more."""
        self._feeds.pop(topic).close()

    def _join(self) -> None:
        rospy.names._set_caller_id(
            f"{self.names.namespace}/unnamed"
        )  # where init_node takes its namespace from
        rospy.init_node(self.names.node_name, argv=[], disable_signals=True)
        leave_standard_output_alone()
        rospy.on_shutdown(self._note_shutdown)

    def _leave(self) -> None:
        """Wait until the queues are empty, then end rospy: its threads would keep the process alive."""
        publishers = [member for member in list(self._members) if isinstance(member, Ros1Publisher)]
        deadline = time.monotonic() + SENDING
        while time.monotonic() < deadline and not all(publisher.sent() for publisher in publishers):
            time.sleep(0.005)
        time.sleep(0.02)  # a queue is emptied just before its messages are written
        self.link.stop()
        rospy.signal_shutdown("closed")

    def _note_state(self, present: bool) -> None:
        post(self.loop, self._state_changed, present)

    def _state_changed(self, present: bool) -> None:
        if not present and self._waiting is None:
            cure = "Start it with `roscore`, or set ROS_MASTER_URI to where it runs."
            self._waiting = Waiting(
                self.clock, self.log, f"ROS master at {self.master_uri}", cure
            ).__enter__()
        elif present and self._waiting is not None:
            self._waiting.__exit__(None, None, None)
            self._waiting = None
        self.set_connected(present)
        if self._first_look is not None and not self._first_look.done():
            self._first_look.set_result(None)

    def _note_again(self, names: list[str]) -> None:
        post(
            self.loop, self.log, f"the ROS master had forgotten {', '.join(sorted(names))}: registered again"
        )

    def _note_problem(self, problem: Exception) -> None:
        post(self.loop, self.log, f"rospy refused: {type(problem).__name__}: {problem}")

    def _note_shutdown(self) -> None:
        """On rospy's thread: somebody ended our node, most likely a newer node of the same name."""
        if not self.exit_hooks.ran:
            post(self.loop, self.log, f"node {self.node_name} was shut down from outside: is its name taken?")
            post(self.loop, self.set_connected, False)
            self.link.stop()


def _offers() -> Offers:
    topics, services = rospy.topics.get_topic_manager(), registration.get_service_manager()
    return topics.get_publications(), topics.get_subscriptions(), services.get_services()


def _register_again(kind: int, name: str, detail: str) -> None:
    kinds = (registration.Registration.PUB, registration.Registration.SUB, registration.Registration.SRV)
    registration.get_registration_listeners().notify_added(name, detail, kinds[kind])


BACKEND: type[Backend] = Ros1Backend
