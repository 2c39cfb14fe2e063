"""The middleware port: the interface of every backend for artifacts and for the embedded world.

Everything here happens on the loop of the backend's clock: calls must come from it, and callbacks run on it.
"""

from collections import Counter
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from typing import Any, Literal
from weakref import WeakKeyDictionary

from jacaros.robots.ros.action import ActionPolicy, ActionServer, ExecuteCallback
from jacaros.robots.ros.action_client import ActionClient
from jacaros.robots.ros.errors import RosError
from jacaros.robots.ros.lifetime import Lifetime
from jacaros.robots.ros.message import Schema
from jacaros.robots.ros.names import action_type, near_names, service_type
from jacaros.robots.ros.node import Node, NodeSettings, Publisher, Sample, TopicPublisher, TopicSubscription
from jacaros.robots.ros.parameter import Parameters
from jacaros.robots.ros.protocols.transform import Transform
from jacaros.robots.ros.qos import QoS
from jacaros.robots.ros.services import Client, Handler, Service
from jacaros.robots.ros.tf import TransformBroadcaster, TransformListener

__all__ = ["Backend", "Endpoint", "GraphContents", "Sample", "TopicInfo", "alike", "latching"]

DEFAULT_POLICY = ActionPolicy()
ROSOUT = "/rosout"
ROS2_LOG = ("rcl_interfaces/msg/Log", QoS(durability="transient_local", depth=1000))
"""Type and quality of service of the graph's log, as in ROS 2's own profile."""
ROS1_LOG = ("rosgraph_msgs/msg/Log", QoS(depth=100))
ROS1_LEVELS = {"debug": 1, "info": 2, "warn": 4, "error": 8, "fatal": 16}
ROS2_LEVELS = {"debug": 10, "info": 20, "warn": 30, "error": 40, "fatal": 50}


@dataclass(frozen=True, slots=True)
class Endpoint:
    """A publisher or subscription of any node.

    Attributes:
        node: absolute name of its node; empty if the middleware does not report it.
        qos: its offer or request; None if the middleware does not report it.
    """

    node: str = ""
    qos: QoS | None = None


@dataclass(frozen=True, slots=True)
class TopicInfo:
    """A topic.

    Attributes:
        name: absolute name.
        types: types of its messages in full form, sorted; more than one is a mistake of some node.
        publishers, subscriptions: its endpoints.
    """

    name: str
    types: tuple[str, ...]
    publishers: tuple[Endpoint, ...] = ()
    subscriptions: tuple[Endpoint, ...] = ()


def latching(topic: TopicInfo | None) -> str:
    """Return the nodes whose publishers store messages for late subscriptions; empty if none is known."""
    ends = () if topic is None else topic.publishers
    names = {
        each.node or "an unknown node"
        for each in ends
        if each.qos is not None and each.qos.durability == "transient_local"
    }
    return ", ".join(sorted(names))


@dataclass(frozen=True, slots=True)
class GraphContents:
    """A snapshot of the graph.

    The topics and services behind actions, parameters and logging are not included in `topics` and `services`: those
    below ``…/_action/``, actionlib's five, parameter services, ``/rosout``, ``/parameter_events``.

    Attributes:
        topics: by absolute name.
        services: absolute name → type in full form ("" if unknown).
        actions: absolute name → type in full form, such as ``nav2_msgs/action/NavigateToPose``.
        nodes: absolute names, sorted.
    """

    topics: dict[str, TopicInfo] = field(default_factory=dict)
    services: dict[str, str] = field(default_factory=dict)
    actions: dict[str, str] = field(default_factory=dict)
    nodes: tuple[str, ...] = ()

    def near_topics(
        self, name: str, type_name: str, end: Literal["publishers", "subscriptions"]
    ) -> list[str]:
        """Return up to three topics that *name* may mean: of the same type, otherwise of a similar name.

        Args:
            name: absolute name of the missing topic.
            type_name: its type in full form; empty if unknown.
            end: the endpoints that a suggested topic must have.
        """
        used = {each: info.types for each, info in self.topics.items() if getattr(info, end)}
        return near_names(name, used, alike(type_name, used))


def alike(type_name: str, types: Mapping[str, Collection[str]]) -> list[str]:
    """Return the names with a type, sorted; none if the type says nothing about the meaning, such as a string.

    Args:
        type_name: full form; empty if unknown.
        types: the types of each name.
    """
    if type_name.startswith(("std_msgs/", "std_srvs/")):
        return []
    return sorted(name for name, theirs in types.items() if type_name in theirs)


