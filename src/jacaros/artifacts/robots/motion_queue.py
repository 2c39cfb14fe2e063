"""The queue of a robot's motions: its wheels obey one motion at a time, whichever artifact asks.

Artifacts that drive the same robot share its queue.  Motions pass in the order of their requests; one that
is suspended leaves the queue, and stands at its end when its agent resumes it.
"""

import asyncio
from collections import deque
from collections.abc import Callable
from weakref import WeakKeyDictionary

from jacaros.clock import Clock
from jacaros.env.values import Atom, Structure
from jacaros.ros.backend import Backend

GAP = 0.5
"""Seconds by which a motion's next moment may be late, or the time of day be set; more is a gap: for longer than a base
waits for commands nobody watched the robot."""

GUARD_TRIPPED = Atom("guard_tripped")
"""The gap of a robot that a guard has stopped."""


class Claim:
    """One motion's claim to the wheels.

    Args:
        stop: commands zero velocity at once.

    Attributes:
        aborted: somebody wants this motion to end.
        gap: why nobody has watched the robot for a while, for the motion to take; None otherwise.
    """

    def __init__(self, stop: Callable[[], None]) -> None:
        self.stop = stop
        self.aborted = False
        self.gap: Structure | Atom | None = None
        self._waiting: asyncio.Future[None] | None = None
        self._woken = False

    def abort(self) -> None:
        """End the motion: the robot is stopped here and now, the operation fails as soon as it runs."""
        self.aborted = True
        self.stop()
        self.wake()

    def interrupt(self, why: Structure | Atom) -> None:
        """Stop the robot here and now; the motion decides whether it continues."""
        self.gap = why
        self.stop()
        self.wake()

    def wake(self) -> None:
        """End the present wait, or the next one if there is none."""
        if self._waiting is None:
            self._woken = True
        elif not self._waiting.done():
            self._waiting.set_result(None)

    async def wait(self, clock: Clock, seconds: float | None) -> None:
        """Wait until somebody wakes this motion, or the time is over."""
        if self._woken:
            self._woken = False
            return
        waiting = self._waiting = asyncio.get_running_loop().create_future()
        began, set_to = clock.elapsed, clock.now() - clock.elapsed
        timer = None if seconds is None else clock.call_later(seconds, self.wake)
        try:
            await waiting
        finally:
            self._waiting = None
            if timer is not None:
                timer.cancel()
        if seconds is not None:
            self._look_for_gap(clock.elapsed - began - seconds, clock.now() - clock.elapsed - set_to)

    def _look_for_gap(self, late: float, moved: float) -> None:
        """Notice that the process was frozen or stuck, or that the clock was set."""
        if late > GAP:
            self.gap = Structure("delayed", (round(late, 3),))
        elif abs(moved) > GAP:
            self.gap = Structure("clock_jumped", (round(moved, 3),))
        else:
            return
        self.stop()


class MotionQueue:
    """Who drives, and who waits to drive.

    Attributes:
        holder: whose motion drives, None while nobody's does.
        stops: how often the robot was told to stop, for a command that waits to be sent and must not follow.
    """

    def __init__(self) -> None:
        self.stops = 0
        self.holder: Claim | None = None
        self._queue: deque[Claim] = deque()

    def enter(self, claim: Claim) -> bool:
        """Ask for the wheels; False: wait (`Claim.wait`) until it is the `holder`."""
        if self.holder is None:
            self.holder = claim
        elif self.holder is not claim and claim not in self._queue:
            self._queue.append(claim)
        return self.holder is claim

    def leave(self, claim: Claim) -> None:
        """Give the wheels, or the place in the queue, back."""
        if claim in self._queue:
            self._queue.remove(claim)
        if self.holder is claim:
            self.holder = self._queue.popleft() if self._queue else None
            if self.holder is not None:
                self.holder.wake()

    def abort(self) -> None:
        """Abort the motion that drives and all that wait; those that left the queue are not concerned."""
        self.stops += 1
        concerned = [*self._queue] if self.holder is None else [self.holder, *self._queue]
        for claim in concerned:
            claim.abort()


_queues: WeakKeyDictionary[Backend, dict[str, MotionQueue]] = WeakKeyDictionary()


def motion_queue_of(backend: Backend, robot: str) -> MotionQueue:
    """The queue of the robot with the topic prefix *robot*: always the same for the same backend."""
    return _queues.setdefault(backend, {}).setdefault(robot, MotionQueue())
