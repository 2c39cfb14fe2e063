"""Messages made from keywords and dictionaries, and the few differences between client libraries.

An artifact author sees the same kind of message object everywhere: attributes for fields, numbers, texts, nested
messages, and an indexable, iterable object for arrays (`array.array`, a numpy array, tuple, list or ``bytes``, depending
on the client library). The differences are handled here: stamps, defaults and checks of values.
"""

import dataclasses
from array import array
from collections.abc import Callable, Iterable, Mapping, Sequence, Set
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

from jacaros.robots.ros.errors import MessageMismatch, NameInvalid
from jacaros.robots.ros.fields import DURATION, FLOATS, INTEGER_RANGES, TIME, FieldType
from jacaros.runtime.files.texts import aside

K = TypeVar("K")
V = TypeVar("V")

TIMES = (TIME, DURATION)
DEFAULTS: Mapping[str, Mapping[str, object]] = {
    "geometry_msgs/msg/Quaternion": {"w": 1.0},
    "irobot_create_msgs/action/DriveDistance_Goal": {"max_translation_speed": 0.3},
    "irobot_create_msgs/action/RotateAngle_Goal": {"max_rotation_speed": 1.9},
    "nav2_msgs/action/DockRobot_Goal": {
        "use_dock_id": True,
        "max_staging_time": 1000.0,
        "navigate_to_staging_pose": True,
    },
    "nav2_msgs/action/DockRobot_Result": {"success": True},
    "nav2_msgs/action/UndockRobot_Goal": {"max_undocking_time": 30.0},
    "nav2_msgs/action/UndockRobot_Result": {"success": True},
}
"""Default values of ROS 2's definitions. Families of classes without them (of ROS 1, and our own) set these, to avoid zero
rotations."""


class Memo(dict[K, V]):
    """Values that *make* returned for their keys; it is called on the first use of a key."""

    def __init__(self, make: Callable[[K], V]) -> None:
        self._make = make

    def __missing__(self, key: K) -> V:
        made = self[key] = self._make(key)
        return made


