"""The middleware port: what every backend offers to artifacts and to the embedded world.

Everything here happens on the loop of the backend's clock: calls come from there, callbacks arrive there.
"""

from collections.abc import Awaitable, Callable, Mapping
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import Any, Protocol

from jacaros.clock import Clock
from jacaros.ros.action import ActionClient, ActionPolicy, ActionServer, Execute
from jacaros.ros.fields import FieldType
from jacaros.ros.graph import GraphContents
from jacaros.ros.parameter import GivenParameters, Parameters
from jacaros.ros.protocols.transform import Transform
from jacaros.ros.qos import DEFAULT_QOS, QoS
from jacaros.trace import Cause, Tracer

TOPICS = "topics"
SERVICES = "services"
SERVICE_ERRORS = "service errors"
"""A client learns that the server's handler failed; elsewhere such a call times out."""
TRANSFORMS = "transforms"
"""`Backend.tf_broadcast` works."""
QOS = "qos"
"""Reliability and durability are negotiated as on ROS 2."""
DISCOVERY = "discovery"
"""Nodes need time to find each other: what a publisher sends before its subscriptions are matched is lost."""
REGISTRATION = "registration"
"""There is a master that can go and come back."""
ACTIONS = "actions"
"""Action clients and servers."""
PARAMETERS = "parameters"
"""Reading and writing parameters."""
DECLARED_PARAMETERS = "declared parameters"
"""A node says which parameters it has, of which type and range; elsewhere any name may be set."""
PARAMETER_EVENTS = "parameter events"
"""News of changed parameters."""
DEADLINES = "deadlines"
"""`QoS.deadline`, and news of a missed one."""
GRAPH_QOS = "qos in the graph"
"""`Backend.contents` tells the quality of service of other nodes' endpoints."""


class TopicTrouble(StrEnum):
    """What a subscription can learn besides messages."""

    DEADLINE_MISSED = "deadline_missed"
    INCOMPATIBLE_QOS = "incompatible_qos"
    """A publisher is there whose offer does not meet the request: nothing will come from it."""
    OTHER_TYPE = "other_type"
    """The topic carries messages of another type."""


@dataclass(frozen=True, slots=True)
class TopicEvent:
    """Trouble at a topic, with one line for people: what was found, and what to write."""

    trouble: TopicTrouble
    text: str


@dataclass(slots=True)
class Sample:
    """A received message; read-only by agreement (a frozen one costs three times as much).

    Attributes:
        message: read-only by agreement: other receivers may hold the same object.
        topic: absolute name.
        stamp: when it reached the loop, in seconds of the clock.
        cause: beginning of the chain that leads to beliefs and commands; None while nobody watches.
    """

    message: Any
    topic: str
    stamp: float
    cause: Cause | None


