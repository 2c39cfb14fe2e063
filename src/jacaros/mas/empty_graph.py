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


def _everybody(contents: GraphContents) -> Iterator[str]:
    """The names of all who are there.

    Of a busy process its topics may be known before the names of its nodes; then they have an empty one.
    """
    yield from contents.nodes
    for topic in contents.topics.values():
        yield from (endpoint.node for endpoint in (*topic.publishers, *topic.subscriptions))


class EmptyGraph:
    """Tells in a log when nobody else is in the graph `MISSING_AFTER` seconds after our node was started.

    Args:
        backend: our node, started.
        clock: measures the seconds.
        graph: says which graph it is, for people.
        log: takes one line.
    """

    def __init__(self, backend: Backend, clock: Clock, graph: str, log: Callable[[str], None]) -> None:
        self._backend, self._graph, self._log = backend, graph, log
        self._task: asyncio.Task[None] | None = None
        self._timer = clock.call_later(MISSING_AFTER, self._begin)

    def _begin(self) -> None:
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
