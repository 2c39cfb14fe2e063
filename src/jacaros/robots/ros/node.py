"""A node of a graph, with its topics; independent of the middleware.

`Node` has the names, messages, log, connection and exit hooks of all backends. A driver derives its publishers from
`TopicPublisher` and its subscriptions from `TopicSubscription`, and only defines how a message is sent and received.
Everything here happens on the loop of the node's clock: calls must come from it, and callbacks run on it.
"""

import asyncio
import sys
import threading
from collections import deque
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from enum import StrEnum
from functools import cached_property
from pathlib import Path
from typing import Any, ClassVar, Generic, NoReturn, Protocol, TypeVar

from jacaros.robots.ros.action_client import LeavingGoals, OrphanPolicy, Orphans
from jacaros.robots.ros.errors import CapabilityMissing, MessageMismatch, RosError
from jacaros.robots.ros.fields import FieldType
from jacaros.robots.ros.lifetime import Lifetime
from jacaros.robots.ros.message import Schema
from jacaros.robots.ros.names import NodeNames, message_type
from jacaros.robots.ros.parameter import GivenParameters, ParameterValue
from jacaros.robots.ros.qos import DEFAULT_QOS, QoS
from jacaros.robots.ros.waiting import WaitLog
from jacaros.runtime.clock import Clock
from jacaros.runtime.trace import CURRENT, Cause, Tracer


class Capability(StrEnum):
    """What a backend can do."""

    TOPICS = "topics"
    SERVICES = "services"
    SERVICE_ERRORS = "service errors"
    """A client is informed when the server's handler fails; elsewhere such a call times out."""
    TRANSFORMS = "transforms"
    """`jacaros.robots.ros.backend.Backend.tf_broadcast` works."""
    QOS = "qos"
    """Reliability and durability are negotiated as on ROS 2."""
    DISCOVERY = "discovery"
    """Nodes need time to discover each other: messages sent before a subscription is matched are lost."""
    REGISTRATION = "registration"
    """There is a master that can disappear and come back."""
    ACTIONS = "actions"
    """Action clients and servers."""
    PARAMETERS = "parameters"
    """Parameters can be read and written."""
    DECLARED_PARAMETERS = "declared parameters"
    """A node declares its parameters with type and range; elsewhere any name can be set."""
    PARAMETER_EVENTS = "parameter events"
    """Changes of parameters are reported."""
    DEADLINES = "deadlines"
    """`QoS.deadline` is supported, and missed deadlines are reported."""
    GRAPH_QOS = "qos in the graph"
    """`jacaros.robots.ros.backend.Backend.contents` includes the quality of service of other nodes' endpoints."""


class TopicTrouble(StrEnum):
    """Problems that a subscription can report."""

    DEADLINE_MISSED = "deadline_missed"
    INCOMPATIBLE_QOS = "incompatible_qos"
    """A publisher's offer does not meet the request: no messages will arrive from it."""
    OTHER_TYPE = "other_type"
    """The topic carries messages of another type."""


@dataclass(frozen=True, slots=True)
class TopicEvent:
    """A problem at a topic, with one line of text: what was found, and what to write."""

    trouble: TopicTrouble
    text: str


@dataclass(slots=True)
class Sample:
    """A received message; read-only by convention (a frozen class costs three times as much).

    Attributes:
        message: read-only by convention: other receivers may hold the same object.
        topic: absolute name.
        stamp: when it reached the loop, in seconds of the clock.
        cause: start of the causal chain to beliefs and commands; None unless the run is traced.
    """

    message: Any
    topic: str
    stamp: float
    cause: Cause | None


def to_stderr(text: str) -> None:
    """Write a line to standard error, the default log."""
    print(f"[ros] {text}", file=sys.stderr)


