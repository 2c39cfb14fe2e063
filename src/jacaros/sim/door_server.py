"""The doors of the world in the graph: a service that moves each, and a topic that tells how it is."""

from collections.abc import Mapping
from typing import Any

from jacaros.ros.backend import Backend, Publisher, Service
from jacaros.ros.errors import UnknownInterface
from jacaros.ros.qos import QoS
from jacaros.sim.world_time import WorldTime

_LATCHED = QoS(durability="transient_local", depth=1)


class DoorServer:
    """One door.

    Service ``/doors/NAME/open`` (``std_srvs/srv/SetBool``: true opens, false closes; refused while a robot is in it), topic
    ``/doors/NAME/is_open`` (``std_msgs/msg/Bool``, latched).

    Args:
        time: the world, on a clock.
        name: of the door.
        backend: the graph; it is started already.
    """

    def __init__(self, time: WorldTime, name: str, backend: Backend) -> None:
        self._time, self._name = time, name
        self._told: bool | None = None
        self._publisher: Publisher = backend.publisher(
            f"/doors/{name}/is_open", "std_msgs/msg/Bool", _LATCHED
        )
        self._service: Service | None = None
        try:
            self._service = backend.service(f"/doors/{name}/open", "std_srvs/srv/SetBool", self._move)
        except UnknownInterface:
            backend.rosout("warn", f"door {name} cannot be moved: std_srvs/srv/SetBool is not known here")

    def _move(self, request: Any) -> Mapping[str, Any]:
        self._time.catch_up()
        problem = self._time.world.move_door(self._name, bool(request.data))
        self.publish()
        return {"success": problem is None, "message": problem or ""}

    def publish(self) -> None:
        """Tell how the door is, if that is news."""
        now = self._time.world.doors[self._name]
        if now is not self._told:
            self._told = now
            self._publisher.publish(self._publisher.message(data=now))

    def close(self) -> None:
        """Leave the topic and the service."""
        self._publisher.close()
        if self._service is not None:
            self._service.close()