class Schema:
    """A family of message classes (of rospy, rclpy or our own), and the messages made of them.

    Args:
        roots: folders with further definitions, if the family uses definition files; see `jacaros.robots.ros.interfaces`.
    """

    def __init__(self, roots: Sequence[Path] = ()) -> None:
        self._roots = tuple(roots)
        self._fields = Memo(self._read_fields)
        self._classes = Memo(self._find_class)

    def look_in(self, folder: Path) -> None:
        """Search *folder* for definitions, too, from now on."""
        if folder not in self._roots:
            self._roots = (*self._roots, folder)

    def fields(self, type_name: str) -> Mapping[str, FieldType]:
        """Return the fields of a message type in full form, in the order of its definition.

        Raises:
            UnknownInterface: the type is unknown.
        """
        return self._fields[type_name]

    def message_class(self, type_name: str) -> Any:
        """Return the class of a message type in full form. Raises `UnknownInterface`."""
        return self._classes[type_name]

    def new(self, type_name: str) -> Any:
        """Make a message with the family's own defaults. Raises `UnknownInterface`."""
        return self.message_class(type_name)()

    def maker(self, type_name: str) -> Callable[[], Any]:
        """Return a function that makes messages as `new` does. Raises `UnknownInterface`."""
        return partial(self.new, type_name)

    def numbers(self, field: FieldType, values: Any) -> Any:
        """Convert the result of `array_of_numbers` to the form that the family stores in *field*."""
        return values

    def single(self, field: FieldType, value: Any) -> Any:
        """Convert a checked number, bool or text to the form that the family stores in *field*."""
        return value

    def _read_fields(self, type_name: str) -> Mapping[str, FieldType]:
        raise NotImplementedError

    def _find_class(self, type_name: str) -> Any:
        raise NotImplementedError

    def make(self, type_name: str, values: Mapping[str, Any] | None = None) -> Any:
        """Make a message; missing fields get their defaults.

        Args:
            type_name: full form.
            values: field → number, text, bool, list, message, or a mapping for a nested message. Stamps and durations
                may be given in seconds.

        Raises:
            UnknownInterface: the type is unknown.
            MessageMismatch: a field is unknown, or its value has the wrong type or is out of range.
        """
        if type_name in TIMES:
            return self._time(type_name, values or {})
        return self._make(type_name, values or {}, "")

    def checked(self, type_name: str, given: Any) -> Any:
        """Return *given* as a message of a type: unchanged, made from a mapping, or with all defaults for None.

        Raises:
            MessageMismatch: it does not match the type definition.
        """
        if given is None or isinstance(given, Mapping):
            return self.make(type_name, given)
        if not isinstance(given, self.message_class(type_name)):
            raise MessageMismatch(f"expected a {type_name}, found {given!r}", type_name)
        return given

    def _make(self, type_name: str, values: Mapping[str, Any], path: str) -> Any:
        message = self.new(type_name)
        fields = self.fields(type_name)
        for name, value in values.items():
            field = fields.get(name)
            where = f"{path}.{name}" if path else name
            if field is None:
                raise _unknown_field(type_name, where, name, fields)
            converted = self._value(field, value, type_name, where)
            try:
                setattr(message, name, converted)
            except AssertionError as problem:  # rclpy's own check: bounds of texts, ranges of float32
                raise MessageMismatch(f"{type_name}: field {where}: {problem}", type_name, where) from None
        return message

    def _value(self, field: FieldType, value: Any, owner: str, where: str) -> Any:
        try:
            if not field.array:
                return self._single(field, value, where)
            if field.is_numeric:
                return self.numbers(field, array_of_numbers(field, value))
            return self._list(field, value, where)
        except (TypeError, ValueError, OverflowError) as problem:
            known = tuple(self.fields(owner))
            text = f"{owner}: field {where} is {field}, but {problem}"
            raise MessageMismatch(text, owner, where, known) from None

    def _single(self, field: FieldType, value: Any, where: str) -> Any:
        if not field.is_message:
            return self.single(field, single_value(field, value))
        if field.base in TIMES:
            return self._time(field.base, value)
        if isinstance(value, Mapping):
            return self._make(field.base, value, where)
        if not isinstance(value, self.message_class(field.base)):
            raise TypeError(f"{written(value)} is given")
        return value

    def _list(self, field: FieldType, value: Any, where: str) -> list[Any]:
        if isinstance(value, str | bytes | Mapping) or not isinstance(value, Iterable):
            raise TypeError(f"{written(value)} is given")
        elements = [self._single(field, item, f"{where}[{index}]") for index, item in enumerate(value)]
        if field.length and (len(elements) != field.length if field.fixed else len(elements) > field.length):
            raise ValueError(f"{len(elements)} elements are given")
        return elements

    def _time(self, base: str, value: Any) -> Any:
        made = self.new(base)
        if isinstance(value, int | float) and not isinstance(value, bool):
            stamp(made, value)
        elif isinstance(value, Mapping):
            unknown = set(value) - {"sec", "nanosec", "secs", "nsecs"}
            if unknown:
                raise ValueError(f"{unknown.pop()!r} is not a part of a time (sec, nanosec)")
            _set_time(
                made, value.get("sec", value.get("secs", 0)), value.get("nanosec", value.get("nsecs", 0))
            )
        elif isinstance(value, type(made)):
            return value
        else:
            raise TypeError(f"{written(value)} is given; write seconds or a time")
        return made


def _unknown_field(owner: str, where: str, name: str, fields: Mapping[str, FieldType]) -> MessageMismatch:
    known = ", ".join(f"{field} ({kind})" for field, kind in fields.items()) or "none"
    text = f"{owner} has no field {name!r} (at {where}){aside(name, fields) or '.'} Its fields: {known}"
    return MessageMismatch(text, owner, where, tuple(fields))


