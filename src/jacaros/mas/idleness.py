"""Idleness of a run: no agent has anything to do, and nothing pending will give an agent something to do.

Pending are timers of agents and their operations.
"""

import asyncio
from collections.abc import Callable

from jacaros.agents.mind.state.act import Timer
from jacaros.mas.scheduler import Scheduler
from jacaros.runtime.clock import Clock


class Activity:
    """Counts what will give an agent something to do.

    Worlds, batteries and processes of artifacts do not count: they never end.
    """

    def __init__(self) -> None:
        self.pending = 0

    def begin(self) -> None:
        """Something has begun."""
        self.pending += 1

    def end(self) -> None:
        """It has ended, or was cancelled."""
        self.pending -= 1


class AgentTimer:
    """A timer of an agent, counted until it fires or is cancelled."""

    __slots__ = ("_activity", "_callback", "_timer")

    def __init__(self, clock: Clock, activity: Activity, delay: float, callback: Callable[[], None]) -> None:
        self._activity = activity
        self._callback = callback
        activity.begin()
        self._timer: Timer | None = clock.call_later(delay, self._ring)

    def cancel(self) -> None:
        """Cancel the timer. No effect after it has fired."""
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None
            self._activity.end()

    def _ring(self) -> None:
        if self._timer is not None:
            self._timer = None
            self._activity.end()
            self._callback()


_HOPS = 8
"""Number of idle turns of the event loop before a run counts as idle: a message of the in-process ROS graph takes a few
turns to become a belief.
"""


class Idleness:
    """Detects when a run is idle. Costs nothing without listeners.

    Args:
        activity: counts what the agents wait for.

    Attributes:
        turns: the scheduler of the agents. Set before the first check.
    """

    turns: Scheduler

    def __init__(self, activity: Activity) -> None:
        self._activity = activity
        self._watchers: list[Callable[[], None]] = []
        self._looks = 0

    def watch(self, callback: Callable[[], None]) -> Callable[[], None]:
        """Call *callback* whenever the run has become idle. Return a function that ends this."""
        self._watchers.append(callback)
        return lambda: self._watchers.remove(callback) if callback in self._watchers else None

    def stop(self) -> None:
        """Remove all listeners."""
        self._watchers.clear()

    def look(self) -> None:
        """Check whether the run is idle, after the last agent has run out of things to do."""
        if self._watchers:
            self._looks += 1
            self._look_again(self._looks, _HOPS)

    def _look_again(self, look: int, hops: int) -> None:
        if look != self._looks or self._activity.pending or not self.turns.idle:
            return
        if hops:
            asyncio.get_running_loop().call_soon(self._look_again, look, hops - 1)
            return
        for callback in tuple(self._watchers):
            callback()
