"""All that one robot offers to be driven and docked by."""

from collections.abc import Callable, Sequence

from jacaros.ros.backend import Backend
from jacaros.sim.navigation.dock_servers import DockServers
from jacaros.sim.navigation.docking import Docking
from jacaros.sim.navigation.frames import Frames
from jacaros.sim.navigation.grid import Grid
from jacaros.sim.navigation.localisation import Localisation
from jacaros.sim.navigation.nav2_servers import NavigationServers
from jacaros.sim.navigation.navigator import Navigator
from jacaros.sim.navigation.offers import Offers
from jacaros.sim.navigation.placement import Point
from jacaros.sim.navigation.planner import Planner
from jacaros.sim.navigation.wheels import Wheels
from jacaros.sim.robot.robot import Robot
from jacaros.sim.world_time import WorldTime


class RobotNavigation:
    """The navigation and docking servers of one robot: Nav2's and Create 3's on ROS 2, move_base's and the Kobuki's
    on ROS 1, all of them on the memory graph.

    Args:
        time: the world, on a clock.
        robot: which of its robots.
        localisation: where it believes to be.
        backend: the graph; it is started already.
        grid: makes the grid of the world, when it is first wanted.

    Attributes:
        name: of the robot.
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
        prefix = f"/{namespace}" if namespace else ""
        self.name = robot.name
        self._wheels = Wheels(backend, f"{prefix}/cmd_vel", time.clock)
        self._navigator = navigator = Navigator(
            time, robot, localisation, self._wheels, lambda: Planner(grid(), robot.description.radius)
        )
        frames = Frames(backend, namespace, localisation)
        self._offers = Offers(backend, prefix)
        self._servers = NavigationServers(navigator, frames, self._offers)
        docks = DockServers(Docking(navigator), frames, self._offers)
        if backend.ros_version == 2:
            self._servers.offer_nav2()
            docks.offer_nav2()
            docks.offer_create3()
        if backend.ros_version == 1 or backend.name == "memory":
            self._servers.offer_move_base()
            docks.offer_kobuki()

    @property
    def path(self) -> Sequence[Point]:
        """The points of the path that the robot follows now, in metres on the map; empty without a goal."""
        return self._navigator.path

    def close(self) -> None:
        """Withdraw all servers, and stop the robot."""
        self._offers.close()
        self._servers.close()
        self._wheels.close()
