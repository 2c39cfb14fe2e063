"""Drive a robot to poses on the map: plan, drive, wait for others or go around them, or fail with a reason."""

import math
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass

from jacaros.robots.plane.pose import Placement, Point, distance
from jacaros.robots.plane.shapes import Circle
from jacaros.robots.world.navigation.driver import STOP, Driver, Route, in_the_way
from jacaros.robots.world.navigation.navigator import PERIOD, Navigator, WheelClaim
from jacaros.robots.world.navigation.planner import (
    FAILED_TO_MAKE_PROGRESS,
    NO_VALID_PATH,
    TIMEOUT,
    NavigationFailure,
    coordinates,
)

TOLERANCE = 0.04
"""Distance from the goal in metres at which the robot has arrived."""
YAW_TOLERANCE = 0.05
"""The same for the heading, in radians."""
PATIENCE = 3.0
"""Seconds without progress before a recovery; slightly more for each further robot."""
MOST_RECOVERIES = 3
"""Number of failed attempts in a row after which the goal is aborted."""
_MOVED = 0.25
_TURNED = 0.8
_AWAY = 0.6
_LOST = 0.35
_ROOMS = (0.12, 0.07)
_KEEP_RIGHT = 0.1
_BACK = 0.2
_LEAST_ALLOWANCE = 30.0
_LATER = 1.3
_FEEDBACK_EVERY = 2
_STILL = 0.15
_DETOUR = 1.0
"""Length in metres that a detour around others must save before it is abandoned when they have gone."""


@dataclass(frozen=True, slots=True)
class TripProgress:
    """Progress of a goal: estimated pose, seconds since its start, remaining metres and poses, number of recoveries."""

    pose: Placement
    time: float
    remaining: float
    poses_left: int
    recoveries: int


FeedbackCallback = Callable[[TripProgress], object]


async def go(
    navigator: Navigator, goals: Sequence[Placement], tell: FeedbackCallback, limit: float = math.inf
) -> None:
    """Drive through all *goals*, and stop at the last one, with its heading.

    Args:
        navigator: robot.
        goals: poses on the map.
        tell: receives progress, a few times per second.
        limit: seconds after which the goal is aborted; the length of the path sets a limit, too.

    Raises:
        NavigationFailure: a goal cannot be reached.
        Overtaken: another goal has claimed the wheels.
    """
    with navigator.wheels.claimed() as claim:
        try:
            await Trip(navigator, goals, tell, limit).run(claim)
        finally:
            navigator.path = ()


