"""A navigating robot: its estimated pose, its perception and its simplest motions."""

import math
from collections.abc import Callable, Sequence

from jacaros.sim.description import Dock
from jacaros.sim.navigation.driver import STOP, Command, Driver, Pace
from jacaros.sim.navigation.localisation import Localisation
from jacaros.sim.navigation.placement import Placement, Point, distance
from jacaros.sim.navigation.planner import Circle, Planner
from jacaros.sim.navigation.sight import Sight
from jacaros.sim.navigation.wheels import PERIOD, Hold, Wheels
from jacaros.sim.robot.motion import clamp
from jacaros.sim.robot.robot import Robot
from jacaros.sim.trigonometry import wrap
from jacaros.sim.world_time import WorldTime

_BRAKES_IN = 0.05
_GIVE_UP = 2.0


class Navigator:
    """The parts that one robot needs for navigation.

    Args:
        time: the world, on a clock.
        robot: which of its robots.
        localisation: where it believes to be.
        wheels: what it commands.
        make_planner: makes the planner; called at the first goal.

    Attributes:
        path: points of the path that it follows now, empty without a goal.
    """

    def __init__(
        self,
        time: WorldTime,
        robot: Robot,
        localisation: Localisation,
        wheels: Wheels,
        make_planner: Callable[[], Planner],
    ) -> None:
        self.time, self.robot, self.localisation, self.wheels = time, robot, localisation, wheels
        settings = robot.description.navigation
        self.pace = Pace.within(robot.description.limits, settings.speed)
        self.sight = Sight(time.world, robot)
        self.path: Sequence[Point] = ()
        self._make_planner = make_planner
        self._planner: Planner | None = None

    @property
    def planner(self) -> Planner:
        """The planner, made when it is first wanted."""
        if self._planner is None:
            self._planner = self._make_planner()
        return self._planner

    def pose(self) -> Placement:
        """Where the robot believes to be now."""
        self.time.catch_up()
        self.localisation.update(self.time.world.time)
        return self.localisation.pose()

    def others(self, pose: Placement) -> list[Circle]:
        """What the map does not have: other robots in sight, and doors that are closed."""
        doors = self.sight.closed_doors(pose).values()
        return [*self.sight.robots(pose), *(circle for door in doors for circle in door)]

    def free_at(self, pose: Placement, forward: float, others: Sequence[Circle]) -> bool:
        """Whether there is room for the robot *forward* metres ahead (negative: behind)."""
        point = pose.point(forward, 0.0)
        radius = self.robot.description.radius
        if self.planner.grid.clearance_at(*point) < radius + 0.03:
            return False
        return all(distance(point, (x, y)) > radius + other + 0.05 for x, y, other in others)

    async def straight(
        self,
        hold: Hold,
        metres: float,
        speed: float,
        tell: Callable[[float], None] | None = None,
        limit: float = math.inf,
    ) -> float:
        """Drive straight on, or back for negative *metres*; gives how many metres were made.

        It ends early when something is in the way, the robot does not move, or *limit* seconds are over.
        """
        begin = last = self.pose()
        sign = 1.0 if metres >= 0.0 else -1.0
        made, waited, over = 0.0, 0.0, self.time.clock.now() + limit
        while made < abs(metres) - 0.005 and waited < _GIVE_UP and self.time.clock.now() < over:
            reach = sign * (0.06 + speed * _BRAKES_IN)
            command = STOP
            if self._clearer(last, reach):
                left = abs(metres) - made
                wanted = min(speed, max(0.03, left * 1.5))
                off = begin.cosine * last.sine - begin.sine * last.cosine
                command = Command(sign * wanted, clamp(-2.0 * off, 0.5))
            await hold.drive(command)
            pose = self.pose()
            now = sign * begin.local(pose.x, pose.y)[0]
            waited = 0.0 if now > made + 0.001 else waited + PERIOD
            made, last = max(made, now), pose
            if tell is not None:
                tell(max(0.0, abs(metres) - made))
        return sign * made

    def _clearer(self, pose: Placement, reach: float) -> bool:
        """Whether the robot may move on by *reach*: there is room, or at least more than here."""
        if self.free_at(pose, reach, self.others(pose)):
            return True
        grid = self.planner.grid
        there, here = grid.clearance_at(*pose.point(reach, 0.0)), grid.clearance_at(pose.x, pose.y)
        return there > here and self.free_of_robots(pose, reach)

    def free_of_robots(self, pose: Placement, forward: float) -> bool:
        """Whether no robot or door is *forward* metres ahead, or it is further off there than here."""
        point, here = pose.point(forward, 0.0), (pose.x, pose.y)
        radius = self.robot.description.radius
        return all(
            distance(point, (x, y)) > min(radius + other + 0.05, distance(here, (x, y)))
            for x, y, other in self.others(pose)
        )

    async def rotate(
        self, hold: Hold, angle: float, rate: float, tell: Callable[[float], None] | None = None
    ) -> float:
        """Turn on the spot by *angle* radians, by the odometry; gives how many were made."""
        self.time.catch_up()
        last, made, waited = self.robot.odometry.yaw, 0.0, 0.0
        sign = 1.0 if angle >= 0.0 else -1.0
        while made < abs(angle) - 0.01 and waited < _GIVE_UP:
            left = abs(angle) - made
            await hold.drive(Command(0.0, sign * min(rate, max(0.08, 2.0 * left))))
            self.time.catch_up()
            yaw = self.robot.odometry.yaw
            turned = sign * wrap(yaw - last)
            waited = 0.0 if turned > 0.001 else waited + PERIOD
            made, last = made + turned, yaw
            if tell is not None:
                tell(sign * max(0.0, abs(angle) - made))
        return sign * made

    def driver(self) -> Driver:
        """A driver for a new route."""
        return Driver(self.planner, self.pace)

    def docks(self) -> tuple[Dock, ...]:
        """The docks that the robot knows."""
        return self.time.world.description.docks
