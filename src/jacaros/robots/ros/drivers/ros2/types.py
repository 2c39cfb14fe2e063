"""The message and service classes of ROS 2's Python packages as a `Schema`, and parameter values in rclpy's form."""

from collections.abc import Mapping
from functools import cache
from importlib import import_module
from importlib.util import find_spec
from typing import Any

import numpy  # rclpy needs it, too
from rclpy.parameter import Parameter  # type: ignore[import-not-found]

from jacaros.robots.ros.errors import ParameterRefused, UnknownInterface
from jacaros.robots.ros.fields import FieldType, from_ros2
from jacaros.robots.ros.interfaces import PARTS, SUBSTITUTES, origin
from jacaros.robots.ros.message import Schema
from jacaros.robots.ros.parameter import checked_value


class RosidlSchema(Schema):
    """Classes of the installed ROS 2 packages."""

    def fields(self, type_name: str) -> Mapping[str, FieldType]:
        """Return the fields of a type in full form. Raises `UnknownInterface`."""
        return _fields(type_name)

    def numbers(self, field: FieldType, values: Any) -> Any:
        """Convert an array to the form that rclpy checks fastest: numpy for fixed lengths."""
        if field.base == "byte":
            return [bytes([value]) for value in values]
        return numpy.array(values) if field.fixed and field.base != "bool" else values

    def single(self, field: FieldType, value: Any) -> Any:
        """Convert an octet to ``bytes``; return other plain values unchanged."""
        return bytes([value]) if field.base == "byte" else value

    def message_class(self, type_name: str) -> Any:
        """Return the class of a message, request or response type in full form. Raises `UnknownInterface`."""
        return _message_class(type_name)

    def graph_type(self, type_name: str) -> str:
        """Return the name of a type in the graph: a substitute has its own package. Raises `UnknownInterface`."""
        package, kind, name = type_name.split("/")
        self.message_class(type_name)
        return type_name if _is_installed(package) else f"{SUBSTITUTES}/{kind}/{name}"

    def usual_type(self, told: str) -> str:
        """Return our name of a type in the graph: a substitute has the name of the original."""
        package, _, rest = told.partition("/")
        kind, _, name = rest.partition("/")
        if package != SUBSTITUTES:
            return told
        looks_like = origin(kind, name)
        # If the original package is installed, the two differ, so the substitute must be recognised.
        return told if looks_like is None or _is_installed(looks_like) else f"{looks_like}/{kind}/{name}"


@cache
def _fields(type_name: str) -> Mapping[str, FieldType]:
    told = _message_class(type_name).get_fields_and_field_types()
    return {name: from_ros2(text) for name, text in told.items()}


@cache
def _message_class(type_name: str) -> Any:
    package, kind, name = type_name.split("/")
    whole, _, part = name.rpartition("_")
    if whole and part in PARTS.get(kind, ()):
        return getattr(_message_class(f"{package}/{kind}/{whole}"), part)
    found = _imported(package, kind, name)
    if found is None and not _is_installed(package) and origin(kind, name) == package:
        found = _imported(SUBSTITUTES, kind, name)
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


ARRAYS = (
    Parameter.Type.BYTE_ARRAY,
    Parameter.Type.BOOL_ARRAY,
    Parameter.Type.INTEGER_ARRAY,
    Parameter.Type.DOUBLE_ARRAY,
    Parameter.Type.STRING_ARRAY,
)


def parameter(name: str, value: Any, kind: Any = None) -> Any:
    """Make rclpy's object for a parameter.

    Args:
        name: its name.
        value: plain value.
        kind: rclpy's type of an empty list, which the list itself does not show.

    Raises:
        ParameterRefused: a parameter cannot hold this value.
    """
    try:
        plain = checked_value(value)
    except ParameterRefused as problem:
        raise ParameterRefused(f"parameter {name}: {problem}") from None
    if isinstance(plain, bytes):
        return Parameter(name, Parameter.Type.BYTE_ARRAY, [bytes([octet]) for octet in plain])
    if plain == []:
        return Parameter(name, kind if kind in ARRAYS else Parameter.Type.STRING_ARRAY, plain)
    return Parameter(name, value=plain)
