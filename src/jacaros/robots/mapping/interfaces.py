"""Message types: their fields, paths through them, constants and units."""

import keyword
import re
from collections.abc import Callable, Mapping
from functools import lru_cache
from pathlib import Path as FilePath
from typing import Any, TypeVar

from jacaros.robots.mapping.fields import (
    ALL,
    ANGLES,
    HERE,
    SYMBOLS,
    UNITS,
    Conversion,
    FieldPath,
    FilePosition,
    PathStep,
    WrongPath,
    units_of,
)
from jacaros.robots.ros.errors import MessageMismatch, UnknownInterface
from jacaros.robots.ros.fields import FLOATS, INTEGER_RANGES, FieldType
from jacaros.robots.ros.interfaces import BUILT_IN, installed
from jacaros.robots.ros.message import TIMES
from jacaros.robots.ros.node import Node
from jacaros.robots.ros.typestore import DefinitionSchema, stored_types
from jacaros.runtime.files.texts import suggestion
from jacaros.runtime.files.yaml import Problem

T = TypeVar("T")
_CONSTANT = re.compile(r"[A-Z][A-Z0-9_]*")


class StoredInterfaces:
    """The definitions of the package and of this machine, for checks without a middleware."""

    def __init__(self, folders: tuple[FilePath, ...] = ()) -> None:
        self._factory = DefinitionSchema((*folders, *installed()))

    def fields(self, type_name: str) -> Mapping[str, FieldType]:
        """Return the fields of a type, also of parts such as ``pkg/srv/Name_Request``. Raises `UnknownInterface`."""
        return self._factory.fields(type_name)

    def message(self, type_name: str, /, **fields: Any) -> Any:
        """Make a message. Raises `UnknownInterface`, `MessageMismatch`."""
        return self._factory.make(type_name, fields)


Interfaces = Node | StoredInterfaces
"""What describes and makes messages."""


@lru_cache(maxsize=8)
def stored_interfaces(folders: tuple[FilePath, ...] = ()) -> StoredInterfaces:
    """Return the shared instance for *folders* of further definitions; it caches what it has read."""
    return StoredInterfaces(folders)


def constants(interfaces: Interfaces, type_name: str) -> dict[str, object]:
    """Return the constants of a message type by name, also those of the parts of services and actions."""
    kind = type(interfaces.message(type_name))
    return {
        name: value
        for name, value in vars(kind).items()
        if _CONSTANT.fullmatch(name)
        and "__" not in name
        and isinstance(value, bool | int | float | str | bytes)
    }


_SMALL = ("byte", "char", "int8", "uint8")
"""Types of fields that hold one of a few constants."""


def constants_by_field(interfaces: Interfaces, type_name: str) -> dict[str, dict[str, object]]:
    """Return the constants of a message type by the field whose values they name; those without a field under ``""``.

    A constant belongs to the field whose name is its prefix. If the type has a single integer field, and that has 8
    bits, all other constants belong to it, provided that no two have the same value.
    """
    fields = interfaces.fields(type_name)
    longest = sorted(fields, key=len, reverse=True)
    found: dict[str, dict[str, object]] = {}
    for name, value in constants(interfaces, type_name).items():
        owners = (field for field in longest if name.startswith(f"{field.upper()}_"))
        owner = next((field for field in owners if _can_have(fields[field], value)), "")
        found.setdefault(owner, {})[name] = value
    others = found.get("", {})
    numbers = [name for name, kind in fields.items() if kind.base in INTEGER_RANGES]
    alone = len(numbers) == 1 and numbers[0] not in found and fields[numbers[0]].base in _SMALL
    if alone and len(set(others.values())) == len(others) > 1:
        found[numbers[0]] = found.pop("")
    return found


def _can_have(field: FieldType, constant: object) -> bool:
    if field.base in INTEGER_RANGES:
        return isinstance(constant, int | bytes)
    return field.base == "string" if isinstance(constant, str) else field.base in FLOATS


def chosen(known: Mapping[str, object], field: str) -> dict[str, object]:
    """Return the constants for a field, in lower case: those that begin with its name, without it, or else all."""
    start = f"{field.upper()}_"
    own = {name.removeprefix(start).lower(): value for name, value in known.items() if name.startswith(start)}
    return own or {name.lower(): value for name, value in known.items()}


PARTS = ("_Request", "_Response", "_Goal", "_Result", "_Feedback")
"""Suffixes of messages that are parts of services and actions."""


