"""Journeys: maneuvers towards points and headings of the odometry frame, composed of lines and turns.

Their goals are absolute, so after a rest they continue from wherever the robot is.
"""

import math

from jacaros.artifacts.robots.approach import Outlook, Step, Tolerance
from jacaros.artifacts.robots.control import STANDSTILL, Limits, bearing, distance
from jacaros.artifacts.robots.maneuver import Maneuver, Straight, Turn
from jacaros.plane.pose import Pose, normalised

ARRIVED = 0.015
"""Metres within which `DriveTo` is at its point."""

AIMED = math.radians(2.0)
"""Radians within which `DriveTo` corrects its heading while driving instead of turning first."""


AIMING = Tolerance(math.radians(1.0), math.radians(2.0))
"""How exactly `DriveTo` turns towards its point: it corrects the rest while driving."""


class TurnTo:
    """Turn the short way round to an absolute heading; after a rest, from the robot's present heading."""

    activity = "turning"
    needs_odometry = True

    def __init__(self, heading: float) -> None:
        self._goal = heading
        self._turn = Turn(0.0)
        self._before = 0.0

    @property
    def covered(self) -> float:
        """Degrees turned."""
        return self._before + self._turn.covered

    def seconds(self, limits: Limits) -> float:
        """As `Turn`."""
        return self._turn.seconds(limits)

    def progress(self, pose: Pose) -> float:
        """Radians still to turn."""
        return self._turn.progress(pose)

    def begin(self, pose: Pose) -> None:
        """Choose the shorter side."""
        self._turn = Turn(normalised(self._goal - pose.yaw))
        self._turn.begin(pose)

    def command(self, outlook: Outlook) -> Step | None:
        """As `Turn`."""
        return self._turn.command(outlook)

    def rest(self, pose: Pose) -> None:
        """Note the angle turned so far."""
        self._turn.rest(pose)
        self._before += self._turn.covered

    def go_on(self, pose: Pose) -> None:
        """Begin again from the present heading."""
        self.begin(pose)


class DriveTo:
    """Turn towards a point and drive there; after a rest, from wherever the robot is."""

    needs_odometry = True

    def __init__(self, x: float, y: float) -> None:
        self._goal = Pose(x, y, 0.0)
        self._part: Straight | Turn | None = None
        self._driven = 0.0
        self._nominal = 0.0
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

    def command(self, outlook: Outlook) -> Step | None:
        """Return the command of the present part; when a part ends, the next begins."""
        if self._part is None:
            return self._next_part(outlook)
        step = self._part.command(outlook)
        if step is None:
            self._finish_part()
            return None if distance(outlook.pose, self._goal) <= ARRIVED else Step(STANDSTILL)
        return step

    def _next_part(self, outlook: Outlook) -> Step | None:
        pose = outlook.pose
        way = distance(pose, self._goal)
        if way <= ARRIVED:
            return None
        aside = normalised(bearing(pose, self._goal.x, self._goal.y) - pose.yaw)
        # If the line would end within half a centimetre of the point, the robot counts as facing it.
        aimed = abs(aside) <= AIMED or abs(aside) * way <= 0.005
        self._part = Straight(way, pose.yaw + aside) if aimed else Turn(aside, AIMING)
        self._part.begin(pose)
        return self._part.command(outlook) or Step(STANDSTILL)

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

    def command(self, outlook: Outlook) -> Step | None:
        """Return the command of the present part; None after the last."""
        step = self._part.command(outlook)
        if step is None and self._index + 1 < len(self._parts):
            self._index += 1
            self._part.begin(outlook.pose)
            return Step(STANDSTILL)
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
