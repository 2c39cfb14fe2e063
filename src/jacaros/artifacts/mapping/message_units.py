"""Units of the fields of messages, which definitions do not contain in machine-readable form."""

from collections.abc import Mapping

from jacaros.artifacts.mapping.declared import Conversion, Path, WrongPath
from jacaros.artifacts.mapping.interfaces import Interfaces
from jacaros.artifacts.mapping.read_fields import ANGLES, SYMBOLS, UNITS, units_of
from jacaros.ros.fields import FieldType
from jacaros.ros.message import TIMES

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
"""Units of fields, from the comments of the definitions and REP 103; the parts of a vector have its unit."""


def words_of(unit: str) -> str:
    """Return the name of a unit of messages; of alternatives, all names."""
    return " or ".join(SYMBOLS[each].words for each in unit.split(" or "))


def unit_of(type_name: str, field: str) -> str:
    """Return the unit of a field; empty if none exists, or it is unknown."""
    return _UNITS.get(type_name, {}).get(field, "")


def unit_at(path: Path, root: FieldType, interfaces: Interfaces) -> str:
    """Return the unit at an existing path; the parts of a vector have its unit."""
    here, unit = root, ""
    for step in path.steps:
        if isinstance(step, str) and step.startswith("."):
            unit = unit_of(here.base, step[1:]) or unit
            here = interfaces.fields(here.base)[step[1:]]
        else:
            here = FieldType(here.base)
    return "s" if here.base in TIMES else unit


def _kinds(unit: str) -> set[str]:
    """Return the possible kinds of values in a message unit: angle and length for "rad or m", none for volts."""
    return {SYMBOLS[each].kind for each in unit.split(" or ")} - {""}


def check_unit(conversion: Conversion, path: Path, root: FieldType, interfaces: Interfaces) -> None:
    """Reject a unit that the value of a message cannot have.

    Raises:
        WrongPath: the message uses a unit of another kind.
    """
    if not conversion.unit or conversion.knows_message_unit or conversion.kind in ANGLES:
        return
    there = unit_at(path, root, interfaces)
    if there == conversion.unit:
        raise WrongPath(f"messages already have `{path.text}` in {there}", "leave `unit` out")
    kinds, wanted = _kinds(there), UNITS[conversion.unit].kind
    if not there or wanted in kinds:
        return
    listed = ", ".join(units_of(*kinds))
    units = f"units of {' and '.join(sorted(kinds))} are {listed}; or" if kinds else "leave `unit` out, or"
    raise WrongPath(
        f"messages have `{path.text}` in {there}, but {conversion.unit} is a unit of {wanted}",
        f"{units} write the unit of the message: message_unit: ...",
    )
