"""Maneuvers: the task of one motion operation, advanced pose by pose, without time or middleware.

A maneuver begins at a pose, returns a command for every later pose, and None at its end. It can rest (the robot
stands because its agent suspended it) and continue: on the same line if the robot was not moved in between, otherwise
from the robot's pose with the remaining distance or angle.
"""

import math
from dataclasses import dataclass
from typing import ClassVar, Protocol

from jacaros.robots.artifacts.approach import ANGLE, DISTANCE, Approach, Outlook, TimedCommand, Tolerance
from jacaros.robots.artifacts.drive_model import STANDSTILL, Limits, Velocity
from jacaros.robots.plane.pose import ORIGIN, Pose, clamp, normalised

DISPLACED_DISTANCE = 0.02
"""Metres by which a resting robot must be moved to continue from its new position."""

DISPLACED_ANGLE = math.radians(2.0)
"""Radians by which a resting robot must be turned to continue from its new heading."""


@dataclass(frozen=True, slots=True)
class Line:
    """A straight line: from *start*, along its heading, *length* metres (negative: in reverse)."""

    start: Pose
    length: float

    def along(self, pose: Pose) -> float:
        """Return how many metres *pose* is ahead of the start."""
        return self.start.local(pose.x, pose.y)[0]

    def aside(self, pose: Pose) -> float:
        """Return how many metres *pose* is to the left of the line."""
        return self.start.local(pose.x, pose.y)[1]

    def remaining(self, pose: Pose) -> float:
        """Return the remaining distance from *pose*, in signed metres."""
        return self.length - self.along(pose)


def distance(a: Pose, b: Pose) -> float:
    """Return the Euclidean distance of two poses."""
    return math.hypot(b.x - a.x, b.y - a.y)


def bearing(origin: Pose, x: float, y: float) -> float:
    """Return the direction from *origin* to the point x, y."""
    return math.atan2(y - origin.y, x - origin.x)


def steer(line: Line, pose: Pose, speed: float, jitter: float, most: float) -> float:
    """Return the turn rate that leads back to *line*.

    The robot aims at the point of the line 0.4 m ahead (look-ahead). Close to the goal it only keeps its heading,
    because there is no distance left for returning to the line.

    Args:
        line: the line.
        pose: pose at which the command takes effect.
        speed: signed speed.
        jitter: seconds by which the command may come early or late.
        most: greatest turn rate of the robot.
    """
    pull = math.atan2(line.aside(pose), 0.4) if abs(line.remaining(pose)) > 0.05 else 0.0
    aim = line.start.yaw - math.copysign(1.0, speed) * pull
    gain = min(2.0, 0.4 / jitter) if jitter else 2.0
    return clamp(gain * normalised(aim - pose.yaw), 0.5 * most)


class Maneuver(Protocol):
    """A task of the wheels.

    Attributes:
        needs_odometry: False for open-loop motions; their poses may be made up.
        relative: whether the goal counts from where the motion began, not a point or heading of the frame.
    """

    needs_odometry: bool
    relative: bool

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

    def command(self, outlook: Outlook) -> TimedCommand | None:
        """Return the next command; None at the end."""

    def rest(self, pose: Pose) -> None:
        """Store the pose of a robot that was suspended or stopped early; only after `begin`."""

    def go_on(self, pose: Pose) -> None:
        """Continue at *pose* after `rest`."""


class Straight:
    """Drive a signed length along *heading*, by default the robot's initial heading."""

    activity = "driving"
    needs_odometry = relative = True

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

    def command(self, outlook: Outlook) -> TimedCommand | None:
        """Follow the line."""
        line, model = self._line, outlook.model
        self._along = line.along(outlook.pose)
        pulse = self._approach.speed(
            model.linear, outlook, line.remaining(outlook.pose), line.remaining(outlook.ahead)
        )
        if pulse is None or not pulse.speed:
            return None if pulse is None else TimedCommand(STANDSTILL)
        turn = steer(line, outlook.ahead, pulse.speed, model.jitter, outlook.limits.turn_speed)
        return TimedCommand(Velocity(pulse.speed, turn), pulse.seconds)

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
    needs_odometry = relative = True

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

    def command(self, outlook: Outlook) -> TimedCommand | None:
        """Continue turning."""
        self._now = outlook.pose.yaw
        pulse = self._approach.speed(
            outlook.model.angular, outlook, self._remaining(outlook.pose), self._remaining(outlook.ahead)
        )
        return None if pulse is None else TimedCommand(Velocity(0.0, pulse.speed), pulse.seconds)

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
    relative = True

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

    def command(self, outlook: Outlook) -> TimedCommand | None:
        """Return the same velocity until the number of commands is reached."""
        self._now = outlook.pose
        if self._given >= self._times:
            return None
        self._given += 1
        return TimedCommand(outlook.limits.clip(self._velocity), self.period)

    def rest(self, pose: Pose) -> None:
        """The remaining commands are given later."""
        self._now = pose

    def go_on(self, pose: Pose) -> None:
        """Nothing."""


def is_displaced(resting: Pose, pose: Pose) -> bool:
    """Return whether the robot was moved or turned while it rested."""
    turned = abs(normalised(pose.yaw - resting.yaw))
    return distance(resting, pose) > DISPLACED_DISTANCE or turned > DISPLACED_ANGLE


