"""Whether somebody whom the graph still lists is alive: asked with fresh eyes.

A process that was killed, or has dropped out of the network, stays in the graph of those who knew it until its lease has
run out, which is up to 20 s with Fast DDS.  A participant that joins only now finds the living alone.  It costs some ten
milliseconds and is gone again in seconds.
"""

import asyncio
import threading
import time
from collections.abc import Callable
from typing import Any

import rclpy  # type: ignore[import-not-found]
import rclpy.signals  # type: ignore[import-not-found]

from jacaros.ros.handoff import in_thread

NODE = "_jacaros_liveness_check"
"""Tools do not show nodes that begin with an underscore."""
MISSED_AFTER = 4.0
"""Seconds after which who was not found is called missing; the living announce themselves every 3 s, and when met."""
GIVEN_UP_AFTER = 8.0
"""Seconds after which the look is over.  Who is found until then is called present after all."""
POLL = 0.1
"""Seconds between two looks at what was found."""
FRESH = 0.5
"""Seconds for which a look also serves others who begin to doubt."""

Find = Callable[[Any], frozenset[bytes]]
"""Reads identities from a node of rclpy: of those who publish a topic, say."""


class _Question:
    def __init__(
        self, find: Find, suspects: frozenset[bytes], report: Callable[[frozenset[bytes]], None]
    ) -> None:
        self.find = find
        self.suspects = suspects
        self.report = report
        self.missing: frozenset[bytes] = frozenset()


class LivenessCheck:
    """One participant that has joined just now, and what is asked of it; on the loop.

    Args:
        loop: where it is told.
        domain_id: the DDS domain; None for ``ROS_DOMAIN_ID``.
        over: called when the look is over.
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
        """Whether it began so lately that who is found was alive just now."""
        return time.monotonic() < self._began + FRESH

    def ask(self, find: Find, suspects: frozenset[bytes], report: Callable[[frozenset[bytes]], None]) -> None:
        """Find out who of the *suspects* is alive.

        Args:
            find: see `Find`.
            suspects: whom to look for.
            report: called with those that are missing: none as soon as all were found, else after `MISSED_AFTER`, and
                again if some are found after that.
        """
        self._questions.append(_Question(find, suspects, report))

    def leave(self) -> None:
        """Leave the graph; on any thread."""
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
        if done.exception() is not None:  # no more participants on this machine, say: then the lease decides
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
