"""One motion operation from its request to its end: the loop around a maneuver.

Every end publishes zero velocity: success, failure, drop, suspension, loss of odometry, disposal of the artifact.
"""

import math
from dataclasses import dataclass

from jacaros.artifacts.env.arbiter import WHEELS
from jacaros.artifacts.env.values import Atom, Structure
from jacaros.artifacts.kit.connection import Matching
from jacaros.artifacts.kit.ros_artifact import RosArtifact
from jacaros.artifacts.robots.approach import PERIOD, NotMoving, Outlook, Step, Unsettled
from jacaros.artifacts.robots.control import STANDSTILL, Limits, Velocity, distance
from jacaros.artifacts.robots.drive_model import DriveModel
from jacaros.artifacts.robots.maneuver import Maneuver
from jacaros.artifacts.robots.motion_claim import Aborted, Driving, Motions
from jacaros.artifacts.robots.odometry import NO_TRANSFORM, Odometer
from jacaros.plane.pose import Pose

STALE = 0.5
"""Seconds after which the newest odometry is too old to drive by; the robot stops until more arrives."""

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


class MotionFailed(Exception):
    """Raised when a motion ends early.

    Attributes:
        functor, argument: the failure reason, such as ``aborted(0.42)``.
    """

    def __init__(self, message: str, functor: str, argument: float | Atom | Structure) -> None:
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


class Wheels(RosArtifact):
    """The artifact that drives, as used by a motion."""

    motions: Motions
    matching: Matching
    odometer: Odometer
    model: DriveModel
    settings: MotionSettings

    def command(self, velocity: Velocity) -> None:
        """Publish a velocity command."""
        raise NotImplementedError

    def interrupted(self, why: Structure | Atom) -> None:
        """Signal that the robot was not watched for a while."""
        raise NotImplementedError

    def show(self, motion: "Motion", state: str | None) -> None:
        """Show the state of the motion to observers; None: it has ended."""
        raise NotImplementedError