# Journeys: maneuvers towards points and headings of the odometry frame, composed of lines and turns.

ARRIVED = 0.015
"""Metres within which `DriveTo` is at its point."""

AIMED = math.radians(2.0)
"""Radians within which `DriveTo` corrects its heading while driving instead of turning first."""


AIMING = Tolerance(math.radians(1.0), math.radians(2.0))
"""How exactly `DriveTo` turns towards its point: it corrects the rest while driving."""


class TurnTo(Turn):
    """Turn the short way round to an absolute heading; after a rest, from the robot's present heading."""

    relative = False

    def __init__(self, heading: float) -> None:
        super().__init__(0.0)
        self._goal = heading
        self._before = 0.0

    @property
    def covered(self) -> float:
        """Degrees turned."""
        return self._before + super().covered

    def begin(self, pose: Pose) -> None:
        """Choose the shorter side."""
        self._angle, self._approach = normalised(self._goal - pose.yaw), Approach(ANGLE)
        super().begin(pose)

    def go_on(self, pose: Pose) -> None:
        """Begin again from the present heading."""
        self._before = self.covered
        self.begin(pose)


class DriveTo:
    """Turn towards a point and drive there; after a rest, from wherever the robot is."""

    needs_odometry = True
    relative = False

    def __init__(self, x: float, y: float) -> None:
        self._goal = Pose(x, y, 0.0)
        self._part: Straight | Turn | None = None
        self._driven = 0.0
        self._way = 0.0

    @property
    def activity(self) -> str:
        """``turning`` towards the point or ``driving`` to it."""
        return "driving" if self._part is None else self._part.activity

    @property
    def covered(self) -> float:
        """Metres driven."""
        return self._driven + (self._part.covered if isinstance(self._part, Straight) else 0.0)

    def seconds(self, limits: Limits) -> float:
        """Half a turn and the straight line."""
        return Straight(self._way).seconds(limits) + Turn(math.pi).seconds(limits)

    def progress(self, pose: Pose) -> float:
        """That of the present part; 0 between two parts."""
        return 0.0 if self._part is None else self._part.progress(pose)

    def begin(self, pose: Pose) -> None:
        """Measure the distance."""
        self._way = distance(pose, self._goal)

    def command(self, outlook: Outlook) -> TimedCommand | None:
        """Return the command of the present part; when a part ends, the next begins."""
        if self._part is None:
            return self._next_part(outlook)
        step = self._part.command(outlook)
        if step is None:
            self._finish_part()
            return None if distance(outlook.pose, self._goal) <= ARRIVED else TimedCommand(STANDSTILL)
        return step

    def _next_part(self, outlook: Outlook) -> TimedCommand | None:
        pose = outlook.pose
        way = distance(pose, self._goal)
        if way <= ARRIVED:
            return None
        aside = normalised(bearing(pose, self._goal.x, self._goal.y) - pose.yaw)
        # If the line would end within half a centimetre of the point, the robot counts as facing it.
        aimed = abs(aside) <= AIMED or abs(aside) * way <= 0.005
        self._part = Straight(way, pose.yaw + aside) if aimed else Turn(aside, AIMING)
        self._part.begin(pose)
        return self._part.command(outlook) or TimedCommand(STANDSTILL)

    def _finish_part(self) -> None:
        self._driven = self.covered
        self._part = None

    def rest(self, pose: Pose) -> None:
        """Forget the present part; the next one is chosen when the robot continues."""
        if self._part is not None:
            self._part.rest(pose)
            self._finish_part()

    def go_on(self, pose: Pose) -> None:
        """Do nothing: the next command starts from the robot's present pose."""


class Sequence:
    """Several maneuvers in turn; all have absolute goals, so they can be repeated after a rest."""

    needs_odometry = True
    relative = False

    def __init__(self, *parts: Maneuver) -> None:
        self._parts = parts
        self._index = 0

    @property
    def _part(self) -> Maneuver:
        return self._parts[self._index]

    @property
    def activity(self) -> str:
        """The activity of the present part."""
        return self._part.activity

    @property
    def covered(self) -> float:
        """That of the first part: the drive of a drive-and-turn."""
        return self._parts[0].covered

    def seconds(self, limits: Limits) -> float:
        """The sum of all parts."""
        return sum(part.seconds(limits) for part in self._parts)

    def progress(self, pose: Pose) -> float:
        """That of the present part."""
        return self._part.progress(pose)

    def begin(self, pose: Pose) -> None:
        """Begin the first part."""
        self._part.begin(pose)

    def command(self, outlook: Outlook) -> TimedCommand | None:
        """Return the command of the present part; None after the last."""
        step = self._part.command(outlook)
        if step is None and self._index + 1 < len(self._parts):
            self._index += 1
            self._part.begin(outlook.pose)
            return TimedCommand(STANDSTILL)
        return step

    def rest(self, pose: Pose) -> None:
        """Rest the present part."""
        self._part.rest(pose)

    def go_on(self, pose: Pose) -> None:
        """Begin with the first part again: a part that is already done ends immediately."""
        self._index = 0
        self._part.go_on(pose)


def go_to(x: float, y: float, heading: float) -> Maneuver:
    """Drive to a point, then turn to a heading."""
    return Sequence(DriveTo(x, y), TurnTo(heading))


LEAST_PROGRESS = 0.01
"""Metres or radians that count as progress."""


class ProgressChecker:
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
