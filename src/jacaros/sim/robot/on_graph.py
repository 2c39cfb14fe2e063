"""A robot's access to the ROS graph, and the interfaces of its sensors and actuators.

A sensor is a class with `publish`, made from a `RobotOnGraph`.  To add one, write the class and list it in
`jacaros.sim.robot.node.SENSORS`.
"""

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any, Protocol, TypeVar, cast

from jacaros.ros.backend import Backend
from jacaros.ros.errors import UnknownInterface
from jacaros.ros.message import stamp
from jacaros.ros.node import Closable, Publisher, Sample
from jacaros.ros.qos import DEFAULT_QOS, QoS
from jacaros.sim.navigation.localisation import Localisation
from jacaros.sim.robot.robot import Robot
from jacaros.sim.world_time import WorldTime

TICKS_PER_SECOND = 20


E = TypeVar("E", bound=Closable)


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
    _entities: list[Closable] = field(default_factory=list, init=False)

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

    def publisher(
        self, topic: str, type_name: str, qos: QoS = DEFAULT_QOS, optional: bool = False
    ) -> Publisher:
        """Make a publisher under the robot's name for *topic*, reliable by default, that closes with the robot.

        If the robot's kind does not have the topic, or the type of an *optional* one is not installed, it has no
        subscriptions, and nothing may be published.
        """
        name = self.robot.description.interface.name_of(topic, self.prefix)
        with suppress(*((UnknownInterface,) if optional else ())):
            if name is not None:
                return self.keep(self.backend.publisher(name, type_name, qos))
        return cast(Publisher, _Silent())

    def subscribe(self, topic: str, type_name: str, callback: Callable[[Sample], None]) -> None:
        """Subscribe, unless the type is not installed or the robot's kind does not have the topic."""
        name = self.robot.description.interface.name_of(topic, self.prefix)
        with suppress(UnknownInterface):
            if name is not None:
                self.keep(self.backend.subscription(name, type_name, callback))

    def keep(self, entity: E) -> E:
        """Close an entity of the graph with the robot; return it."""
        self._entities.append(entity)
        return entity

    def close(self) -> None:
        """Withdraw all interfaces of the robot."""
        for entity in self._entities:
            entity.close()

    def fill_header(self, header: Any, frame: str) -> None:
        """Fill a header with the time of the world and a frame of the robot."""
        stamp(header.stamp, self.time.now())
        header.frame_id = self.frame_prefix + frame


class _Silent:
    """Stands for the publisher of a topic that a robot does not have."""

    subscription_count = 0


class Sensor(Protocol):
    """A publisher of a robot's state or measurements."""

    def publish(self, ticks: int) -> None:
        """Publish if due at this 20 Hz tick, after the world has caught up."""
