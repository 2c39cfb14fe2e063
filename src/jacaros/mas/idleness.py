"""Whether a run is idle: nobody has anything to do, and nothing that was begun will give anybody something."""

import asyncio
from collections.abc import Callable
from typing import Protocol

from jacaros.mas.activity import Activity

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
