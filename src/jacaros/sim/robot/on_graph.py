"""A robot's access to the ROS graph, and the interfaces of its sensors and actuators.

A sensor is a class with `publish` and `close`, made from a `RobotOnGraph`.  To add one, write the class and list it in
`jacaros.sim.robot.node.SENSORS`.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol

from jacaros.ros.backend import Backend, Publisher, Sample, Subscription
from jacaros.ros.errors import UnknownInterface
from jacaros.ros.message import stamp
from jacaros.ros.qos import DEFAULT_QOS, QoS
from jacaros.sim.navigation.localisation import Localisation
from jacaros.sim.robot.robot import Robot
from jacaros.sim.world_time import WorldTime

TICKS_PER_SECOND = 20


@dataclass(frozen=True)
class RobotOnGraph:
    """A robot of the world with its access to a ROS graph.

    Attributes:
        time: the world on a clock.
        robot: robot of that world.
        backend: graph; already started.
        localisation: estimated pose.
    """

    time: WorldTime
    robot: Robot
    backend: Backend
    localisation: Localisation

    @property
    def prefix(self) -> str:
        """Prefix of the robot's topics."""
        namespace = self.robot.description.namespace
        return f"/{namespace}" if namespace else ""

    @property
    def frame_prefix(self) -> str:
        """Prefix of the robot's frames."""
        namespace = self.robot.description.namespace
        return f"{namespace}/" if namespace else ""

    def _name(self, topic: str) -> str:
        name = self.robot.description.interface.name_of(topic, self.prefix)
        if name is None:
            raise UnknownInterface(f"robots of this kind have no {topic}")
        return name

    def publisher(self, topic: str, type_name: str, qos: QoS = DEFAULT_QOS) -> Publisher:
        """Make a publisher under the robot's name for *topic*, reliable by default.

        Raises:
            UnknownInterface: the type is not installed, or the robot's kind does not have the topic.
        """
        return self.backend.publisher(self._name(topic), type_name, qos)

    def publisher_if_known(self, topic: str, type_name: str) -> Publisher | None:
        """Make a publisher; return None where the type is not installed, or for another kind of robot."""
        try:
            return self.publisher(topic, type_name)
        except UnknownInterface:
            return None

    def subscription_if_known(
        self, topic: str, type_name: str, callback: Callable[[Sample], None]
    ) -> Subscription | None:
        """Subscribe; return None where the type is not installed, or for another kind of robot."""
        try:
            return self.backend.subscription(self._name(topic), type_name, callback)
        except UnknownInterface:
            return None

    def fill_header(self, header: Any, frame: str) -> None:
        """Fill a header with the time of the world and a frame of the robot."""
        stamp(header.stamp, self.time.now())
        header.frame_id = self.frame_prefix + frame


class Sensor(Protocol):
    """A publisher of a robot's state or measurements."""

    def publish(self, ticks: int) -> None:
        """Publish if due at this 20 Hz tick, after the world has caught up."""

    def close(self) -> None:
        """Withdraw the topics."""


class Actuator(Protocol):
    """A device of a robot that is commanded through the graph."""

    def close(self) -> None:
        """Withdraw its interfaces."""
