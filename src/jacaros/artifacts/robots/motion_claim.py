"""The motions of a robot: to abort them, and to wake the one that waits or drives.

The arbiter of resources (`jacaros.env.resources.arbiter`) decides which of them drives: all use ``wheels``.
"""

import asyncio
from collections.abc import Callable
from weakref import WeakKeyDictionary

from jacaros.clock import Clock
from jacaros.env.values import Atom, Structure
from jacaros.ros.backend import Backend

GAP = 0.5
"""Seconds by which a motion may be late, or the clock be set. More is a gap: the robot was not watched for longer
than a base waits for commands."""

GUARD_TRIPPED = Atom("guard_tripped")
"""Reason of the gap of a robot that a guard has stopped."""


class Claim:
    """One motion, from its request to its end.

    Args:
        stop: commands zero velocity immediately.

    Attributes:
        aborted: the motion was aborted.
        gap: why the robot was not watched for a while; the motion clears it. None otherwise.
    """

    def __init__(self, stop: Callable[[], None]) -> None:
        self.stop = stop
        self.aborted = False
        self.gap: Structure | Atom | None = None
        self._waiting: asyncio.Future[None] | None = None
        self._woken = False

    def abort(self) -> None:
        """Abort the motion: stop the robot immediately; the operation fails when it runs next."""
        self.aborted = True
        self.stop()
        self.wake()

    def interrupt(self, why: Structure | Atom) -> None:
        """Stop the robot immediately; the motion decides whether it continues."""
        self.gap = why
        self.stop()
        self.wake()

    def wake(self) -> None:
        """End the present wait, or the next one if none exists."""
        if self._waiting is None:
            self._woken = True
        elif not self._waiting.done():
            self._waiting.set_result(None)

    async def wait(self, clock: Clock, seconds: float | None) -> None:
        """Wait until this motion is woken or the time is over."""
        if self._woken:
            self._woken = False
            return
        waiting = self._waiting = asyncio.get_running_loop().create_future()
        began, set_to = clock.elapsed, clock.now() - clock.elapsed
        unknown = clock.now() == 0.0  # a clock that follows /clock before its first message
        timer = None if seconds is None else clock.call_later(seconds, self.wake)
        try:
            await waiting
        finally:
            self._waiting = None
            if timer is not None:
                timer.cancel()
        if seconds is not None:
            moved = 0.0 if unknown else clock.now() - clock.elapsed - set_to
            self._look_for_gap(clock.elapsed - began - seconds, moved)

    def _look_for_gap(self, late: float, moved: float) -> None:
        """Detect that the process was frozen or stuck, or that the clock was set."""
        if late > GAP:
            self.gap = Structure("delayed", (round(late, 3),))
        elif abs(moved) > GAP:
            self.gap = Structure("clock_jumped", (round(moved, 3),))
        else:
            return
        self.stop()


class Motions:
    """The motions of one robot that drive or wait to drive, of all artifacts.

    Attributes:
        stops: how often the robot was stopped; a command that is still waiting to be sent must not follow.
        claims: motions that are neither suspended nor finished.
    """

    def __init__(self) -> None:
        self.stops = 0
        self.claims: dict[Claim, None] = {}

    def abort(self) -> None:
        """Abort the motion that drives and all that wait, except suspended ones."""
        self.stops += 1
        for claim in list(self.claims):
            claim.abort()


_motions: WeakKeyDictionary[Backend, dict[str, Motions]] = WeakKeyDictionary()


def motions_of(backend: Backend, robot: str) -> Motions:
    """Return the motions of the robot with the topic prefix *robot*: the same object for the same backend."""
    return _motions.setdefault(backend, {}).setdefault(robot, Motions())
