"""The graph and the time of one virtual run, as the modules of this package share them."""

import asyncio
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any

from jacaros.robots.ros.backend import Backend
from jacaros.robots.ros.drivers.memory.graph import MemoryGraph
from jacaros.robots.ros.open import open_backend
from jacaros.runtime.clock import VirtualClock


class TimeIsUp(BaseException):
    """Ends a program, wherever it waits, at the time limit of its run."""


class VirtualGraph:
    """Nodes of one process on one virtual clock, and the program that spins them.

    Args:
        clock: the clock.
        loop: its loop; it runs while the program spins, and only then does time pass.
        parameters: values of the node's parameters, as ``--ros-args -p NAME:=VALUE`` gives them.
        print_line: takes each line that a node logs, with the node's name.
        log: takes lines of the graph itself.

    Attributes:
        graph: the graph.
    """

    def __init__(
        self,
        clock: VirtualClock,
        loop: asyncio.AbstractEventLoop,
        parameters: Mapping[str, Any],
        print_line: Callable[[str, str], None],
        log: Callable[[str], None],
    ) -> None:
        self.clock, self.loop, self.parameters, self.print_line = clock, loop, parameters, print_line
        self.graph = MemoryGraph()
        self._log = log
        self._backends: list[Backend] = []
        self._end: asyncio.Future[BaseException] = loop.create_future()

    def node(self, name: str, namespace: str = "") -> Any:
        """Join the graph by one more node, whose relative names are in *namespace*."""
        backend = open_backend("memory", self.clock, name, namespace, log=self._log, graph=self.graph)
        self._backends.append(backend)
        if self.loop.is_running():
            _without_waiting(backend)
        else:
            self.loop.run_until_complete(backend.start())
        return backend

    async def close(self) -> None:
        """Let all nodes leave the graph."""
        for backend in reversed(self._backends):
            await backend.close()

    def call(self, callback: Callable[..., object], *arguments: Any) -> None:
        """Run a callback of the program, unless it has ended; what it raises is raised where the program spins."""
        if self._end.done():
            return
        try:
            callback(*arguments)
        except BaseException as problem:
            self.stop(problem)

    def stop(self, problem: BaseException) -> None:
        """Raise *problem* where the program spins."""
        if not self._end.done():
            self._end.set_result(problem)

    def spin(self) -> None:
        """Let time pass until a callback raises an exception."""
        raise self.loop.run_until_complete(self._end)


def _without_waiting(backend: Backend) -> None:
    starting = backend.start()
    try:
        starting.send(None)  # in a memory graph it never waits
    except StopIteration:
        return
    raise AssertionError("a node of a memory graph waits for its start")


_current: ContextVar[VirtualGraph] = ContextVar("virtual graph")


def current() -> VirtualGraph:
    """Return the graph of the run; raises ``LookupError`` outside of one."""
    return _current.get()


@contextmanager
def being_current(graph: VirtualGraph) -> Iterator[None]:
    """Let `current` return *graph* in this context."""
    token = _current.set(graph)
    try:
        yield
    finally:
        _current.reset(token)