class Trip:
    """Drives a robot through poses.

    Args:
        navigator: robot.
        goals: poses on the map.
        tell: receives progress, a few times per second.
        limit: maximum duration in seconds.
    """

    def __init__(
        self,
        navigator: Navigator,
        goals: Sequence[Placement],
        tell: FeedbackCallback,
        limit: float = math.inf,
    ) -> None:
        self.navigator, self.goals, self._tell = navigator, list(goals), tell
        self._clock = navigator.time.clock
        self._began = self._clock.now()
        self._pose = navigator.pose()
        self._others: list[Circle] = []
        # Two robots that block each other must not step back and return at the same time.
        self._patience = PATIENCE + _LATER * (
            list(navigator.time.world.robots).index(navigator.robot.name) % 4
        )
        self._recoveries = self._in_a_row = self._cycles = 0
        self._stuck_at: Point = (math.inf, math.inf)
        self._hopeless: list[Circle] | None = None
        self._avoided: list[Circle] = []
        self._vias: list[float] = []
        self._mark = self._pose
        self._marked = self._planned = self._began
        self._look()
        self._drive_along(self._first_way())
        self._allowance = min(limit, _LEAST_ALLOWANCE + 4.0 * self._route.length / navigator.pace.speed)

    async def run(self, claim: WheelClaim) -> None:
        """Drive to the end; see `go`."""
        while not self._arrived():
            self._check()
            if self._clock.now() - self._marked > self._patience:
                await self._recover(claim)
            await claim.drive(self._driver.command(self._pose, self._route, self._others))
            self._look()
            self._follow()
        await self._turn(claim)

    async def _turn(self, claim: WheelClaim) -> None:
        """Turn to the heading of the last goal."""
        self._marked = self._clock.now()
        while (command := self._driver.heading(self._pose, self.goals[-1], YAW_TOLERANCE)) is not None:
            self._check()
            if (
                self._clock.now() - self._marked
                > 2.0 * PATIENCE + 2.0 * math.pi / self.navigator.pace.turn_rate
            ):
                raise NavigationFailure(FAILED_TO_MAKE_PROGRESS, "the robot cannot reach the heading")
            await claim.drive(command)
            self._look()
        self._report()

    def _look(self) -> None:
        self._pose = self.navigator.pose()
        self._others = self.navigator.others(self._pose)

    def _arrived(self) -> bool:
        last = self.goals[-1]
        apart = distance((self._pose.x, self._pose.y), (last.x, last.y))
        near_end = len(self._vias) == 0 and self._route.remaining < 2.0 * TOLERANCE
        return near_end and apart <= TOLERANCE

    def _check(self) -> None:
        if self.navigator.robot.battery.empty:
            raise NavigationFailure(FAILED_TO_MAKE_PROGRESS, "the battery is empty")
        if self._clock.now() - self._began > self._allowance:
            raise NavigationFailure(TIMEOUT, f"goal not reached after {self._allowance:g} s")

    def _follow(self) -> None:
        """Update the progress on the path, and replan when the path is blocked."""
        here = (self._pose.x, self._pose.y)
        beside = self._route.advance(here)
        while self._vias and self._route.done >= self._vias[0] - TOLERANCE:
            del self._vias[0], self.goals[0]
        if self._got_on():
            self._mark, self._marked = self._pose, self._clock.now()
            if distance(here, self._stuck_at) > _AWAY:
                self._in_a_row = 0
        radius = self.navigator.robot.description.radius
        blocked = in_the_way(self._route, self._others, radius, 1.5)
        if beside > _LOST or (blocked and self._clock.now() - self._planned >= 1.0):
            self._plan_again()
        elif self._avoided and self._clock.now() - self._planned >= 1.0:
            self._reconsider()
        self._cycles += 1
        if self._cycles % _FEEDBACK_EVERY == 0:
            self._report()

    def _got_on(self) -> bool:
        """Return whether the robot has moved or turned since the last call that returned true."""
        now, then = self._pose, self._mark
        turned = now.cosine * then.cosine + now.sine * then.sine < _TURNED
        return turned or distance((now.x, now.y), (then.x, then.y)) > _MOVED

    def _report(self) -> None:
        self._tell(
            TripProgress(
                self._pose,
                self._clock.now() - self._began,
                self._route.remaining,
                len(self.goals),
                self._recoveries,
            )
        )

    def _first_way(self) -> list[Point]:
        free = self._way(())
        if not self._others:
            return free
        way = self._way_now()
        if way is None:
            # Others may be gone when the robot arrives; walls will not.
            return self._way(())
        self._note_detour(way, Route(free).length)
        return way

    def _plan_again(self) -> None:
        """Plan around the obstacles; if there is no path, keep the old one."""
        self._planned = self._clock.now()
        # Finding that there is no path takes longest; do not repeat it while the obstacles are unchanged.
        if self._hopeless is not None and _stand_still(self._hopeless, self._others):
            return
        way = self._way_now()
        if way is None:
            self._hopeless = self._others
            return
        self._hopeless = None
        self._note_detour(way, self._route.remaining)
        self._drive_along(way)

    def _note_detour(self, way: list[Point], without: float) -> None:
        """Record the obstacles that make *way* much longer than *without*, its length in metres without them."""
        if Route(way).length > without + _DETOUR:
            self._avoided = self._others

    def _reconsider(self) -> None:
        """Return from a detour to the direct path when the robot sees that the obstacles have gone."""
        self._planned = self._clock.now()
        if not all(self.navigator.perception.covers((x, y), self._pose) for x, y, _ in self._avoided):
            return
        vias = self._vias
        way = self._way_now()
        if way is not None and Route(way).length < self._route.remaining - _DETOUR:
            self._avoided = []
            self._drive_along(way)
        else:
            self._vias = vias

    def _way_now(self) -> list[Point] | None:
        """Return the path around the obstacles; None if no path exists."""
        with suppress(NavigationFailure):
            return self._way(self._others)
        return None

    def _way(self, others: Sequence[Circle]) -> list[Point]:
        """Return the path through all remaining goals, keeping well away from *others* if there is room."""
        if others:
            with suppress(NavigationFailure):
                return self._way_around(others, _ROOMS[0])
        return self._way_around(others, _ROOMS[1])

    def _way_around(self, others: Sequence[Circle], room: float) -> list[Point]:
        """Return the path that keeps *room* metres more distance from *others* than from walls; updates `_vias`."""
        planner, pose = self.navigator.planner, self._pose
        obstacles = []
        for x, y, radius in others:
            # Slightly to the left of the other: robots that meet pass on the right.
            forward, left = pose.local(x, y)
            shift = _KEEP_RIGHT if forward > 0.0 and room == _ROOMS[0] else 0.0
            obstacles.append((*pose.point(forward, left + shift), radius + room))
        points, vias = [(pose.x, pose.y)], []
        for goal in self.goals:
            piece = planner.plan(points[-1], (goal.x, goal.y), obstacles)
            points += piece[1:]
            vias.append(Route(points).length)
        self._vias = vias[:-1]
        return points

    def _drive_along(self, points: list[Point]) -> None:
        if len(points) < 2:  # already there
            points = [points[0], points[0]]
        self.navigator.path = points
        self._route = Route(points)
        self._driver = Driver(self.navigator.planner, self.navigator.pace)

    async def _recover(self, claim: WheelClaim) -> None:
        """Recover: step back if there is room, wait a moment, and replan."""
        if self._in_a_row >= MOST_RECOVERIES:
            self._give_up()
        self._recoveries += 1
        self._in_a_row += 1
        self._stuck_at = (self._pose.x, self._pose.y)
        if self.navigator.free_at(self._pose, -_BACK, self._others):
            await self.navigator.straight(claim, -_BACK, 0.15)
        else:
            for _ in range(round(1.0 / PERIOD)):
                await claim.drive(STOP)
        self._look()
        self._plan_again()
        self._mark, self._marked = self._pose, self._clock.now()

    def _give_up(self) -> None:
        here = coordinates((self._pose.x, self._pose.y))
        radius = self.navigator.robot.description.radius
        for name, door in self.navigator.perception.closed_doors(self._pose).items():
            if in_the_way(self._route, door, radius, self._route.remaining):
                raise NavigationFailure(
                    NO_VALID_PATH, f"the door '{name}' is closed, and there is no other path"
                )
        for x, y, other in self._others:
            if in_the_way(self._route, [(x, y, other)], radius, self._route.remaining):
                who = "another robot or a person" if self.navigator.time.world.people else "another robot"
                raise NavigationFailure(
                    NO_VALID_PATH,
                    f"{who} blocks the path at {coordinates((x, y))}, and there is no other path",
                )
        raise NavigationFailure(FAILED_TO_MAKE_PROGRESS, f"the robot is stuck at {here}")


def _stand_still(before: Sequence[Circle], now: Sequence[Circle]) -> bool:
    """Return whether the obstacles are unchanged, as far as the robot perceives."""
    return len(before) == len(now) and all(
        distance((ax, ay), (bx, by)) < _STILL for (ax, ay, _), (bx, by, _) in zip(before, now, strict=True)
    )
