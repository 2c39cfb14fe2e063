"""The approach to a goal along one degree of freedom: drive by the predicted pose, stand, check, and correct.

A robot is driven by where it will be when the next command takes effect (`DriveModel.ahead`), along a trapezoidal profile
that ends at the goal. There it stands until odometry shows it at rest, and the pose is checked. What is missing is driven
again, by shorter and shorter steps. So a late robot does not swing: no command answers a pose that an earlier command is
about to change.
"""

import math
from dataclasses import dataclass

from jacaros.robots.artifacts.drive_model import HELD, Axis, DriveModel, Limits, Velocity
from jacaros.robots.plane.pose import Pose

BRAKING_SHARE = 0.6
"""Fraction of the robot's acceleration used for slowing down; the rest is a reserve for disturbances."""

PERIOD = 0.05
"""Seconds between two commands of a closed loop."""

SHORTEST = 0.02
"""Seconds of the shortest pulse."""

LONGEST = 4.0
"""Factor by which a pulse is extended at most."""

CORRECTIONS = 4
"""Corrections after which the tolerance becomes what the robot can do; after `MOST` of them the motion fails."""

MOST = 15

IDLE = 5
"""Drives in a row that did not move the robot, at a speed that should."""

AVERAGED = 2.0
"""Seconds that a noisy pose is averaged at most before it is checked."""


@dataclass(frozen=True, slots=True)
class TimedCommand:
    """A command and the seconds for which it holds."""

    velocity: Velocity
    seconds: float = PERIOD


@dataclass(frozen=True, slots=True)
class Pulse:
    """A speed and the seconds for which it holds."""

    speed: float
    seconds: float = PERIOD


STAND = Pulse(0.0)


@dataclass(frozen=True, slots=True)
class Tolerance:
    """When a goal is reached.

    Attributes:
        usual: metres or radians.
        most: the same for a robot that cannot be placed so finely, because its wheels only roll fast, or its
            messages are late irregularly.
    """

    usual: float
    most: float


DISTANCE = Tolerance(0.005, 0.02)
ANGLE = Tolerance(math.radians(0.3), math.radians(1.5))


class Unsettled(Exception):
    """Raised when a robot cannot be placed within the tolerance."""


class NotMoving(Exception):
    """Raised when a robot does not move though its commands are fast enough."""


@dataclass(frozen=True, slots=True)
class Outlook:
    """What a maneuver decides by.

    Attributes:
        model: the robot.
        limits: cruise speeds.
        now: the present time.
        pose: the newest pose.
        ahead, velocity: pose and velocity at the moment at which the next command takes effect.
    """

    model: DriveModel
    limits: Limits
    now: float
    pose: Pose
    ahead: Pose
    velocity: Velocity


