"""``rclpy.task``: results that come later."""

from collections.abc import Callable
from typing import Any

from virtual_rclpy.graph import VirtualGraph


class Future:
    """A result that comes later."""

    def __init__(self, graph: VirtualGraph) -> None:
        self._graph = graph
        self._done = False
        self._result: Any = None
        self._callbacks: list[Callable[[Future], object]] = []

    def done(self) -> bool:
        """Return whether the result is there."""
        return self._done

    def result(self) -> Any:
        """Return the result; None until it is there."""
        return self._result

    def set_result(self, result: Any) -> None:
        """Take the result and run the callbacks."""
        self._done, self._result = True, result
        for callback in self._callbacks:
            self._graph.call(callback, self)

    def arrive(self, result: Any) -> None:
        """Take the result when the program spins: as in rclpy, a callback of the executor delivers it."""
        self._graph.call(self.set_result, result)

    def add_done_callback(self, callback: Callable[["Future"], object]) -> None:
        """Run *callback* with this future when the result is there."""
        if self._done:
            self._graph.call(callback, self)
        else:
            self._callbacks.append(callback)
