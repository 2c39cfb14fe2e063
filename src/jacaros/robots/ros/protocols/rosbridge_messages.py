"""Messages in the notation of the rosbridge protocol, and definitions of types that the server knows.

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
import re
import struct
import sys
from array import array
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from jacaros.robots.ros.errors import UnknownInterface
from jacaros.robots.ros.fields import DURATION, FLOATS, TIME, FieldType
from jacaros.robots.ros.message import Memo, array_of_numbers
from jacaros.robots.ros.names import message_type
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


_TYPED_ARRAYS = range(64, 88)
"""Tags of typed arrays; their bits mean: floats, signed integers, little-endian, and the size of an element."""


def unpacked(value: Any) -> "array[Any] | None":
    """Convert a typed array of CBOR to a Python array; return None if *value* is not a known one.

    Raises:
        ValueError: its octets are not a whole number of elements.
    """
    tag = getattr(value, "tag", -1)
    if tag not in _TYPED_ARRAYS or not isinstance(value.value, bytes):
        return None
    kind = ("efd" if tag & 16 else "bhiq" if tag & 8 else "BHIQ")[tag & 3 :][:1]
    order = "little" if tag & 4 else "big"
    if not kind:  # floats of 128 bits
        return None
    if kind == "e":  # 16 bits, a type that Python arrays lack
        if len(value.value) % 2:
            raise ValueError(f"{len(value.value)} octets of numbers with 2 are given")
        sign = ">" if order == "big" else "<"
        return array("f", struct.unpack(f"{sign}{len(value.value) // 2}e", value.value))
    made = array(kind, value.value)
    if order != sys.byteorder:
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


Ask = Callable[[str, dict[str, Any]], dict[str, Any] | None]
"""Calls a service of rosapi and waits for the fields of its response; None if it fails, `TimeoutError` if there is no
answer."""

_DETAILS = {
    "msg": ("message_details",),
    "srv": ("service_request_details", "service_response_details"),
    "action": ("action_goal_details", "action_result_details", "action_feedback_details"),
}
"""Services of rosapi that return the parts of a definition, in the order of the file."""
_BASES = {"double": "float64", "float": "float32", "boolean": "bool", "octet": "byte"}
_ROS1_BASES = {
    "char": "uint8",
    "byte": "int8",
    "time": "builtin_interfaces/Time",
    "duration": "builtin_interfaces/Duration",
}
_OWN = {
    "rosgraph_msgs/msg/Log": "std_msgs/Header header\nbyte level\nstring name\nstring msg\nstring file\n"
    "string function\nuint32 line\nstring[] topics\n",
    "rcl_interfaces/srv/GetParameters": "string[] names\n---\nParameterValue[] values\n",
    "rcl_interfaces/srv/GetParameterTypes": "string[] names\n---\nuint8[] types\n",
    "rcl_interfaces/srv/SetParameters": "Parameter[] parameters\n---\nSetParametersResult[] results\n",
    "rcl_interfaces/srv/ListParameters": "string[] prefixes\nuint64 depth\n---\nListParametersResult result\n",
}
"""Definitions that the backend itself needs: ROS 1's log, and the services of ROS 2's nodes."""
_ACTIONLIB = {
    "ActionGoal": "std_msgs/Header header\nactionlib_msgs/GoalID goal_id\n{action}_Goal goal\n",
    "ActionResult": "std_msgs/Header header\nactionlib_msgs/GoalStatus status\n{action}_Result result\n",
    "ActionFeedback": "std_msgs/Header header\nactionlib_msgs/GoalStatus status\n{action}_Feedback feedback\n",
}
"""The wrappers that actionlib adds to the three parts of an action."""
_NO_FIELD = "structure_needs_at_least_one_member"
_SEQUENCE = re.compile(r"sequence<(?P<base>.+?)(?:,\s*\d+)?>")
_INTEGER = re.compile(r"-?\d+")
_CONSTANT = re.compile(r"[A-Z][A-Z0-9_]*")


class BridgeSchema(DefinitionSchema):
    """Message classes of `DefinitionSchema`, plus those whose definitions the server knows.

    Args:
        roots: the user's own definition folders.
        ask: asks the server; it blocks the calling thread, but once per otherwise unknown type.
        describe: returns why the server cannot be asked, None if it can.
    """

    def __init__(self, roots: Sequence[Path], ask: Ask, describe: Callable[[], str | None]) -> None:
        super().__init__(roots)
        self._ask = ask
        self._describe = describe
        self._reported: dict[str, str] = {}

    def _require(self, type_name: str) -> None:
        action, _, part = type_name.rpartition("_")
        if part not in _ACTIONLIB or "/action/" not in action:
            super()._require(type_name)
        elif not is_stored(type_name):
            self._register(type_name, _ACTIONLIB[part].format(action=action))

    def _definition(self, type_name: str) -> str:
        try:
            return super()._definition(type_name)
        except UnknownInterface as unknown:
            # The second: parts of types that the server has described.
            known = _OWN.get(type_name) or self._reported.get(type_name)
            if known is not None:
                return known
            reason = self._describe()
            if reason is None:
                try:
                    text = self._fetch(type_name)
                    if text is not None:
                        return text
                    reason = "the rosbridge server does not know it either"
                except TimeoutError:
                    reason = "the rosbridge server was asked for it, but has not answered yet"
            raise UnknownInterface(f"{unknown} ({reason})") from None

    def _fetch(self, type_name: str) -> str | None:
        """Return the definition of a type in the form of a file, and store those of its parts."""
        parts = []
        for service in _DETAILS[type_name.split("/")[1]]:
            answer = self._ask(f"/rosapi/{service}", {"type": type_name})
            typedefs = None if answer is None else answer.get("typedefs")
            if not typedefs:
                return None
            whole, *others = typedefs
            parts.append(definition_text(whole))
            for other in others:
                self._reported.setdefault(message_type(other["type"]), definition_text(other))
        return "---\n".join(parts)


def written_on_ros1(type_name: str) -> str:
    """Return a type in ROS 1's form: ``std_msgs/String``, ``nav2_msgs/NavigateToPoseActionGoal``."""
    package, kind, name = type_name.split("/")
    if kind == "action":  # one of the messages of an action
        name = "".join(name.rsplit("_", 1))
    return f"{package}/{name}"