class Backend(Node):
    """A node in a ROS graph. Its driver defines how to start and to close, and provides the parts.

    Args:
        settings: names, clock and log.
        schema: the library's family of message classes.
        lifetime: how it joins and leaves.

    Attributes:
        actions: its action clients and servers, which send messages when they are closed.
    """

    def __init__(self, settings: NodeSettings, schema: Schema, lifetime: Lifetime) -> None:
        super().__init__(settings, schema, lifetime)
        self.actions: WeakKeyDictionary[ActionClient | ActionServer, None] = WeakKeyDictionary()
        self._transforms = TransformBroadcaster(self)
        self._frames = TransformListener(self)
        self._rosout: Publisher | None = None

    def receivers(self, topic: str) -> int:
        """Return the number of subscriptions of this node that receive the messages of a topic (absolute name)."""
        return sum(isinstance(member, TopicSubscription) and member.topic == topic for member in self.members)

    async def other_publishers(self, topic: str) -> list[str]:
        """Return the other nodes that publish a topic (absolute name), sorted; over rosbridge those beside the server.

        Raises:
            ServiceError: as `contents`.
        """
        nodes = Counter(await self._publishers(topic))
        nodes[self.node_name] -= sum(
            isinstance(member, TopicPublisher) and member.topic == topic for member in self.members
        )
        return sorted(node or "an unknown node" for node, number in nodes.items() if number > 0)

    async def _publishers(self, topic: str) -> list[str]:
        """Return the node of each publisher of a topic, as the graph reports them."""
        info = (await self.contents()).topics.get(topic)
        return [] if info is None else [each.node for each in info.publishers]

    def close_actions(self) -> None:
        """Close the clients and servers of actions, which inform their peers."""
        for action in list(self.actions):
            action.close()

    def service(self, name: str, type_name: str, handler: Handler) -> Service:
        """Offer a service. Raises `NameInvalid` or `UnknownInterface`.

        An exception of *handler* becomes `CallFailed` at the client (or its time-out, see `Capability.SERVICE_ERRORS`).
        """
        make = self.parts.service or self._unable("services")
        return self.keep(make(self, self.resolve(name), service_type(type_name), handler))

    def client(self, name: str, type_name: str) -> Client:
        """Make a client of a service. Raises `NameInvalid` or `UnknownInterface`."""
        make = self.parts.client or self._unable("services")
        return self.keep(make(self, self.resolve(name), service_type(type_name)))

    def action_client(self, name: str, type_name: str) -> ActionClient:
        """Make a client of an action (``nav2_msgs/action/NavigateToPose``).

        Raises:
            NameInvalid, UnknownInterface: as `client`.
            CapabilityMissing: the backend has no actions (`Capability.ACTIONS`).
        """
        make = self.parts.action_client or self._unable("action clients")
        made: ActionClient = make(self, self.resolve(name), action_type(type_name))
        self.actions[made] = None
        return made

    def action_server(
        self, name: str, type_name: str, execute: ExecuteCallback, policy: ActionPolicy = DEFAULT_POLICY
    ) -> ActionServer:
        """Offer an action; *execute* runs each accepted goal, as a task on the loop.

        Raises:
            NameInvalid, UnknownInterface, CapabilityMissing: as `action_client`.
        """
        make = self.parts.action_server or self._unable("action servers")
        made: ActionServer = make(self, self.resolve(name), action_type(type_name), execute, policy)
        self.actions[made] = None
        return made

    async def contents(self, timeout: float = 5.0) -> GraphContents:
        """Return the contents of the graph.

        Raises:
            ServiceError: the graph (master, bridge) did not answer within *timeout* seconds.
        """
        self._unable("looking at the graph")

    def parameters(self, node: str | None = None) -> Parameters:
        """Return the parameters of our own node, or of another by its name.

        Raises:
            NameInvalid: the name is invalid.
            CapabilityMissing: the backend has no parameters (`Capability.PARAMETERS`).
        """
        self._unable("parameters")

    def tf_broadcast(self, transform: Any, static: bool = False) -> None:
        """Publish a ``geometry_msgs/msg/TransformStamped`` (message or mapping) on ``/tf`` or ``/tf_static``.

        Raises:
            CapabilityMissing: ``tf2_msgs`` is not installed.
            MessageMismatch: the transform does not match the type definition.
        """
        self._transforms.send(transform, static)

    def tf_listen(self) -> None:
        """Subscribe to ``/tf`` and ``/tf_static``. The first look-up does so too, but begins without any transforms.

        Raises:
            CapabilityMissing: as `tf_broadcast`.
        """
        self._frames.listen()

    def tf_lookup(self, target: str, source: str, stamp: float | None = None) -> Transform:
        """Return the transform from frame *source* to frame *target*, as ``tf2``'s look-up does.

        Args:
            target, source: frames, without a leading slash.
            stamp: seconds since the epoch; interpolated between two known transforms; None: the newest common time.

        Raises:
            TransformUnavailable: with the reason.
            CapabilityMissing: as `tf_broadcast`.
        """
        return self._frames.lookup(target, source, stamp)

    async def tf_wait(
        self, target: str, source: str, stamp: float | None = None, timeout: float | None = None
    ) -> Transform:
        """As `tf_lookup`, but wait up to *timeout* seconds of the clock until it is possible."""
        return await self._frames.wait(target, source, stamp, timeout)

    def rosout(self, level: str, text: str) -> None:
        """Write a line to the graph's log ``/rosout`` under our node's name.

        Args:
            level: ``debug``, ``info``, ``warn``, ``error`` or ``fatal``.
            text: the line.
        """
        ros1 = self.ros_version == 1
        numbers = ROS1_LEVELS if ros1 else ROS2_LEVELS
        if level not in numbers:
            raise RosError(f"unknown log level {level!r}: expected one of {', '.join(numbers)}")
        if self._rosout is None:
            self._rosout = self.publisher(ROSOUT, *(ROS1_LOG if ros1 else ROS2_LOG))
        now, writer = self.clock.now(), self._rosout
        if ros1:
            message = writer.message(
                header={"stamp": now}, level=numbers[level], name=self.node_name, msg=text
            )
        else:
            # ROS 2 names loggers as Python does.
            logger = self.node_name.strip("/").replace("/", ".")
            message = writer.message(stamp=now, level=numbers[level], name=logger, msg=text)
        writer.publish(message)
