"""The motions of a robot: who drives, who waits, and what ends or interrupts them.

The arbiter of resources decides which of them drives: all use ``wheels``.
"""

import asyncio
from collections.abc import Callable
from typing import Self
from weakref import WeakKeyDictionary

from jacaros.artifacts.env.arbiter import HOLDING
from jacaros.artifacts.env.values import Atom, Structure
from jacaros.robots.artifacts.drive_model import DriveModel
from jacaros.robots.kit.ros_artifact import RosArtifact
from jacaros.robots.ros.backend import Backend
from jacaros.robots.ros.guarded import guarded_by
from jacaros.runtime.clock import Clock

GAP = 0.5
"""Seconds by which a motion may be late, or the clock be set. More is a gap: the robot was not watched for longer
than a base waits for commands."""

GUARD_TRIPPED = Atom("guard_tripped")
"""Reason of the gap of a robot that a guard has stopped."""


class MotionClaim:
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
        models: what is known of the robot, for each artifact that drives it.
    """

    def __init__(self) -> None:
        self.stops = 0
        self.claims: dict[MotionClaim, None] = {}
        self.models: list[DriveModel] = []

    def watch(self, mover: RosArtifact, stand: Callable[[], None], halt: Callable[[], None]) -> None:
        """Stop the robot when the process ends or a guard trips, by *stand*, and when *mover* ends, by *halt*.

        *stand* may be called in a thread, so it only publishes.
        """
        mover.at_dispose(mover.ros.add_exit_hook(stand))
        mover.at_dispose(guarded_by(mover.ros).on_standstill(stand))
        mover.at_dispose(halt)

    def abort(self) -> None:
        """Abort the motion that drives and all that wait, except suspended ones.

        The robot stops immediately; the operations fail when they run next.
        """
        self.stops += 1
        for claim in list(self.claims):
            claim.aborted = True
            claim.stop()
            claim.wake()


class Aborted(Exception):
    """Raised in a motion that was aborted."""


class Driving(MotionClaim):
    """One motion of an operation: it waits for its turn, and stops whatever ends or interrupts it.

    A context manager: the motion begins when it is entered, and stops when it is left.

    Args:
        mover: the artifact of the operation.
        motions: the motions of the robot.
        use: what the motion needs.
        stop: stops the robot.
        show: shows ``waiting`` or ``paused`` to observers.
    """

    def __init__(
        self,
        mover: RosArtifact,
        motions: Motions,
        use: str,
        stop: Callable[[], None],
        show: Callable[[str], None] = lambda state: None,
    ) -> None:
        super().__init__(self.halt)
        self._mover, self._motions, self._stop, self._show = mover, motions, stop, show
        self._execution = mover.current
        self._holding = self._execution.hold((use,))
        self._claims_itself = not self._holding.entered
        self._hooks: list[Callable[[], None]] = []

    @property
    def paused(self) -> bool:
        """Whether the agent has suspended the motion, or another one drives."""
        return self._execution.paused

    def halt(self) -> None:
        """Stop the robot immediately if this motion drives; otherwise another one may be driving it."""
        if self._holding.claim.state in HOLDING:
            self._stop()

    def __enter__(self) -> Self:
        self._hooks = [
            self._execution.on_pause(self._on_pause),
            self._holding.watch(self.wake),
            guarded_by(self._mover.ros).on_interruption(lambda: self.interrupt(GUARD_TRIPPED)),
        ]
        return self

    def _on_pause(self) -> None:
        self.halt()
        self.wake()

    def __exit__(self, *_: object) -> None:
        for forget in self._hooks:
            forget()
        self.halt()
        self._motions.claims.pop(self, None)
        if self._claims_itself:
            self._holding.leave()

    async def ready(self) -> None:
        """Wait until this motion may drive. While it is suspended, `Motions.abort` does not end it."""
        execution, claims = self._execution, self._motions.claims
        self._holding.enter()
        claims[self] = None
        while execution.paused:
            suspended = execution.suspended
            if suspended:
                claims.pop(self, None)
            else:
                claims[self] = None
            self._show("paused" if suspended else "waiting")
            self._holding.rest()
            if execution.paused:
                await self.pass_time(None)
        claims[self] = None

    async def pass_time(self, seconds: float | None) -> None:
        """Wait until this motion is woken or the time is over.

        Raises:
            Aborted: the motion was aborted.
        """
        await self._mover.step(self.wait(self._mover.clock, seconds))
        if self.aborted:
            raise Aborted


_motions: WeakKeyDictionary[Backend, dict[str, Motions]] = WeakKeyDictionary()


def motions_of(backend: Backend, robot: str) -> Motions:
    """Return the motions of the robot with the topic prefix *robot*: the same object for the same backend."""
    return _motions.setdefault(backend, {}).setdefault(robot, Motions())