@dataclass(frozen=True)
class NodeSettings:
    """The arguments of `jacaros.robots.ros.open.open_backend`.

    Attributes:
        clock: the run's clock.
        node_name: plain name of the node.
        namespace: prefix of relative names.
        remap: replacements of names.
        log: called with one line about the connection: waiting, missing, found, lost.
        interface_paths: folders with further definitions (``memory`` and, for services, ``ros1``).
        parameters: values of parameters of our node from outside, in place of declared defaults.
        orphans: what to do with action goals that an earlier run of the node left.
    """

    clock: Clock
    node_name: str
    namespace: str = ""
    remap: Mapping[str, str] = field(default_factory=dict)
    log: Callable[[str], None] = to_stderr
    interface_paths: Sequence[Path] = ()
    parameters: Mapping[str, ParameterValue] = field(default_factory=dict)
    orphans: OrphanPolicy = "keep"


class Closable(Protocol):
    """A part of a node in the graph: a publisher, subscription, service or client of any driver."""

    def close(self) -> None:
        """Leave the graph; calling it again has no effect."""


M = TypeVar("M", bound=Closable)


@dataclass(frozen=True, slots=True)
class SubscriptionOptions:
    """The arguments of a subscription.

    Attributes:
        topic: absolute name.
        type_name: message type in full form.
        callback: called with each message, on the loop.
        qos: requested quality of service.
        on_event: called with problems, on the loop; without it they are logged.
    """

    topic: str
    type_name: str
    callback: Callable[[Sample], None]
    qos: QoS = DEFAULT_QOS
    on_event: Callable[[TopicEvent], None] | None = None


@dataclass(frozen=True)
class Parts:
    """The classes of a driver; each is called with the node, an absolute name and a type in full form.

    Attributes:
        publisher: also with the quality of service.
        subscription: with `SubscriptionOptions` in place of name and type.
        service: also with the handler.
        client: of a service.
        action_client: with no further argument.
        action_server: also with the code of goals, and the policy for several.
    """

    publisher: "Callable[..., Publisher]"
    subscription: "Callable[..., Subscription]"
    service: Callable[..., Any] | None = None
    client: Callable[..., Any] | None = None
    action_client: Callable[..., Any] | None = None
    action_server: Callable[..., Any] | None = None


