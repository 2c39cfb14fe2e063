"""Messages in the notation of the rosbridge protocol.

The notation is that of ``rosbridge_library.internal.message_conversion``: arrays of octets in base64, times as
``secs`` and ``nsecs`` on ROS 1 and ``sec`` and ``nanosec`` on ROS 2, and ``null`` for the floating-point numbers that
JSON cannot represent (NaN and both infinities, so all three arrive as NaN).

A subscription may request CBOR (RFC 8949) instead of JSON. Arrays of numbers are then typed arrays (RFC 8746), so
images and scans cost a fraction, and infinite numbers and NaN arrive unchanged. Servers cannot encode every type: a
message with an array of fixed length, for instance, is lost.
"""

import base64
import binascii
import math
import sys
from array import array
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from typing import Any

from jacaros.robots.ros.fields import DURATION, FLOATS, TIME, FieldType
from jacaros.robots.ros.message import Memo, array_of_numbers
from jacaros.robots.ros.typestore import DefinitionSchema, is_stored

_OCTETS = ("uint8", "char")
_ONE_OCTET = (*_OCTETS, "byte", "int8", "bool")
_ROS1_FIELDS: Mapping[str, Mapping[str, str]] = {
    TIME: {"sec": "secs", "nanosec": "nsecs"},
    DURATION: {"sec": "secs", "nanosec": "nsecs"},
    "sensor_msgs/msg/CameraInfo": {"d": "D", "k": "K", "r": "R", "p": "P"},
}
"""Fields with other names in ROS 1's definitions."""

Encoder = Callable[[Any], Any]
Decoder = Callable[[Any], Any]


class Translator:
    """Converts messages to JSON values and back.

    Args:
        schema: the message classes.

    Attributes:
        ros_version: 1 or 2: the notation for writing; reading accepts both.
    """

    def __init__(self, schema: DefinitionSchema) -> None:
        self._schema = schema
        self._encoders, self._decoders = Memo(self._message_encoder), Memo(self._message_decoder)
        self._packed = Memo(partial(worth_packing, schema))
        self._version = 2

    @property
    def ros_version(self) -> int:
        """The notation for writing."""
        return self._version

    @ros_version.setter
    def ros_version(self, version: int) -> None:
        if version != self._version:
            self._version = version
            self._encoders.clear()

    def packs(self, type_name: str) -> bool:
        """Return whether messages of a type should be requested as CBOR."""
        return self._packed[type_name]

    def encode(self, type_name: str, message: Any) -> Any:
        """Return *message* as a JSON value."""
        return self._encoders[type_name](message)

    def decode(self, type_name: str, value: Any) -> Any:
        """Make a message from a JSON value; missing fields get their defaults.

        Raises:
            ValueError: the value does not match the type; the text names the field.
        """
        return self._decoders[type_name](value)

    def _message_encoder(self, type_name: str) -> Encoder:
        renamed = _ROS1_FIELDS.get(type_name, {}) if self._version == 1 else {}
        fields = [
            (name, renamed.get(name, name), self._field_encoder(field))
            for name, field in self._schema.fields(type_name).items()
        ]

        def encode(message: Any) -> dict[str, Any]:
            return {written: encoder(getattr(message, name)) for name, written, encoder in fields}

        return encode

    def _field_encoder(self, field: FieldType) -> Encoder:
        if not field.array:
            return self._single_encoder(field)
        if field.base in _OCTETS:
            return _to_base64
        if field.is_numeric:
            return _to_list
        single = self._single_encoder(field)
        return lambda values: [single(value) for value in values]

    def _single_encoder(self, field: FieldType) -> Encoder:
        if field.is_message:
            base = field.base
            return lambda message: self.encode(base, message)
        return _plain

    def _message_decoder(self, type_name: str) -> Decoder:
        renamed = _ROS1_FIELDS.get(type_name, {})
        fields = [
            (name, renamed.get(name), self._field_decoder(type_name, name, field))
            for name, field in self._schema.fields(type_name).items()
        ]
        new = self._schema.new

        def decode(value: Any) -> Any:
            if not isinstance(value, dict):
                raise ValueError(f"expected a {type_name}, found {value!r:.60}")
            message = new(type_name)
            for name, other, decoder in fields:
                if name in value:
                    setattr(message, name, decoder(value[name]))
                elif other is not None and other in value:
                    setattr(message, name, decoder(value[other]))
            return message

        return decode

    def _field_decoder(self, owner: str, name: str, field: FieldType) -> Decoder:
        decoder = self._array_decoder(field) if field.array else self._single_decoder(field)

        def decode(value: Any) -> Any:
            try:
                return decoder(value)
            except (TypeError, ValueError, OverflowError) as problem:
                raise ValueError(f"field {name} of {owner} is {field}, but {problem}") from None

        return decode

    def _array_decoder(self, field: FieldType) -> Decoder:
        if field.is_numeric:
            return _numbers(field)
        single = self._single_decoder(field)
        return lambda values: [single(value) for value in _sequence(values)]

    def _single_decoder(self, field: FieldType) -> Decoder:
        if field.is_message:
            base = field.base
            return lambda value: self.decode(base, value)
        if field.base in FLOATS:
            return lambda value: math.nan if value is None else float(value)
        if field.base == "string":
            return str
        if field.base == "bool":
            return bool
        return int


