"""The topics that a robot publishes: odometry, battery, laser, bumpers, cliffs, docks and recognised objects.

To add one, write a function that fills its message, and list it in `SENSORS`.
"""

import math
from collections.abc import Mapping, Sequence
from typing import Any, Final

from jacaros.robots.plane.shapes import Segment
from jacaros.robots.plane.trigonometry import radians, sine_cosine
from jacaros.robots.ros.message import constant
from jacaros.robots.world.graph.frames import AmclPose, RobotTransforms
from jacaros.robots.world.graph.on_graph import TICKS_PER_SECOND, RobotOnGraph
from jacaros.robots.world.graph.publishing import Sensor, Tick, events, sensor


# Fields are assigned one by one: at 20 messages per second this is five times as fast as nested messages made from
# keywords, which would cost more than the steps of the world.
def _odometry(at: RobotOnGraph, message: Any) -> None:
    robot, odometry = at.robot, at.robot.odometry
    message.child_frame_id = at.frame_prefix + "base_footprint"
    pose, twist = message.pose.pose, message.twist.twist
    pose.position.x, pose.position.y = odometry.x, odometry.y
    pose.orientation.z, pose.orientation.w = sine_cosine(0.5 * odometry.yaw)
    twist.linear.x, twist.angular.z = robot.speed, robot.turn_rate


def _charging(at: RobotOnGraph) -> str:
    if at.robot.battery.charging:
        return "CHARGING"
    return "FULL" if at.robot.fed else "DISCHARGING"


def _battery(at: RobotOnGraph, message: Any) -> None:
    battery = at.robot.battery
    message.voltage, message.percentage = battery.voltage, battery.level / 100.0
    message.current = message.charge = message.capacity = message.design_capacity = math.nan
    message.present = True
    message.power_supply_status = constant(message, f"POWER_SUPPLY_STATUS_{_charging(at)}")


_TICKS_PER_SCAN = 4


def _laser(at: RobotOnGraph) -> Tick:
    settings = at.robot.description.laser
    described = sensor(
        "/scan",
        "sensor_msgs/msg/LaserScan",
        _scan,
        _TICKS_PER_SCAN,
        fields=lambda at: {"ranges": at.time.world.scan(at.robot.name)},
        frame="base_scan",
        always=settings.always,
    )
    return described(at) if settings.enabled else bool


def _scan(at: RobotOnGraph, message: Any) -> None:
    laser = at.time.world.lasers[at.robot.name]
    message.angle_min, message.angle_max = laser.angle_min, laser.angle_max
    message.angle_increment = laser.angle_increment
    message.scan_time = _TICKS_PER_SCAN / TICKS_PER_SECOND
    message.range_min, message.range_max = laser.settings.range_min, laser.settings.range_max


RECOGNISED_WITHIN = 4.0
"""Distance up to which objects are recognised, in metres."""
_SINE, _COSINE = sine_cosine(radians(30.0))
"""Of half the field of view of the camera that recognises them."""


def _recognised(at: RobotOnGraph) -> Mapping[str, Any]:
    """The objects in front of the robot, as a vision program names them to the original JaCaROS.

    ``cup,0.30,-0.10,0.00`` is name, metres ahead, left and up.
    """
    robot, world, frame = at.robot, at.time.world, at.robot.placement
    seen = []
    for each in world.objects.by_name.values():
        x, y = each.place
        ahead, left = frame.local(x, y)
        in_view = 0.0 < ahead <= RECOGNISED_WITHIN and abs(left) * _COSINE <= ahead * _SINE
        if in_view and not Segment(robot.x, robot.y, x, y).crosses(*world.segments):
            seen.append(f"{each.name},{ahead:.2f},{left:.2f},0.00")
    return {"perception": seen}


def _pressed(at: RobotOnGraph) -> frozenset[str]:
    return frozenset(at.robot.contacts.values()) - {""}


def _kobuki_bumpers(at: RobotOnGraph) -> frozenset[str]:
    zones = {"left": "LEFT", "front": "CENTER", "right": "RIGHT"}
    return frozenset(zones[side] for side in at.robot.contacts.values() if side in zones)


def sees_cliff(at: RobotOnGraph, degrees: float) -> bool:
    """Return whether a sensor at the rim of the robot, *degrees* to the left of straight ahead, is over a cliff."""
    robot, cliffs = at.robot, at.time.world.description.cliffs
    if not cliffs or robot.fallen:
        return robot.fallen
    sine, cosine = sine_cosine(robot.yaw + radians(degrees))
    x, y = robot.x + robot.description.radius * cosine, robot.y + robot.description.radius * sine
    return any(cliff.contains(x, y) for cliff in cliffs)


_KOBUKI_CLIFFS: Final[Mapping[str, float]] = {"LEFT": 60.0, "CENTER": 0.0, "RIGHT": -60.0}
"""Bearings of a Kobuki's cliff sensors, in degrees from straight ahead."""


def _kobuki_cliffs(at: RobotOnGraph) -> frozenset[str]:
    return frozenset(side for side, degrees in _KOBUKI_CLIFFS.items() if sees_cliff(at, degrees))


def _dropped_wheels(at: RobotOnGraph) -> frozenset[str]:
    return frozenset(("LEFT", "RIGHT") if at.robot.wheels_drop else ())