def definition_text(typedef: Mapping[str, Any]) -> str:
    """Convert a ``rosapi_msgs/msg/TypeDef`` to the text of a definition.

    Args:
        typedef: its fields; the length of an array is -1 for a single value and 0 for no limit.
    """
    ros1 = "/msg/" not in "".join(typedef["fieldtypes"]) and not _BASES.keys() & set(typedef["fieldtypes"])
    lines = list(_constants(typedef))
    lengths = typedef.get("fieldarraylen") or [-1] * len(typedef["fieldnames"])
    for name, kind, length in zip(typedef["fieldnames"], typedef["fieldtypes"], lengths, strict=True):
        if name != _NO_FIELD:
            sequence = _SEQUENCE.fullmatch(kind)
            if sequence is not None:  # this is how bounded sequences of bounded strings are described
                kind, length = sequence["base"], 0
            array = "" if length < 0 else f"[{length or ''}]"
            lines.append(f"{_base(kind, ros1)}{array} {name}")
    return "".join(f"{line}\n" for line in lines)


def _base(kind: str, ros1: bool) -> str:
    kind = re.sub(r",\s*\d+$", "", kind)  # this is how bounded sequences are described
    kind = re.sub(r"^(w?string)<\d+>$", "string", kind).replace("/msg/", "/")
    if ros1 and kind in _ROS1_BASES:
        return _ROS1_BASES[kind]
    return _BASES.get(kind, kind)


def _constants(typedef: Mapping[str, Any]) -> Iterator[str]:
    # rosapi reports their values as texts, together with class attributes that are not constants.
    pairs = zip(typedef.get("constnames") or (), typedef.get("constvalues") or (), strict=False)
    for name, value in pairs:
        if _CONSTANT.fullmatch(name) and name != "SLOT_TYPES" and _INTEGER.fullmatch(str(value)):
            yield f"int64 {name}={value}"
