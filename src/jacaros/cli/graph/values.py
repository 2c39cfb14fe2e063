"""Which parts of a message are worth a place in a belief or among the parameters of an operation."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

from jacaros.cli.graph.definitions import Fields, is_time, unit_of
from jacaros.ros.fields import FieldType

HEADER = "std_msgs/msg/Header"
_QUATERNION = "geometry_msgs/msg/Quaternion"
MANY = 6
"""More values than this make no good belief."""

_CHOSEN: Mapping[str, tuple[str, ...]] = {
    "geometry_msgs/msg/PoseWithCovariance": ("pose",),
    "geometry_msgs/msg/TwistWithCovariance": ("twist",),
    "geometry_msgs/msg/AccelWithCovariance": ("accel",),
    "nav_msgs/msg/Odometry": ("pose",),
    "sensor_msgs/msg/Imu": ("orientation", "angular_velocity"),
}
"""Of some types a few fields say nearly all."""
_IN_THE_PLANE: Mapping[str, tuple[str, ...]] = {
    "geometry_msgs/msg/Pose": ("position", "orientation"),
    "geometry_msgs/msg/Point": ("x", "y"),
    "geometry_msgs/msg/Point32": ("x", "y"),
}
"""Robots on wheels: the height is left out."""
_LEFT = (
    "behavior_tree",
    "controller_id",
    "planner_id",
    "goal_checker_id",
    "progress_checker_id",
    "number_of_loops",
    "goal_index",
)
"""Fields of Nav2's goals that are better left as they are: it then takes what its configuration says."""
_TURNS = ("angular", "angular_velocity")
"""Vectors of a robot on wheels of which only z is not zero."""


@dataclass(frozen=True, slots=True)
class Value:
    """A value of a message, as an agent gets or gives it.

    Attributes:
        path: in the message.
        name: for agents, in lower case.
        conversion: further keys of the mapping file, such as ``as: yaw, unit: degrees``; empty for the plain value.
        unit: as a word for people; empty when it is not known.
    """

    path: str
    name: str
    conversion: str = ""
    unit: str = ""

    @property
    def as_field(self) -> str:
        """An entry of ``fields`` of a property."""
        return f"{{path: {self.path}, {self.conversion}}}" if self.conversion else self.path

    @property
    def as_value(self) -> str:
        """What stands behind the field of a message that an operation sends."""
        return f"{{value: ${self.name}, {self.conversion}}}" if self.conversion else f"${self.name}"


def values_of(fields: Fields, type_name: str, path: str = "") -> list[Value]:
    """The values of a message that agents want; lists and headers are left out.  Raises `UnknownInterface`."""
    return _with_own_names(list(_walk(fields, type_name, path)))


def lists_of(fields: Fields, type_name: str) -> list[tuple[str, FieldType]]:
    """The fields of a message that are lists."""
    return [(name, kind) for name, kind in fields(type_name).items() if kind.array]


def _walk(fields: Fields, type_name: str, path: str) -> Iterator[Value]:
    chosen = _CHOSEN.get(type_name) or _IN_THE_PLANE.get(type_name)
    for name, kind in fields(type_name).items():
        here = f"{path}.{name}" if path else name
        if kind.array or kind.base == HEADER or (chosen and name not in chosen):
            continue
        if kind.base == _QUATERNION:
            yield Value(here, "yaw", "as: yaw, unit: degrees", "degrees")
        elif kind.is_message and not is_time(kind):
            if type_name == "geometry_msgs/msg/Twist" and name == "linear":
                yield Value(f"{here}.x", "speed", "", "metres per second")
            elif name in _TURNS:
                yield Value(f"{here}.z", "turn", "unit: degrees", "degrees per second")
            else:
                yield from _walk(fields, kind.base, here)
        elif name not in _LEFT:
            unit = "s" if is_time(kind) else unit_of(type_name, name)
            angle = unit in ("rad", "rad/s")
            words = _WORDS.get(unit, "")
            yield Value(
                here,
                "yaw" if name == "theta" else name.lower(),
                "unit: degrees" if angle else "",
                words.replace("radians", "degrees") if angle else words,
            )


_WORDS = {
    "m": "metres",
    "s": "seconds",
    "m/s": "metres per second",
    "rad": "radians",
    "rad/s": "radians per second",
    "V": "volts",
    "A": "amperes",
    "°C": "degrees Celsius",
    "degrees": "degrees",
    "Pa": "pascals",
    "lx": "lux",
    "0 to 1": "0 to 1",
}


def _with_own_names(values: list[Value]) -> list[Value]:
    """Values of one name get that of the uppermost field in front: ``start_x``, ``end_x``; or all of the path."""
    for count in (1, None):
        names = [value.name for value in values]
        values = [_longer(value, count) if names.count(value.name) > 1 else value for value in values]
    return values


def _longer(value: Value, count: int | None) -> Value:
    """The same value, with the first *count* steps of its path in front of its name."""
    above = value.path.split(".")[:-1][:count]
    return replace(value, name="_".join([*above, value.name]).lower())
