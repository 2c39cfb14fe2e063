"""An event loop without sockets, which its host runs in short turns, on virtual time that follows real time.

A browser has a loop of its own, and code that blocks it cannot receive a message. So the host calls `PumpedLoop.pump`
again and again, and does its other work between two calls.
"""

import asyncio
from collections.abc import Callable
from typing import Any

from jacaros.runtime.clock import Loop, VirtualClock, VirtualSelector, real_time

BEHIND = 0.25
"""Seconds of real time that the clock may lag behind. What is more is dropped: a slow machine gets a slow robot, and a
tab that was in the background does not catch up in a burst.
"""


class PacedClock(VirtualClock):
    """A virtual clock that moves no faster than *speed* seconds per second of real time.

    A machine that is too slow for the speed delays time, so the robot drives the same way on every machine.

    Args:
        speed: greater than 0; infinite for as fast as possible.
        real: seconds of a steady clock.
    """

    has_speed = True
    CYCLES_PER_MILLISECOND = 50
    """About what agents do in real time: the world moves on beside a plan that never ends."""

    def __init__(self, speed: float = 1.0, real: Callable[[], float] = real_time) -> None:
        super().__init__()
        self._real = real
        self._speed = speed
        self._noted = real()
        self._reached = 0.0

    @property
    def speed(self) -> float:
        """Seconds of this clock per second of real time."""
        return self._speed

    @speed.setter
    def speed(self, speed: float) -> None:
        self.note()
        self._speed = speed

    def note(self) -> None:
        """Let time continue from here: after a pause, or a change of speed."""
        self._noted, self._reached = self._real(), self.elapsed

    def resume(self) -> None:
        """Continue exactly where the clock was paused."""
        self.note()
        super().resume()

    def ahead(self) -> float:
        """Return by how many seconds the clock may move now."""
        if self._speed == float("inf"):
            return self._speed
        moment = self._reached + (self._real() - self._noted) * self._speed
        if moment - self.elapsed > BEHIND * self._speed:
            self.note()
            self._reached += BEHIND * self._speed
            moment = self._reached
        return max(0.0, moment - self.elapsed)

    def next(self) -> float | None:
        """Return the seconds of this clock until the first timer, None without one."""
        moment = self._timers.first_moment()
        return None if moment is None else max(0.0, moment - self.elapsed)


class _Turns(VirtualSelector):
    """Ends a turn of the loop when nothing is ready, or its time is over; there are no sockets to wait for."""

    clock: PacedClock

    def __init__(self, clock: PacedClock, end_turn: Callable[[], None]) -> None:
        super().__init__(clock)
        self._end_turn = end_turn
        self.until = 0.0
        self.rest: float | None = 0.0
        """Seconds of real time until the next turn; None: when something happens outside."""

    def select(self, timeout: float | None = None) -> list[Any]:
        if self.clock.paused:
            self.hold_run()
        elif not self.ready:
            self._move(timeout)
        if not self.ready or real_time() >= self.until:
            self.rest = 0.0 if self.ready else self._rest(timeout)
            self._end_turn()
        return []

    def _move(self, timeout: float | None) -> None:
        """Move the clock as far as real time allows, at most to the next timer."""
        ahead = self.clock.ahead()
        if timeout is not None:
            ahead = min(ahead, timeout)
        self.clock.advance(None if ahead == float("inf") else ahead)

    def _rest(self, timeout: float | None) -> float | None:
        waits = [each for each in (timeout, self.clock.next()) if each is not None]
        if self.clock.paused or not waits:
            return None
        return max(0.0, min(waits) - self.clock.ahead()) / self.clock.speed


class PumpedLoop(Loop, asyncio.BaseEventLoop):
    """The loop of a run in a browser.

    Args:
        clock: its time.
    """

    has_threads = False

    def __init__(self, clock: PacedClock) -> None:
        super().__init__()
        self._clock = clock
        self._turns = self._selector = _Turns(clock, self.stop)
        self._turns.ready = self._ready  # type: ignore[attr-defined]

    def pump(self, seconds: float) -> float | None:
        """Run what is ready for about *seconds*.

        Returns:
            Seconds until the next call, 0.0 for at once; None: not before something happens outside.
        """
        self._turns.until = real_time() + seconds
        outer = asyncio._get_running_loop()
        asyncio._set_running_loop(None)
        try:
            self.run_forever()
        finally:
            asyncio._set_running_loop(outer)
        return self._turns.rest

    def time(self) -> float:
        """Return seconds of virtual time since the beginning."""
        return self._clock.elapsed

    def _process_events(self, event_list: list[Any]) -> None:
        """Do nothing: there are no sockets."""

    def _write_to_self(self) -> None:
        """Do nothing: no other thread has to wake the loop."""
