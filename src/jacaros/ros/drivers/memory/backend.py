"""A ROS graph inside the process: nothing to install, deterministic, as fast as the loop.

Topics, services, actions, parameters and quality of service behave as on ROS 2; the message classes are the genuine
definitions from ``rosbags``.  A published message is handed over by reference, one turn of the loop per message, in the
order of publishing; so messages are read-only from `publish` on.
"""

import asyncio
from collections.abc import Callable
from typing import TypeVar

from jacaros.ros.action import ActionPolicy, Execute
from jacaros.ros.action_calling import GoalSender
from jacaros.ros.backend import (
    ACTIONS,
    DEADLINES,
    DECLARED_PARAMETERS,
    DEFAULT_POLICY,
    GRAPH_QOS,
    PARAMETER_EVENTS,
    PARAMETERS,
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
from jacaros.ros.drivers.memory.graph import MemoryGraph
from jacaros.ros.drivers.memory.node import Member, MemoryNode
from jacaros.ros.drivers.memory.services import (
    MemoryActionServer,
    MemoryClient,
    MemoryGoalWire,
    MemoryParameters,
    MemoryService,
)
from jacaros.ros.drivers.memory.topics import MemoryPublisher, MemorySubscription
from jacaros.ros.errors import RosError, ServiceUnavailable
from jacaros.ros.graph import GraphContents
from jacaros.ros.names import action_type, message_type, service_type
from jacaros.ros.node import NodeSettings
from jacaros.ros.qos import DEFAULT_QOS, QoS
from jacaros.ros.typestore import RosbagsSchema

__all__ = ["BACKEND", "MemoryBackend", "MemoryGraph", "MemoryPublisher", "MemorySubscription"]


_M = TypeVar("_M", bound=Member)


class MemoryBackend(MemoryNode):
    """A node in a graph inside the process.

    Args:
        settings: names, clock and reports.
        graph: the graph to join; a new one without it.
    """

    name = "memory"
    capabilities = frozenset(
        {
            TOPICS,
            SERVICES,
            SERVICE_ERRORS,
            TRANSFORMS,
            QOS,
            ACTIONS,
            PARAMETERS,
            DECLARED_PARAMETERS,
            PARAMETER_EVENTS,
            DEADLINES,
            GRAPH_QOS,
        }
    )

    def __init__(self, settings: NodeSettings, graph: MemoryGraph | None = None) -> None:
        self._schema = RosbagsSchema(settings.interface_paths)
        super().__init__(settings, self._schema, graph)

    async def start(self) -> None:
        """Join the graph."""
        self._loop = asyncio.get_running_loop()
        self.lifetime.join()
        self.graph.join(self)
        self.set_connected(self.graph.up)

    async def close(self) -> None:
        """Run the exit hooks and leave the graph."""
        self.lifetime.stop()
        for member in list(self.members):
            member.close()
        self.members.clear()
        self.graph.leave(self)
        self.set_connected(False)
        self.lifetime.left()

    def vanish(self) -> None:
        """Be gone without a word, as a killed process is; see `MemoryGraph.vanish`."""
        self.vanished = True
        for member in list(self.members):
            getattr(member, "vanish", member.close)()
        self.members.clear()
        self.graph.leave(self)

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
        name = self.resolve(topic)
        return self._joined(MemorySubscription(self, name, full_type, callback, qos, on_event))

    def service(self, name: str, type_name: str, handler: Handler) -> MemoryService:
        """Offer a service."""
        full_type = service_type(type_name)
        self._schema.offered(full_type)
        return self._joined(MemoryService(self, self.resolve(name), full_type, handler))

    def client(self, name: str, type_name: str) -> MemoryClient:
        """Make a client of a service."""
        full_type = service_type(type_name)
        self._schema.service(full_type)
        return self._joined(MemoryClient(self, self.resolve(name), full_type))

    def action_client(self, name: str, type_name: str) -> GoalSender:
        """Make a client of an action."""
        full_type = action_type(type_name)
        self._schema.action(full_type)
        return self._joined(MemoryGoalWire(self, self.resolve(name), full_type)).sender

    def action_server(
        self, name: str, type_name: str, execute: Execute, policy: ActionPolicy = DEFAULT_POLICY
    ) -> MemoryActionServer:
        """Offer an action."""
        full_type = action_type(type_name)
        self._schema.offered(full_type)
        return self._joined(MemoryActionServer(self, self.resolve(name), full_type, execute, policy))

    def parameters(self, node: str | None = None) -> MemoryParameters:
        """Give the parameters of our own node, or of another."""
        return MemoryParameters(self, self.node_name if node is None else self.resolve(node))

    async def contents(self, timeout: float = 5.0) -> GraphContents:
        """Look at the graph."""
        if not self.graph.up:
            raise ServiceUnavailable("the graph is interrupted")
        return self.graph.contents()

    def _joined(self, member: _M) -> _M:
        assert self.loop is not None
        if self.vanished:
            member.close()
            raise RosError(f"node {self.node_name} was taken away from the graph")
        self.members.append(member)
        return member


BACKEND: type[Backend] = MemoryBackend
