"""The middleware port: the interface of every backend for artifacts and for the embedded world.

Everything here happens on the loop of the backend's clock: calls must come from it, and callbacks run on it.
"""

from collections.abc import Awaitable, Callable, Mapping
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import Any, Protocol

from jacaros.ros.action import ActionPolicy, ActionServer, Execute
from jacaros.ros.action_client import ActionClient
from jacaros.ros.fields import FieldType
from jacaros.ros.graph import GraphContents
from jacaros.ros.parameter import GivenParameters, Parameters
from jacaros.ros.protocols.transform import Transform
from jacaros.ros.qos import DEFAULT_QOS, QoS
from jacaros.runtime.clock import Clock
from jacaros.runtime.trace import Cause, Tracer

TOPICS = "topics"
SERVICES = "services"
SERVICE_ERRORS = "service errors"
"""A client is informed when the server's handler fails; elsewhere such a call times out."""
TRANSFORMS = "transforms"
"""`Backend.tf_broadcast` works."""
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
"""`Backend.contents` includes the quality of service of other nodes' endpoints."""


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


class Closable(Protocol):
    """Something that is closed once."""

    def close(self) -> None:
        """Close it; a part of a graph leaves the graph."""


class Publisher(Protocol):
    """Publishes on a topic.

    Attributes:
        watcher: called with each message before it is sent; None for no watcher.
    """

    watcher: Callable[[Any], None] | None

    @property
    def topic(self) -> str:
        """Absolute name of the topic."""

    @property
    def subscription_count(self) -> int:
        """Number of connected subscriptions."""

    def message(self, **fields: Any) -> Any:
        """Make a message of the topic's type; see `Backend.message`."""

    def publish(self, message: Any) -> None:
        """Publish *message*, or one with the fields of a mapping; it must not be changed afterwards.

        Raises:
            MessageMismatch: the message is not of the topic's type, or the fields do not match it.
        """

    def close(self) -> None:
        """Leave the topic; later messages are dropped."""


class Subscription(Protocol):
    """Receives messages of a topic."""

    @property
    def topic(self) -> str:
        """Absolute name of the topic."""

    @property
    def publisher_count(self) -> int:
        """Number of connected publishers."""

    @property
    def latched(self) -> bool:
        """Whether stored messages are received, which may be old; False if unknown."""

    def close(self) -> None:
        """Leave the topic; the callback is no longer called."""


class Service(Protocol):
    """Answers the calls of a service."""

    @property
    def name(self) -> str:
        """Absolute name of the service."""

    def close(self) -> None:
        """Stop offering the service."""


class Client(Protocol):
    """Calls a service."""

    @property
    def name(self) -> str:
        """Absolute name of the service."""

    @property
    def ready(self) -> bool:
        """Whether a node offers the service, as far as is known."""

    def request(self, **fields: Any) -> Any:
        """Make a request message; see `Backend.message`."""

    async def call(self, request: Any = None, timeout: float | None = None) -> Any:
        """Call the service and return its response.

        Args:
            request: a request message, a mapping of its fields, or None for the defaults.
            timeout: seconds to wait for the server and for the response, in total; None: no limit.

        Raises:
            MessageMismatch: the request does not match the type definition.
            ServiceUnavailable: no node offered the service in time.
            CallTimedOut: the server did not answer in time.
            CallFailed: the server's handler failed (only with `SERVICE_ERRORS`), or the connection broke.
        """

    def close(self) -> None:
        """Close the client; pending calls fail with `CallFailed`."""


Handler = Callable[[Any], Any | Awaitable[Any]]
"""Takes a request; returns a response message, a mapping of its fields or None for the defaults."""


DEFAULT_POLICY = ActionPolicy()