def known_types(kind: str) -> list[str]:
    """Types of a kind, ``msg``, ``srv`` or ``action``."""
    own = [
        f"{path.parent.parent.name}/{kind}/{path.stem}"
        for path in sorted(BUILT_IN.glob(f"*/{kind}/*.{kind}"))
    ]
    whole = [name for name in stored_types() if not name.endswith(PARTS)]
    return [*own, *(name for name in whole if f"/{kind}/" in name)]


def tried(
    place: FilePosition, problems: list[Problem], make: Callable[..., T], *arguments: object
) -> T | None:
    """Return what *make* returns, or None after a mistake, which *problems* receives."""
    try:
        return make(*arguments)
    except (WrongPath, UnknownInterface, MessageMismatch) as error:
        problems.append(place.problem(str(error), getattr(error, "help", "")))
        return None


# Follow paths through message types and messages.

Fields = Callable[[str], Mapping[str, FieldType]]
"""Returns the fields of a message type, given in full form."""


def follow(path: FieldPath, root: FieldType, fields: Fields) -> FieldType:
    """Return the type that a path leads to.

    Raises:
        WrongPath: a field does not exist.
        UnknownInterface: a type on the way is unknown.
    """
    here = root
    shown = ""
    for step in path.steps:
        if isinstance(step, str) and step.startswith("."):
            here = _field(path, step[1:], here, shown, fields)
            shown = f"{shown}.{step[1:]}".lstrip(".")
            continue
        if not here.array:
            text = f"`{path.text}`: {shown or 'the message'} is {here}, not an array"
            raise WrongPath(text, f"write {shown}")
        if isinstance(step, int) and here.length and not -here.length <= step < here.length:
            at_most = "" if here.fixed else "at most "
            text = f"`{path.text}`: {shown} has {at_most}{here.length} elements"
            raise WrongPath(text, f"elements are {shown}[0] to {shown}[{here.length - 1}]")
        here = here.element
        shown = f"{shown}[{step}]"
    return here


def _field(path: FieldPath, name: str, here: FieldType, shown: str, fields: Fields) -> FieldType:
    where = shown or "the message"
    if here.array:
        text = f"`{path.text}`: {where} is an array, {here}"
        raise WrongPath(text, f"write {shown}[0].{name}, or {shown}[*].{name} for all")
    if not here.is_message:
        raise WrongPath(f"`{path.text}`: {where} is {here} and has no fields", f"write {shown}")
    known = fields(here.base)
    if name not in known:
        listed = ", ".join(f"{field} ({kind})" for field, kind in known.items()) or "none"
        meant = suggestion(name, known)
        help = f"{meant} Its fields: {listed}" if meant else f"its fields: {listed}"
        raise WrongPath(f"`{path.text}`: {here.base} has no field `{name}`", help)
    return known[name]


Getter = Callable[[Any, int], Any]
"""Takes a message and the index of the current element; returns the value at a path."""


def getter(path: FieldPath) -> Getter:
    """Return a function that follows a path, compiled to one expression: sensors send a thousand messages a second."""
    made: Getter = eval(f"lambda m, i: {_expression(path.steps, 'm', 0)}", {})
    return made


def _expression(steps: tuple[PathStep, ...], value: str, depth: int) -> str:
    for place, step in enumerate(steps):
        if step == ALL:
            each = f"e{depth}"
            return f"[{_expression(steps[place + 1 :], each, depth + 1)} for {each} in {value}]"
        if isinstance(step, str) and step != HERE:
            name = step[1:]
            value = f"getattr({value}, {name!r})" if keyword.iskeyword(name) else f"{value}.{name}"
        else:
            value = f"{value}[{step}]"
    return value


# Units of the fields of messages, which definitions do not contain in machine-readable form.

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


def unit_at(path: FieldPath, root: FieldType, interfaces: Interfaces) -> str:
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


def check_unit(conversion: Conversion, path: FieldPath, root: FieldType, interfaces: Interfaces) -> None:
    """Reject a unit that the value of a message cannot have.

    Raises:
        WrongPath: the message uses a unit of another kind.
    """
    if not conversion.unit or conversion.kind in ANGLES:
        return
    there = unit_at(path, root, interfaces)
    if there == conversion.unit:
        raise WrongPath(f"messages already have `{path.text}` in {there}", "leave `unit` out")
    kinds, wanted = _kinds(there), UNITS[conversion.unit].kind
    if not there or wanted in kinds:
        return
    help = (
        f"units of {' and '.join(sorted(kinds))} are {', '.join(units_of(*kinds))}"
        if kinds
        else "leave `unit` out"
    )
    raise WrongPath(
        f"messages have `{path.text}` in {there}, but {conversion.unit} is a unit of {wanted}", help
    )
