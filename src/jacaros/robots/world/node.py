"""The world as a ROS node: all its robots, doors and faults and its map, on any backend and any clock."""

import math
from collections.abc import Sequence
from functools import cache, partial
from typing import Any, cast

from jacaros.robots.ros.backend import Backend
from jacaros.robots.ros.message import stamp
from jacaros.robots.ros.node import Publisher
from jacaros.robots.world.data.grid import Grid
from jacaros.robots.world.graph.faulty_graph import FaultyGraph
from jacaros.robots.world.graph.frames import MAP
from jacaros.robots.world.graph.on_graph import LATCHED, TICKS_PER_SECOND, OnGraph, WorldTime
from jacaros.robots.world.graph.robot_node import RobotNode
from jacaros.robots.world.navigation.servers import RobotNavigation
from jacaros.robots.world.physics.localisation import SimulatedLocalisation
from jacaros.robots.world.physics.world import World
from jacaros.runtime.clock import Clock, Timer

_GRID = "nav_msgs/msg/OccupancyGrid"


class SimNode:
    """Runs a world on a clock and a ROS graph; agents access it over topics only.

    Beside its robots, it offers

    - each door: the service ``/doors/NAME/open`` (``std_srvs/srv/SetBool``: true opens, false closes; fails while a robot
      is in it) and the topic ``/doors/NAME/is_open`` (``std_msgs/msg/Bool``, latched);
    - each fault: the service ``/faults/NAME`` (``std_srvs/srv/SetBool``);
    - the map: the topics ``/map`` and, for robots with a namespace, ``/robot_1/map`` (``nav_msgs/msg/OccupancyGrid``,
      latched, at the first subscription), and the service ``/map_server/map`` (on ROS 1 ``/static_map``).

    Args:
        world: world; its time continues.
        backend: graph; must be started before `start`, and is not closed by `close`.
        clock: the clock that the world follows.

    Attributes:
        grid: returns the map of the world, which is created on first use.
    """

    def __init__(self, world: World, backend: Backend, clock: Clock) -> None:
        affected = world.faults.topics or world.faults.actions
        self._faulty = FaultyGraph(backend, world.faults, clock) if affected else None
        self.world, self.clock = world, clock
        self.backend = backend if self._faulty is None else cast(Backend, self._faulty)
        self.time = WorldTime(world, clock)
        self.robots: list[RobotNode] = []
        self.navigation: list[RobotNavigation] = []
        self._at: OnGraph | None = None
        self._doors: dict[str, Publisher] = {}
        self._published: dict[str, bool] = {}
        self._maps: list[Publisher] = []
        self._map: Any = None
        self.grid = cache(lambda: Grid(world.description))
        self._timer: Timer | None = None
        self._ticks = 0

    def start(self) -> None:
        """Join the graph, and let the time of the world run from now on.

        Raises:
            RosError: the backend is not started, or does not support a namespace or a message type.
            UsageError: a fault affects an unknown topic or action.
        """
        self.time = WorldTime(self.world, self.clock)
        self.robots = [
            RobotNode(self.time, robot, self.backend, SimulatedLocalisation(self.world, robot, self.grid))
            for robot in self.world.robots.values()
        ]
        self.navigation = [
            RobotNavigation(robot, self.grid)
            for robot in self.robots
            if robot.robot.description.navigation.enabled
        ]
        self._at = at = OnGraph(self.time, self.backend)
        names = dict.fromkeys(f"{prefix}/map" for prefix in ("", *(robot.prefix for robot in self.robots)))
        self._maps = [at.publisher(name, _GRID, LATCHED) for name in names]
        name = "/static_map" if self.backend.ros_version == 1 else "/map_server/map"
        at.service(name, "nav_msgs/srv/GetMap", lambda request: {"map": self._map_message()})
        for door in self.world.doors:
            self._doors[door] = at.publisher(f"/doors/{door}/is_open", "std_msgs/msg/Bool", LATCHED)
            at.switch(f"/doors/{door}/open", partial(self._move_door, door))
        for fault in self.world.faults.by_name:
            at.switch(f"/faults/{fault}", partial(self.world.faults.switch, fault))
        if self._faulty is not None:
            self._faulty.check()
        self._ticks = 0
        self._wait_for_tick()

    def beliefs(self) -> dict[str, tuple[float, float, float]]:
        """Return the estimated pose of each robot, by name: metres on the map, and radians."""
        found = {}
        for each in self.robots:
            x, y, cosine, sine = each.localisation.belief(self.world.time)
            found[each.robot.name] = (x, y, math.atan2(sine, cosine))
        return found

    def paths(self) -> dict[str, Sequence[tuple[float, float]]]:
        """Return the points of the path of each robot, by name, in metres on the map; empty without a goal."""
        return {each.name: each.path for each in self.navigation}

    def _map_message(self) -> Any:
        if self._map is None:
            grid, now = self.grid(), self.time.now()
            self._map = message = self.backend.message(_GRID, data=grid.occupancy())
            stamp(message.header.stamp, now)
            message.header.frame_id = MAP
            message.info.resolution = grid.resolution
            message.info.width, message.info.height = grid.width - 2, grid.height - 2
            stamp(message.info.map_load_time, now)
            message.info.origin.position.x, message.info.origin.position.y = grid.x_min, grid.y_min
        return self._map

    def _move_door(self, name: str, opened: bool) -> str | None:
        stuck = self.world.stuck_doors.get(name)
        if stuck is not None and self.world.doors[name] != opened and stuck():
            return f"the door '{name}' is stuck"
        problem = self.world.move_door(name, opened)
        self._publish_door(name)
        return problem

    def _publish_door(self, name: str) -> None:
        now = self.world.doors[name]
        if self._published.get(name) is not now:
            self._published[name] = now
            self._doors[name].publish(self._doors[name].message(data=now))

    def _wait_for_tick(self) -> None:
        period = 1.0 / TICKS_PER_SECOND
        delay = period
        if not self.clock.virtual:
            # From the start, not from the last tick: delays of the loop must not add up. Missed ticks (the process
            # was blocked, or the computer slept) are dropped, not repeated in a burst.
            passed = self.time.passed()
            self._ticks = max(self._ticks + 1, math.floor(passed / period) + 1)
            # A clock that was set back must not stop the world.
            delay = min(max(0.0, self._ticks * period - passed), 2.0 * period)
        self._timer = self.clock.call_later(delay, self._tick)

    def _tick(self) -> None:
        self._wait_for_tick()
        self.time.catch_up()
        for robot in self.robots:
            robot.publish()
        for door in self._doors:
            self._publish_door(door)
        for publisher in tuple(self._maps):
            if publisher.subscription_count:
                self._maps.remove(publisher)
                publisher.publish(self._map_message())

    def stop(self) -> None:
        """Stop the world; its topics remain."""
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None
            self.time.catch_up()

    def close(self) -> None:
        """Stop the world and withdraw its topics."""
        self.stop()
        for navigation in self.navigation:
            navigation.close()
        for each in (*self.robots, self._at):
            if each is not None:
                each.close()
        self.robots, self.navigation, self._at = [], [], None
        self._doors, self._published, self._maps, self._map = {}, {}, [], None