class Node:
    """A node that can publish and subscribe, without its driver.

    Args:
        settings: names, clock and log.
        schema: the library's family of message classes.
        lifetime: how it joins and leaves.

    Attributes:
        name: ``memory``, ``ros1``, ``ros2`` or ``rosbridge``.
        ros_version: 1 or 2: the version whose names and types are usual in this graph (``memory``: 2).
        capabilities: the capabilities of the backend; see `Capability`.
        parts: the classes of the driver.
        connected: whether the graph (on ROS 1: the master) can be reached.
        members: the node's entities in the graph, in the order of creation.
        tracer: called with each message that arrives; None unless the run is traced.
        delivered: called when messages of other processes have been delivered.
        given_parameters: values for parameters of the node from outside, and which of them are declared.
        leaving_goals: goals of all action clients that are being cancelled.
    """

    name = "none"
    ros_version = 2
    capabilities: frozenset[Capability] = frozenset()
    parts: ClassVar[Parts]

    def __init__(self, settings: NodeSettings, schema: Schema, lifetime: Lifetime) -> None:
        self.clock = settings.clock
        self.log = settings.log
        self.names = NodeNames(settings.node_name, settings.namespace, settings.remap)
        self.factory = schema
        self.lifetime = lifetime
        self.connected = False
        self.delivered: Callable[[], None] = lambda: None
        self.tracer: Tracer | None = None
        self.orphans = Orphans(self.names.full_name, settings.orphans, settings.log)
        self.leaving_goals: LeavingGoals = {}
        self.given_parameters = GivenParameters(settings.parameters)
        self.members: dict[Closable, None] = {}
        self._loop: asyncio.AbstractEventLoop | None = None
        self._first_look: asyncio.Future[None] | None = None
        self._end_waiting: Callable[[bool], None] | None = None
        self._on_connection: list[Callable[[bool], None]] = []

    @property
    def node_name(self) -> str:
        """Absolute name of the node."""
        return self.names.full_name

    @property
    def loop(self) -> asyncio.AbstractEventLoop:
        """The loop on which the node was started. Raises `RosError` before."""
        if self._loop is None:
            raise RosError(
                f"the {self.name} backend of {self.node_name} is not started: await backend.start() first"
            )
        return self._loop

    async def start(self) -> None:
        """Join the graph.

        If the graph cannot be reached yet, this logs so and returns; the backend keeps trying, and entities created
        meanwhile join later.
        """
        raise NotImplementedError

    async def close(self) -> None:
        """Run the exit hooks and leave the graph."""
        raise NotImplementedError

    def on_connection(self, callback: Callable[[bool], None]) -> Callable[[], None]:
        """Call *callback* on the loop with the new value whenever `connected` changes. Return a function that ends this."""
        self._on_connection.append(callback)
        return lambda: self._on_connection.remove(callback)

    def set_connected(self, connected: bool) -> None:
        """Note that the graph was found or lost, and inform the callbacks; on the loop."""
        if connected != self.connected:
            self.connected = connected
            for callback in list(self._on_connection):
                callback(connected)

    def join(self) -> asyncio.Future[None]:
        """Store the running loop. Return a future that is done when the graph was found, or is known to be missing."""
        self._loop = asyncio.get_running_loop()
        self._first_look = self._loop.create_future()
        self.lifetime.join()
        return self._first_look

    def found(self) -> None:
        """Note, on the loop, that the graph was found."""
        self._stop_waiting(True)
        self.set_connected(True)
        self.looked()

    def missing(self, what: str, help: str) -> None:
        """Note, on the loop, that the graph is missing or lost, and awaited.

        Args:
            what: its name for the log.
            help: what the user can do about it.
        """
        if self._end_waiting is None and not self.lifetime.leaving:
            self._end_waiting = WaitLog(self.clock, self.log, what, help).begin()
        self.set_connected(False)
        self.looked()

    def looked(self) -> None:
        """Let `join` stop waiting."""
        if self._first_look is not None and not self._first_look.done():
            self._first_look.set_result(None)

    def left(self) -> None:
        """Note, on the loop, that the node has left, and stop waiting."""
        self._stop_waiting(False)
        self.set_connected(False)

    def _stop_waiting(self, found: bool) -> None:
        if self._end_waiting is not None:
            self._end_waiting(found)
            self._end_waiting = None

    def keep(self, member: M) -> M:
        """Close *member* with the node, which must be started. Raises `RosError` otherwise."""
        assert self.loop is not None
        self.members[member] = None
        return member

    def forget(self, member: Closable) -> None:
        """Deregister an entity that has left."""
        self.members.pop(member, None)

    def close_members(self) -> None:
        """Close the node's entities in the graph."""
        for member in list(self.members):
            with suppress(Exception):  # a failure of one must not keep the others open
                member.close()
        self.members.clear()

    def after_delivery(self, callback: Callable[[], None]) -> None:
        """Call *callback* on the loop after messages of other processes have been delivered.

        Receivers that got work from them can then do it immediately. A backend need not call it.
        """
        self.delivered = callback

    def add_exit_hook(self, hook: Callable[[], None]) -> Callable[[], None]:
        """Call *hook* when the process ends for any reason that it can detect, or when `close` is called.

        The hook publishes what makes the robot safe, or sends requests to cancel; once the first hook has begun,
        other messages are dropped. It may be called several times, and in a thread if the loop is stuck, so it must
        not touch the loop. Returns a function that removes the hook.
        """
        return self.lifetime.add(hook)

    def resolve(self, name: str) -> str:
        """Return the absolute, remapped form of a topic or service name. Raises `NameInvalid`."""
        return self.names.resolve(name)

    def add_interfaces(self, folder: Path) -> None:
        """Search *folder* for type definitions too: ``PACKAGE/msg/NAME.msg``, ``PACKAGE/srv/NAME.srv`` and so on.

        No effect on ``ros2``, where packages are installed.
        """
        self.factory.look_in(folder)

    def fields(self, type_name: str) -> Mapping[str, FieldType]:
        """Return the fields of a message type in the order of its definition. Raises `UnknownInterface`."""
        return self.factory.fields(message_type(type_name))

    def message(self, type_name: str, /, **fields: Any) -> Any:
        """Make a message.

        Args:
            type_name: ``geometry_msgs/msg/Twist`` or ``geometry_msgs/Twist``.
            fields: values; mappings for nested messages, seconds for stamps; other fields have their defaults.

        Raises:
            UnknownInterface: the type is unknown.
            MessageMismatch: a field is unknown, or a value has the wrong type or is out of range.
        """
        return self.factory.make(message_type(type_name), fields)

    def publisher(self, topic: str, type_name: str, qos: QoS = DEFAULT_QOS) -> "Publisher":
        """Make a publisher. Raises `NameInvalid` or `UnknownInterface`."""
        self._check_deadline(qos)
        return self.keep(self.parts.publisher(self, self.resolve(topic), message_type(type_name), qos))

    def subscription(
        self,
        topic: str,
        type_name: str,
        callback: Callable[[Sample], None],
        qos: QoS = DEFAULT_QOS,
        on_event: Callable[[TopicEvent], None] | None = None,
    ) -> "Subscription":
        """Call *callback* on the loop with each message. Raises `NameInvalid`, `UnknownInterface`.

        Args:
            topic: any form of its name.
            type_name: message type.
            callback: called with each message.
            qos: requested quality of service; `CapabilityMissing` for a deadline if the backend does not support
                them.
            on_event: called with problems, on the loop; without it they are logged.
        """
        self._check_deadline(qos)
        full_type = message_type(type_name)
        self.factory.fields(full_type)
        name = self.resolve(topic)
        return self.keep(
            self.parts.subscription(self, SubscriptionOptions(name, full_type, callback, qos, on_event))
        )

    def _check_deadline(self, qos: QoS) -> None:
        """Reject a deadline if the backend does not support them."""
        if qos.deadline is not None and Capability.DEADLINES not in self.capabilities:
            raise CapabilityMissing(
                f"the {self.name} backend does not support deadlines (a deadline of {qos.deadline:g} s was requested); "
                "leave it out, or use --ros ros2 or --ros memory"
            )

    def _unable(self, what: str) -> NoReturn:
        raise CapabilityMissing(f"{what}: the {self.name} backend cannot do this")


