"""A ROS graph inside the process: needs no installation, deterministic, as fast as the loop.

Topics, services, actions, parameters and quality of service behave as on ROS 2; the message classes have the original
definitions. A published message is passed by reference, one turn of the loop per message, in the
order of publishing; therefore messages are read-only from `publish` on.
"""

from jacaros.ros.backend import Backend
from jacaros.ros.drivers.memory.graph import MemoryGraph, MemoryNode, MemoryPublisher, MemorySubscription
from jacaros.ros.drivers.memory.services import (
    MemoryActionServer,
    MemoryClient,
    MemoryGoalWire,
    MemoryParameters,
    MemoryService,
)
from jacaros.ros.errors import ServiceUnavailable
from jacaros.ros.graph import GraphContents
from jacaros.ros.node import (
    ACTIONS,
    DEADLINES,
    DECLARED_PARAMETERS,
    GRAPH_QOS,
    PARAMETER_EVENTS,
    PARAMETERS,
    QOS,
    SERVICE_ERRORS,
    SERVICES,
    TOPICS,
    TRANSFORMS,
    Parts,
)

__all__ = ["BACKEND", "MemoryBackend", "MemoryGraph", "MemoryPublisher", "MemorySubscription"]


class MemoryBackend(MemoryNode):
    """A node in an in-process graph.

    Args:
        settings: names, clock and log.
        graph: the graph to join; default: a new one.
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

    parts = Parts(
        publisher=MemoryPublisher,
        subscription=MemorySubscription,
        service=MemoryService,
        client=MemoryClient,
        action_client=MemoryGoalWire.client,
        action_server=MemoryActionServer,
    )

    async def start(self) -> None:
        """Join the graph."""
        self.join()
        self.graph.join(self)
        self.set_connected(self.graph.up)

    async def close(self) -> None:
        """Run the exit hooks and leave the graph."""
        self.lifetime.stop()
        self.close_members()
        self.graph.leave(self)
        self.left()
        self.lifetime.left()

    def parameters(self, node: str | None = None) -> MemoryParameters:
        """Return the parameters of our own node, or of another."""
        return MemoryParameters(self, self.node_name if node is None else self.resolve(node))

    async def contents(self, timeout: float = 5.0) -> GraphContents:
        """Return the contents of the graph."""
        if not self.graph.up:
            raise ServiceUnavailable("the graph is interrupted")
        return self.graph.contents()

    async def _publishers(self, topic: str) -> list[str]:
        return [publisher.node_name for publisher in self.graph.topic(topic).publishers]


BACKEND: type[Backend] = MemoryBackend
