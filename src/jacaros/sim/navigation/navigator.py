"""A navigating robot: its estimated pose, its perception and its basic motions."""

import math
from collections.abc import Callable, Sequence

from jacaros.plane.pose import Placement, Point, clamp, distance, wrap
from jacaros.sim.description import Dock
from jacaros.sim.navigation.driver import STOP, Command, Driver, Pace
from jacaros.sim.navigation.laser_perception import LaserPerception
from jacaros.sim.navigation.localisation import Localisation
from jacaros.sim.navigation.planner import Circle, Planner
from jacaros.sim.navigation.wheels import PERIOD, Claim, Wheels
from jacaros.sim.robot.robot import Robot
from jacaros.sim.world_time import WorldTime

_BRAKES_IN = 0.05
_GIVE_UP = 2.0


class Navigator:
    """The parts of one robot that navigation needs.

    Args:
        time: the world on a clock.
        robot: robot of that world.
        localisation: estimated pose.
        wheels: commands of the base.
        make_planner: creates the planner; called at the first goal.

    Attributes:
        path: points of the current path; empty without a goal.
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
        self.perception = LaserPerception(time.world, robot)
        self.path: Sequence[Point] = ()
        self._make_planner = make_planner
        self._planner: Planner | None = None

    @property
    def planner(self) -> Planner:
        """The planner, created on first use."""
        if self._planner is None:
            self._planner = self._make_planner()
        return self._planner

    def pose(self) -> Placement:
        """Return the estimated pose."""
        self.time.catch_up()
        self.localisation.update(self.time.world.time)
        return self.localisation.pose()

    def others(self, pose: Placement) -> list[Circle]:
        """Return what the map lacks: other robots in view, and closed doors."""
        doors = self.perception.closed_doors(pose).values()
        return [*self.perception.robots(pose), *(circle for door in doors for circle in door)]

    def free_at(self, pose: Placement, forward: float, others: Sequence[Circle]) -> bool:
        """Return whether there is room for the robot *forward* metres ahead (negative: behind)."""
        point = pose.point(forward, 0.0)
        radius = self.robot.description.radius
        if self.planner.grid.clearance_at(*point) < radius + 0.03:
            return False
        return all(distance(point, (x, y)) > radius + other + 0.05 for x, y, other in others)

    async def straight(
        self,
        claim: Claim,
        metres: float,
        speed: float,
        tell: Callable[[float], None] | None = None,
        limit: float = math.inf,
    ) -> float:
        """Drive straight ahead, or back for negative *metres*; return the distance driven, in metres.

        The motion ends early if the way is blocked, the robot does not move, or *limit* seconds are over.
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
            await claim.drive(command)
            pose = self.pose()
            now = sign * begin.local(pose.x, pose.y)[0]
            waited = 0.0 if now > made + 0.001 else waited + PERIOD
            made, last = max(made, now), pose
            if tell is not None:
                tell(max(0.0, abs(metres) - made))
        return sign * made

    def _clearer(self, pose: Placement, reach: float) -> bool:
        """Return whether the robot may move *reach* further: there is room, or at least more than here."""
        if self.free_at(pose, reach, self.others(pose)):
            return True
        grid = self.planner.grid
        there, here = grid.clearance_at(*pose.point(reach, 0.0)), grid.clearance_at(pose.x, pose.y)
        return there > here and self.free_of_robots(pose, reach)

    def free_of_robots(self, pose: Placement, forward: float) -> bool:
        """Return whether no robot or door is *forward* metres ahead, or it is farther away there than here."""
        point, here = pose.point(forward, 0.0), (pose.x, pose.y)
        radius = self.robot.description.radius
        return all(
            distance(point, (x, y)) > min(radius + other + 0.05, distance(here, (x, y)))
            for x, y, other in self.others(pose)
        )

    async def rotate(
        self, claim: Claim, angle: float, rate: float, tell: Callable[[float], None] | None = None
    ) -> float:
        """Turn on the spot by *angle* radians of odometry; return the angle turned."""
        self.time.catch_up()
        last, made, waited = self.robot.odometry.yaw, 0.0, 0.0
        sign = 1.0 if angle >= 0.0 else -1.0
        while made < abs(angle) - 0.01 and waited < _GIVE_UP:
            left = abs(angle) - made
            await claim.drive(Command(0.0, sign * min(rate, max(0.08, 2.0 * left))))
            self.time.catch_up()
            yaw = self.robot.odometry.yaw
            turned = sign * wrap(yaw - last)
            waited = 0.0 if turned > 0.001 else waited + PERIOD
            made, last = made + turned, yaw
            if tell is not None:
                tell(sign * max(0.0, abs(angle) - made))
        return sign * made

    def driver(self) -> Driver:
        """Return a driver for a new path."""
        return Driver(self.planner, self.pace)

    def docks(self) -> tuple[Dock, ...]:
        """Return the docks that the robot knows."""
        return self.time.world.description.docks
