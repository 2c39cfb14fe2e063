"""A graph inside the process for tests."""

from collections.abc import Callable, Coroutine
from typing import Any

from jacaros.robots.ros.backend import Backend
from jacaros.robots.ros.drivers.memory.graph import MemoryGraph
from jacaros.robots.ros.open import open_backend
from jacaros.runtime.clock import VirtualClock, run


class GraphLab:
    """Nodes on one virtual clock, and what they log."""

    def __init__(self) -> None:
        self.clock = VirtualClock()
        self.graph = MemoryGraph()
        self.log: list[str] = []

    async def node(self, name: str, **options: Any) -> Backend:
        """Return a new node that has joined the graph."""
        made = open_backend("memory", self.clock, name, graph=self.graph, log=self.log.append, **options)
        await made.start()
        return made

    @classmethod
    def play(cls, scene: Callable[[Any], Coroutine[Any, Any, None]]) -> None:
        """Run a scene in a new lab."""
        lab = cls()
        run(lambda: scene(lab), lab.clock)
