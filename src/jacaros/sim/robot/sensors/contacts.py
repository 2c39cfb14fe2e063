"""Bumpers, cliffs and docks, in the message types of the robots that have these sensors.

Nothing is computed without subscribers.
"""

import math
from typing import Any

from jacaros.ros.message import constant
from jacaros.sim.navigation.laser_perception import hidden
from jacaros.sim.robot.on_graph import RobotOnGraph
from jacaros.sim.robot.sensors.cliffs import sees_cliff

_TICKS_PER_HAZARD = 2
_TICKS_PER_DOCK = 10
_TICKS_PER_CORE = 10
_DOCK_SEEN_FROM = 2.0
_WHEEL_RADIUS = 0.033
_TICKS_PER_TURN = 4096
_HALF_TRACK = 0.08
_BUMPERS = {"left": "bump_left", "front": "bump_front_center", "right": "bump_right"}
"""Frames of the Create 3's bumper zones; there is no zone at the back."""
_CLIFFS = {
    "cliff_side_left": 60.0,
    "cliff_front_left": 15.0,
    "cliff_front_right": -15.0,
    "cliff_side_right": -60.0,
}
"""Frames of its cliff sensors, with their bearings in degrees from straight ahead."""
_WHEELS = ("wheel_drop_left", "wheel_drop_right")
_KOBUKI = {"left": "LEFT", "front": "CENTER", "right": "RIGHT"}
_TOPICS = (
    ("/hazard_detection", "irobot_create_msgs/msg/HazardDetectionVector"),  # TurtleBot 4, 10 Hz
    ("/dock_status", "irobot_create_msgs/msg/DockStatus"),  # TurtleBot 4, 2 Hz
    ("/sensor_state", "turtlebot3_msgs/msg/SensorState"),  # TurtleBot 3, 20 Hz
    ("/mobile_base/events/bumper", "kobuki_msgs/msg/BumperEvent"),  # TurtleBot 2, on changes
    ("/mobile_base/sensors/core", "kobuki_msgs/msg/SensorState"),  # TurtleBot 2, 2 Hz
)


class RobotContacts:
    """The bumper and dock topics of one robot."""

    def __init__(self, at: RobotOnGraph) -> None:
        self._at, self._time, self._robot = at, at.time, at.robot
        self._hazards, self._dock, self._state, self._bumper, self._core = (
            at.publisher(topic, type_name, optional=True) for topic, type_name in _TOPICS
        )
        self._pressed: frozenset[str] = frozenset()
        self._docked: bool | None = None

    def publish(self, ticks: int) -> None:
        """Publish if due at this tick of 20 Hz."""
        pressed = frozenset(self._robot.contacts.values()) - {""}
        if self._hazards.subscription_count and (ticks % _TICKS_PER_HAZARD == 0 or pressed != self._pressed):
            self._publish_hazards(self._hazards, pressed)
        if self._state.subscription_count:
            self._publish_state(self._state, pressed)
        if pressed != self._pressed:
            if self._bumper.subscription_count:
                self._publish_bumpers(self._bumper, pressed)
            self._pressed = pressed
        docked = self._robot.dock is not None
        if self._dock.subscription_count and (ticks % _TICKS_PER_DOCK == 0 or docked != self._docked):
            self._publish_dock(self._dock, docked)
        self._docked = docked
        if self._core.subscription_count and ticks % _TICKS_PER_CORE == 0:
            self._publish_core(self._core, docked)

    def _publish_core(self, publisher: Any, docked: bool) -> None:
        """Publish a Kobuki's battery in tenths of a volt: 13.2 V is empty, 16.5 V full, and it never reads full before."""
        battery = self._robot.battery
        message = publisher.message(battery=math.floor(132.0 + 0.33 * battery.level + 1e-6))
        state = (
            "DOCKING_CHARGING"
            if battery.charging
            else "DOCKING_CHARGED"
            if self._robot.fed
            else "DISCHARGING"
        )
        message.charger = constant(message, state)
        self._at.fill_header(message.header, "base_link")
        publisher.publish(message)

    def _publish_hazards(self, publisher: Any, pressed: frozenset[str]) -> None:
        detections = [self._hazard("BUMP", _BUMPERS[side]) for side in sorted(pressed & _BUMPERS.keys())]
        cliffs = self._time.world.description.cliffs
        for frame, degrees in _CLIFFS.items():
            if sees_cliff(self._robot, degrees, cliffs):
                detections.append(self._hazard("CLIFF", frame))
        if self._robot.fallen:
            detections += [self._hazard("WHEEL_DROP", frame) for frame in _WHEELS]
        message = publisher.message(detections=detections)
        self._at.fill_header(message.header, "base_link")
        publisher.publish(message)

    def _hazard(self, kind: str, frame: str) -> Any:
        hazard = self._at.backend.message("irobot_create_msgs/msg/HazardDetection")
        self._at.fill_header(hazard.header, frame)
        hazard.type = constant(hazard, kind)
        return hazard

    def _publish_dock(self, publisher: Any, docked: bool) -> None:
        message = publisher.message(is_docked=docked, dock_visible=docked or self._sees_dock())
        self._at.fill_header(message.header, "base_link")
        publisher.publish(message)

    def _sees_dock(self) -> bool:
        robot, world = self._robot, self._time.world.description
        for dock in world.docks:
            dx, dy = dock.pose.x - robot.x, dock.pose.y - robot.y
            if dx * dx + dy * dy <= _DOCK_SEEN_FROM * _DOCK_SEEN_FROM and not hidden(
                self._time.world.segments, robot.x, robot.y, dock.pose.x, dock.pose.y
            ):
                return True
        return False

    def _publish_state(self, publisher: Any, pressed: frozenset[str]) -> None:
        message = publisher.message()
        self._at.fill_header(message.header, "base_link")
        forward = bool(pressed - {"back"})
        message.bumper = forward * constant(message, "BUMPER_FORWARD")
        message.bumper += ("back" in pressed) * constant(message, "BUMPER_BACKWARD")
        message.battery = self._robot.battery.voltage
        message.torque = True
        odometry = self._robot.odometry
        per_metre = _TICKS_PER_TURN / (2.0 * math.pi * _WHEEL_RADIUS)
        message.left_encoder = _int32((odometry.rolled - odometry.turned * _HALF_TRACK) * per_metre)
        message.right_encoder = _int32((odometry.rolled + odometry.turned * _HALF_TRACK) * per_metre)
        publisher.publish(message)

    def _publish_bumpers(self, publisher: Any, pressed: frozenset[str]) -> None:
        for side in sorted((pressed ^ self._pressed) & _KOBUKI.keys()):
            message = publisher.message()
            message.bumper = constant(message, _KOBUKI[side])
            message.state = constant(message, "PRESSED" if side in pressed else "RELEASED")
            publisher.publish(message)


def _int32(value: float) -> int:
    return (math.floor(value) + 0x80000000) % 0x100000000 - 0x80000000
