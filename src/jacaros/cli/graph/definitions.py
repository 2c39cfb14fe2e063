"""Definitions of types as people and mapping files need them: every path, its type and its unit."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from jacaros.ros.fields import DURATION, TIME, FieldType
from jacaros.ros.names import feedback_type, goal_type, request_type, response_type, result_type

Fields = Callable[[str], Mapping[str, FieldType]]
"""Gives the fields of a message type in full form."""

_LASER = "sensor_msgs/msg/LaserScan"
_BATTERY = "sensor_msgs/msg/BatteryState"
_RANGE = "sensor_msgs/msg/Range"
_FIX = "sensor_msgs/msg/NavSatFix"

_UNITS: Mapping[str, Mapping[str, str]] = {
    "geometry_msgs/msg/Point": {"x": "m", "y": "m", "z": "m"},
    "geometry_msgs/msg/Point32": {"x": "m", "y": "m", "z": "m"},
    "geometry_msgs/msg/Pose2D": {"x": "m", "y": "m", "theta": "rad"},
    "geometry_msgs/msg/Twist": {"linear": "m/s", "angular": "rad/s"},
    "geometry_msgs/msg/Accel": {"linear": "m/s²", "angular": "rad/s²"},
    "geometry_msgs/msg/Wrench": {"force": "N", "torque": "N m"},
    "geometry_msgs/msg/Transform": {"translation": "m"},
    _LASER: {
        **dict.fromkeys(("angle_min", "angle_max", "angle_increment"), "rad"),
        **dict.fromkeys(("time_increment", "scan_time"), "s"),
        **dict.fromkeys(("range_min", "range_max", "ranges"), "m"),
    },
    _RANGE: {"field_of_view": "rad", "min_range": "m", "max_range": "m", "range": "m"},
    _BATTERY: {
        **dict.fromkeys(("voltage", "cell_voltage"), "V"),
        **dict.fromkeys(("temperature", "cell_temperature"), "°C"),
        "current": "A",
        **dict.fromkeys(("charge", "capacity", "design_capacity"), "Ah"),
        "percentage": "0 to 1",
    },
    "sensor_msgs/msg/Imu": {"angular_velocity": "rad/s", "linear_acceleration": "m/s²"},
    "sensor_msgs/msg/MagneticField": {"magnetic_field": "T"},
    "sensor_msgs/msg/Temperature": {"temperature": "°C"},
    "sensor_msgs/msg/FluidPressure": {"fluid_pressure": "Pa"},
    "sensor_msgs/msg/RelativeHumidity": {"relative_humidity": "0 to 1"},
    "sensor_msgs/msg/Illuminance": {"illuminance": "lx"},
    "sensor_msgs/msg/JointState": {"position": "rad or m", "velocity": "rad/s or m/s", "effort": "N m or N"},
    _FIX: {"latitude": "degrees", "longitude": "degrees", "altitude": "m"},
    "nav_msgs/msg/MapMetaData": {"resolution": "m"},
    "nav2_msgs/action/NavigateToPose_Feedback": {"distance_remaining": "m"},
    "nav2_msgs/action/NavigateThroughPoses_Feedback": {"distance_remaining": "m"},
    "irobot_create_msgs/action/DriveDistance_Goal": {"distance": "m", "max_translation_speed": "m/s"},
    "irobot_create_msgs/action/DriveDistance_Feedback": {"remaining_travel_distance": "m"},
    "irobot_create_msgs/action/RotateAngle_Goal": {"angle": "rad", "max_rotation_speed": "rad/s"},
    "irobot_create_msgs/action/RotateAngle_Feedback": {"remaining_angle_travel": "rad"},
}
"""Units of fields, from the comments of the definitions and REP 103; a vector's parts have the unit of the vector."""


@dataclass(frozen=True, slots=True)
class Leaf:
    """A value in a message that is no message itself.

    Attributes:
        path: from the root, as mapping files write it; of the elements of an array, those of the first.
        type: of the value.
        unit: empty where there is none, or it is not known.
    """

    path: str
    type: FieldType
    unit: str = ""


def leaves(fields: Fields, type_name: str, path: str = "", unit: str = "") -> Iterator[Leaf]:
    """All values of a message type, in the order of its definition; raises `UnknownInterface`."""
    for name, kind in fields(type_name).items():
        here = f"{path}.{name}" if path else name
        own = unit_of(type_name, name) or unit
        if not kind.is_message:
            yield Leaf(here, kind, own)
        elif is_time(kind):
            yield Leaf(here, kind, "s")
        else:
            yield from leaves(fields, kind.base, f"{here}[0]" if kind.array else here, own)


def unit_of(type_name: str, field: str) -> str:
    """The unit of a field; empty where there is none, or it is not known."""
    return _UNITS.get(type_name, {}).get(field, "")


def is_time(kind: FieldType) -> bool:
    """Whether a field is a time or duration: agents and mappings see seconds."""
    return kind.base in (TIME, DURATION)


def parts(type_name: str) -> dict[str, str]:
    """The message types of an interface by what they are: of a message itself, of a service request and response."""
    kind = type_name.split("/")[1]
    if kind == "srv":
        return {"request": request_type(type_name), "response": response_type(type_name)}
    if kind == "action":
        return {
            "goal": goal_type(type_name),
            "result": result_type(type_name),
            "feedback": feedback_type(type_name),
        }
    return {"message": type_name}


def value_at(message: Any, path: str) -> Any:
    """What stands at a path of `leaves`; None below an empty array."""
    for step in path.split("."):
        name, bracket, _ = step.partition("[")
        message = getattr(message, name)
        if bracket:
            if not len(message):
                return None
            message = message[0]
    return message
