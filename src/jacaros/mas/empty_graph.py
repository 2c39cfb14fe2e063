"""A ROS 2 graph with nobody else in it is most often another domain: told once, since no middleware does."""

import asyncio
from collections.abc import Callable, Iterator

from jacaros.clock import Clock
from jacaros.ros.backend import Backend
from jacaros.ros.errors import RosError
from jacaros.ros.graph import GraphContents
from jacaros.ros.waiting import MISSING_AFTER

_ANSWER = 5.0
"""Seconds for the graph to tell what is in it."""
_STEP, _LATE = 0.1, 0.02
"""Seconds between two looks at the loop, and how late it may be to count as on time."""
_AT_MOST = 30.0
"""Seconds after which a loop that is always late is waited for no longer."""


def _everybody(contents: GraphContents) -> Iterator[str]:
    """The names of all who are there.

    Of a busy process its topics may be known before the names of its nodes; then they have an empty one.
    """
    yield from contents.nodes
    for topic in contents.topics.values():
        yield from (endpoint.node for endpoint in (*topic.publishers, *topic.subscriptions))


class EmptyGraph:
    """Logs when nobody else is in the graph `MISSING_AFTER` seconds after our node was started.

    Only seconds in which the loop is on time count: on a busy machine discovery is late, too, and so are other nodes.

    Args:
        backend: our node, started.
        clock: measures the seconds.
        graph: says which graph it is, for people.
        log: takes one line.
    """

    def __init__(self, backend: Backend, clock: Clock, graph: str, log: Callable[[str], None]) -> None:
        self._backend, self._graph, self._log = backend, graph, log
        self._task: asyncio.Task[None] | None = None
        self._clock, self._begun = clock, clock.elapsed
        self._missing = round(MISSING_AFTER / _STEP)
        self._wait()

    def _wait(self) -> None:
        self._due = self._clock.elapsed + _STEP
        self._timer = self._clock.call_later(_STEP, self._step)

    def _step(self) -> None:
        now = self._clock.elapsed
        self._missing -= now - self._due < _LATE
        if self._missing > 0 and now - self._begun < _AT_MOST:
            self._wait()
        else:
            self._task = asyncio.get_running_loop().create_task(self._look())

    async def _look(self) -> None:
        try:
            contents = await self._backend.contents(_ANSWER)
        except RosError:
            return  # who cannot ask cannot tell either
        if not any(who != self._backend.node_name for who in _everybody(contents)):
            self._log(
                f"nobody else is in {self._graph}. Is the robot running? It must have the same ROS_DOMAIN_ID (here "
                "--domain-id, too) and ROS_AUTOMATIC_DISCOVERY_RANGE"
            )

    def close(self) -> None:
        """Tell nothing any more."""
        self._timer.cancel()
        if self._task is not None:
            self._task.cancel()
