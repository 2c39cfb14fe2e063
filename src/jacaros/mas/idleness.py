"""Whether a run is idle: nobody has anything to do, and nothing that was begun will give anybody something.

What may: the timers of agents, and their operations.
"""

import asyncio
from collections.abc import Callable
from typing import Protocol

from jacaros.bdi.architecture import Timer
from jacaros.clock import Clock


class Activity:
    """Counts what will give an agent something to do again.

    Worlds, batteries and the processes of artifacts do not count: they never end.
    """

    def __init__(self) -> None:
        self.pending = 0

    def begin(self) -> None:
        """Something has been begun."""
        self.pending += 1

    def end(self) -> None:
        """It is over, or was taken back."""
        self.pending -= 1


class AgentTimer:
    """A call that is to come, counted until it has come or was taken back."""

    __slots__ = ("_activity", "_callback", "_timer")

    def __init__(self, clock: Clock, activity: Activity, delay: float, callback: Callable[[], None]) -> None:
        self._activity = activity
        self._callback = callback
        activity.begin()
        self._timer: Timer | None = clock.call_later(delay, self._ring)

    def cancel(self) -> None:
        """Take the call back; nothing happens when it is past."""
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
"""Turns of the loop that must pass without anything to do before a run counts as idle: a message of a ROS
graph inside the process takes a few to become a belief."""


class Turns(Protocol):
    """What gives the agents their turns."""

    @property
    def idle(self) -> bool:
        """True when no agent is ready."""


class Idleness:
    """Tells when a run is idle, to those who want to know; it costs nothing while there are none.

    Args:
        activity: what the agents wait for.

    Attributes:
        turns: to be set before the first look.
    """

    turns: Turns

    def __init__(self, activity: Activity) -> None:
        self._activity = activity
        self._watchers: list[Callable[[], None]] = []
        self._looks = 0

    def watch(self, told: Callable[[], None]) -> Callable[[], None]:
        """Call *told* whenever the run has become idle; gives what ends that."""
        self._watchers.append(told)
        return lambda: self._watchers.remove(told) if told in self._watchers else None

    def stop(self) -> None:
        """Tell nobody any more."""
        self._watchers.clear()

    def look(self) -> None:
        """Look whether the run is idle: the last agent has run out of things to do."""
        if self._watchers:
            self._looks += 1
            self._look_again(self._looks, _HOPS)

    def _look_again(self, look: int, hops: int) -> None:
        if look != self._looks or self._activity.pending or not self.turns.idle:
            return
        if hops:
            asyncio.get_running_loop().call_soon(self._look_again, look, hops - 1)
            return
        for told in tuple(self._watchers):
            told()
