"""The message and service classes of ROS 2's Python packages as a `Schema`, and parameter values in rclpy's form."""

from collections.abc import Mapping
from functools import cache
from importlib import import_module
from importlib.util import find_spec
from typing import Any

import numpy  # rclpy needs it, too
from rclpy.parameter import Parameter  # type: ignore[import-not-found]

from jacaros.ros.errors import ParameterRefused, UnknownInterface
from jacaros.ros.fields import FieldType, from_ros2
from jacaros.ros.interfaces.ros2_package import PACKAGE, origin
from jacaros.ros.message import Schema

_PARTS = {"srv": ("Request", "Response"), "action": ("Goal", "Result", "Feedback")}
"""The messages of services and actions."""


class RosidlSchema(Schema):
    """Classes of the installed ROS 2 packages."""

    def _read_fields(self, type_name: str) -> Mapping[str, FieldType]:
        told = self.message_class(type_name).get_fields_and_field_types()
        return {name: from_ros2(text) for name, text in told.items()}

    def numbers(self, field: FieldType, values: Any) -> Any:
        """Convert an array to the form that rclpy checks fastest: numpy for fixed lengths."""
        if field.base == "byte":
            return [bytes([value]) for value in values]
        return numpy.array(values) if field.fixed and field.base != "bool" else values

    def single(self, field: FieldType, value: Any) -> Any:
        """Convert an octet to ``bytes``; return other plain values unchanged."""
        return bytes([value]) if field.base == "byte" else value

    def graph_type(self, type_name: str) -> str:
        """Return the name of a type in the graph: a substitute has its own package. Raises `UnknownInterface`."""
        package, kind, name = type_name.split("/")
        self.message_class(type_name)
        return type_name if _is_installed(package) else f"{PACKAGE}/{kind}/{name}"

    def usual_type(self, told: str) -> str:
        """Return our name of a type in the graph: a substitute has the name of the original."""
        package, _, rest = told.partition("/")
        kind, _, name = rest.partition("/")
        if package != PACKAGE:
            return told
        looks_like = origin(kind, name)
        # If the original package is installed, the two differ, so the substitute must be recognised.
        return told if looks_like is None or _is_installed(looks_like) else f"{looks_like}/{kind}/{name}"

    def _find_class(self, type_name: str) -> Any:
        package, kind, name = type_name.split("/")
        whole, _, part = name.rpartition("_")
        if whole and part in _PARTS.get(kind, ()):
            return getattr(self.message_class(f"{package}/{kind}/{whole}"), part)
        found = _imported(package, kind, name)
        if found is None and not _is_installed(package) and origin(kind, name) == package:
            found = _imported(PACKAGE, kind, name)
        if found is None:
            raise UnknownInterface(
                f"{type_name} is not installed for ROS 2 (no {name} in a Python module {package}.{kind}); "
                f"install ros-<distribution>-{package.replace('_', '-')}, or build its package, source its "
                "setup file"
            )
        return found


@cache
def _is_installed(package: str) -> bool:
    try:
        return find_spec(package) is not None
    except (ImportError, ValueError):
        return False


def _imported(package: str, kind: str, name: str) -> Any:
    try:
        return getattr(import_module(f"{package}.{kind}"), name, None)
    except ImportError:
        return None


_KINDS: dict[type, Any] = {
    bool: Parameter.Type.BOOL,
    int: Parameter.Type.INTEGER,
    float: Parameter.Type.DOUBLE,
    str: Parameter.Type.STRING,
    bytes: Parameter.Type.BYTE_ARRAY,
}
_LIST_KINDS: dict[type, Any] = {
    bool: Parameter.Type.BOOL_ARRAY,
    int: Parameter.Type.INTEGER_ARRAY,
    float: Parameter.Type.DOUBLE_ARRAY,
    str: Parameter.Type.STRING_ARRAY,
}
_ARRAYS = {*_LIST_KINDS.values(), Parameter.Type.BYTE_ARRAY}
_WIDEST = 2**63


def parameter(name: str, value: Any, kind: Any = None) -> Any:
    """Make rclpy's object for a parameter.

    Args:
        name: its name.
        value: plain value.
        kind: rclpy's type of an empty list, which the list itself does not show.

    Raises:
        ParameterRefused: a parameter cannot hold this value.
    """
    if isinstance(value, list | tuple):
        elements = list(value)
        if not elements:
            return Parameter(name, kind if kind in _ARRAYS else Parameter.Type.STRING_ARRAY, [])
        if any(isinstance(element, int) and not -_WIDEST <= element < _WIDEST for element in elements):
            raise ParameterRefused(
                f"parameter {name}: {value!r} is too large for a parameter, which has 64 bits"
            )
        kinds = {_LIST_KINDS.get(type(element)) for element in elements}
        if len(kinds) == 1 and (kind := kinds.pop()) is not None:
            return Parameter(name, kind, elements)
    elif isinstance(value, bytes | bytearray):
        return Parameter(name, Parameter.Type.BYTE_ARRAY, [bytes([octet]) for octet in value])
    elif isinstance(value, int) and not -_WIDEST <= value < _WIDEST:
        raise ParameterRefused(f"parameter {name}: {value} is too large for a parameter, which has 64 bits")
    else:
        for python, kind in _KINDS.items():  # bool is a subclass of int, so it comes first
            if isinstance(value, python):
                return Parameter(name, kind, python(value))
    raise ParameterRefused(
        f"parameter {name}: expected a bool, a number, a text, bytes, or a list of bools, ints, floats or "
        f"texts, found {value!r}"
    )


def plain_value(told: Any) -> Any:
    """Convert a value from rclpy; None for a parameter without one."""
    if isinstance(told, str | bool | int | float) or told is None:
        return told
    elements = list(told)
    return b"".join(elements) if elements and isinstance(elements[0], bytes) else elements
