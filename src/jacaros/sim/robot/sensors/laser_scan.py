"""The laser scan of a robot on its topic."""

from jacaros.ros.node import Publisher
from jacaros.sim.robot.on_graph import TICKS_PER_SECOND, RobotOnGraph

_TICKS_PER_SCAN = 4


class LaserSensor:
    """``/scan``: 5 Hz with subscribers, or always with ``publish: always``; not for robots without a laser."""

    def __init__(self, at: RobotOnGraph) -> None:
        self._at = at
        self._settings = at.robot.description.laser
        self._publisher = (
            at.publisher("/scan", "sensor_msgs/msg/LaserScan") if self._settings.enabled else None
        )

    def publish(self, ticks: int) -> None:
        """Publish if due."""
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
