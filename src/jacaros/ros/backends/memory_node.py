"""A node in a graph inside the process, as its publishers, services and actions know it."""

import itertools

from jacaros.ros.backends.memory_graph import MemoryGraph
from jacaros.ros.node import Node, NodeSettings
from jacaros.ros.parameter_store import DeclaredParameters
from jacaros.ros.typestore import RosbagsSchema


class MemoryNode(Node):
    """The part of `jacaros.ros.backends.memory.MemoryBackend` that its members use.

    Args:
        settings: names, clock and reports.
        schema: the message classes.
        graph: the graph to join; a new one without it.
    """

    def __init__(self, settings: NodeSettings, schema: RosbagsSchema, graph: MemoryGraph | None) -> None:
        super().__init__(settings, schema, finish=lambda: None, threaded_hooks=False)
        self.graph = graph if graph is not None else MemoryGraph()
        self.declared = DeclaredParameters(
            self.node_name,
            settings.parameters,
            lambda changed: self.graph.parameters_changed(self.node_name, changed),
            self.log,
        )
        self.vanished = False
        self._goal_numbers = itertools.count(1)

    def new_goal_id(self) -> str:
        """Number the goals that this node sends."""
        return f"{self.node_name}-{next(self._goal_numbers)}"