class Approach:
    """Reduce a remaining distance or angle to zero.

    Args:
        tolerance: when the goal is reached.
    """

    def __init__(self, tolerance: Tolerance) -> None:
        self._tolerance = tolerance
        self._corrections = 0
        self._towards = self._from = self._fastest = 0.0
        self._held = self._before = 0.0
        self._pulse = 1.0
        self._idle = 0
        self._rests_since: float | None = None

    def speed(self, axis: Axis, outlook: Outlook, rest: float, ahead: float) -> Pulse | None:
        """Return the next signed speed and its seconds; None at the goal.

        Args:
            axis: the degree of freedom.
            outlook: the robot.
            rest: signed remaining distance or angle at the newest pose.
            ahead: the same at the predicted pose.

        Raises:
            Unsettled: the robot cannot be placed within the tolerance.
            NotMoving: the robot does not move.
        """
        if not self._towards:
            at_rest = self._check(axis, outlook, rest)
            if at_rest is None or not self._towards:
                return at_rest
        speed = outlook.velocity.linear if axis is outlook.model.linear else outlook.velocity.angular
        return self._drive(axis, outlook.model, ahead * self._towards, speed * self._towards)

    def _check(self, axis: Axis, outlook: Outlook, rest: float) -> Pulse | None:
        """Stand; at rest, end or choose the direction of the next drive."""
        model, now = outlook.model, outlook.now
        if not model.has_come_to_rest():
            self._rests_since = None
            return STAND
        self._rests_since = now if self._rests_since is None else self._rests_since
        uncertain = model.uncertainty.linear if axis is model.linear else model.uncertainty.angular
        if uncertain > self._tolerance.usual and now - self._rests_since < AVERAGED:
            return STAND
        self._learn(axis, rest, uncertain)
        if abs(rest) <= self._allowed(axis, model) + uncertain:
            return None
        self._corrections += 1
        if self._corrections > MOST:
            raise Unsettled
        self._towards, self._from = math.copysign(1.0, rest), rest
        self._held = self._before = 0.0
        self._rests_since = None
        return STAND

    def _allowed(self, axis: Axis, model: DriveModel) -> float:
        """Return the tolerance; after some corrections, what this robot can do."""
        if self._corrections <= CORRECTIONS:
            return self._tolerance.usual / (4.0, 4.0, 2.0, 1.0, 1.0)[self._corrections]
        finest = axis.least * (SHORTEST + model.jitter)
        return max(self._tolerance.usual, min(self._tolerance.most, finest))

    def _learn(self, axis: Axis, rest: float, uncertain: float) -> None:
        """Compare how far the robot came with what was expected."""
        fastest, self._fastest = self._fastest, 0.0
        if not fastest or abs(self._from) < 3.0 * uncertain:
            return
        share = (self._from - rest) / self._from
        if share < 0.2:
            self._note_idle(axis, fastest)
            return
        self._idle = 0
        if fastest <= 1.01 * axis.least:
            self._pulse = max(0.3, min(LONGEST, self._pulse / math.sqrt(min(4.0, share))))

    def _note_idle(self, axis: Axis, fastest: float) -> None:
        """Try a longer pulse, or a faster one, after a drive that hardly moved the robot."""
        if self._held < HELD and self._pulse < LONGEST:
            self._pulse = min(LONGEST, 2.0 * self._pulse)
        elif axis.did_not_roll(fastest):
            self._pulse = 1.0
        else:
            self._idle += 1
        if self._idle > IDLE:
            raise NotMoving

    def _drive(self, axis: Axis, model: DriveModel, rest: float, speed: float) -> Pulse:
        """Return the next speed of a trapezoidal profile that ends at the goal, *rest* ahead."""
        braking = BRAKING_SHARE * axis.acceleration
        lead = braking * max(PERIOD, model.jitter)
        profile = math.sqrt(lead * lead + 2.0 * braking * max(0.0, rest)) - lead
        wanted = min(axis.cruise, profile, max(speed, self._before) + axis.declared * PERIOD)
        seconds, least = PERIOD, axis.least
        if wanted < least:
            # Slower wheels would not roll: the rest is one short pulse.
            pulse = self._pulse * pulse_for(rest, max(speed, 0.0), least, axis.acceleration)
            wanted, seconds = least, min(PERIOD, pulse)
        towards = self._towards
        if seconds < PERIOD:
            self._towards = 0.0
            if seconds < SHORTEST / 2.0:
                return STAND
        self._fastest, self._before = max(self._fastest, wanted), wanted
        self._held += seconds
        return Pulse(towards * wanted, max(SHORTEST, seconds))


def pulse_for(rest: float, speed: float, least: float, acceleration: float) -> float:
    """Return the seconds of a command *least* after which a robot with this *speed* rolls to *rest* and stands there."""
    left = rest - speed * speed / (2.0 * acceleration)
    if left <= 0.0 or speed >= least:
        return left / least
    seconds = (math.sqrt(speed * speed + acceleration * left) - speed) / acceleration
    ramp = (least - speed) / acceleration
    if seconds <= ramp:
        return seconds
    return ramp + (left - (2.0 * speed + acceleration * ramp) * ramp) / least
