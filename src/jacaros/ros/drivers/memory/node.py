"""A node in an in-process graph, as seen by its publishers, services and actions."""

import itertools

from jacaros.ros.drivers.memory.graph import MemoryGraph
from jacaros.ros.errors import RosError
from jacaros.ros.lifetime import Lifetime
from jacaros.ros.node import M, Node, NodeSettings
from jacaros.ros.parameter_store import DeclaredParameters
from jacaros.ros.typestore import DefinitionSchema


class MemoryNode(Node):
    """The part of `jacaros.ros.drivers.memory.backend.MemoryBackend` that its entities use.

    Args:
        settings: names, clock and log.
        graph: the graph to join; default: a new one.
    """

    def __init__(self, settings: NodeSettings, graph: MemoryGraph | None) -> None:
        self.schema = DefinitionSchema(settings.interface_paths)
        super().__init__(settings, self.schema, Lifetime(settings.log))
        self.graph = graph if graph is not None else MemoryGraph()
        self.declared = DeclaredParameters(
            self.node_name,
            self.given_parameters,
            lambda changed: self.graph.parameters_changed(self.node_name, changed),
            self.log,
        )
        self.vanished = False
        self._goal_numbers = itertools.count(1)

    def keep(self, member: M) -> M:
        """Close *member* with the node. Raises `RosError` if the node has vanished."""
        if self.vanished:
            member.close()
            raise RosError(f"node {self.node_name} was taken away from the graph")
        return super().keep(member)

    def new_goal_id(self) -> str:
        """Return a numbered id for a goal of this node."""
        return f"{self.node_name}-{next(self._goal_numbers)}"
