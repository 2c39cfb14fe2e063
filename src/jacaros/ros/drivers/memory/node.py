"""A node in a graph inside the process, as its publishers, services and actions know it."""

import itertools
from typing import Protocol

from jacaros.ros.drivers.memory.graph import MemoryGraph
from jacaros.ros.lifetime import Lifetime
from jacaros.ros.node import Node, NodeSettings
from jacaros.ros.parameter_store import DeclaredParameters
from jacaros.ros.typestore import RosbagsSchema


class Member(Protocol):
    """What a node has in its graph."""

    def close(self) -> None:
        """Leave, and be forgotten by the node."""


class MemoryNode(Node):
    """The part of `jacaros.ros.drivers.memory.backend.MemoryBackend` that its members use.

    Args:
        settings: names, clock and reports.
        schema: the message classes.
        graph: the graph to join; a new one without it.

    Attributes:
        members: what the node has in the graph, in its order.
    """

    def __init__(self, settings: NodeSettings, schema: RosbagsSchema, graph: MemoryGraph | None) -> None:
        super().__init__(settings, schema, Lifetime(settings.log))
        self.graph = graph if graph is not None else MemoryGraph()
        self.declared = DeclaredParameters(
            self.node_name,
            self.given_parameters,
            lambda changed: self.graph.parameters_changed(self.node_name, changed),
            self.log,
        )
        self.vanished = False
        self.members: list[Member] = []
        self._goal_numbers = itertools.count(1)

    def forget(self, member: Member) -> None:
        """Note that a member has left."""
        if member in self.members:
            self.members.remove(member)

    def new_goal_id(self) -> str:
        """Number the goals that this node sends."""
        return f"{self.node_name}-{next(self._goal_numbers)}"
