"""Other nodes that command the same robot: a base follows whichever command came last, so motions end in wrong places."""

import asyncio
from collections.abc import Callable
from contextlib import suppress

from jacaros.ros.backend import Backend
from jacaros.ros.errors import RosError
from jacaros.ros.guarded import guarded_by, guards_of
from jacaros.runtime.clock import Clock

EMBEDDED_WORLD = frozenset({"/world"})
"""The node of the embedded world, in this process or of `jacaros sim`: the robot itself, with its navigation."""

LOOK = 1.0
"""Seconds between two queries. Only a publisher that two of them find counts: discovery also finds those that are
leaving."""


class OtherPublishers:
    """Watch the publishers of a velocity topic that belong neither to the run nor to its guard.

    Args:
        backend: the node of the run.
        clock: measures the pauses.
        topic: absolute name.
        changed: called with a node and whether it publishes now.
        log: takes a warning about a node that no other artifact of the run has reported.
    """

    def __init__(
        self,
        backend: Backend,
        clock: Clock,
        topic: str,
        changed: Callable[[str, bool], None],
        log: Callable[[str], None],
    ) -> None:
        self._backend, self._clock, self._topic = backend, clock, topic
        self._changed, self._log = changed, log
        self._own = guards_of(backend.node_name) | EMBEDDED_WORLD
        self._found: frozenset[str] = frozenset()
        self._shown: frozenset[str] = frozenset()
        self._query: asyncio.Task[None] | None = None
        self._timer = clock.call_later(LOOK, self._look)

    def close(self) -> None:
        """Stop watching."""
        self._timer.cancel()
        if self._query is not None:
            self._query.cancel()

    def _look(self) -> None:
        self._query = asyncio.ensure_future(self._ask())

    async def _ask(self) -> None:
        with suppress(RosError):  # the graph cannot be reached now, or not be queried at all
            found = frozenset(await self._backend.other_publishers(self._topic))
            before, self._found = self._found, found - self._own
            self._show(self._found & before)
        self._timer = self._clock.call_later(LOOK, self._look)

    def _show(self, nodes: frozenset[str]) -> None:
        before, self._shown = self._shown, nodes
        for node in sorted(before ^ nodes):
            self._changed(node, node in nodes)
            if node in nodes and guarded_by(self._backend).is_news((self._topic, node)):
                self._log(
                    f"warning: {node} also publishes on {self._topic}: the robot follows whichever command came last\n"
                    "  help: give every source a topic of its own, and let twist_mux choose between them"
                )
