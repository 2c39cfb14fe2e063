"""The middleware port: the interface of every backend for artifacts and for the embedded world.

Everything here happens on the loop of the backend's clock: calls must come from it, and callbacks run on it.
"""

from collections import Counter
from typing import Any
from weakref import WeakKeyDictionary

from jacaros.ros.action import ActionPolicy, ActionServer, Execute
from jacaros.ros.action_client import ActionClient
from jacaros.ros.graph import GraphContents
from jacaros.ros.lifetime import Lifetime
from jacaros.ros.message import Schema
from jacaros.ros.names import action_type, service_type
from jacaros.ros.node import Node, NodeSettings, TopicPublisher, TopicSubscription
from jacaros.ros.parameter import Parameters
from jacaros.ros.protocols.transform import Transform
from jacaros.ros.rosout import RosoutWriter
from jacaros.ros.services import Client, Handler, Service
from jacaros.ros.tf import TransformBroadcaster, TransformListener

DEFAULT_POLICY = ActionPolicy()


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
        self._rosout = RosoutWriter(self)

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
        self, name: str, type_name: str, execute: Execute, policy: ActionPolicy = DEFAULT_POLICY
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
        self._rosout.write(level, text)