N = TypeVar("N", bound=Node)


class Entity(Generic[N]):
    """A publisher, subscription, service or client, from its creation until it is closed.

    Args:
        node: its node.
        name: absolute name.
        type_name: type in full form.
    """

    def __init__(self, node: N, name: str, type_name: str) -> None:
        self.name = name
        self.type_name = type_name
        self._node = node
        self._closed = False

    @property
    def node_name(self) -> str:
        """Absolute name of the node."""
        return self._node.node_name

    def close(self) -> None:
        """Leave the graph; calling it again has no effect."""
        if not self._closed:
            self._closed = True
            self._node.forget(self)
            self._leave()

    def _leave(self) -> None:
        """Leave the graph, once."""


class _TopicEnd(Entity[N]):
    """The common part of publishers and subscriptions."""

    def __init__(self, node: N, topic: str, type_name: str, qos: QoS) -> None:
        super().__init__(node, topic, type_name)
        self.topic = topic
        self.qos = qos
        self._reported: set[object] = set()

    @property
    def latched(self) -> bool:
        """Whether messages are stored for late subscriptions, or received from before this one."""
        return self.qos.durability != "volatile"


class TopicPublisher(_TopicEnd[N]):
    """Publishes on a topic; a driver defines `_send` and `_leave`.

    Args:
        node: its node.
        topic: absolute name.
        type_name: message type in full form.
        qos: offered quality of service.

    Attributes:
        watcher: called with each message before it is sent; None for no watcher.
    """

    watcher: Callable[[Any], None] | None = None

    def __init__(self, node: N, topic: str, type_name: str, qos: QoS) -> None:
        super().__init__(node, topic, type_name, qos)
        self._class = node.factory.message_class(type_name)

    @property
    def subscription_count(self) -> int:
        """Number of connected subscriptions."""
        raise NotImplementedError

    @cached_property
    def new(self) -> Callable[[], Any]:
        """A function that makes a message of the topic's type with all defaults."""
        return self._node.factory.maker(self.type_name)

    def message(self, **fields: Any) -> Any:
        """Make a message of the topic's type; see `Backend.message`."""
        return self._node.factory.make(self.type_name, fields)

    def publish(self, message: Any) -> None:
        """Publish *message*, or one with the fields of a mapping; it must not be changed afterwards.

        Raises:
            MessageMismatch: the message is not of the topic's type, or the fields do not match it.
        """
        if not isinstance(message, self._class):
            if not isinstance(message, Mapping):
                text = f"topic {self.topic}: expected a {self.type_name}, found {message!r}"
                raise MessageMismatch(text, self.type_name)
            message = self._node.factory.make(self.type_name, message)
        if not self._closed:
            if self.watcher is not None:
                self.watcher(message)
            self._node.lifetime.send(self._send, message)
            if self._node.tracer is not None:
                self._node.tracer.sent_message(self.topic, message, CURRENT.get())

    def report(self, text: str, key: object = None) -> None:
        """Log why messages are not received, once for each *key* (default: the text)."""
        if not self._closed and (key or text) not in self._reported:
            self._reported.add(key or text)
            self._node.log(text)

    def _send(self, message: Any) -> None:
        """Send a message of the topic's class; from any thread when the process ends."""
        raise NotImplementedError


