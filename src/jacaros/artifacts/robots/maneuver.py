"""Maneuvers: the task of one motion operation, advanced pose by pose, without time or middleware.

A maneuver begins at a pose, returns a command for every later pose, and None at its end. It can rest (the robot
stands because its agent suspended it) and continue: on the same line if the robot was not moved in between, otherwise
from the robot's pose with the remaining distance or angle.
"""

import math
from typing import Protocol

from jacaros.artifacts.robots.control import (
    ANGLE_TOLERANCE,
    DISTANCE_TOLERANCE,
    STANDSTILL,
    Limits,
    Line,
    Pose,
    Velocity,
    distance,
    drive_command,
    hold_command,
    turn_command,
    unwrapped,
)

DISPLACED_DISTANCE = 0.02
"""Metres by which a resting robot must be moved to continue from its new position."""

DISPLACED_ANGLE = math.radians(2.0)
"""Radians by which a resting robot must be turned to continue from its new heading."""

PERIOD = 0.05
"""Seconds between two commands of a closed loop."""


class Maneuver(Protocol):
    """A task of the wheels.

    Attributes:
        period: seconds between two commands.
        needs_odometry: False for open-loop motions; their poses may be made up.
    """

    period: float
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

    def command(self, pose: Pose, before: Velocity, limits: Limits, period: float) -> Velocity | None:
        """Return the next command for *pose* after the command *before*; None at the end."""

    def hold(self, pose: Pose) -> Velocity:
        """Return the command that keeps the robot at the goal while it settles."""

    def rest(self, pose: Pose) -> None:
        """Store the pose of a robot that was suspended or stopped early; only after `begin`."""

    def go_on(self, pose: Pose) -> None:
        """Continue at *pose* after `rest`."""


class Straight:
    """Drive a signed length along *heading*, by default the robot's initial heading."""

    activity = "driving"
    period = PERIOD
    needs_odometry = True

    def __init__(self, length: float, heading: float | None = None) -> None:
        self._length = length
        self._heading = heading
        self._before = 0.0
        self._along = 0.0
        self._line = Line(Pose(0.0, 0.0, 0.0), length)
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
        heading = pose.heading if self._heading is None else self._heading
        self._line = Line(Pose(pose.x, pose.y, heading), self._length)

    def command(self, pose: Pose, before: Velocity, limits: Limits, period: float) -> Velocity | None:
        """Follow the line."""
        self._along = self._line.along(pose)
        if abs(self._line.remaining(pose)) <= DISTANCE_TOLERANCE:
            return None
        return drive_command(self._line, pose, before, limits, period)

    def hold(self, pose: Pose) -> Velocity:
        """Correct the last millimetres."""
        return hold_command(self._line.remaining(pose), unwrapped(self._line.start.heading - pose.heading))

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
    period = PERIOD
    needs_odometry = True

    def __init__(self, angle: float) -> None:
        self._angle = angle
        self._turned = 0.0
        self._heading = 0.0
        self._resting = Pose(0.0, 0.0, 0.0)

    @property
    def covered(self) -> float:
        """Degrees turned, positive in both directions."""
        return math.degrees(abs(self._turned))

    def seconds(self, limits: Limits) -> float:
        """Angle divided by turn speed, plus the ramps."""
        return abs(self._angle) / limits.turn_speed + 2.0 * limits.turn_speed / limits.turn_acceleration

    def progress(self, pose: Pose) -> float:
        """Remaining radians."""
        return abs(self._angle - self._turned - unwrapped(pose.heading - self._heading))

    def begin(self, pose: Pose) -> None:
        """Count the angle from the heading of *pose*."""
        self._heading = pose.heading
        self._turned = 0.0

    def command(self, pose: Pose, before: Velocity, limits: Limits, period: float) -> Velocity | None:
        """Continue turning, adding up the angle across the jump at 180 degrees."""
        self._count(pose)
        remaining = self._angle - self._turned
        if abs(remaining) <= ANGLE_TOLERANCE:
            return None
        return turn_command(remaining, before, limits, period)

    def hold(self, pose: Pose) -> Velocity:
        """Correct the last fractions of a degree."""
        self._count(pose)
        return hold_command(0.0, self._angle - self._turned)

    def _count(self, pose: Pose) -> None:
        self._turned += unwrapped(pose.heading - self._heading)
        self._heading = pose.heading

    def rest(self, pose: Pose) -> None:
        """Store the angle turned so far."""
        self._count(pose)
        self._resting = pose

    def go_on(self, pose: Pose) -> None:
        """Turn the rest; turns by others in between do not count."""
        if is_displaced(self._resting, pose):
            self._heading = pose.heading


class Timed:
    """Repeat one velocity a number of times, ten times a second: open-loop driving."""

    period = 0.1
    needs_odometry = False

    def __init__(self, velocity: Velocity, times: int) -> None:
        self._velocity = velocity
        self._times = times
        self._given = 0
        self._start = self._now = Pose(0.0, 0.0, 0.0)

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

    def command(self, pose: Pose, before: Velocity, limits: Limits, period: float) -> Velocity | None:
        """Return the same velocity until the number of commands is reached."""
        self._now = pose
        if self._given >= self._times:
            return None
        self._given += 1
        return limits.clip(self._velocity)

    def hold(self, pose: Pose) -> Velocity:
        """Stand still."""
        return STANDSTILL

    def rest(self, pose: Pose) -> None:
        """The remaining commands are given later."""
        self._now = pose

    def go_on(self, pose: Pose) -> None:
        """Nothing."""


def is_displaced(resting: Pose, pose: Pose) -> bool:
    """Return whether the robot was moved or turned while it rested."""
    turned = abs(unwrapped(pose.heading - resting.heading))
    return distance(resting, pose) > DISPLACED_DISTANCE or turned > DISPLACED_ANGLE
