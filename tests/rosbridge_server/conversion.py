"""JSON values and messages, by the rules of rosbridge_library's ``message_conversion``, error texts included.

Written apart from the client's translation: what one of them gets wrong the other does not understand.
"""

import base64
import math
from typing import Any

import cbor2

from jacaros.robots.ros.fields import FLOATS, INTEGER_RANGES, FieldType
from jacaros.robots.ros.node import Node

TIMES = ("builtin_interfaces/msg/Time", "builtin_interfaces/msg/Duration")
OCTETS = ("uint8", "char")


class Mismatch(Exception):
    """The values do not fit the type."""


def short(type_name: str) -> str:
    """``std_msgs/String`` for ``std_msgs/msg/String``."""
    return f"{type_name.split('/')[0]}/{type_name.split('/')[-1]}"


def to_json(node: Node, type_name: str, message: Any, ros1: bool) -> Any:
    """Give the JSON values of a message."""
    if type_name in TIMES:
        if ros1:
            return {"secs": message.sec, "nsecs": message.nanosec}
        return {"sec": message.sec, "nanosec": message.nanosec}
    values = {
        name: _field_to_json(node, field, getattr(message, name), ros1)
        for name, field in node.factory.fields(type_name).items()
    }
    if ros1 and type_name == "std_msgs/msg/Header":
        values["seq"] = 0
    return values


def _field_to_json(node: Node, field: FieldType, value: Any, ros1: bool) -> Any:
    if not field.array:
        return _single_to_json(node, field, value, ros1)
    if field.base in OCTETS:
        return base64.b64encode(_octets(value)).decode()
    return [_single_to_json(node, field, each, ros1) for each in value]


def _octets(values: Any) -> bytes:
    """An image at once: a server that is at it for seconds answers no ping, and is left for another."""
    if hasattr(values, "astype"):
        return bytes(values.astype("uint8").tobytes())
    return bytes(int(each) & 255 for each in values)


def _single_to_json(node: Node, field: FieldType, value: Any, ros1: bool) -> Any:
    if field.is_message:
        return to_json(node, field.base, value, ros1)
    if field.base in FLOATS:
        return float(value) if math.isfinite(value) else None
    if field.base == "string":
        return str(value)
    return bool(value) if field.base == "bool" else int(value)


TAGS = {"uint16": 69, "uint32": 70, "uint64": 71, "int8": 72, "int16": 77, "int32": 78, "int64": 79}
TAGS |= {"float32": 85, "float64": 86}
"""Tags of typed arrays, all little-endian."""


def to_cbor(node: Node, type_name: str, message: Any, ros1: bool) -> Any:
    """Give a message as rosbridge packs it.

    Raises:
        AttributeError: where the genuine server fails too, at arrays of fixed length, of texts, and at octets.
    """
    if type_name in TIMES:
        return to_json(node, type_name, message, ros1)
    return {
        name: _field_to_cbor(node, field, getattr(message, name), ros1)
        for name, field in node.factory.fields(type_name).items()
    }


def _field_to_cbor(node: Node, field: FieldType, value: Any, ros1: bool) -> Any:
    if field.base == "byte" or (field.array and (field.length or field.base == "string")):
        raise AttributeError(f"{field} has no attribute 'get_fields_and_field_types'")
    if field.is_message:
        if field.array:
            return [to_cbor(node, field.base, each, ros1) for each in value]
        return to_cbor(node, field.base, value, ros1)
    if not field.array:
        return value.item() if hasattr(value, "item") else value
    if field.base in OCTETS:
        return _octets(value)
    if field.base == "bool":
        return [bool(each) for each in value]
    import numpy

    kind = numpy.dtype(field.base).newbyteorder("<")
    return cbor2.CBORTag(TAGS[field.base], numpy.asarray(value, dtype=kind).tobytes())


def from_json(node: Node, type_name: str, values: Any, ros1: bool) -> Any:
    """Make a message.

    Raises:
        Mismatch: with the words of rosbridge.
    """
    return _message(node, type_name, values, ros1, short(type_name), ())


def _message(node: Node, type_name: str, values: Any, ros1: bool, root: str, path: tuple[str, ...]) -> Any:
    if not isinstance(values, dict):
        if not path:
            raise Mismatch(f"Expected a JSON object for type {root} but received a {type(values)}")
        raise _wrong(root, path, short(type_name), values)
    if type_name in TIMES:
        seconds, rest = ("secs", "nsecs") if ros1 else ("sec", "nanosec")
        # ROS 2's side reads the names of ROS 1 too; the other way round it does not work.
        if not ros1:
            seconds = "sec" if "sec" in values else "secs"
            rest = "nanosec" if "nanosec" in values else "nsecs"
        return node.factory.make(type_name, {"sec": values.get(seconds, 0), "nanosec": values.get(rest, 0)})
    message = node.factory.new(type_name)
    fields = node.factory.fields(type_name)
    for name, value in values.items():
        where = (*path, name)
        if name not in fields:
            if ros1 and name == "seq":
                continue
            raise Mismatch(f"Message type {root} does not have a field {'.'.join(where)}")
        setattr(message, name, _field(node, fields[name], value, ros1, root, where))
    return message


def _field(node: Node, field: FieldType, value: Any, ros1: bool, root: str, path: tuple[str, ...]) -> Any:
    if not field.array:
        return _single(node, field, value, ros1, root, path)
    import numpy

    if field.base in OCTETS and isinstance(value, str):
        return numpy.frombuffer(base64.b64decode(value), dtype="uint8").copy()
    if not isinstance(value, list):
        raise _wrong(root, path, str(field), value)
    elements = [_single(node, field, each, ros1, root, path) for each in value]
    if not field.is_numeric:
        return elements
    return numpy.array(elements, dtype={"byte": "uint8", "char": "uint8"}.get(field.base, field.base))


def _single(node: Node, field: FieldType, value: Any, ros1: bool, root: str, path: tuple[str, ...]) -> Any:
    if field.is_message:
        return _message(node, field.base, value, ros1, root, path)
    if field.base in FLOATS:
        if isinstance(value, int | float) and not isinstance(value, bool):
            return float(value)
    elif field.base in INTEGER_RANGES:
        if isinstance(value, int) and not isinstance(value, bool):
            return value
    elif isinstance(value, bool if field.base == "bool" else str):
        return value
    raise _wrong(root, path, field.base, value)


def _wrong(root: str, path: tuple[str, ...], wanted: str, value: Any) -> Mismatch:
    return Mismatch(f"{root} message requires a {wanted} for field {'.'.join(path)}, but got a {type(value)}")