class TopicSubscription(_TopicEnd[N]):
    """Receives messages of a topic; a driver passes messages to `deliver`, or to `put` if each must wait for its turn.

    Args:
        node: its node.
        wanted: topic, type and callbacks.
    """

    def __init__(self, node: N, wanted: SubscriptionOptions) -> None:
        super().__init__(node, wanted.topic, wanted.type_name, wanted.qos)
        self._callback = wanted.callback
        self._on_event = wanted.on_event
        self._waiting: deque[Any] = deque(maxlen=wanted.qos.depth)
        self._loop = node.loop

    @property
    def publisher_count(self) -> int:
        """Number of connected publishers."""
        raise NotImplementedError

    def put(self, message: Any) -> None:
        """Queue *message* for a turn of the loop, on the loop; the oldest is dropped if the queue is full."""
        if not self._loop.is_closed():
            self._waiting.append(message)
            self._loop.call_soon(self._deliver_next)

    def deliver(self, message: Any) -> None:
        """Deliver a message, on the loop."""
        node = self._node
        why = None if node.tracer is None else node.tracer.received_message(self.topic, message)
        self._callback(Sample(message, self.topic, node.clock.now(), why))

    def report(self, trouble: TopicTrouble, text: str, key: object = None) -> None:
        """Report a problem, on the loop.

        Args:
            trouble: its kind.
            text: one line of text.
            key: report it once for each key; None: each time.
        """
        if self._closed or key in self._reported:
            return
        if key is not None:
            self._reported.add(key)
        if self._on_event is None:
            self._node.log(text)
        else:
            # Later, because the subscriber does not have the subscription yet.
            self._loop.call_soon(self._tell_now, TopicEvent(trouble, text))

    def report_type_mismatch(self, who: str, theirs: str) -> None:
        """Report, once for each type, that messages of another type are published."""
        self.report(
            TopicTrouble.OTHER_TYPE,
            f"topic {self.topic}: {who} publishes {theirs}, not {self.type_name}; to receive it, write {theirs} here",
            theirs,
        )

    def report_qos(self, problem: str, whose: str = "", key: object = None) -> None:
        """Report that a publisher (*whose*: which one is not connected) offers less than is requested."""
        self.report(
            TopicTrouble.INCOMPATIBLE_QOS,
            f"topic {self.topic}: incompatible QoS: not connected{whose}: {problem}; "
            "request at most what the publisher offers",
            key,
        )

    def report_deadline(self, first: bool) -> None:
        """Report that a deadline passed without a message; only the *first* after a message is logged."""
        if first or self._on_event is not None:
            self.report(
                TopicTrouble.DEADLINE_MISSED,
                f"topic {self.topic}: no message within the deadline of {self.qos.deadline:g} s",
            )

    def close(self) -> None:
        """Leave the topic; the callback is no longer called."""
        self._waiting.clear()
        super().close()

    def _tell_now(self, event: TopicEvent) -> None:
        if self._on_event is not None and not self._closed:
            self._on_event(event)

    def _deliver_next(self) -> None:
        # Empty if a later message pushed this turn's message out, or the subscription was closed.
        if self._waiting:
            self.deliver(self._waiting.popleft())


