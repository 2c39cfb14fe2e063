"""Maneuvers: the task of one motion operation, advanced pose by pose, without time or middleware.

A maneuver begins at a pose, returns a command for every later pose, and None at its end. It can rest (the robot
stands because its agent suspended it) and continue: on the same line if the robot was not moved in between, otherwise
from the robot's pose with the remaining distance or angle.
"""

import math
from typing import ClassVar, Protocol

from jacaros.artifacts.robots.approach import ANGLE, DISTANCE, Approach, Outlook, Step, Tolerance
from jacaros.artifacts.robots.control import STANDSTILL, Limits, Line, Velocity, distance, steer
from jacaros.plane.pose import ORIGIN, Pose, normalised

DISPLACED_DISTANCE = 0.02
"""Metres by which a resting robot must be moved to continue from its new position."""

DISPLACED_ANGLE = math.radians(2.0)
"""Radians by which a resting robot must be turned to continue from its new heading."""


class Maneuver(Protocol):
    """A task of the wheels.

    Attributes:
        needs_odometry: False for open-loop motions; their poses may be made up.
    """

    needs_odometry: bool

    @property
    def activity(self) -> str:
        """``driving`` or ``turning``: the present activity."""

    @property
    def covered(self) -> float:
        """How much is done: metres for drives, degrees for turns."""

    def seconds(self, limits: Limits) -> float:
        """Return how many seconds it takes without obstacles; known after `begin`."""

    def progress(self, pose: Pose) -> float:
        """Return a number that decreases as the maneuver makes progress: remaining metres or radians."""

    def begin(self, pose: Pose) -> None:
        """Start at *pose*."""

    def command(self, outlook: Outlook) -> Step | None:
        """Return the next command; None at the end."""

    def rest(self, pose: Pose) -> None:
        """Store the pose of a robot that was suspended or stopped early; only after `begin`."""

    def go_on(self, pose: Pose) -> None:
        """Continue at *pose* after `rest`."""


class Straight:
    """Drive a signed length along *heading*, by default the robot's initial heading."""

    activity = "driving"
    needs_odometry = True

    def __init__(self, length: float, heading: float | None = None) -> None:
        self._length = length
        self._heading = heading
        self._approach = Approach(DISTANCE)
        self._before = 0.0
        self._along = 0.0
        self._line = Line(ORIGIN, length)
        self._resting = self._line.start

    @property
    def covered(self) -> float:
        """Metres driven along the line, also positive in reverse."""
        return abs(self._before + self._along)

    def seconds(self, limits: Limits) -> float:
        """Length divided by speed, plus the ramps."""
        return abs(self._length) / limits.speed + 2.0 * limits.speed / limits.acceleration

    def progress(self, pose: Pose) -> float:
        """Remaining metres."""
        return abs(self._line.remaining(pose))

    def begin(self, pose: Pose) -> None:
        """Lay the line through *pose*."""
        heading = pose.yaw if self._heading is None else self._heading
        self._line = Line(Pose(pose.x, pose.y, heading), self._length)

    def command(self, outlook: Outlook) -> Step | None:
        """Follow the line."""
        line, model = self._line, outlook.model
        self._along = line.along(outlook.pose)
        pulse = self._approach.speed(
            model.linear,
            outlook,
            line.remaining(outlook.pose),
            line.remaining(outlook.ahead),
        )
        if pulse is None or not pulse.speed:
            return None if pulse is None else Step(STANDSTILL)
        turn = steer(line, outlook.ahead, pulse.speed, model.jitter, outlook.limits.turn_speed)
        return Step(Velocity(pulse.speed, turn), pulse.seconds)

    def rest(self, pose: Pose) -> None:
        """Store the rest of the line."""
        self._resting = pose
        self._along = self._line.along(pose)

    def go_on(self, pose: Pose) -> None:
        """Keep the line, or lay the rest of it through *pose* if the robot was moved meanwhile."""
        if is_displaced(self._resting, pose):
            self._before += self._along
            self._line = Line(pose, self._length - self._before)
            self._along = 0.0


class Turn:
    """Turn on the spot by a signed angle; more than a full turn is possible."""

    activity = "turning"
    needs_odometry = True

    def __init__(self, angle: float, tolerance: Tolerance = ANGLE) -> None:
        self._angle = angle
        self._approach = Approach(tolerance)
        self._heading = self._now = 0.0
        self._resting = ORIGIN

    @property
    def covered(self) -> float:
        """Degrees turned, positive in both directions."""
        return math.degrees(abs(self._now - self._heading))

    def seconds(self, limits: Limits) -> float:
        """Angle divided by turn speed, plus the ramps."""
        return abs(self._angle) / limits.turn_speed + 2.0 * limits.turn_speed / limits.turn_acceleration

    def progress(self, pose: Pose) -> float:
        """Remaining radians."""
        return abs(self._remaining(pose))

    def _remaining(self, pose: Pose) -> float:
        # Headings of a model count full turns.
        return self._heading + self._angle - pose.yaw

    def begin(self, pose: Pose) -> None:
        """Count the angle from the heading of *pose*."""
        self._heading = self._now = pose.yaw

    def command(self, outlook: Outlook) -> Step | None:
        """Continue turning."""
        self._now = outlook.pose.yaw
        pulse = self._approach.speed(
            outlook.model.angular,
            outlook,
            self._remaining(outlook.pose),
            self._remaining(outlook.ahead),
        )
        return None if pulse is None else Step(Velocity(0.0, pulse.speed), pulse.seconds)

    def rest(self, pose: Pose) -> None:
        """Store the angle turned so far."""
        self._now, self._resting = pose.yaw, pose

    def go_on(self, pose: Pose) -> None:
        """Turn the rest; turns by others in between do not count."""
        if is_displaced(self._resting, pose):
            self._heading += pose.yaw - self._resting.yaw


class Timed:
    """Repeat one velocity a number of times, ten times a second: open-loop driving."""

    period: ClassVar = 0.1
    needs_odometry = False

    def __init__(self, velocity: Velocity, times: int) -> None:
        self._velocity = velocity
        self._times = times
        self._given = 0
        self._start = self._now = ORIGIN

    @property
    def activity(self) -> str:
        """``driving`` or ``turning``."""
        return "driving" if self._velocity.linear else "turning"

    @property
    def covered(self) -> float:
        """Metres from the start, as far as odometry shows."""
        return distance(self._start, self._now)

    def seconds(self, limits: Limits) -> float:
        """A tenth of a second per command."""
        return self._times * self.period

    def progress(self, pose: Pose) -> float:
        """The number of remaining commands: time always makes progress."""
        return float(self._times - self._given)

    def begin(self, pose: Pose) -> None:
        """Store the start."""
        self._start = self._now = pose

    def command(self, outlook: Outlook) -> Step | None:
        """Return the same velocity until the number of commands is reached."""
        self._now = outlook.pose
        if self._given >= self._times:
            return None
        self._given += 1
        return Step(outlook.limits.clip(self._velocity), self.period)

    def rest(self, pose: Pose) -> None:
        """The remaining commands are given later."""
        self._now = pose

    def go_on(self, pose: Pose) -> None:
        """Nothing."""


def is_displaced(resting: Pose, pose: Pose) -> bool:
    """Return whether the robot was moved or turned while it rested."""
    turned = abs(normalised(pose.yaw - resting.yaw))
    return distance(resting, pose) > DISPLACED_DISTANCE or turned > DISPLACED_ANGLE
