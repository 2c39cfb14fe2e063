"""Parameters of `jacaros.ros.backends.memory`: as on ROS 2, every node keeps its own."""

import asyncio
from collections.abc import Callable, Mapping

from jacaros.ros.backends.memory_node import MemoryNode
from jacaros.ros.backends.memory_services import come
from jacaros.ros.errors import CapabilityMissing
from jacaros.ros.parameter import Declaration, ParameterValue
from jacaros.ros.parameter_store import DeclaredParameters
from jacaros.ros.waiting import Absence


class MemoryParameters:
    """The parameters of a node, seen from another or from itself."""

    def __init__(self, asker: MemoryNode, node: str) -> None:
        self.node = node
        self._asker = asker
        self._absence = Absence()

    def declare(self, name: str, declaration: Declaration) -> ParameterValue:
        """Declare a parameter of our own node."""
        self._require_own()
        return self._asker.declared.declare(name, declaration)

    def withdraw(self, name: str) -> None:
        """Take a declaration of our own node back."""
        self._require_own()
        self._asker.declared.withdraw(name)

    async def names(self, timeout: float | None = None) -> list[str]:
        """Names of the node's parameters."""
        return (await self._store(timeout)).names()

    async def get(self, name: str, timeout: float | None = None) -> ParameterValue:
        """Give a parameter's value."""
        return (await self._store(timeout)).get(name)

    async def set(self, name: str, value: ParameterValue, timeout: float | None = None) -> None:
        """Change a parameter."""
        (await self._store(timeout)).set(name, value)
        await asyncio.sleep(0)  # the news of it comes first, as it does on real graphs more often than not

    def on_change(self, callback: Callable[[Mapping[str, ParameterValue]], None]) -> Callable[[], None]:
        """Have *callback* called with what changed."""
        return self._asker.graph.listen_to_parameters(self.node, callback)

    def _require_own(self) -> None:
        if self.node != self._asker.node_name:
            raise CapabilityMissing(
                f"only {self.node} itself can declare its parameters; {self._asker.node_name} can get and set them"
            )

    async def _store(self, timeout: float | None) -> DeclaredParameters:
        if self.node == self._asker.node_name:
            return self._asker.declared
        graph = self._asker.graph
        node = graph.node(self.node)
        what = f"parameters of node {self.node}"
        while node is None:
            await come(self._asker, f"node {self.node}", what, timeout, self._absence)
            node = graph.node(self.node)
        self._absence.end(self._asker.log, what)
        return node.declared
