"""The world as a ROS node: all its robots, on any backend and any clock."""

import math
from collections.abc import Sequence
from functools import partial
from typing import cast

from jacaros.ros.backend import Backend
from jacaros.runtime.clock import Clock, Timer
from jacaros.sim.door_server import DoorServer
from jacaros.sim.faults.graph import FaultyGraph
from jacaros.sim.map_server import MapServer
from jacaros.sim.navigation.grid import Grid
from jacaros.sim.navigation.robot import RobotNavigation
from jacaros.sim.robot.node import RobotNode
from jacaros.sim.robot.on_graph import TICKS_PER_SECOND
from jacaros.sim.switch_service import SwitchService
from jacaros.sim.world import World
from jacaros.sim.world_time import WorldTime


class SimNode:
    """Runs a world on a clock and a ROS graph; agents access it over topics only.

    Args:
        world: world; its time continues.
        backend: graph; must be started before `start`, and is not closed by `close`.
        clock: the clock that the world follows.
    """

    def __init__(self, world: World, backend: Backend, clock: Clock) -> None:
        affected = world.faults.topics or world.faults.actions
        self._faulty = FaultyGraph(backend, world.faults, clock) if affected else None
        self.world, self.clock = world, clock
        self.backend = backend if self._faulty is None else cast(Backend, self._faulty)
        self.time = WorldTime(world, clock)
        self.robots: list[RobotNode] = []
        self.navigation: list[RobotNavigation] = []
        self.doors: list[DoorServer] = []
        self.faults: list[SwitchService] = []
        self._map: MapServer | None = None
        self._grid: Grid | None = None
        self._timer: Timer | None = None
        self._ticks = 0

    def start(self) -> None:
        """Join the graph, and let the time of the world run from now on.

        Raises:
            RosError: the backend is not started, or does not support a namespace or a message type.
            UsageError: a fault affects an unknown topic or action.
        """
        self.time = WorldTime(self.world, self.clock)
        self.robots = [RobotNode(self.time, robot, self.backend) for robot in self.world.robots.values()]
        self.navigation = [
            RobotNavigation(self.time, robot.robot, robot.localisation, self.backend, self.grid)
            for robot in self.robots
            if robot.robot.description.navigation.enabled
        ]
        prefixes = [robot.prefix for robot in self.robots]
        self._map = MapServer(self.backend, prefixes, self.grid, self.time.now)
        self.doors = [DoorServer(self.time, door, self.backend) for door in self.world.doors]
        faults = self.world.faults
        self.faults = [
            SwitchService(self.time, self.backend, f"/faults/{name}", partial(faults.switch, name))
            for name in faults.by_name
        ]
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

    def grid(self) -> Grid:
        """Return the map of the world, created on first use."""
        if self._grid is None:
            self._grid = Grid(self.world.description)
        return self._grid

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
        for door in self.doors:
            door.publish()
        if self._map is not None:
            self._map.publish()

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
        for robot in self.robots:
            robot.close()
        for door in self.doors:
            door.close()
        if self._map is not None:
            self._map.close()
        for fault in self.faults:
            fault.close()
        self.robots, self.navigation, self.doors, self._map = [], [], [], None
        self.faults = []
