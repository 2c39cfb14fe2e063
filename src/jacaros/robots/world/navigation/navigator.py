"""A navigating robot: its wheels, its estimated pose, its perception and its basic motions."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import cached_property
from typing import Any

from jacaros.robots.plane.pose import Placement, Point, clamp, distance, wrap
from jacaros.robots.plane.shapes import Circle
from jacaros.robots.ros.action import GoalCallback, GoalStatus
from jacaros.robots.ros.node import Publisher
from jacaros.robots.world.data.grid import Grid
from jacaros.robots.world.graph.frames import ODOMETRY, stamped_pose
from jacaros.robots.world.graph.on_graph import ActiveGoal, GoalExecution, Overtaken, RobotOnGraph
from jacaros.robots.world.navigation.driver import STOP, Pace, WheelCommand
from jacaros.robots.world.navigation.planner import NavigationFailure, Planner
from jacaros.robots.world.physics.perception import LaserPerception

PERIOD = 0.1
"""Seconds between two commands."""
_BRAKES_IN = 0.05
_GIVE_UP = 2.0


class WheelClaim:
    """A claim of the wheels, until another goal claims them."""

    def __init__(self, wheels: "Wheels") -> None:
        self._wheels = wheels

    async def drive(self, command: WheelCommand) -> None:
        """Publish a command, and wait until the next one is due.

        Raises:
            Overtaken: a newer goal has claimed the wheels.
        """
        self._check()
        self._wheels.send(command)
        await self._wheels.at.time.clock.sleep(PERIOD)
        self._check()

    def _check(self) -> None:
        if self._wheels.holder is not self:
            raise Overtaken


class Wheels:
    """Commands the base of one robot on ``/cmd_vel``, as any other node would, for one driver at a time."""

    def __init__(self, at: RobotOnGraph) -> None:
        self.at = at
        self.holder: WheelClaim | None = None
        self._publisher: Publisher | None = None

    @contextmanager
    def claimed(self) -> Iterator[WheelClaim]:
        """Claim the wheels from the current driver; afterwards stop the robot, unless another driver claimed them."""
        self.holder = claim = WheelClaim(self)
        try:
            yield claim
        finally:
            if self.holder is claim:
                self.holder = None
                self.send(STOP)

    def send(self, command: WheelCommand) -> None:
        """Publish a command."""
        if self._publisher is None:  # no publisher before the first command
            topic = self.at.name("/cmd_vel") or "/cmd_vel"
            self._publisher = self.at.backend.publisher(topic, "geometry_msgs/msg/Twist")
        message = self._publisher.message()
        message.linear.x, message.angular.z = command
        self._publisher.publish(message)

    def close(self) -> None:
        """Stop the robot if it is driving, and withdraw the topic."""
        if self._publisher is None:
            return
        if self.holder is not None:
            self.holder = None
            self.send(STOP)
        self._publisher.close()
        self._publisher = None


class Navigator:
    """The parts of one robot that navigation needs.

    Args:
        at: the robot on the graph.
        grid: creates the grid of the world; called at the first goal.

    Attributes:
        path: points of the current path; empty without a goal.
    """

    def __init__(self, at: RobotOnGraph, grid: Callable[[], Grid]) -> None:
        self.at, self.time, self.robot, self.wheels = at, at.time, at.robot, Wheels(at)
        settings = at.robot.description.navigation
        self.pace = Pace.within(at.robot.description.limits, settings.speed)
        self.perception = LaserPerception(at.time.world, at.robot)
        self.path: Sequence[Point] = ()
        self._grid = grid

    @cached_property
    def planner(self) -> Planner:
        """The planner, created on first use."""
        return Planner(self._grid(), self.robot.description.radius)

    def pose(self) -> Placement:
        """Return the estimated pose."""
        self.time.catch_up()
        self.at.localisation.update(self.time.world.time)
        return self.at.localisation.pose()

    def odometry_pose(self) -> Any:
        """Return the pose of odometry as a message."""
        return stamped_pose(self.at, self.robot.odometry.placement, ODOMETRY)

    def serve(
        self,
        name: str,
        type_name: str,
        execute: GoalExecution,
        accept: GoalCallback | None = None,
        overtaken: GoalStatus = GoalStatus.ABORTED,
        coded: Callable[[int], int] = int,
    ) -> None:
        """Serve an action; a failure, with its code, sets those of the fields below that the action's result has."""

        async def carry_out(goal: ActiveGoal) -> Mapping[str, Any]:
            try:
                return await execute(goal)
            except NavigationFailure as failure:
                goal.abort(
                    failure.text,
                    success=False,
                    error_code=coded(failure.code),
                    is_docked=self.robot.dock is not None,
                    text=failure.text,
                    pose=self.odometry_pose(),
                )

        self.at.action(name, type_name, carry_out, accept, overtaken)

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
        claim: WheelClaim,
        metres: float,
        speed: float,
        tell: Callable[[float], object] = bool,
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
            # The laser sees what is truly ahead, also when the robot is lost.
            if self._clearer(self.robot.placement, reach):
                left = abs(metres) - made
                wanted = min(speed, max(0.03, left * 1.5))
                off = begin.cosine * last.sine - begin.sine * last.cosine
                command = WheelCommand(sign * wanted, clamp(-2.0 * off, 0.5))
            await claim.drive(command)
            pose = self.pose()
            now = sign * begin.local(pose.x, pose.y)[0]
            waited = 0.0 if now > made + 0.001 else waited + PERIOD
            made, last = max(made, now), pose
            tell(max(0.0, abs(metres) - made))
        return sign * made

    def _clearer(self, pose: Placement, reach: float) -> bool:
        """Return whether the robot may move *reach* further: there is room, or at least more than here."""
        if self.free_at(pose, reach, self.others(pose)):
            return True
        grid = self.planner.grid
        there, here = grid.clearance_at(*pose.point(reach, 0.0)), grid.clearance_at(pose.x, pose.y)
        return there > here and self._free_of_robots(pose, reach)

    def _free_of_robots(self, pose: Placement, forward: float) -> bool:
        """Return whether no robot or door is *forward* metres ahead, or it is farther away there than here."""
        point, here = pose.point(forward, 0.0), (pose.x, pose.y)
        radius = self.robot.description.radius
        return all(
            distance(point, (x, y)) > min(radius + other + 0.05, distance(here, (x, y)))
            for x, y, other in self.others(pose)
        )

    async def rotate(
        self, claim: WheelClaim, angle: float, rate: float, tell: Callable[[float], object] = bool
    ) -> float:
        """Turn on the spot by *angle* radians of odometry; return the angle turned."""
        self.time.catch_up()
        last, made, waited = self.robot.odometry.yaw, 0.0, 0.0
        sign = 1.0 if angle >= 0.0 else -1.0
        while made < abs(angle) - 0.01 and waited < _GIVE_UP:
            left = abs(angle) - made
            await claim.drive(WheelCommand(0.0, sign * min(rate, max(0.08, 2.0 * left))))
            self.time.catch_up()
            yaw = self.robot.odometry.yaw
            turned = sign * wrap(yaw - last)
            waited = 0.0 if turned > 0.001 else waited + PERIOD
            made, last = made + turned, yaw
            tell(sign * max(0.0, abs(angle) - made))
        return sign * made
