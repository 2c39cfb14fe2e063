"""ROS 2 through rclpy: the complete backend."""

from collections.abc import Callable
from typing import Any, TypeVar

from jacaros.robots.ros.backend import Backend, GraphContents
from jacaros.robots.ros.drivers.ros2 import graph as ros2_graph
from jacaros.robots.ros.drivers.ros2.actions import Ros2ActionServer, Ros2GoalWire
from jacaros.robots.ros.drivers.ros2.node import Ros2Node
from jacaros.robots.ros.drivers.ros2.parameters import OwnParameters
from jacaros.robots.ros.drivers.ros2.receiving import RCLError
from jacaros.robots.ros.drivers.ros2.services import Ros2Client, Ros2Service
from jacaros.robots.ros.drivers.ros2.topics import Ros2Publisher, Ros2Subscription
from jacaros.robots.ros.errors import CallFailed, CallTimedOut, RosError, UnknownInterface
from jacaros.robots.ros.handoff import in_thread
from jacaros.robots.ros.node import Capability, NodeSettings, Parts
from jacaros.robots.ros.parameter import Parameters
from jacaros.robots.ros.parameter_services import NodeParameters, ParameterEvents, read_value
from jacaros.robots.ros.tf import MESSAGE as TRANSFORM_MESSAGE
from jacaros.robots.ros.waiting import within

T = TypeVar("T")
CAPABILITIES = frozenset(Capability) - {Capability.SERVICE_ERRORS, Capability.REGISTRATION}


def _joining(what: str, make: Callable[..., T]) -> Callable[..., T]:
    """Translate the error that two parts of one process use a service or action with different types."""

    def join(node: Ros2Node, name: str, type_name: str, *more: Any) -> T:
        try:
            return make(node, name, type_name, *more)
        except RCLError as problem:
            other = "incompatible type" in str(problem)
            because = "this node already uses it with another type" if other else str(problem)
            raise RosError(f"{what} {name} cannot be used with type {type_name}: {because}") from None

    return join


class Ros2Backend(Ros2Node):
    """A ROS 2 node that implements the port.

    Args:
        settings: names, clock and log.
        domain_id: the DDS domain; default: ``ROS_DOMAIN_ID``.
    """

    parts = Parts(
        publisher=Ros2Publisher,
        subscription=Ros2Subscription,
        service=_joining("service", Ros2Service),
        client=_joining("service", Ros2Client),
        action_client=_joining("action", Ros2GoalWire.client),
        action_server=_joining("action", Ros2ActionServer),
    )

    def __init__(self, settings: NodeSettings, domain_id: int | None = None) -> None:
        super().__init__(settings, domain_id)
        self._parameter_events = ParameterEvents(self.subscription, read_value)
        self._parameters: dict[str, Parameters] = {}

    @property
    def capabilities(self) -> frozenset[Capability]:  # type: ignore[override]
        """The capabilities; transforms only if ``tf2_msgs`` is installed."""
        try:
            self.schema.message_class(TRANSFORM_MESSAGE)
        except UnknownInterface:
            return CAPABILITIES - {Capability.TRANSFORMS}
        return CAPABILITIES

    async def start(self) -> None:
        """Join the graph."""
        await super().start()
        self._parameters[self.node_name] = OwnParameters(self, self._parameter_events)

    def parameters(self, node: str | None = None) -> Parameters:
        """Return the parameters of our own node, or of another."""
        name = self.node_name if node is None else self.resolve(node)
        if name not in self._parameters:
            self._parameters[name] = NodeParameters(
                self.clock, name, self._parameter_client, self._parameter_events
            )
        return self._parameters[name]

    def _parameter_client(self, name: str, type_name: str) -> Ros2Client:
        return self.keep(Ros2Client(self, name, type_name, repeatable=True))

    async def contents(self, timeout: float = 5.0) -> GraphContents:
        """Return the contents of the graph."""
        seen = in_thread(self.loop, lambda: ros2_graph.contents(self), "looking at the graph")
        try:
            return await within(self.clock, seen, timeout)
        except TimeoutError:
            raise CallTimedOut(
                f"rclpy did not return the contents of the graph within {timeout:g} s"
            ) from None
        except RCLError as problem:  # a node that left during the query
            raise CallFailed(f"rclpy cannot return the contents of the graph: {problem}") from None

    async def _publishers(self, topic: str) -> list[str]:
        return [ros2_graph.endpoint(info).node for info in self.rcl.get_publishers_info_by_topic(topic)]


BACKEND: type[Backend] = Ros2Backend
