"""Units of the fields of messages, which no definition tells to programs."""

from collections.abc import Mapping

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


def unit_of(type_name: str, field: str) -> str:
    """The unit of a field; empty where there is none, or it is not known."""
    return _UNITS.get(type_name, {}).get(field, "")