_CREATE3_BUMPERS = {"left": "bump_left", "front": "bump_front_center", "right": "bump_right"}
"""Frames of the Create 3's bumper zones; there is no zone at the back."""
_CREATE3_CLIFFS = {
    "cliff_side_left": 60.0,
    "cliff_front_left": 15.0,
    "cliff_front_right": -15.0,
    "cliff_side_right": -60.0,
}
"""Frames of its cliff sensors, with their bearings in degrees from straight ahead."""
_CREATE3_WHEELS = ("wheel_drop_left", "wheel_drop_right")


def _hazards(at: RobotOnGraph) -> Mapping[str, Any]:
    hazards = [
        *(("BUMP", _CREATE3_BUMPERS[side]) for side in sorted(_pressed(at) & _CREATE3_BUMPERS.keys())),
        *(("CLIFF", frame) for frame, degrees in _CREATE3_CLIFFS.items() if sees_cliff(at, degrees)),
        *(("WHEEL_DROP", frame) for frame in (_CREATE3_WHEELS if at.robot.wheels_drop else ())),
    ]
    return {"detections": [_hazard(at, *each) for each in hazards]}


def _hazard(at: RobotOnGraph, kind: str, frame: str) -> Any:
    hazard = at.backend.message("irobot_create_msgs/msg/HazardDetection")
    at.fill_header(hazard.header, frame)
    hazard.type = constant(hazard, kind)
    return hazard


def _docked(at: RobotOnGraph) -> bool:
    return at.robot.dock is not None


def _dock(at: RobotOnGraph, message: Any) -> None:
    message.is_docked = _docked(at)
    message.dock_visible = _docked(at) or at.time.world.visible_dock(at.robot) is not None


_TICKS_PER_METRE = 4096 / (2.0 * math.pi * 0.033)
"""Of the encoders of a TurtleBot 3, whose wheels have a radius of 33 mm."""
_HALF_TRACK = 0.08


def _turtlebot3(at: RobotOnGraph, message: Any) -> None:
    pressed, odometry = _pressed(at), at.robot.odometry
    message.bumper = bool(pressed - {"back"}) * constant(message, "BUMPER_FORWARD")
    message.bumper += ("back" in pressed) * constant(message, "BUMPER_BACKWARD")
    message.battery = at.robot.battery.voltage
    message.torque = True
    message.left_encoder = _int32((odometry.rolled - odometry.turned * _HALF_TRACK) * _TICKS_PER_METRE)
    message.right_encoder = _int32((odometry.rolled + odometry.turned * _HALF_TRACK) * _TICKS_PER_METRE)


def _int32(value: float) -> int:
    return (math.floor(value) + 0x80000000) % 0x100000000 - 0x80000000


def _kobuki_core(at: RobotOnGraph, message: Any) -> None:
    """The battery in tenths of a volt: 13.2 V is empty, 16.5 V full, and it never reads full before."""
    message.battery = math.floor(132.0 + 0.33 * at.robot.battery.level + 1e-6)
    states = {"CHARGING": "DOCKING_CHARGING", "FULL": "DOCKING_CHARGED"}
    message.charger = constant(message, states.get(_charging(at), "DISCHARGING"))


SENSORS: Final[Sequence[Sensor]] = (
    sensor("/odom", "nav_msgs/msg/Odometry", _odometry, frame="odom"),
    lambda at: RobotTransforms(at).publish,
    lambda at: AmclPose(at).publish,
    # Of a TurtleBot 4, 3 and 2:
    sensor(
        "/hazard_detection",
        "irobot_create_msgs/msg/HazardDetectionVector",
        every=2,
        fields=_hazards,
        changed=lambda at: (_pressed(at), at.robot.wheels_drop),
        optional=True,
    ),
    sensor("/sensor_state", "turtlebot3_msgs/msg/SensorState", _turtlebot3, optional=True),
    events(
        "/mobile_base/events/bumper",
        "kobuki_msgs/msg/BumperEvent",
        _kobuki_bumpers,
        "bumper",
        ("RELEASED", "PRESSED"),
    ),
    sensor("/dock_status", "irobot_create_msgs/msg/DockStatus", _dock, 10, changed=_docked, optional=True),
    sensor("/mobile_base/sensors/core", "kobuki_msgs/msg/SensorState", _kobuki_core, 10, optional=True),
    events(
        "/mobile_base/events/cliff",
        "kobuki_msgs/msg/CliffEvent",
        _kobuki_cliffs,
        "sensor",
        ("FLOOR", "CLIFF"),
    ),
    events(
        "/mobile_base/events/wheel_drop",
        "kobuki_msgs/msg/WheelDropEvent",
        _dropped_wheels,
        "wheel",
        ("RAISED", "DROPPED"),
    ),
    sensor(
        "/battery_state",
        "sensor_msgs/msg/BatteryState",
        _battery,
        20,
        frame="base_footprint",
        changed=_charging,
        always=True,
    ),
    _laser,
    sensor(
        "/jason/perception",
        "perception_msgs/msg/perception",
        every=10,
        fields=_recognised,
        frame="",
        optional=True,
    ),
)
"""Sensors of every robot, in publishing order."""