class Publisher(Protocol):
    """Sends messages to a topic."""

    @property
    def topic(self) -> str:
        """Absolute name of the topic."""

    @property
    def subscription_count(self) -> int:
        """How many subscriptions are connected now."""

    def message(self, **fields: Any) -> Any:
        """Make a message of the topic's type; see `Backend.message`."""

    def publish(self, message: Any) -> None:
        """Send *message*, or one with the fields of a mapping; it must not be changed afterwards.

        Raises:
            MessageMismatch: the message is not of the topic's type, or the fields do not fit it.
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
        """How many publishers are connected now."""

    def close(self) -> None:
        """Leave the topic; the callback is not called any more."""


class Service(Protocol):
    """Answers the calls of a service."""

    @property
    def name(self) -> str:
        """Absolute name of the service."""

    def close(self) -> None:
        """Stop to offer the service."""


class Client(Protocol):
    """Calls a service."""

    @property
    def name(self) -> str:
        """Absolute name of the service."""

    @property
    def ready(self) -> bool:
        """Whether somebody offers the service, as far as is known."""

    def request(self, **fields: Any) -> Any:
        """Make a request message; see `Backend.message`."""

    async def call(self, request: Any = None, timeout: float | None = None) -> Any:
        """Call the service and give its response.

        Args:
            request: a request message, or a mapping of its fields, or None for an empty one.
            timeout: seconds for waiting for the server and for the answer together; None waits for ever.

        Raises:
            MessageMismatch: the request does not fit the definition.
            ServiceUnavailable: nobody offered the service in time.
            CallTimedOut: the server did not answer in time.
            CallFailed: the server's handler failed (only with `SERVICE_ERRORS`), or the connection broke.
        """

    def close(self) -> None:
        """Give the client up; pending calls fail with `CallFailed`."""


Handler = Callable[[Any], Any | Awaitable[Any]]
"""Takes a request; gives a response message, a mapping of its fields or None for the defaults."""


DEFAULT_POLICY = ActionPolicy()


class Backend(Protocol):
    """A node in a ROS graph.

    Attributes:
        tracer: told of each message that arrives, None while nobody watches.
    """

    tracer: Tracer | None

    @property
    def name(self) -> str:
        """``memory``, ``ros1``, ``ros2`` or ``rosbridge``."""

    @property
    def ros_version(self) -> int:
        """1 or 2: whose names and types are usual in this graph (``memory``: 2)."""

    @property
    def capabilities(self) -> frozenset[str]:
        """What works here; the constants of this file."""

    @property
    def node_name(self) -> str:
        """Absolute name of the node."""

    @property
    def clock(self) -> Clock:
        """The clock that it was given."""

    @property
    def connected(self) -> bool:
        """Whether the graph (on ROS 1: the master) can be reached."""

    def on_connection(self, callback: Callable[[bool], None]) -> None:
        """Have *callback* called on the loop whenever `connected` changes, with the new value."""

    def after_delivery(self, callback: Callable[[], None]) -> None:
        """Have *callback* called on the loop after messages of other processes have been delivered.

        Whoever got something to do by them may then do it at once.  A backend need not call it.
        """

    async def start(self) -> None:
        """Join the graph.

        Where the graph cannot be reached yet, this returns all the same, after saying so through the log; the
        backend goes on trying and what is made meanwhile joins later.
        """

    async def close(self) -> None:
        """Run the exit hooks and leave the graph."""

    def resolve(self, name: str) -> str:
        """Give the absolute, remapped form of a topic or service name; raises `NameInvalid`."""

    def add_interfaces(self, folder: Path) -> None:
        """Look for definitions of types in *folder* too: ``PACKAGE/msg/NAME.msg``, ``PACKAGE/srv/NAME.srv`` and so on.

        On ``ros2`` that changes nothing: there packages are installed.
        """

    def fields(self, type_name: str) -> Mapping[str, FieldType]:
        """Fields of a message type in the order of its definition; raises `UnknownInterface`."""

    def message(self, type_name: str, /, **fields: Any) -> Any:
        """Make a message.

        Args:
            type_name: ``geometry_msgs/msg/Twist`` or ``geometry_msgs/Twist``.
            fields: values; mappings for nested messages, seconds for stamps; the others have their defaults.

        Raises:
            UnknownInterface: the type is not known.
            MessageMismatch: a field is unknown, or a value has the wrong type or is out of range.
        """

    def receivers(self, topic: str) -> int:
        """Return how many subscriptions of this node receive the messages of a topic, given by its absolute name."""

    def publisher(self, topic: str, type_name: str, qos: QoS = DEFAULT_QOS) -> Publisher:
        """Make a publisher; raises `NameInvalid` or `UnknownInterface`."""

    def subscription(
        self,
        topic: str,
        type_name: str,
        callback: Callable[[Sample], None],
        qos: QoS = DEFAULT_QOS,
        on_event: Callable[[TopicEvent], None] | None = None,
    ) -> Subscription:
        """Have *callback* called on the loop for each message; raises `NameInvalid`, `UnknownInterface`.

        Args:
            topic: any form of its name.
            type_name: of its messages.
            callback: takes each message.
            qos: what is asked for; `CapabilityMissing` for a deadline where there are none.
            on_event: told of trouble, on the loop; without it trouble goes to the log.
        """

    def service(self, name: str, type_name: str, handler: Handler) -> Service:
        """Offer a service; raises `NameInvalid` or `UnknownInterface`.

        An exception of *handler* becomes `CallFailed` at the client (or its time-out, see `SERVICE_ERRORS`).
        """

    def client(self, name: str, type_name: str) -> Client:
        """Make a client of a service; raises `NameInvalid` or `UnknownInterface`."""

    def action_client(self, name: str, type_name: str) -> ActionClient:
        """Make a client of an action (``nav2_msgs/action/NavigateToPose``).

        Raises:
            NameInvalid, UnknownInterface: as `client`.
            CapabilityMissing: there are no actions here (`ACTIONS`).
        """

    def action_server(
        self, name: str, type_name: str, execute: Execute, policy: ActionPolicy = DEFAULT_POLICY
    ) -> ActionServer:
        """Offer an action; each accepted goal is carried out by *execute*, as a task on the loop.

        Raises:
            NameInvalid, UnknownInterface, CapabilityMissing: as `action_client`.
        """

    @property
    def given_parameters(self) -> GivenParameters:
        """Values for parameters of our own node that came from outside, and which of them are declared."""

    def parameters(self, node: str | None = None) -> Parameters:
        """Give the parameters of our own node, or of another by its name.

        Raises:
            NameInvalid: the name breaks the rules.
            CapabilityMissing: there are no parameters here (`PARAMETERS`).
        """

    async def contents(self, timeout: float = 5.0) -> GraphContents:
        """Look at the graph.

        Raises:
            ServiceError: the graph (master, bridge) cannot be asked within *timeout* seconds.
        """

    def tf_broadcast(self, transform: Any, static: bool = False) -> None:
        """Publish a ``geometry_msgs/msg/TransformStamped`` (message or mapping) on ``/tf`` or ``/tf_static``.

        Raises:
            CapabilityMissing: ``tf2_msgs`` is not installed.
            MessageMismatch: the transform does not fit the definition.
        """

    def tf_listen(self) -> None:
        """Begin to listen to ``/tf`` and ``/tf_static``; looking up does that too, but then knows nothing at first.

        Raises:
            CapabilityMissing: as `tf_broadcast`.
        """

    def tf_lookup(self, target: str, source: str, stamp: float | None = None) -> Transform:
        """Give the transform that takes points in frame *source* to frame *target*, as ``tf2``'s look-up does.

        Args:
            target, source: frames, without a slash in front.
            stamp: seconds since the epoch; between two known transforms it is interpolated; None: the newest
                time for which all of the way is known.

        Raises:
            TransformUnavailable: with the reason.
            CapabilityMissing: as `tf_broadcast`.
        """

    async def tf_wait(
        self, target: str, source: str, stamp: float | None = None, timeout: float | None = None
    ) -> Transform:
        """`tf_lookup` as soon as it is possible, at most *timeout* seconds of the clock later."""

    def rosout(self, level: str, text: str) -> None:
        """Write a line to the graph's log ``/rosout`` under our node's name.

        Args:
            level: ``debug``, ``info``, ``warn``, ``error`` or ``fatal``.
            text: the line.
        """

    def add_exit_hook(self, hook: Callable[[], None]) -> Callable[[], None]:
        """Have *hook* called when the process stops for any reason it can notice, or `close` is called.

        The hook publishes what makes the robot safe, or sends requests to cancel; after the first hook has begun, messages
        of others are dropped.  It may be called several times, and in a thread when the loop is stuck, so it must not touch
        the loop.  The result takes the hook back.
        """