class Backend(Protocol):
    """A node in a ROS graph.

    Attributes:
        tracer: called with each message that arrives; None unless the run is traced.
    """

    tracer: Tracer | None

    @property
    def name(self) -> str:
        """``memory``, ``ros1``, ``ros2`` or ``rosbridge``."""

    @property
    def ros_version(self) -> int:
        """1 or 2: the version whose names and types are usual in this graph (``memory``: 2)."""

    @property
    def capabilities(self) -> frozenset[str]:
        """The capabilities of the backend; the constants of this file."""

    @property
    def node_name(self) -> str:
        """Absolute name of the node."""

    @property
    def clock(self) -> Clock:
        """The clock that the backend was given."""

    @property
    def connected(self) -> bool:
        """Whether the graph (on ROS 1: the master) can be reached."""

    def on_connection(self, callback: Callable[[bool], None]) -> None:
        """Call *callback* on the loop with the new value whenever `connected` changes."""

    def after_delivery(self, callback: Callable[[], None]) -> None:
        """Call *callback* on the loop after messages of other processes have been delivered.

        Receivers that got work from them can then do it immediately. A backend need not call it.
        """

    async def start(self) -> None:
        """Join the graph.

        If the graph cannot be reached yet, this logs so and returns; the backend keeps trying, and entities created
        meanwhile join later.
        """

    async def close(self) -> None:
        """Run the exit hooks and leave the graph."""

    def resolve(self, name: str) -> str:
        """Return the absolute, remapped form of a topic or service name. Raises `NameInvalid`."""

    def add_interfaces(self, folder: Path) -> None:
        """Search *folder* for type definitions too: ``PACKAGE/msg/NAME.msg``, ``PACKAGE/srv/NAME.srv`` and so on.

        No effect on ``ros2``, where packages are installed.
        """

    def fields(self, type_name: str) -> Mapping[str, FieldType]:
        """Return the fields of a message type in the order of its definition. Raises `UnknownInterface`."""

    def message(self, type_name: str, /, **fields: Any) -> Any:
        """Make a message.

        Args:
            type_name: ``geometry_msgs/msg/Twist`` or ``geometry_msgs/Twist``.
            fields: values; mappings for nested messages, seconds for stamps; other fields have their defaults.

        Raises:
            UnknownInterface: the type is unknown.
            MessageMismatch: a field is unknown, or a value has the wrong type or is out of range.
        """

    def receivers(self, topic: str) -> int:
        """Return the number of subscriptions of this node that receive the messages of a topic (absolute name)."""

    async def other_publishers(self, topic: str) -> list[str]:
        """Return the other nodes that publish a topic (absolute name), sorted; over rosbridge those beside the server.

        Raises:
            ServiceError: as `contents`.
        """

    def publisher(self, topic: str, type_name: str, qos: QoS = DEFAULT_QOS) -> Publisher:
        """Make a publisher. Raises `NameInvalid` or `UnknownInterface`."""

    def subscription(
        self,
        topic: str,
        type_name: str,
        callback: Callable[[Sample], None],
        qos: QoS = DEFAULT_QOS,
        on_event: Callable[[TopicEvent], None] | None = None,
    ) -> Subscription:
        """Call *callback* on the loop with each message. Raises `NameInvalid`, `UnknownInterface`.

        Args:
            topic: any form of its name.
            type_name: message type.
            callback: called with each message.
            qos: requested quality of service; `CapabilityMissing` for a deadline if the backend does not support
                them.
            on_event: called with problems, on the loop; without it they are logged.
        """

    def service(self, name: str, type_name: str, handler: Handler) -> Service:
        """Offer a service. Raises `NameInvalid` or `UnknownInterface`.

        An exception of *handler* becomes `CallFailed` at the client (or its time-out, see `SERVICE_ERRORS`).
        """

    def client(self, name: str, type_name: str) -> Client:
        """Make a client of a service. Raises `NameInvalid` or `UnknownInterface`."""

    def action_client(self, name: str, type_name: str) -> ActionClient:
        """Make a client of an action (``nav2_msgs/action/NavigateToPose``).

        Raises:
            NameInvalid, UnknownInterface: as `client`.
            CapabilityMissing: the backend has no actions (`ACTIONS`).
        """

    def action_server(
        self, name: str, type_name: str, execute: Execute, policy: ActionPolicy = DEFAULT_POLICY
    ) -> ActionServer:
        """Offer an action; *execute* runs each accepted goal, as a task on the loop.

        Raises:
            NameInvalid, UnknownInterface, CapabilityMissing: as `action_client`.
        """

    @property
    def given_parameters(self) -> GivenParameters:
        """Return values for parameters of our own node from outside, and which of them are declared."""

    def parameters(self, node: str | None = None) -> Parameters:
        """Return the parameters of our own node, or of another by its name.

        Raises:
            NameInvalid: the name is invalid.
            CapabilityMissing: the backend has no parameters (`PARAMETERS`).
        """

    async def contents(self, timeout: float = 5.0) -> GraphContents:
        """Return the contents of the graph.

        Raises:
            ServiceError: the graph (master, bridge) did not answer within *timeout* seconds.
        """

    def tf_broadcast(self, transform: Any, static: bool = False) -> None:
        """Publish a ``geometry_msgs/msg/TransformStamped`` (message or mapping) on ``/tf`` or ``/tf_static``.

        Raises:
            CapabilityMissing: ``tf2_msgs`` is not installed.
            MessageMismatch: the transform does not match the type definition.
        """

    def tf_listen(self) -> None:
        """Subscribe to ``/tf`` and ``/tf_static``. The first look-up does so too, but begins without any transforms.

        Raises:
            CapabilityMissing: as `tf_broadcast`.
        """

    def tf_lookup(self, target: str, source: str, stamp: float | None = None) -> Transform:
        """Return the transform from frame *source* to frame *target*, as ``tf2``'s look-up does.

        Args:
            target, source: frames, without a leading slash.
            stamp: seconds since the epoch; interpolated between two known transforms; None: the newest common time.

        Raises:
            TransformUnavailable: with the reason.
            CapabilityMissing: as `tf_broadcast`.
        """

    async def tf_wait(
        self, target: str, source: str, stamp: float | None = None, timeout: float | None = None
    ) -> Transform:
        """As `tf_lookup`, but wait up to *timeout* seconds of the clock until it is possible."""

    def rosout(self, level: str, text: str) -> None:
        """Write a line to the graph's log ``/rosout`` under our node's name.

        Args:
            level: ``debug``, ``info``, ``warn``, ``error`` or ``fatal``.
            text: the line.
        """

    def add_exit_hook(self, hook: Callable[[], None]) -> Callable[[], None]:
        """Call *hook* when the process ends for any reason that it can detect, or when `close` is called.

        The hook publishes what makes the robot safe, or sends requests to cancel; once the first hook has begun,
        other messages are dropped. It may be called several times, and in a thread if the loop is stuck, so it must
        not touch the loop. Returns a function that removes the hook.
        """
