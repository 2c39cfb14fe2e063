"""ROS 2 through rclpy: the backend, put together."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TypeVar

from jacaros.ros.action import ActionClient, ActionPolicy, Execute
from jacaros.ros.backend import (
    ACTIONS,
    DEADLINES,
    DECLARED_PARAMETERS,
    DEFAULT_POLICY,
    DISCOVERY,
    GRAPH_QOS,
    PARAMETER_EVENTS,
    PARAMETERS,
    QOS,
    SERVICES,
    TOPICS,
    TRANSFORMS,
    Backend,
    Handler,
    Sample,
    TopicEvent,
)
from jacaros.ros.drivers.ros2 import graph as ros2_graph
from jacaros.ros.drivers.ros2.actions import Ros2ActionServer
from jacaros.ros.drivers.ros2.goals import Ros2GoalWire
from jacaros.ros.drivers.ros2.node import Member, Ros2Node
from jacaros.ros.drivers.ros2.parameters import OtherParameters, OwnParameters, read_value
from jacaros.ros.drivers.ros2.services import Ros2Client, Ros2Service
from jacaros.ros.drivers.ros2.topics import Ros2Publisher, Ros2Subscription
from jacaros.ros.errors import CallFailed, CallTimedOut, RosError, UnknownInterface
from jacaros.ros.graph import GraphContents
from jacaros.ros.handoff import in_thread
from jacaros.ros.names import action_type, message_type, service_type
from jacaros.ros.node import NodeSettings
from jacaros.ros.parameter import Parameters
from jacaros.ros.parameter_news import ParameterNews
from jacaros.ros.qos import DEFAULT_QOS, QoS
from jacaros.ros.tf import MESSAGE as TRANSFORM_MESSAGE
from jacaros.ros.waiting import within

M = TypeVar("M", bound=Member)
CAPABILITIES = frozenset(
    {
        TOPICS,
        SERVICES,
        QOS,
        ACTIONS,
        DISCOVERY,
        PARAMETERS,
        DECLARED_PARAMETERS,
        PARAMETER_EVENTS,
        DEADLINES,
        GRAPH_QOS,
    }
)


@contextmanager
def _joining(what: str, type_name: str) -> Iterator[None]:
    """Say in our words that two parts of one process do not agree about the type of a service or action."""
    try:
        yield
    except ros2_graph.RCLError as problem:
        other = "incompatible type" in str(problem)
        because = "this node uses it with another type already" if other else str(problem)
        raise RosError(f"{what} cannot be joined with type {type_name}: {because}") from None


class Ros2Backend(Ros2Node):
    """A ROS 2 node with all that the port offers.

    Args:
        settings: names, clock and reports.
        domain_id: the DDS domain; ``ROS_DOMAIN_ID`` without it.
    """

    def __init__(self, settings: NodeSettings, domain_id: int | None = None) -> None:
        super().__init__(settings, domain_id)
        self._news = ParameterNews(self.subscription, read_value)
        self._parameters: dict[str, Parameters] = {}

    @property
    def capabilities(self) -> frozenset[str]:  # type: ignore[override]
        """What works here; transforms only where ``tf2_msgs`` is installed."""
        try:
            self.schema.message_class(TRANSFORM_MESSAGE)
        except UnknownInterface:
            return CAPABILITIES
        return CAPABILITIES | {TRANSFORMS}

    async def start(self) -> None:
        """Join the graph."""
        await super().start()
        self._parameters[self.node_name] = OwnParameters(self, self._news)

    async def close(self) -> None:
        """Run the exit hooks and leave the graph; goals of both sides are told that we go."""
        self.lifetime.stop()
        for member in list(self.members):
            if isinstance(member, Ros2GoalWire | Ros2ActionServer) and not self.ended:
                (member.sender if isinstance(member, Ros2GoalWire) else member).close()
        await super().close()

    def publisher(self, topic: str, type_name: str, qos: QoS = DEFAULT_QOS) -> Ros2Publisher:
        """Make a publisher."""
        return self._keep(Ros2Publisher(self, self.resolve(topic), message_type(type_name), qos))

    def subscription(
        self,
        topic: str,
        type_name: str,
        callback: Callable[[Sample], None],
        qos: QoS = DEFAULT_QOS,
        on_event: Callable[[TopicEvent], None] | None = None,
    ) -> Ros2Subscription:
        """Have *callback* called for every message."""
        name, kind = self.resolve(topic), message_type(type_name)
        return self._keep(Ros2Subscription(self, name, kind, callback, qos, on_event))

    def service(self, name: str, type_name: str, handler: Handler) -> Ros2Service:
        """Offer a service."""
        name, kind = self.resolve(name), service_type(type_name)
        with _joining(f"service {name}", kind):
            return self._keep(Ros2Service(self, name, kind, handler))

    def client(self, name: str, type_name: str) -> Ros2Client:
        """Make a client of a service."""
        name, kind = self.resolve(name), service_type(type_name)
        with _joining(f"service {name}", kind):
            return self._keep(Ros2Client(self, name, kind))

    def action_client(self, name: str, type_name: str) -> ActionClient:
        """Make a client of an action."""
        name, kind = self.resolve(name), action_type(type_name)
        with _joining(f"action {name}", kind):
            return self._keep(Ros2GoalWire(self, name, kind)).sender

    def action_server(
        self, name: str, type_name: str, execute: Execute, policy: ActionPolicy = DEFAULT_POLICY
    ) -> Ros2ActionServer:
        """Offer an action."""
        name, kind = self.resolve(name), action_type(type_name)
        with _joining(f"action {name}", kind):
            return self._keep(Ros2ActionServer(self, name, kind, execute, policy))

    def parameters(self, node: str | None = None) -> Parameters:
        """Give the parameters of our own node, or of another."""
        name = self.node_name if node is None else self.resolve(node)
        if name not in self._parameters:
            self._parameters[name] = OtherParameters(self, name, self._news)
        return self._parameters[name]

    async def contents(self, timeout: float = 5.0) -> GraphContents:
        """Look at the graph."""
        seen = in_thread(self.loop, lambda: ros2_graph.contents(self), "looking at the graph")
        try:
            return await within(self.clock, seen, timeout)
        except TimeoutError:
            raise CallTimedOut(f"rclpy did not tell within {timeout:g} s what is in the graph") from None
        except ros2_graph.RCLError as problem:  # a node that went while it was looked at
            raise CallFailed(f"rclpy cannot tell what is in the graph: {problem}") from None

    def _keep(self, member: M) -> M:
        self.members.append(member)
        return member


BACKEND: type[Backend] = Ros2Backend
