"""The navigation and docking servers of one robot."""

from collections.abc import Callable, Sequence

from jacaros.plane.pose import Point
from jacaros.ros.backend import Backend
from jacaros.sim.navigation.dock_servers import DockServers
from jacaros.sim.navigation.docking import Docking
from jacaros.sim.navigation.frames import Frames
from jacaros.sim.navigation.grid import Grid
from jacaros.sim.navigation.localisation import Localisation
from jacaros.sim.navigation.nav2_servers import NavigationServers
from jacaros.sim.navigation.navigator import Navigator
from jacaros.sim.navigation.planner import Planner
from jacaros.sim.navigation.servers import Servers
from jacaros.sim.navigation.wheels import Wheels
from jacaros.sim.robot.robot import Robot
from jacaros.sim.world_time import WorldTime


class RobotNavigation:
    """The servers of one robot: Nav2's and Create 3's on ROS 2, move_base's and the Kobuki's on ROS 1, all of them on the
    memory graph.

    Args:
        time: the world on a clock.
        robot: robot of that world.
        localisation: estimated pose.
        backend: graph; already started.
        grid: creates the grid of the world; called on first use.

    Attributes:
        name: name of the robot.
    """

    def __init__(
        self,
        time: WorldTime,
        robot: Robot,
        localisation: Localisation,
        backend: Backend,
        grid: Callable[[], Grid],
    ) -> None:
        namespace = robot.description.namespace
        self.name = robot.name
        self._servers = Servers(backend, robot.description)
        self._wheels = Wheels(backend, self._servers.name("/cmd_vel") or "/cmd_vel", time.clock)
        self._navigator = navigator = Navigator(
            time, robot, localisation, self._wheels, lambda: Planner(grid(), robot.description.radius)
        )
        frames = Frames(backend, namespace, localisation)
        self._navigation = NavigationServers(navigator, frames, self._servers)
        docks = DockServers(Docking(navigator), frames, self._servers)
        if backend.ros_version == 2:
            self._navigation.offer_nav2()
            docks.offer_nav2()
            docks.offer_create3()
        if backend.ros_version == 1 or backend.name == "memory":
            self._navigation.offer_move_base()
            docks.offer_kobuki()

    @property
    def path(self) -> Sequence[Point]:
        """Points of the current path, in metres on the map; empty without a goal."""
        return self._navigator.path

    def close(self) -> None:
        """Withdraw all servers, and stop the robot."""
        self._servers.close()
        self._navigation.close()
        self._wheels.close()