class Motion:
    """Run one motion operation.

    Args:
        wheels: the artifact of the operation.
        maneuver: the task.
    """

    def __init__(self, wheels: Wheels, maneuver: Maneuver) -> None:
        self._wheels = wheels
        self._maneuver = maneuver
        self._driving = Driving(
            wheels,
            wheels.motions,
            WHEELS,
            lambda: wheels.command(STANDSTILL),
            lambda state: wheels.show(self, state),
        )
        self._begun = False
        self._due = 0.0
        self._active = 0.0
        self._blind_since: float | None = None
        self._frame = ""
        self._fresh = 0
        self._left_at: Pose | None = None
        self._watched = False
        self._progress = Progress()
        self._sought = (0.0, 0.0)

    def halt(self) -> None:
        """Command zero velocity immediately if this motion is driving."""
        self._driving.halt()

    async def run(self) -> None:
        """Drive the maneuver to its end.

        Raises:
            MotionFailed: ``aborted``, ``no_odometry``, ``no_transform``, ``blocked``, ``does_not_move``, ``late``,
                ``interrupted`` or ``timeout``.
        """
        try:
            with self._driving:
                await self._drive()
        except Aborted:
            if self._begun:
                self._maneuver.rest(self._pose())
            raise MotionFailed("the motion was aborted", "aborted", self._maneuver.covered) from None
        except Unsettled:
            raise self._unsettled() from None
        except NotMoving:
            raise self._stuck() from None
        finally:
            self._wheels.show(self, None)

    async def _drive(self) -> None:
        ended = False
        while not ended:
            await self._get_ready()
            if self._begun:
                self._maneuver.go_on(self._pose())
            else:
                self._maneuver.begin(self._pose())
            self._begun = True
            self._progress.reset()
            ended = await self._follow()

    async def _get_ready(self) -> None:
        """Claim the robot and wait until it stands: it may still roll from an earlier motion."""
        ready = False
        while not ready:
            await self._driving.ready()
            ready = await self._stand()

    async def _stand(self) -> bool:
        """Bring a robot that receives commands to a stop. Return False if the agent suspends the motion meanwhile."""
        braking = 0.0
        blind = not self._maneuver.needs_odometry
        pauses = self._wheels.matching.pauses(always=blind)
        self._due = self._wheels.clock.elapsed
        while not self._driving.paused:
            self._heed_gap()
            seen = blind or self._has_odometry()
            pause = next(pauses, None)
            if pause is None and seen and self._rests(braking):
                return True
            await self._command(Step(STANDSTILL, PERIOD if pause is None else pause), pause is None)
            braking += PERIOD if pause is None else pause
        return False

    def _rests(self, braking: float) -> bool:
        """Return whether the robot stands, or has braked for so long that its twist must be noise."""
        odometer = self._wheels.odometer
        return (
            odometer.newest is None
            or self._wheels.model.has_come_to_rest()
            or braking >= LONGEST_BRAKING + self._wheels.model.delay
        )

    async def _follow(self) -> bool:
        """Follow the maneuver. Return True at its end, False if the agent suspended it and the robot stands."""
        maneuver = self._maneuver
        blind = not maneuver.needs_odometry
        self._due = self._wheels.clock.elapsed
        while True:
            if self._driving.paused:
                if await self._brake():
                    maneuver.rest(self._pose())
                    return False
                continue
            self._heed_gap()
            if not blind and not self._has_odometry():
                await self._command(Step(STANDSTILL))
                continue
            step = maneuver.command(self._outlook())
            self._check(step)
            if step is None:
                return True
            await self._command(step)

    def _outlook(self) -> Outlook:
        wheels, now = self._wheels, self._wheels.clock.elapsed
        ahead, velocity = wheels.model.ahead(now)
        return Outlook(wheels.model, wheels.settings.limits, now, wheels.model.pose, ahead, velocity)

    async def _command(self, step: Step, periodic: bool = True) -> None:
        """Send one command and wait until the next is due."""
        self._wheels.show(self, self._maneuver.activity)
        self._wheels.command(step.velocity)
        await self._driving.wait(self._until_due(step.seconds) if periodic else step.seconds)
        self._active += step.seconds

    def _until_due(self, period: float) -> float:
        """Return the seconds until the next command, counted from the time at which this one was due.

        A late turn of the loop therefore does not extend an open-loop motion. A closed loop does not catch up.
        """
        now: float = self._wheels.clock.elapsed
        self._due += period
        if self._maneuver.needs_odometry:
            self._due = max(self._due, now)
        return max(0.0, self._due - now)

    async def _brake(self) -> bool:
        """Stop before another motion may drive: braking is part of the motion, and counts.

        Return False if the agent resumes the motion before the robot stands.
        """
        self._wheels.show(self, "paused")
        braking = 0.0
        while self._driving.paused:
            if self._rests(braking):
                return True
            self._wheels.command(STANDSTILL)
            await self._driving.wait(PERIOD)
            braking += PERIOD
        return False

    def _pose(self) -> Pose:
        return self._wheels.model.pose

    def _heed_gap(self) -> None:
        """After a gap, signal it, and continue only with new odometry; an open-loop motion fails.

        Raises:
            MotionFailed: ``interrupted``.
        """
        if self._sees():
            self._watched = True
        elif self._watched and not self._maneuver.needs_odometry:
            self._driving.claim.interrupt(self._silence())
        why, self._driving.claim.gap = self._driving.claim.gap, None
        if why is None:
            return
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
                self._driving.claim.gap = self._silence()
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

    def _check(self, step: Step | None) -> None:
        """Fail if the motion takes too long or makes no progress."""
        settings, maneuver = self._wheels.settings, self._maneuver
        allowed = settings.timeout or 30.0 + 4.0 * maneuver.seconds(settings.limits)
        if self._active >= allowed:
            raise MotionFailed(f"the motion took longer than {allowed:g} s", "timeout", allowed)
        model = self._wheels.model
        sought, self._sought = self._sought, (model.linear.lower, model.angular.lower)
        if step is None or step.velocity == STANDSTILL or self._sought != sought:
            self._progress.reset()
        elif self._progress.is_stuck(maneuver.progress(self._pose()), self._active, self._patience()):
            raise self._stuck()

    def _patience(self) -> float:
        """Return the seconds without progress that are too long; slow cruising and late robots need more."""
        limits = self._wheels.settings.limits
        return (
            max(STUCK, 4.0 * LEAST_PROGRESS / min(limits.speed, limits.turn_speed)) + self._wheels.model.delay
        )

    def _stuck(self) -> MotionFailed:
        """Return the failure of a robot that does not follow commands: it is blocked if it has followed them before."""
        model, driving = self._wheels.model, self._maneuver.activity == "driving"
        if model.has_rolled(driving):
            return MotionFailed(f"the robot is stuck ({model})", "blocked", self._maneuver.covered)
        if not self._wheels.matching.exists():
            return MotionFailed("no base receives the commands", "does_not_move", Atom("unmatched"))
        return MotionFailed(
            f"odometry shows no reaction to commands ({model})", "does_not_move", Atom("no_reaction")
        )

    def _unsettled(self) -> MotionFailed:
        """Return the failure of a robot that cannot be placed within the tolerance."""
        model = self._wheels.model
        text = f"the robot cannot be placed exactly enough ({model})"
        if model.is_late:
            return MotionFailed(text, "late", round(model.delay, 3))
        return MotionFailed(text, "does_not_move", Atom("dead_band"))


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
