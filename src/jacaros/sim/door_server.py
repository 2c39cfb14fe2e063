"""Doors in the ROS graph: a service that moves each door, and a topic with its state."""

from jacaros.ros.backend import Backend
from jacaros.ros.node import Publisher
from jacaros.ros.qos import QoS
from jacaros.sim.switch_service import SwitchService
from jacaros.sim.world_time import WorldTime

_LATCHED = QoS(durability="transient_local", depth=1)


class DoorServer:
    """One door.

    Service ``/doors/NAME/open`` (``std_srvs/srv/SetBool``: true opens, false closes; fails while a robot is in it), topic
    ``/doors/NAME/is_open`` (``std_msgs/msg/Bool``, latched).

    Args:
        time: the world on a clock.
        name: name of the door.
        backend: graph; already started.
    """

    def __init__(self, time: WorldTime, name: str, backend: Backend) -> None:
        self._time, self._name = time, name
        self._published: bool | None = None
        self._publisher: Publisher = backend.publisher(
            f"/doors/{name}/is_open", "std_msgs/msg/Bool", _LATCHED
        )
        self._service = SwitchService(time, backend, f"/doors/{name}/open", self._move)

    def _move(self, opened: bool) -> str | None:
        world = self._time.world
        stuck = world.stuck_doors.get(self._name)
        if stuck is not None and world.doors[self._name] != opened and stuck():
            return f"the door '{self._name}' is stuck"
        problem = world.move_door(self._name, opened)
        self.publish()
        return problem

    def publish(self) -> None:
        """Publish the state of the door if it has changed."""
        now = self._time.world.doors[self._name]
        if now is not self._published:
            self._published = now
            self._publisher.publish(self._publisher.message(data=now))

    def close(self) -> None:
        """Withdraw the topic and the service."""
        self._publisher.close()
        self._service.close()
