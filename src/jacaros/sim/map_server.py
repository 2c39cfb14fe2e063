"""The map of the world, on ``/map`` and as a service."""

from collections.abc import Callable, Iterable
from typing import Any

from jacaros.ros.backend import Backend
from jacaros.ros.errors import UnknownInterface
from jacaros.ros.message import stamp
from jacaros.ros.node import Publisher
from jacaros.ros.qos import QoS
from jacaros.ros.services import Service
from jacaros.sim.navigation.frames import MAP
from jacaros.sim.navigation.grid import Grid

LATCHED = QoS(durability="transient_local", depth=1)
_GRID = "nav_msgs/msg/OccupancyGrid"
_SERVICE = "nav_msgs/srv/GetMap"


class MapServer:
    """Publishes the map at the first subscription.

    Topics ``/map`` and, for robots with a namespace, ``/robot_1/map`` (``nav_msgs/msg/OccupancyGrid``, latched); service
    ``/map_server/map`` (on ROS 1 ``/static_map``, ``nav_msgs/srv/GetMap``).

    Args:
        backend: graph; already started.
        prefixes: prefixes of the robots' names.
        grid: returns the grid; called on first use.
        now: returns the stamp of the map, in seconds.
    """

    def __init__(
        self, backend: Backend, prefixes: Iterable[str], grid: Callable[[], Grid], now: Callable[[], float]
    ) -> None:
        self._backend, self._grid, self._now = backend, grid, now
        self._message: Any = None
        names = dict.fromkeys(["/map", *(f"{prefix}/map" for prefix in prefixes)])
        self._publishers: list[Publisher] = [backend.publisher(name, _GRID, LATCHED) for name in names]
        self._unpublished = list(self._publishers)
        self._service = self._serve()

    def _serve(self) -> Service | None:
        name = "/static_map" if self._backend.ros_version == 1 else "/map_server/map"
        try:
            return self._backend.service(name, _SERVICE, lambda request: {"map": self.map()})
        except UnknownInterface:
            return None

    def publish(self) -> None:
        """Publish on topics with a first subscription."""
        for publisher in tuple(self._unpublished):
            if publisher.subscription_count:
                self._unpublished.remove(publisher)
                publisher.publish(self.map())

    def map(self) -> Any:
        """Return the map as a message."""
        if self._message is None:
            grid = self._grid()
            message = self._backend.message(_GRID, data=grid.occupancy())
            stamp(message.header.stamp, self._now())
            message.header.frame_id = MAP
            message.info.resolution = grid.resolution
            message.info.width, message.info.height = grid.width - 2, grid.height - 2
            stamp(message.info.map_load_time, self._now())
            message.info.origin.position.x, message.info.origin.position.y = grid.x_min, grid.y_min
            self._message = message
        return self._message

    def close(self) -> None:
        """Withdraw the topics and the service."""
        for publisher in self._publishers:
            publisher.close()
        if self._service is not None:
            self._service.close()
