"""Check whether a peer that the graph still lists is alive.

A process that was killed, or has lost its network, stays in the graph of its peers until its lease expires, up to 20
s with Fast DDS. A participant that has just joined discovers only living ones. It costs about 10 ms and leaves again
after some seconds.
"""

import asyncio
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import rclpy  # type: ignore[import-not-found]
import rclpy.signals  # type: ignore[import-not-found]

from jacaros.robots.ros.handoff import in_thread

NODE = "_jacaros_liveness_check"
"""Tools do not show nodes that begin with an underscore."""
MISSED_AFTER = 4.0
"""Seconds after which an undiscovered peer counts as missing; living ones announce themselves every 3 s, and on
discovery."""
GIVEN_UP_AFTER = 8.0
"""Seconds after which the check ends. Peers discovered until then are reported as present."""
POLL = 0.1
"""Seconds between two queries of the discovered peers."""
FRESH = 0.5
"""Seconds during which a running check also serves further callers."""

Find = Callable[[Any], frozenset[bytes]]
"""Returns identities from a node of rclpy, such as those of a topic's publishers."""


ReportLost = Callable[[frozenset[bytes]], None]
"""Takes the missing ones of the identities that a caller has asked about."""


@dataclass(eq=False)
class _Question:
    find: Find
    suspects: frozenset[bytes]
    report: ReportLost
    missing: frozenset[bytes] = frozenset()


class LivenessCheck:
    """One participant that has just joined, and the callers' questions; on the loop.

    Args:
        loop: loop of the callbacks.
        domain_id: the DDS domain; None for ``ROS_DOMAIN_ID``.
        over: called when the check has ended.
    """

    def __init__(
        self, loop: asyncio.AbstractEventLoop, domain_id: int | None, over: Callable[["LivenessCheck"], None]
    ) -> None:
        self._loop = loop
        self._domain_id = domain_id
        self._over = over
        self._began = time.monotonic()
        self._questions: list[_Question] = []
        self._lock = threading.Lock()
        self._left = False
        self._context: Any = None
        self._rcl: Any = None
        in_thread(loop, self._join, "liveness check").add_done_callback(self._joined)

    @property
    def fresh(self) -> bool:
        """Whether it has begun so recently that its results are valid for a new caller."""
        return time.monotonic() < self._began + FRESH

    def ask(self, find: Find, suspects: frozenset[bytes], report: ReportLost) -> None:
        """Find out which of the *suspects* are alive.

        Args:
            find: see `Find`.
            suspects: identities to look for.
            report: called with the missing ones: with none as soon as all are found, else after `MISSED_AFTER`, and
                again if some are found later.
        """
        self._questions.append(_Question(find, suspects, report))

    def leave(self) -> None:
        """Leave the graph; callable on any thread."""
        with self._lock:
            self._left = True
            if self._rcl is not None:
                self._rcl.destroy_node()
            if self._context is not None:
                self._context.try_shutdown()

    def _join(self) -> None:
        no_signals = rclpy.signals.SignalHandlerOptions.NO
        with self._lock:
            if self._left:
                return
            context = rclpy.Context()
            rclpy.init(args=[], context=context, domain_id=self._domain_id, signal_handler_options=no_signals)
            self._context = context
            self._rcl = rclpy.create_node(
                NODE,
                context=context,
                use_global_arguments=False,
                enable_rosout=False,
                start_parameter_services=False,
            )

    def _joined(self, done: "asyncio.Future[None]") -> None:
        # For instance no further participants on this machine: then the lease decides.
        if done.exception() is not None:
            self._end()
        else:
            self._began = time.monotonic()
            self._look()

    def _look(self) -> None:
        if self._left:
            return
        patience = time.monotonic() - self._began
        for question in list(self._questions):
            missing = question.suspects - self._found(question)
            if not missing or (patience > MISSED_AFTER and missing != question.missing):
                question.missing = missing
                question.report(missing)
            if not missing:
                self._questions.remove(question)
        if patience > GIVEN_UP_AFTER or not self._questions:
            self._end()
        else:
            self._loop.call_later(POLL, self._look)

    def _found(self, question: _Question) -> frozenset[bytes]:
        with self._lock:
            return frozenset() if self._left else question.find(self._rcl)

    def _end(self) -> None:
        self._over(self)
        in_thread(self._loop, self.leave, "liveness check")
