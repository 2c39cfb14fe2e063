"""What a robot tells of itself and of what it senses: odometry, battery and laser scan.

A sensor is a class with `publish` and `close`; its place in the graph is a `RobotOnGraph`.  Another one is one class, and
one word in `jacaros.sim.robot_node.SENSORS`, the list of those that every robot has.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol

from jacaros.ros.backend import Backend, Publisher, Sample, Subscription
from jacaros.ros.errors import UnknownInterface
from jacaros.ros.message import constant, stamp
from jacaros.ros.qos import DEFAULT_QOS, QoS
from jacaros.sim.navigation.localisation import Localisation
from jacaros.sim.robot import Robot
from jacaros.sim.trigonometry import sine_cosine
from jacaros.sim.world_time import WorldTime

TICKS_PER_SECOND = 20
_TICKS_PER_SCAN = 4
_TICKS_PER_BATTERY = 20


@dataclass(frozen=True)
class RobotOnGraph:
    """A robot of the world and its place in a ROS graph.

    Attributes:
        time: the world, on a clock.
        robot: which of its robots.
        backend: the graph; it is started already.
        localisation: where the robot believes to be.
    """

    time: WorldTime
    robot: Robot
    backend: Backend
    localisation: Localisation

    @property
    def prefix(self) -> str:
        """What stands before the names of the robot's topics."""
        namespace = self.robot.description.namespace
        return f"/{namespace}" if namespace else ""

    @property
    def frame_prefix(self) -> str:
        """What stands before the names of its frames."""
        namespace = self.robot.description.namespace
        return f"{namespace}/" if namespace else ""

    def publisher(self, topic: str, type_name: str, qos: QoS = DEFAULT_QOS) -> Publisher:
        """Make a publisher below the robot's namespace; reliable: it serves subscriptions that ask for that, and others."""
        return self.backend.publisher(self.prefix + topic, type_name, qos)

    def publisher_if_known(self, topic: str, type_name: str) -> Publisher | None:
        """The same; None where the type is not installed, for robots of that kind are not used there."""
        try:
            return self.publisher(topic, type_name)
        except UnknownInterface:
            return None

    def subscription_if_known(
        self, topic: str, type_name: str, callback: Callable[[Sample], None]
    ) -> Subscription | None:
        """Hear a topic below the robot's namespace; None where the type is not installed."""
        try:
            return self.backend.subscription(self.prefix + topic, type_name, callback)
        except UnknownInterface:
            return None

    def fill_header(self, header: Any, frame: str) -> None:
        """Give a header the time of the world, and one of the robot's frames."""
        stamp(header.stamp, self.time.now())
        header.frame_id = self.frame_prefix + frame


class Sensor(Protocol):
    """Something that a robot tells the graph."""

    def publish(self, ticks: int) -> None:
        """Publish what is due at this tick of 20 Hz; the world has caught up."""

    def close(self) -> None:
        """Leave the topics."""


class Actuator(Protocol):
    """Something that a robot does when the graph asks for it."""

    def close(self) -> None:
        """Leave the graph."""


# Fields are assigned one by one: at twenty messages a second this is five times as fast as making nested messages from
# keywords, and the world's own steps are cheaper than those would be.


class OdometrySensor:
    """``/odom``: what the wheels did, 20 Hz."""

    def __init__(self, at: RobotOnGraph) -> None:
        self._at = at
        self._publisher = at.publisher("/odom", "nav_msgs/msg/Odometry")

    def publish(self, ticks: int) -> None:
        """Publish, if somebody listens."""
        del ticks
        if not self._publisher.subscription_count:
            return
        robot, odometry = self._at.robot, self._at.robot.odometry
        message = self._publisher.message()
        self._at.fill_header(message.header, "odom")
        message.child_frame_id = self._at.frame_prefix + "base_footprint"
        pose, twist = message.pose.pose, message.twist.twist
        pose.position.x, pose.position.y = odometry.x, odometry.y
        pose.orientation.z, pose.orientation.w = sine_cosine(0.5 * odometry.yaw)
        twist.linear.x, twist.angular.z = robot.speed, robot.turn_rate
        self._publisher.publish(message)

    def close(self) -> None:
        """Leave the topic."""
        self._publisher.close()


class BatterySensor:
    """``/battery_state``: 1 Hz, and when the robot begins or ends to charge."""

    def __init__(self, at: RobotOnGraph) -> None:
        self._robot, self._at = at.robot, at
        self._publisher = at.publisher("/battery_state", "sensor_msgs/msg/BatteryState")
        self._charging: tuple[bool, bool] | None = None

    def publish(self, ticks: int) -> None:
        """Publish what is due."""
        charging = (self._robot.battery.charging, self._robot.fed)
        if ticks % _TICKS_PER_BATTERY == 0 or charging != self._charging:
            self._charging = charging
            self._send()

    def _send(self) -> None:
        battery = self._robot.battery
        message = self._publisher.message()
        self._at.fill_header(message.header, "base_footprint")
        message.voltage, message.percentage = battery.voltage, battery.level / 100.0
        message.current = message.charge = message.capacity = message.design_capacity = float("nan")
        message.present = True
        message.power_supply_status = constant(message, f"POWER_SUPPLY_STATUS_{self._status()}")
        self._publisher.publish(message)

    def _status(self) -> str:
        if self._robot.battery.charging:
            return "CHARGING"
        return "FULL" if self._robot.fed else "DISCHARGING"

    def close(self) -> None:
        """Leave the topic."""
        self._publisher.close()


class LaserSensor:
    """``/scan``: 5 Hz when somebody listens, or always if the world file says so; nothing for a robot without a laser."""

    def __init__(self, at: RobotOnGraph) -> None:
        self._at = at
        self._settings = at.robot.description.laser
        self._publisher = (
            at.publisher("/scan", "sensor_msgs/msg/LaserScan") if self._settings.enabled else None
        )

    def publish(self, ticks: int) -> None:
        """Publish what is due."""
        publisher = self._publisher
        if publisher is None or ticks % _TICKS_PER_SCAN:
            return
        if self._settings.always or publisher.subscription_count:
            self._send(publisher)

    def _send(self, publisher: Publisher) -> None:
        world, name = self._at.time.world, self._at.robot.name
        laser = world.laser(name)
        message = publisher.message(ranges=world.scan(name))
        self._at.fill_header(message.header, "base_scan")
        message.angle_min, message.angle_max = laser.beams.angle_min, laser.beams.angle_max
        message.angle_increment = laser.beams.angle_increment
        message.scan_time = _TICKS_PER_SCAN / TICKS_PER_SECOND
        message.range_min, message.range_max = laser.settings.range_min, laser.settings.range_max
        publisher.publish(message)

    def close(self) -> None:
        """Leave the topic."""
        if self._publisher is not None:
            self._publisher.close()
