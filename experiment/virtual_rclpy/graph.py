"""The graph and the time of one virtual run, as the modules of this package share them."""

import asyncio
from collections import deque
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
        spinning: whether callbacks run while the program waits: a thread spins its nodes.
        concurrent: whether callbacks run while another callback waits: the executor has several threads.
    """

    spinning = concurrent = False

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
        self._held: deque[tuple[Callable[..., object], tuple[Any, ...]]] = deque()
        self._in_callback = self._time_is_up = self._time_passes = False

    def node(self, name: str, namespace: str = "") -> Any:
        """Join the graph by one more node, whose relative names are in *namespace*."""
        backend = open_backend("memory", self.clock, name, namespace, log=self._log, graph=self.graph)
        self._backends.append(backend)
        self.loop.run_until_complete(backend.start())
        return backend

    async def close(self) -> None:
        """Let all nodes leave the graph."""
        for backend in reversed(self._backends):
            await backend.close()

    def call(self, callback: Callable[..., object], *arguments: Any) -> None:
        """Let the program run a callback when it spins, or waits while a thread spins, but not inside another one."""
        self._held.append((callback, arguments))
        self._return_to_program()

    def end_program(self) -> None:
        """Raise `TimeIsUp` where the program waits."""
        self._time_is_up = True
        self._return_to_program()

    def spin(self) -> None:
        """Let time pass until a callback raises an exception."""
        self.spinning = True
        self.wait(lambda: False)

    def wait(self, ready: Callable[[], bool], timeout: float | None = None) -> bool:
        """Let time pass until a callback has made *ready* true, or for some seconds; return whether it is true."""
        end = None if timeout is None else self.clock.elapsed + timeout
        timer = None if timeout is None else self.clock.call_later(timeout, self._return_to_program)
        try:
            while not ready():
                if self._time_is_up:
                    raise TimeIsUp
                if end is not None and self.clock.elapsed >= end:
                    return False
                if not self._run_callback():
                    self._let_time_pass()
        finally:
            if timer is not None:
                timer.cancel()
        return True

    def wait_for(self, available: Callable[[], bool], timeout: float | None) -> bool:
        """Look four times a second, as rclpy does, whether a server is available."""
        end = None if timeout is None else self.clock.elapsed + timeout
        while not available():
            if end is not None and self.clock.elapsed >= end:
                return False
            self.wait(available, 0.25)
        return True

    def _let_time_pass(self) -> None:
        self._time_passes = True
        self.loop.run_forever()  # until it is stopped

    def _return_to_program(self) -> None:
        if self._time_passes:
            self._time_passes = False
            self.loop.stop()

    def _run_callback(self) -> bool:
        """Run the next callback; return whether there is one that may run now."""
        if not self._held or not self.spinning or (self._in_callback and not self.concurrent):
            return False
        callback, arguments = self._held.popleft()
        inside, self._in_callback = self._in_callback, True
        try:
            callback(*arguments)
        finally:
            self._in_callback = inside
        return True


_current: ContextVar[VirtualGraph] = ContextVar("virtual graph")


def current_or_none() -> VirtualGraph | None:
    """Return the graph of the run whose program is running; None outside of one."""
    return _current.get(None)


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
