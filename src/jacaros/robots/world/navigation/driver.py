"""Path following by pure pursuit, for a round robot that can turn on the spot.

Pure functions: numbers in, a command out.
"""

import itertools
import math
from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

from jacaros.robots.plane.pose import Placement, Point, clamp, distance
from jacaros.robots.plane.shapes import Circle
from jacaros.robots.world.data.robot import RobotLimits
from jacaros.robots.world.navigation.planner import Planner


class Route:
    """A path of straight segments.

    Attributes:
        points: start, corners and end.
        length: total length, in metres.
        done: distance covered along the path, in metres; never decreases.
    """

    def __init__(self, points: Sequence[Point]) -> None:
        self.points = list(points)
        self._at = [0.0]
        for before, after in itertools.pairwise(self.points):
            self._at.append(self._at[-1] + distance(before, after))
        self.length = self._at[-1]
        self.done = 0.0

    @property
    def remaining(self) -> float:
        """Remaining distance, in metres."""
        return self.length - self.done

    def advance(self, place: Point, window: float = 0.8) -> float:
        """Update the progress for a robot at *place*; return the distance from the path, in metres.

        Only the next *window* metres are searched, because a path may return to an earlier place.
        """
        best, best_at = math.inf, self.done
        first = max(0, bisect_right(self._at, self.done) - 1)
        for index in range(first, len(self.points) - 1):
            if self._at[index] > self.done + window:
                break
            (ax, ay), (bx, by) = self.points[index], self.points[index + 1]
            dx, dy = bx - ax, by - ay
            if dx == 0.0 and dy == 0.0:
                continue
            share = ((place[0] - ax) * dx + (place[1] - ay) * dy) / (dx * dx + dy * dy)
            share = 0.0 if share < 0.0 else 1.0 if share > 1.0 else share
            apart = distance(place, (ax + share * dx, ay + share * dy))
            at = self._at[index] + share * (self._at[index + 1] - self._at[index])
            if at >= self.done and apart < best:
                best, best_at = apart, at
        if best == math.inf:
            best = distance(place, self.point(self.done))
        self.done = best_at
        return best

    def point(self, at: float) -> Point:
        """Return the point at *at* metres along the path, at most its end."""
        if at >= self.length:
            return self.points[-1]
        index = max(0, bisect_right(self._at, at) - 1)
        piece = self._at[index + 1] - self._at[index]
        share = (at - self._at[index]) / piece
        (ax, ay), (bx, by) = self.points[index], self.points[index + 1]
        return ax + share * (bx - ax), ay + share * (by - ay)

    def samples(self, ahead: float, step: float = 0.1) -> list[Point]:
        """Return points on the next *ahead* metres of the path, including its end if that is near enough."""
        count = math.floor(min(ahead, self.remaining) / step)
        points = [self.point(self.done + index * step) for index in range(count + 1)]
        return [*points, self.points[-1]] if ahead >= self.remaining else points


TURN_IN_PLACE = 0.8
"""Tangent of the bearing above which the robot turns on the spot before driving."""
_DRIVE_AGAIN = 0.15
KEEP_OFF = 0.08
"""Distance in metres that the robot keeps from robots in front of it."""
PASSING = 0.05
"""Distance in metres that the robot keeps from robots that it passes."""
_PASSING_SPEED = 0.2
_SLOWEST = 0.04
_APPROACH_TIME = 0.7
"""Seconds that the robot is always away from the end of its path: late commands need some."""
_LOOK_AHEAD = 0.2
_LOOK_AHEAD_TIME = 0.4
_PREDICTED = 0.5
_SKIN = 0.012
"""Clearance in metres (in addition to the radius) at which the robot does not approach a wall further."""


class WheelCommand(NamedTuple):
    """A command for the wheels: m/s and rad/s."""

    speed: float
    turn_rate: float


