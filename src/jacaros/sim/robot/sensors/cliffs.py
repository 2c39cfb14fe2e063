"""The cliff and wheel-drop sensors of a Kobuki (TurtleBot 2).

A Create 3 publishes cliffs on ``/hazard_detection`` instead, see `jacaros.sim.robot.sensors.contacts`.  Nothing is
computed without subscribers.
"""

from collections.abc import Mapping
from typing import Any, Final

from jacaros.plane.trigonometry import radians, sine_cosine
from jacaros.ros.message import constant
from jacaros.sim.description import Rectangle
from jacaros.sim.robot.on_graph import RobotOnGraph
from jacaros.sim.robot.robot import Robot

_SENSORS: Final[Mapping[str, float]] = {"LEFT": 60.0, "CENTER": 0.0, "RIGHT": -60.0}
"""Bearings of a Kobuki's cliff sensors, in degrees from straight ahead."""


def sees_cliff(robot: Robot, degrees: float, cliffs: tuple[Rectangle, ...]) -> bool:
    """Return whether a sensor at the rim of *robot*, *degrees* to the left of straight ahead, is over a cliff."""
    if not cliffs or robot.fallen:
        return robot.fallen
    sine, cosine = sine_cosine(robot.yaw + radians(degrees))
    x, y = robot.x + robot.description.radius * cosine, robot.y + robot.description.radius * sine
    return any(cliff.contains(x, y) for cliff in cliffs)


class CliffSensors:
    """The cliff and wheel drop events of one robot."""

    def __init__(self, at: RobotOnGraph) -> None:
        self._robot, self._cliffs = at.robot, at.time.world.description.cliffs
        self._cliff = at.publisher("/mobile_base/events/cliff", "kobuki_msgs/msg/CliffEvent", optional=True)
        self._drop = at.publisher(
            "/mobile_base/events/wheel_drop", "kobuki_msgs/msg/WheelDropEvent", optional=True
        )
        self._seen: frozenset[str] = frozenset()
        self._dropped = False

    def publish(self, ticks: int) -> None:
        """Publish changes."""
        del ticks
        if not self._cliffs:
            return
        if self._cliff.subscription_count:
            self._publish_cliffs(self._cliff)
        if self._robot.fallen and not self._dropped and self._drop.subscription_count:
            self._dropped = True
            for wheel in ("LEFT", "RIGHT"):
                message = self._drop.message()
                message.wheel, message.state = constant(message, wheel), constant(message, "DROPPED")
                self._drop.publish(message)

    def _publish_cliffs(self, publisher: Any) -> None:
        seen = frozenset(
            side for side, degrees in _SENSORS.items() if sees_cliff(self._robot, degrees, self._cliffs)
        )
        for side in sorted(seen ^ self._seen):
            message = publisher.message()
            message.sensor = constant(message, side)
            message.state = constant(message, "CLIFF" if side in seen else "FLOOR")
            publisher.publish(message)
        self._seen = seen
