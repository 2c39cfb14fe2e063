"""The fields of a message: paths with types and units, and the selection of fields for beliefs and parameters."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import zip_longest
from typing import Any

from jacaros.robots.mapping.interfaces import (
    Fields,
    Interfaces,
    chosen,
    constants,
    constants_by_field,
    unit_of,
    words_of,
)
from jacaros.robots.ros.fields import DURATION, FLOATS, INTEGER_RANGES, TIME, FieldType

HEADER = "std_msgs/msg/Header"
_LAYOUT = "std_msgs/msg/MultiArrayLayout"
_QUATERNION = "geometry_msgs/msg/Quaternion"
MANY = 6
"""Number of values in a belief."""

_FEW = 8
"""Number of constants named in a comment."""

_CHOSEN: Mapping[str, tuple[str, ...]] = {
    "geometry_msgs/msg/PoseWithCovariance": ("pose",),
    "geometry_msgs/msg/TwistWithCovariance": ("twist",),
    "geometry_msgs/msg/AccelWithCovariance": ("accel",),
    "nav_msgs/msg/Odometry": ("pose",),
    "sensor_msgs/msg/Imu": ("orientation", "angular_velocity"),
    "sensor_msgs/msg/Range": ("range",),
    "sensor_msgs/msg/NavSatFix": ("latitude", "longitude", "altitude"),
}
"""The essential fields of some types."""
_IN_THE_PLANE: Mapping[str, tuple[str, ...]] = {
    "geometry_msgs/msg/Pose": ("position", "orientation"),
    "geometry_msgs/msg/Point": ("x", "y"),
    "geometry_msgs/msg/Point32": ("x", "y"),
}
"""Fields for robots on wheels: the height is left out."""
_LEFT = (
    "behavior_tree",
    "controller_id",
    "planner_id",
    "goal_checker_id",
    "progress_checker_id",
    "number_of_loops",
    "goal_index",
    "variance",
)
"""Fields that keep their defaults: those of Nav2's goals, for which Nav2 then uses its configuration, and the variance of
sensors."""
_TURNS = ("angular", "angular_velocity")
"""Vectors of which only z can differ from zero on a robot on wheels."""


@dataclass(frozen=True, slots=True)
class Unit:
    """How to show values of a unit.

    Attributes:
        word: name of the unit in comments; empty if the unit is unknown.
        digits: number of significant decimals; None for values without decimals.
        band: dead band: smaller changes are ignored.
    """

    word: str = ""
    digits: int | None = None
    band: float = 0.0


_NO_NUMBER = Unit()
_DEGREES = Unit("degrees", 1, 1.0)
_DEGREES_PER_SECOND = Unit("degrees per second", 1, 1.0)
_PRECISION: Mapping[str, tuple[int, float]] = {
    "m": (2, 0.02),
    "s": (2, 0.0),
    "m/s": (2, 0.02),
    "V": (2, 0.02),
    "A": (2, 0.02),
    "°C": (1, 0.1),
    "degrees": (7, 0.00001),  # of latitude and longitude: a metre
    "Pa": (0, 1.0),
    "lx": (0, 1.0),
    "0 to 1": (2, 0.0),
}
"""Significant decimals and dead band by the unit of a message; other numbers have 3 decimals."""


def _shown(unit: str) -> Unit:
    """Return how to show values in a unit of messages; angles are shown in degrees."""
    if unit in ("rad", "rad/s"):
        return _DEGREES if unit == "rad" else _DEGREES_PER_SECOND
    digits, band = _PRECISION.get(unit, (3, 0.0))
    return Unit(words_of(unit), digits, band)


@dataclass(frozen=True, slots=True)
class GivenValue:
    """A value of a message, as read or given by an agent.

    Attributes:
        path: path in the message.
        name: name for agents, in lower case.
        conversion: further keys in the mapping file, such as ``as: yaw, unit: degrees``; empty for the plain value.
        unit: unit of the number.
        limits: for the comment: the names of the constants, or the longest string.
    """

    path: str
    name: str
    conversion: str = ""
    unit: Unit = _NO_NUMBER
    limits: str = ""

    @property
    def remark(self) -> str:
        """Return the comment at the end of the line."""
        return f"  # {self.limits}" if self.limits else ""

    @property
    def as_field(self) -> str:
        """Return the entry in the ``fields`` of a property."""
        digits = f"round: {self.unit.digits}" if self.unit.digits is not None else ""
        usual = "yaw" if "as: yaw" in self.conversion else self.path.rpartition(".")[2].lower()
        name = f"name: {self.name}" if self.name != usual else ""
        keys = ", ".join(filter(None, (self.conversion, digits, name)))
        return f"{{path: {quoted(self.path)}, {keys}}}" if keys else quoted(self.path)

    @property
    def as_value(self) -> str:
        """Return the value of a field in a message that an operation sends."""
        return f"{{value: ${self.name}, {self.conversion}}}" if self.conversion else f"${self.name}"


def quoted(path: str) -> str:
    """Return a path in the notation for brackets in YAML."""
    return f'"{path}"' if "[" in path else path


def values_of(types: Interfaces, type_name: str) -> list[GivenValue]:
    """Return the values of a message that agents need, without lists and headers. Raises `UnknownInterface`."""
    if is_time(FieldType(type_name)):
        return [GivenValue(".", "seconds", "", _shown("s"))]
    return _with_own_names(list(_walk(types, type_name, "", "")))


def lists_of(types: Interfaces, type_name: str) -> list[tuple[str, FieldType]]:
    """Return the list fields of a message."""
    return [(name, kind) for name, kind in types.fields(type_name).items() if kind.array]


def list_of(path: str, kind: FieldType) -> GivenValue:
    """Return a list of plain values as one value."""
    return GivenValue(
        path, path.rpartition(".")[2].lower(), "", Unit("a list", 3 if kind.base in FLOATS else None)
    )


def _walk(types: Interfaces, type_name: str, path: str, unit: str) -> Iterator[GivenValue]:
    chosen = _CHOSEN.get(type_name) or _IN_THE_PLANE.get(type_name)
    for name, kind in types.fields(type_name).items():
        here = f"{path}.{name}" if path else name
        own = unit_of(type_name, name) or unit  # parts of a vector have the unit of the vector
        if kind.array or kind.base in (HEADER, _LAYOUT) or (chosen and name not in chosen):
            continue
        if kind.base == _QUATERNION:
            yield GivenValue(here, "yaw", "as: yaw, unit: degrees", _DEGREES)
        elif kind.is_message and not is_time(kind):
            if type_name == "geometry_msgs/msg/Twist" and name == "linear":
                yield GivenValue(f"{here}.x", "speed", "", _shown("m/s"))
            elif name in _TURNS:
                yield GivenValue(f"{here}.z", "turn", "unit: degrees", _DEGREES_PER_SECOND)
            else:
                yield from _walk(types, kind.base, here, own)
        elif name not in _LEFT:
            yield _single(types, type_name, name, kind, here, own)


def _single(
    types: Interfaces, type_name: str, name: str, kind: FieldType, path: str, unit: str
) -> GivenValue:
    """Return the value of a plain field."""
    word = "yaw" if name == "theta" else name.lower()
    if is_time(kind):
        return GivenValue(path, word, "", _shown("s"))
    if kind.base in FLOATS:
        conversion = "unit: degrees" if unit in ("rad", "rad/s") else ""
        return GivenValue(path, word, conversion, _shown(unit))
    if kind.base in INTEGER_RANGES and name in constants_by_field(types, type_name):
        named = chosen(constants(types, type_name), name)
        if len(set(named.values())) == len(named):  # otherwise two constants name the same value
            limits = ", ".join(list(named)[:_FEW]) + ", ..." * (len(named) > _FEW)
            return GivenValue(path, word, "as: name", limits=limits)
    return GivenValue(path, word, limits=f"at most {kind.bound} characters" if kind.bound else "")


def _with_own_names(values: list[GivenValue]) -> list[GivenValue]:
    """Prefix equal names with the parts of their paths that differ: ``start_x``, ``end_x``."""
    longer = [_longer(value, [each for each in values if each.name == value.name]) for value in values]
    names = [value.name for value in longer]
    return [
        replace(value, name=value.path.replace(".", "_").lower()) if names.count(value.name) > 1 else value
        for value in longer
    ]


def _longer(value: GivenValue, alike: Sequence[GivenValue]) -> GivenValue:
    """Return a value, its name prefixed with the parts of its path that differ from *alike*."""
    paths = [each.path.split(".")[:-1] for each in alike]
    differ = [len(set(steps)) > 1 for steps in zip_longest(*paths)]
    own = [step for step, is_own in zip(value.path.split(".")[:-1], differ, strict=False) if is_own]
    return replace(value, name="_".join([*own, value.name]).lower())


@dataclass(frozen=True, slots=True)
class Leaf:
    """A plain value in a message.

    Attributes:
        path: path from the root, as in mapping files; for arrays, that of the first element.
        type: type of the value.
        unit: unit; empty if it has none or is unknown.
        owner: type of the message with this field.
    """

    path: str
    type: FieldType
    unit: str = ""
    owner: str = ""

    @property
    def name(self) -> str:
        """Last field of the path."""
        return self.path.rpartition(".")[2]


def leaves(fields: Fields, type_name: str, path: str = "", unit: str = "") -> Iterator[Leaf]:
    """Yield all plain values of a message type, in the order of its definition; raises `UnknownInterface`."""
    for name, kind in fields(type_name).items():
        here = f"{path}.{name}" if path else name
        own = unit_of(type_name, name) or unit
        if not kind.is_message:
            yield Leaf(here, kind, own, type_name)
        elif is_time(kind):
            yield Leaf(here, kind, "s")
        else:
            yield from leaves(fields, kind.base, f"{here}[0]" if kind.array else here, own)


def messages(fields: Fields, type_name: str) -> Iterator[str]:
    """Yield the type and the types of all nested messages, except times; raises `UnknownInterface`."""
    yield type_name
    for kind in fields(type_name).values():
        if kind.is_message and not is_time(kind):
            yield from messages(fields, kind.base)


def is_time(kind: FieldType) -> bool:
    """Return whether a field is a time or a duration, which agents and mappings see in seconds."""
    return kind.base in (TIME, DURATION)


_PARTS = {"srv": ("request", "response"), "action": ("goal", "result", "feedback")}


def parts(type_name: str) -> dict[str, str]:
    """Return the message types of an interface: the message, or request and response, or goal, result and feedback."""
    names = _PARTS.get(type_name.split("/")[1], ())
    return {name: f"{type_name}_{name.capitalize()}" for name in names} or {"message": type_name}


def value_at(message: Any, path: str) -> Any:
    """Return the value at a path from `leaves`; None below an empty array."""
    for step in path.split("."):
        name, bracket, _ = step.partition("[")
        message = getattr(message, name)
        if bracket:
            if not len(message):
                return None
            message = message[0]
    return message
