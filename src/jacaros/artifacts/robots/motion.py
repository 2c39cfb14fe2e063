"""One motion operation from its request to its end: the loop around a maneuver.

Every end publishes zero velocity: success, failure, drop, suspension, loss of odometry, disposal of the artifact.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol

from jacaros.artifacts.kit.connection import Matching
from jacaros.artifacts.robots.control import STANDSTILL, Limits, Pose, Velocity, distance
from jacaros.artifacts.robots.maneuver import Maneuver
from jacaros.artifacts.robots.motion_claim import GUARD_TRIPPED, Claim, Motions
from jacaros.artifacts.robots.odometry import NO_TRANSFORM, Odometer
from jacaros.env.resources.resource import WHEELS, Use
from jacaros.env.values import Atom, Structure

STALE = 0.5
"""Seconds after which the newest odometry is too old to drive by; the robot stops until more arrives."""

SETTLED = 3
"""Number of consecutive odometry messages at the goal that end a motion."""

STUCK = 2.0
"""Seconds without progress after which a commanded motion is blocked."""

LEAST_PROGRESS = 0.01
"""Metres or radians that count as progress."""

FRESH = 2
"""Odometry messages that must arrive after a gap before a motion continues: the first one may predate it."""

LEAP = 1.0
"""Metres that odometry may move during a gap. More means that it was reset, so its coordinates have changed their
meaning."""

LONGEST_BRAKING = 3.0
"""Seconds after which a braking robot counts as standing: its twist may only be noise."""

UNKNOWN_POSE = Pose(0.0, 0.0, 0.0)


class MotionFailed(Exception):
    """Raised when a motion ends early.

    Attributes:
        functor, argument: the failure reason, such as ``aborted(0.42)``.
    """

    def __init__(self, message: str, functor: str, argument: float) -> None:
        super().__init__(message)
        self.functor, self.argument = functor, argument


@dataclass(frozen=True, slots=True)
class MotionSettings:
    """How a robot is driven.

    Attributes:
        limits: cruise speeds and accelerations of closed loops.
        odometry_timeout: seconds without odometry until a motion fails.
        timeout: seconds of driving until a motion fails; None: four times the time needed plus 30 s.
    """

    limits: Limits
    odometry_timeout: float
    timeout: float | None


class Wheels(Protocol):
    """The artifact that drives, as used by a motion."""

    clock: Any
    motions: Motions
    matching: Matching
    odometer: Odometer
    settings: MotionSettings

    @property
    def current(self) -> Any:
        """The running operation."""

    def command(self, velocity: Velocity) -> None:
        """Publish a velocity command."""

    def on_interruption(self, callback: Callable[[], None]) -> Callable[[], None]:
        """Call *callback* when a guard has stopped the robot. Return a function that removes it."""

    def interrupted(self, why: Structure | Atom) -> None:
        """Signal that the robot was not watched for a while."""

    def show(self, motion: "Motion", state: str | None) -> None:
        """Show the state of the motion to observers; None: it has ended."""

    async def step(self, awaitable: Any) -> Any:
        """Release the artifact while waiting."""


class Motion:
    """Run one motion operation.

    Args:
        wheels: the artifact of the operation.
        maneuver: the task.
    """

    def __init__(self, wheels: Wheels, maneuver: Maneuver) -> None:
        self._wheels = wheels
        self._maneuver = maneuver
        self._execution = wheels.current
        self._holding = self._execution.hold((Use(WHEELS),))
        self._claims_itself = not self._holding.entered
        self._claim = Claim(self.halt)
        self._before = STANDSTILL
        self._begun = False
        self._due = 0.0
        self._active = 0.0
        self._blind_since: float | None = None
        self._frame = ""
        self._fresh = 0
        self._left_at: Pose | None = None
        self._watched = False
        self._progress = Progress()

    def halt(self) -> None:
        """Command zero velocity immediately if this motion is driving."""
        self._before = STANDSTILL
        if self._holding.holds:
            self._wheels.command(STANDSTILL)

    def end(self) -> None:
        """Stop, and let the next motion drive; calling it again has no effect."""
        self.halt()
        self._wheels.motions.claims.pop(self._claim, None)
        if self._claims_itself:
            self._holding.leave()
        self._wheels.show(self, None)

    async def run(self) -> None:
        """Drive the maneuver to its end.

        Raises:
            MotionFailed: ``aborted``, ``no_odometry``, ``no_transform``, ``blocked``, ``interrupted`` or ``timeout``.
        """
        forget = self._execution.on_pause(self._on_pause)
        unwatch = self._holding.watch(self._claim.wake)
        ignore = self._wheels.on_interruption(lambda: self._claim.interrupt(GUARD_TRIPPED))
        try:
            await self._claim_wheels()
            await self._drive()
        finally:
            forget()
            unwatch()
            ignore()
            self.end()

    def _on_pause(self) -> None:
        self.halt()
        self._claim.wake()

    async def _drive(self) -> None:
        ended = False
        while not ended:
            await self._get_ready()
            if self._begun:
                self._maneuver.go_on(self._pose())
            else:
                self._maneuver.begin(self._pose())
            self._begun = True
            self._before = STANDSTILL
            self._progress.reset()
            ended = await self._follow()

    async def _get_ready(self) -> None:
        """Claim the robot and wait until it stands: it may still roll from an earlier motion."""
        ready = False
        while not ready:
            await self._claim_wheels()
            ready = await self._stand()

    async def _claim_wheels(self) -> None:
        """Claim the wheels. A motion that is suspended meanwhile is not ended by `Motions.abort`."""
        execution, claims = self._execution, self._wheels.motions.claims
        self._holding.enter()
        claims[self._claim] = None
        while execution.paused:
            suspended = execution.suspended
            if suspended:
                claims.pop(self._claim, None)
            else:
                claims[self._claim] = None
            self._wheels.show(self, "paused" if suspended else "waiting")
            self._holding.rest()
            if execution.paused:
                await self._wait(None)
        claims[self._claim] = None

    async def _stand(self) -> bool:
        """Bring a robot that receives commands to a stop. Return False if the agent suspends the motion meanwhile."""
        braking = 0.0
        blind = not self._maneuver.needs_odometry
        pauses = self._wheels.matching.pauses(always=blind)
        self._due = self._wheels.clock.elapsed
        while not self._execution.paused:
            self._heed_gap()
            seen = blind or self._has_odometry()
            pause = next(pauses, None)
            if pause is None and seen and (self._stands() or braking >= LONGEST_BRAKING):
                return True
            await self._command(STANDSTILL, pause)
            braking += self._maneuver.period if pause is None else pause
        return False

    async def _follow(self) -> bool:
        """Follow the maneuver. Return True at its end, False if the agent suspended it and the robot stands."""
        maneuver, odometer = self._maneuver, self._wheels.odometer
        blind = not maneuver.needs_odometry
        settled = 0
        self._due = self._wheels.clock.elapsed
        while settled < SETTLED:
            if self._execution.paused:
                if await self._brake():
                    maneuver.rest(self._pose())
                    return False
                continue
            self._heed_gap()
            seen = odometer.count
            if not blind and not self._has_odometry():
                await self._command(STANDSTILL)
                continue
            command = maneuver.command(
                self._pose(), self._before, self._wheels.settings.limits, maneuver.period
            )
            self._check(command)
            if blind and command is None:
                return True
            await self._command(command or maneuver.hold(self._pose()))
            if command is not None:
                settled = 0
            elif odometer.count > seen:
                settled += 1
        return True

    async def _command(self, velocity: Velocity, seconds: float | None = None) -> None:
        """Send one command and wait until the next is due; None: the period of the maneuver."""
        period = self._maneuver.period if seconds is None else seconds
        self._wheels.show(self, self._maneuver.activity)
        self._wheels.command(velocity)
        self._before = velocity
        await self._wait(self._until_due(period) if seconds is None else seconds)
        self._active += period

    def _until_due(self, period: float) -> float:
        """Return the seconds until the next command, counted from the time at which this one was due.

        A late turn of the loop therefore does not extend an open-loop motion. A closed loop does not catch up.
        """
        now: float = self._wheels.clock.elapsed
        self._due += period
        if self._maneuver.needs_odometry:
            self._due = max(self._due, now)
        return max(0.0, self._due - now)

    async def _wait(self, seconds: float | None) -> None:
        await self._wheels.step(self._claim.wait(self._wheels.clock, seconds))
        if self._claim.aborted:
            if self._begun:
                self._maneuver.rest(self._pose())
            raise MotionFailed("the motion was aborted", "aborted", self._maneuver.covered)

    async def _brake(self) -> bool:
        """Stop before another motion may drive: braking is part of the motion, and counts.

        Return False if the agent resumes the motion before the robot stands.
        """
        self._wheels.show(self, "paused")
        odometer = self._wheels.odometer
        seen, braking = odometer.count, 0.0
        while self._execution.paused:
            # The newest message may predate the command that moved the robot.
            if (self._stands() and odometer.count >= seen + 2) or braking >= LONGEST_BRAKING:
                return True
            self._wheels.command(STANDSTILL)
            await self._wait(self._maneuver.period)
            braking += self._maneuver.period
        return False

    def _pose(self) -> Pose:
        newest = self._wheels.odometer.newest
        return UNKNOWN_POSE if newest is None else newest.pose

    def _stands(self) -> bool:
        newest = self._wheels.odometer.newest
        return newest is None or newest.standing

    def _heed_gap(self) -> None:
        """After a gap, signal it, and continue only with new odometry; an open-loop motion fails.

        Raises:
            MotionFailed: ``interrupted``.
        """
        if self._sees():
            self._watched = True
        elif self._watched and not self._maneuver.needs_odometry:
            self._claim.interrupt(self._silence())
        why, self._claim.gap = self._claim.gap, None
        if why is None:
            return
        self._before = STANDSTILL
        self._progress.reset()
        self._wheels.interrupted(why)
        self._left_at = self._pose() if self._begun else None
        self._fresh = self._wheels.odometer.count + FRESH
        if self._begun and not self._maneuver.needs_odometry:
            raise MotionFailed(
                f"the open-loop motion was interrupted ({why})",
                "interrupted",
                self._maneuver.covered,
            )

    def _silence(self) -> Structure:
        age = self._wheels.odometer.age(self._wheels.clock.now())
        return Structure("no_odometry", (round(age or 0.0, 3),))

    def _sees(self) -> bool:
        """Return whether the newest odometry is current."""
        age = self._wheels.odometer.age(self._wheels.clock.now())
        # If the clock was set back, the newest odometry is from the future and equally out of date.
        return age is not None and abs(age) <= STALE

    def _has_odometry(self) -> bool:
        """Return whether there is odometry to drive by. Fail if it was missing for too long."""
        odometer = self._wheels.odometer
        if odometer.trusted and odometer.count >= self._fresh and self._sees():
            self._stay_in(odometer.frame)
            self._check_leap()
            self._blind_since = None
            return True
        if self._blind_since is None:
            self._blind_since = self._active
            if self._begun and odometer.trusted and odometer.count >= self._fresh:
                self._claim.gap = self._silence()
        limit = self._wheels.settings.odometry_timeout
        if self._active - self._blind_since >= limit:
            raise MotionFailed(f"{_lack(odometer)} for {limit:g} s", odometer.lacking, limit)
        return False

    def _check_leap(self) -> None:
        """Fail if odometry was reset during a gap: the robot was restarted, so the goal's position is unknown."""
        left_at, self._left_at = self._left_at, None
        if left_at is not None and distance(left_at, self._pose()) > LEAP:
            raise MotionFailed("odometry was reset", "interrupted", self._maneuver.covered)

    def _stay_in(self, frame: str) -> None:
        """Fail if poses arrive in another frame than at the beginning: the goal is a point in the first one."""
        self._frame = self._frame or frame
        if frame != self._frame:
            since = self._active if self._blind_since is None else self._blind_since
            text = f"odometry changed its frame from {self._frame} to {frame}"
            raise MotionFailed(text, "no_odometry", round(self._active - since, 1))

    def _check(self, command: Velocity | None) -> None:
        """Fail if the motion takes too long or makes no progress."""
        settings, maneuver = self._wheels.settings, self._maneuver
        allowed = settings.timeout or 30.0 + 4.0 * maneuver.seconds(settings.limits)
        if self._active >= allowed:
            raise MotionFailed(f"the motion took longer than {allowed:g} s", "timeout", allowed)
        if command is None or command == STANDSTILL:
            self._progress.reset()
        elif self._progress.is_stuck(maneuver.progress(self._pose()), self._active, self._patience()):
            raise MotionFailed("the robot is stuck", "blocked", maneuver.covered)

    def _patience(self) -> float:
        """Return the seconds without progress that are too long; slow cruising needs more."""
        limits = self._wheels.settings.limits
        return max(STUCK, 4.0 * LEAST_PROGRESS / min(limits.speed, limits.turn_speed))


def _lack(odometer: Odometer) -> str:
    if odometer.lacking == NO_TRANSFORM:
        return "no transform from the frame of odometry to the driving frame; is the robot localised?"
    bad = f" ({odometer.faults} messages were bad)" if odometer.faults else ""
    return f"no odometry{bad}"


class Progress:
    """Detects a motion that makes no progress."""

    def __init__(self) -> None:
        self.reset()

    def reset(self) -> None:
        """Reset: the robot is not supposed to move, or has a new goal."""
        self._least = math.inf
        self._since = 0.0

    def is_stuck(self, remaining: float, now: float, patience: float) -> bool:
        """Record the remaining distance at *now* (seconds of driving). Return True if it decreased too little for too
        long."""
        if remaining < self._least - LEAST_PROGRESS:
            self._least, self._since = remaining, now
        return now - self._since >= patience