STOP = WheelCommand(0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Pace:
    """Limits of navigation: m/s, rad/s, m/s2."""

    speed: float
    turn_rate: float
    braking: float

    @classmethod
    def within(cls, limits: RobotLimits, speed: float) -> "Pace":
        """Return the limits of a robot for navigation at a speed of at most *speed*."""
        return cls(min(speed, limits.speed), min(1.5, limits.turn_rate), 0.5 * limits.acceleration)


class Driver:
    """Drives along one path.

    Args:
        planner: knows the walls.
        pace: limits of speed and acceleration.
    """

    def __init__(self, planner: Planner, pace: Pace) -> None:
        self.planner, self.pace = planner, pace
        self._turning = False
        self._speed = 0.0

    def command(self, pose: Placement, route: Route, others: Sequence[Circle] = ()) -> WheelCommand:
        """Return the next command; *route* must be up to date (`Route.advance`)."""
        here = (pose.x, pose.y)
        target, ahead = self._target(here, route)
        forward, left = pose.local(*target)
        if self._must_turn(forward, left):
            self._speed = 0.0
            return WheelCommand(0.0, self._turn(forward, left))
        apart2 = forward * forward + left * left
        curvature = 2.0 * left / apart2 if apart2 > 1e-6 else 0.0
        speed = min(self.pace.speed, self._for_end(route), self._for_others(pose, others), 0.1 + ahead)
        if speed <= 0.0:
            self._speed = 0.0
            return STOP
        if abs(curvature) * speed > self.pace.turn_rate:
            speed = self.pace.turn_rate / abs(curvature)
        speed = self._for_walls(pose, speed, curvature)
        self._speed = speed
        return WheelCommand(speed, clamp(speed * curvature, self.pace.turn_rate))

    def heading(self, pose: Placement, wanted: Placement, tolerance: float) -> WheelCommand | None:
        """Return a command that turns to the heading of *wanted*; None if it is reached to *tolerance* radians."""
        forward = pose.cosine * wanted.cosine + pose.sine * wanted.sine
        left = pose.cosine * wanted.sine - pose.sine * wanted.cosine
        if forward > 0.0 and abs(left) <= tolerance:
            return None
        return WheelCommand(0.0, self._turn(forward, left))

    def _target(self, here: Point, route: Route) -> tuple[Point, float]:
        """Return the target point and its distance: at most as far as the straight line to it is free."""
        ahead = _LOOK_AHEAD + _LOOK_AHEAD_TIME * self._speed
        while ahead > 0.06:
            target = route.point(route.done + ahead)
            if self.planner.free(here, target):
                return target, ahead
            ahead *= 0.6
        return route.point(route.done + 0.06), 0.06

    def _must_turn(self, forward: float, left: float) -> bool:
        limit = _DRIVE_AGAIN if self._turning else TURN_IN_PLACE
        self._turning = forward <= 0.0 or abs(left) > limit * forward
        return self._turning

    def _turn(self, forward: float, left: float) -> float:
        length = math.sqrt(forward * forward + left * left)
        off = 1.5 if forward <= 0.0 or length == 0.0 else abs(left) / length
        rate = min(self.pace.turn_rate, 2.5 * off + 0.05)
        return rate if left >= 0.0 else -rate

    def _for_end(self, route: Route) -> float:
        """Return a speed at which the robot can still stop at the end, though its commands may be late."""
        left = max(0.0, route.remaining)
        return max(_SLOWEST, min(math.sqrt(2.0 * self.pace.braking * left) - 0.05, left / _APPROACH_TIME))

    def _for_others(self, pose: Placement, others: Sequence[Circle]) -> float:
        """Return a speed that falls with the distance of robots ahead, to 0 at `KEEP_OFF` unless there is room to pass."""
        speed = self.pace.speed
        for x, y, radius in others:
            forward, left = pose.local(x, y)
            if forward <= 0.0:
                continue
            reach = radius + self.planner.radius
            gap = math.sqrt(forward * forward + left * left) - reach
            if abs(left) < reach + PASSING:
                speed = min(speed, max(0.0, 0.8 * (gap - KEEP_OFF)))
            elif gap < 3.0 * KEEP_OFF:
                speed = min(speed, _PASSING_SPEED)
        return speed

    def _for_walls(self, pose: Placement, speed: float, curvature: float) -> float:
        """Return the highest speed that keeps the next half second clear of walls."""
        grid, least = self.planner.grid, self.planner.radius + _SKIN
        now = grid.clearance_at(pose.x, pose.y)
        for share in (1.0, 0.5, 0.25):
            reach = speed * share * _PREDICTED
            # The middle of the arc to first order, because the arc is short.
            half = 0.5 * reach * reach * curvature
            x, y = pose.point(reach, half)
            then = grid.clearance_at(x, y)
            if then >= least or then >= now:
                return speed * share
        return 0.0


def in_the_way(route: Route, others: Sequence[Circle], radius: float, ahead: float) -> bool:
    """Return whether one of *others* stands on the next *ahead* metres of a robot's path."""
    if not others:
        return False
    points = route.samples(ahead)
    for x, y, other in others:
        reach = radius + other + PASSING
        for px, py in points:
            dx, dy = px - x, py - y
            if dx * dx + dy * dy < reach * reach:
                return True
    return False