Publisher = TopicPublisher[Any]
Subscription = TopicSubscription[Any]


R = TypeVar("R", bound=TopicSubscription[Any])
F = TypeVar("F", bound="TopicMultiplexer[Any]")


class TopicMultiplexer(Generic[R]):
    """The process's only subscription of a topic at the middleware, shared by ours; a driver defines `_leave`.

    Args:
        topic: absolute name.
        type_name: message type in full form: that of the first subscription.
    """

    def __init__(self, topic: str, type_name: str) -> None:
        self.topic = topic
        self.type_name = type_name
        self.known_as = type_name
        """The graph's name of the type: those of actionlib, for instance, have names of their own."""
        self.readers: tuple[R, ...] = ()
        self.lock = threading.Lock()
        """Held while readers or latched messages change."""

    @property
    def publisher_count(self) -> int:
        """Number of connected publishers."""
        raise NotImplementedError

    def add(self, reader: R) -> None:
        """Add *reader*, which receives the latched messages first."""
        with self.lock:
            self.readers = (*self.readers, reader)
            for message in self.latched(reader):
                reader.put(message)

    def remove(self, reader: R) -> bool:
        """Remove *reader*. Return True if it was the last one, and the topic was left."""
        with self.lock:
            self.readers = tuple(other for other in self.readers if other is not reader)
            last = not self.readers
        if last:
            self._leave()
        return last

    def join(self) -> None:
        """Subscribe at a server that does not know us yet."""

    def lost(self) -> None:
        """Note that the server is gone. Latched messages are delivered again on reconnect and may have changed."""

    def latched(self, reader: R) -> Iterable[Any]:
        """Return the latched messages for a late *reader*."""
        return ()

    def put(self, message: Any) -> None:
        """Pass a message to all readers."""
        for reader in self.readers:
            reader.put(message)

    def see_type(self, type_name: str | None) -> None:
        """Check the type of the topic in the graph, if it is known."""
        if type_name not in (None, self.known_as):
            self.report(
                f"topic {self.topic}: expected {self.type_name}, found {type_name}: nothing will be received; "
                f"write {type_name}"
            )

    def report(self, text: str) -> None:
        """Report to each reader, once, that the published type is not the requested one."""
        for reader in self.readers:
            reader.report(TopicTrouble.OTHER_TYPE, text, text)

    def _leave(self) -> None:
        """Leave the topic: it has no readers."""
        raise NotImplementedError


class SharedSubscription(TopicSubscription[N]):
    """A subscription that reads from a multiplexer, which is made with the first one of its topic and closed with the
    last.

    Args:
        multiplexers: those of the node, by topic.
        new_multiplexer: makes one for a node, a topic and a type.
        node, wanted: as for `TopicSubscription`.
    """

    def __init__(
        self,
        node: N,
        wanted: SubscriptionOptions,
        multiplexers: dict[str, F],
        new_multiplexer: Callable[[N, str, str], F],
    ) -> None:
        super().__init__(node, wanted)
        topic, type_name = wanted.topic, wanted.type_name
        self._multiplexers = multiplexers
        if topic not in multiplexers:
            multiplexers[topic] = new_multiplexer(node, topic, type_name)
        self._multiplexer: TopicMultiplexer[Any] | None = multiplexers[topic]
        if self._multiplexer.type_name == type_name:
            self._multiplexer.add(self)
        else:
            self.report(
                TopicTrouble.OTHER_TYPE,
                f"topic {topic} is received as {self._multiplexer.type_name} in this process already, not as {type_name}: "
                f"nothing will be received; write {self._multiplexer.type_name}",
            )
            self._multiplexer = None

    @property
    def publisher_count(self) -> int:
        """Number of connected publishers."""
        return 0 if self._multiplexer is None or self._closed else self._multiplexer.publisher_count

    def _leave(self) -> None:
        if (
            self._multiplexer is not None
            and self._multiplexer.remove(self)
            and self._multiplexers.get(self.topic) is self._multiplexer
        ):
            del self._multiplexers[self.topic]