def _plain(value: Any) -> Any:
    return value.item() if hasattr(value, "item") else value


def _to_list(values: Any) -> list[Any]:
    return values.tolist() if hasattr(values, "tolist") else list(values)


def _to_base64(values: Any) -> str:
    octets = values.tobytes() if hasattr(values, "tobytes") else bytes(values)
    return base64.standard_b64encode(octets).decode("ascii")


def _sequence(values: Any) -> list[Any]:
    if not isinstance(values, list):
        raise ValueError(f"{values!r:.60} is given")
    return values


def _numbers(field: FieldType) -> Decoder:
    """Read an array of numbers: a list, octets in base64, or what CBOR makes of it."""

    unbounded = replace(field, length=0, fixed=False)

    def decode(values: Any) -> Any:
        numbers: Any = unpacked(values)
        if numbers is None and isinstance(values, bytes) and field.base in _ONE_OCTET:
            numbers = values
        if numbers is None and isinstance(values, str) and field.base in _ONE_OCTET:
            numbers = binascii.a2b_base64(values, strict_mode=True)
        if numbers is None:
            numbers = _sequence(values)
        if field.base == "bool":
            return [bool(number) for number in numbers]
        if field.base in FLOATS and numbers is values:
            numbers = [math.nan if number is None else number for number in numbers]
        return array_of_numbers(unbounded, numbers)

    return decode


_TYPED_ARRAYS = {
    64: "B",
    69: "H",
    70: "I",
    71: "Q",
    72: "b",
    77: "h",
    78: "i",
    79: "q",
    85: "f",
    86: "d",
}
"""Type codes of `array.array` by the tags that servers use, all little-endian."""


def unpacked(value: Any) -> "array[Any] | None":
    """Convert a typed array of CBOR to a Python array; return None if *value* is not a known one.

    Raises:
        ValueError: its octets are not a whole number of elements.
    """
    code = _TYPED_ARRAYS.get(getattr(value, "tag", -1))
    if code is None or not isinstance(value.value, bytes):
        return None
    made = array(code, value.value)
    if sys.byteorder == "big":
        made.byteswap()
    return made


def worth_packing(schema: DefinitionSchema, type_name: str) -> bool:
    """Return whether CBOR is worthwhile for a type, and servers can encode all its fields."""
    types = [type_name]
    fields: list[FieldType] = []
    for each in types:
        own = schema.fields(each).values()
        fields += own
        types += {field.base for field in own if field.is_message}.difference(types)
    return all(_can_be_packed(field) for field in fields) and any(
        field.array and field.is_numeric for field in fields
    )


def _can_be_packed(field: FieldType) -> bool:
    if field.base == "byte":
        return False
    return not field.array or (not field.length and field.base != "string")


_ACTIONLIB = {
    "ActionGoal": "std_msgs/Header header\nactionlib_msgs/GoalID goal_id\n{action}_Goal goal\n",
    "ActionResult": "std_msgs/Header header\nactionlib_msgs/GoalStatus status\n{action}_Result result\n",
    "ActionFeedback": "std_msgs/Header header\nactionlib_msgs/GoalStatus status\n{action}_Feedback feedback\n",
}
"""The wrappers that actionlib adds to the three parts of an action."""


class BridgeSchema(DefinitionSchema):
    """Message classes of `DefinitionSchema`, plus those of actionlib's topics."""

    def _require(self, type_name: str) -> None:
        action, _, part = type_name.rpartition("_")
        if part not in _ACTIONLIB or "/action/" not in action:
            super()._require(type_name)
        elif not is_stored(type_name):
            self._register(type_name, _ACTIONLIB[part].format(action=action))


def written_on_ros1(type_name: str) -> str:
    """Return a type in ROS 1's form: ``std_msgs/String``, ``nav2_msgs/NavigateToPoseActionGoal``."""
    package, kind, name = type_name.split("/")
    if kind == "action":  # one of the messages of an action
        name = "".join(name.rsplit("_", 1))
    return f"{package}/{name}"