def stamp(time: Any, seconds: float) -> None:
    """Set a message's time or duration, such as ``m.header.stamp``, in place.

    Args:
        time: the time object inside the message.
        seconds: since the Unix epoch for a time.

    Works with the time objects of every backend.
    """
    whole = int(seconds // 1)
    nanoseconds = round((seconds - whole) * 1e9)
    if nanoseconds >= 1_000_000_000:
        whole, nanoseconds = whole + 1, 0
    _set_time(time, whole, nanoseconds)


def to_seconds(time: Any) -> float:
    """Return a message's time or duration, such as ``m.header.stamp``, in seconds; for every backend."""
    if hasattr(time, "nanosec"):
        return float(time.sec + time.nanosec * 1e-9)
    return float(time.secs + time.nsecs * 1e-9)


def _set_time(time: Any, seconds: int, nanoseconds: int) -> None:
    if hasattr(time, "nanosec"):
        time.sec, time.nanosec = seconds, nanoseconds
    else:
        time.secs, time.nsecs = seconds, nanoseconds


def constant(message: Any, name: str) -> Any:
    """Return the value of a constant of the message's type, such as ``POWER_SUPPLY_STATUS_CHARGING``; for every
    backend.

    Raises:
        NameInvalid: the type has no such constant.
    """
    owner = message if isinstance(message, type) else type(message)
    try:
        return getattr(owner, name)
    except AttributeError:
        raise NameInvalid(f"{owner.__name__} has no constant {name}") from None


def type_of(message: Any) -> str:
    """Return the type of a message of any backend in full form, such as ``nav_msgs/msg/Odometry``."""
    kind = type(message)
    genpy_name = getattr(kind, "_type", None)
    if isinstance(genpy_name, str):  # genpy: nav_msgs/Odometry
        package, _, short = genpy_name.partition("/")
        return f"{package}/msg/{short}"
    name: str = getattr(kind, "__msgtype__", None) or kind.__name__.replace("__", "/")
    if "/" in name:  # ours
        return name
    return f"{kind.__module__.partition('.')[0]}/msg/{name}"  # rclpy: nav_msgs.msg._odometry.Odometry


def plain(value: Any) -> Any:
    """Convert a message of any backend to dictionaries, lists, numbers and texts, for records and output.

    Times become ``{"sec": …, "nanosec": …}`` everywhere; octets become integers.
    """
    if value is None or isinstance(value, bool | int | float | str):
        return value
    if hasattr(value, "nsecs"):
        return {"sec": value.secs, "nanosec": value.nsecs}
    names = field_names(value)
    if names is None:
        return value.tolist() if hasattr(value, "tolist") else [plain(element) for element in value]
    octets = hasattr(type(value), "get_fields_and_field_types")
    return {name: _plain_field(getattr(value, name), octets) for name in names}


def _plain_field(value: Any, octets: bool) -> Any:
    # rclpy returns one octet as bytes of length 1; rospy returns uint8[] as bytes.
    return value[0] if octets and isinstance(value, bytes) else plain(value)


def field_names(message: Any) -> list[str] | None:
    """Return the names of a message's fields in order, for every backend; None if *message* is not a message."""
    kind = type(message)
    if hasattr(kind, "get_fields_and_field_types"):  # rclpy
        return list(kind.get_fields_and_field_types())
    if hasattr(kind, "__dataclass_fields__"):  # ours
        return _dataclass_fields(kind)
    if hasattr(kind, "_slot_types"):  # genpy
        return list(kind.__slots__)
    return None


_names_by_class: dict[type, list[str]] = {}


def _dataclass_fields(kind: type) -> list[str]:
    names = _names_by_class.get(kind)
    if names is None:
        names = _names_by_class[kind] = [field.name for field in dataclasses.fields(kind)]
    return names


def written(value: object) -> str:
    """Format a value for an error message: ``repr`` for built-in types, ``str`` for others, such as terms."""
    return repr(value) if type(value).__module__ == "builtins" else str(value)


def single_value(field: FieldType, value: Any) -> bool | int | float | str:
    """Return *value* as a plain Python value of the base type of *field* (not as an array).

    Integer fields accept whole floating-point numbers, and all fields accept numpy scalars.

    Raises:
        TypeError: the value has the wrong type.
        ValueError: the number is out of range, or the string too long.
    """
    if hasattr(value, "item") and getattr(value, "shape", None) == ():
        value = value.item()
    if field.base == "string":
        return _text(field, value)
    if field.base == "bool":
        if isinstance(value, bool):
            return value
    elif not isinstance(value, bool):
        if field.base in FLOATS and isinstance(value, int | float):
            return float(value)
        if field.base in INTEGER_RANGES:
            return _integer(field.base, value)
    raise TypeError(f"{written(value)} is given")


def _text(field: FieldType, value: Any) -> str:
    if isinstance(value, str):
        if field.bound and len(value) > field.bound:
            raise ValueError(f"a string of {len(value)} characters is given")
        return str.__str__(value)  # convert subclasses, such as atoms, to plain strings
    raise TypeError(f"{written(value)} is given")


def _integer(base: str, value: Any) -> int:
    if base == "byte" and isinstance(value, bytes) and len(value) == 1:
        return value[0]
    if isinstance(value, float) and value.is_integer():
        value = int(value)
    if not isinstance(value, int):
        raise TypeError(f"{written(value)} is given")
    low, high = INTEGER_RANGES[base]
    if not low <= value <= high:
        raise ValueError(f"{value} is given; it must be from {low} to {high}")
    return value


_TYPECODES = {
    "float64": "d",
    "float32": "f",
    "int8": "b",
    "uint8": "B",
    "byte": "B",
    "char": "B",
    "int16": "h",
    "uint16": "H",
    "int32": "i",
    "uint32": "I",
    "int64": "q",
    "uint64": "Q",
}
"""Type codes of `array.array`, the same as in rclpy."""


def array_of_numbers(field: FieldType, values: Any) -> Any:
    """Return *values* as an `array.array` of the field's type, or as a list for booleans.

    Accepts lists, tuples, ranges, bytes, numpy arrays and any other iterable.

    Raises:
        TypeError: an element is not a number, or has a fraction in an integer field.
        ValueError: wrong length or out of range.
    """
    if isinstance(values, str | Mapping | Set) or not isinstance(values, Iterable):
        raise TypeError(f"{_shortened(values)} is given")
    made = _converted(field, values)
    if field.length and (len(made) != field.length if field.fixed else len(made) > field.length):
        raise ValueError(f"{len(made)} elements are given")
    return made


def _converted(field: FieldType, values: Any) -> Any:
    if isinstance(values, bytes | bytearray | memoryview):
        values = array("B", bytes(values))  # one number per byte, not raw bytes of wider numbers
    code = _TYPECODES.get(field.base)
    if code is not None and isinstance(values, array):
        if values.typecode == code:
            return values
    elif hasattr(values, "tolist"):
        values = values.tolist()
    if code is not None:
        try:
            return array(code, values)
        except (OverflowError, TypeError):
            pass  # an element is invalid, or is a whole float for an integer field: check each one below
    checked: list[Any] = [single_value(field.element, each) for each in values]
    return checked if code is None else array(code, checked)


def zeros(field: FieldType, length: int) -> Any:
    """Make *length* zeros of the field's type: an `array.array`, or a list for booleans."""
    code = _TYPECODES.get(field.base)
    return [False] * length if code is None else array(code, bytes(length * array(code).itemsize))


def _shortened(values: Any) -> str:
    text = repr(values)
    return text if len(text) <= 60 else text[:57] + "..."
