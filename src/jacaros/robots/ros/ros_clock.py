"""The clock of a simulator: time from ``/clock`` (ROS's ``use_sim_time``).

Delays are measured in the forward progress of ``/clock``. So everything waits while the simulator is paused, and runs
at its speed. When the simulator is reset and its time jumps back, pending waits continue with their remaining time:
no wait is for a time that never comes again, and no timer fires early.
"""

import asyncio
from collections.abc import Callable
from typing import Any

from jacaros.robots.ros.backend import Backend
from jacaros.robots.ros.message import to_seconds
from jacaros.robots.ros.qos import QoS
from jacaros.runtime.clock import Clock, Timer

CLOCK_TOPIC = "/clock"
CLOCK_TYPE = "rosgraph_msgs/msg/Clock"
CLOCK_QOS = QoS(reliability="best_effort", depth=1)
"""The request of ROS 2's own nodes: an old time is worthless."""

OVERTAKEN = 0.1
"""Seconds by which a message may be older than the previous one without being a jump: on an unreliable topic they can
overtake each other."""

AHEAD = 5.0
"""A step of more seconds is a jump: the simulator skipped time, or its messages were lost."""

NEARLY = 1e-6
"""Rounding error in seconds by which a timer may seem not yet due."""

SILENT_AFTER = 3.0
"""Seconds of real time after which a clock that does not move is reported."""


class RosClock(Clock):
    """Time from ``/clock``; it is 0 until the first message, as in all ROS nodes.

    Args:
        log: called with one line: the clock is missing, has arrived, stopped, jumped.

    Attributes:
        elapsed: seconds of forward progress since the first message, without pauses.
        paused: whether no timer fires, although the simulator may continue.
    """

    elapsed = 0.0

    def __init__(self, log: Callable[[str], None]) -> None:
        super().__init__()
        self._log = log
        self._time: float | None = None
        self._on_jump: list[Callable[[float], None]] = []
        self._watch: asyncio.TimerHandle | None = None
        self._moved = False
        self._told_still = False
        self._subscription: Any = None

    def now(self) -> float:
        """The newest time of ``/clock`` in seconds; most simulators begin at 0."""
        return self._time or 0.0

    @property
    def running(self) -> bool:
        """Whether a message of ``/clock`` has arrived."""
        return self._time is not None

    def call_later(self, delay: float, callback: Callable[[], None]) -> Timer:
        """Call *callback* when ``/clock`` has advanced by *delay* seconds."""
        timer = super().call_later(delay, callback)
        if delay <= 0.0:
            asyncio.get_running_loop().call_soon(self._ring)
        return timer

    def pause(self) -> None:
        """Stop timers until `resume`; `now` still follows the simulator, which is not paused."""
        self.paused = True

    def resume(self) -> None:
        """Continue timers with their remaining delays."""
        if self.paused:
            self.paused = False
            asyncio.get_running_loop().call_soon(self._ring)

    def on_jump(self, told: Callable[[float], None]) -> Callable[[], None]:
        """Call *told* after a time jump with the jump in seconds, negative if backwards.

        Returns:
            A function that removes the callback.
        """
        self._on_jump.append(told)
        return lambda: self._on_jump.remove(told) if told in self._on_jump else None

    def listen(self, source: Backend) -> None:
        """Follow the ``/clock`` of a graph that our node has joined."""
        self._subscription = source.subscription(
            CLOCK_TOPIC, CLOCK_TYPE, lambda sample: self.move_to(to_seconds(sample.message.clock)), CLOCK_QOS
        )
        self._log(f"waiting for {CLOCK_TOPIC}")
        self._look_later()

    def close(self) -> None:
        """Stop following the graph; time stands still."""
        if self._subscription is not None:
            self._subscription.close()
            self._subscription = None
        if self._watch is not None:
            self._watch.cancel()
            self._watch = None

    def move_to(self, time: float) -> None:
        """Handle a message of ``/clock``; timers that are due fire soon, in order."""
        before = self._time
        if before is not None and before - OVERTAKEN <= time <= before:
            return
        self._time = time
        if before is None:
            self._log(f"{CLOCK_TOPIC} found: the time is {time:.3f} s")
        elif time < before:
            self._jump(time - before)
        elif not self.paused:
            self.elapsed += time - before
            self._ring()
            if time - before > AHEAD:
                self._jump(time - before)
        self._note_motion()

    def _ring(self) -> None:
        if self.paused:
            return
        loop, due = asyncio.get_running_loop(), self.elapsed + NEARLY
        while (timer := self._timers.next_due(due)) is not None:
            # Through the loop, so that an error reaches its handler and not the middleware.
            loop.call_soon(timer.ring)

    def _jump(self, by: float) -> None:
        if by < 0:
            self._log(
                f"{CLOCK_TOPIC} jumped back by {-by:.3f} s (was the simulator reset?); waits continue with their remaining "
                "time"
            )
        else:
            self._log(f"{CLOCK_TOPIC} jumped ahead by {by:.3f} s; waits that end in this interval are over")
        for told in tuple(self._on_jump):
            told(by)

    def _note_motion(self) -> None:
        self._moved = True
        if self._told_still:
            self._told_still = False
            self._log(f"{CLOCK_TOPIC} continues")

    def _look_later(self) -> None:
        self._watch = asyncio.get_running_loop().call_later(SILENT_AFTER, self._look)

    def _look(self) -> None:
        if not self._moved and not self._told_still:
            self._told_still = True
            if self._time is None:
                self._log(
                    f"no publisher on {CLOCK_TOPIC}: time stands still until a simulator publishes it (`jacaros sim WORLD "
                    "--publish-clock`); without one run with --clock real"
                )
            else:
                self._log(f"{CLOCK_TOPIC} stopped at {self._time:.3f} s; all agents wait for the simulator")
        self._moved = False
        self._look_later()
