"""The parameters of our own node, which rclpy stores."""

import math
from collections.abc import Callable, Mapping
from typing import Any

from rcl_interfaces.msg import (  # type: ignore[import-not-found]
    FloatingPointRange,
    IntegerRange,
    ParameterDescriptor,
)
from rclpy.exceptions import (  # type: ignore[import-not-found]
    ParameterAlreadyDeclaredException,
    ParameterException,
    ParameterNotDeclaredException,
)
from rclpy.parameter import Parameter  # type: ignore[import-not-found]

from jacaros.robots.ros.drivers.ros2.node import Ros2Node
from jacaros.robots.ros.drivers.ros2.types import ARRAYS, parameter
from jacaros.robots.ros.errors import ParameterRefused, ParameterUnknown
from jacaros.robots.ros.parameter import DeclaredParameter, ParameterValue, checked_value, fault_of
from jacaros.robots.ros.parameter_services import ParameterEvents

_LARGEST = 2**63 - 1


class OwnParameters:
    """The parameters of our own node; rclpy stores them and serves other nodes on its thread."""

    def __init__(self, node: Ros2Node, events: ParameterEvents) -> None:
        self.node = node.node_name
        self._node = node
        self._parameter_events = events

    def declare(self, name: str, declaration: DeclaredParameter) -> ParameterValue:
        """Declare a parameter."""
        value = default = parameter(name, declaration.default)
        given = self._node.given_parameters.take(name)
        if given is not None:
            # rclpy's own error messages do not say what to write.
            for candidate in (checked_value(declaration.default), given):
                if (fault := fault_of(candidate, declaration)) is not None:
                    raise ParameterRefused(f"parameter {name} of {self.node} is {fault}")
            value = parameter(name, given, default.type_)
        try:
            made = self._node.rcl.declare_parameter(
                name, value.value, _descriptor(default, declaration), ignore_override=True
            )
        except ParameterAlreadyDeclaredException:
            raise ParameterRefused(f"parameter {name} of {self.node} is already declared") from None
        except (ParameterException, ValueError) as problem:
            raise ParameterRefused(f"parameter {name} of {self.node}: {problem}") from None
        if value.value == [] and value.type_ != made.type_:
            made = self._retyped(value, declaration.read_only)
        return self._value(made)

    def _retyped(self, empty: Any, read_only: bool) -> Any:
        """Set the type of a declared empty list: rclpy takes every empty list for octets."""
        rcl = self._node.rcl
        told = rcl.describe_parameter(empty.name)
        told.type, told.read_only = empty.type_.value, False
        rcl.set_parameters([empty])
        told.read_only = read_only
        return rcl.get_parameter(empty.name)

    def withdraw(self, name: str) -> None:
        """Undeclare a parameter."""
        rcl = self._node.rcl
        if not rcl.has_parameter(name):
            raise ParameterUnknown(self._unknown(name))
        rcl.describe_parameter(name).read_only = False  # rclpy applies it to our own node, too
        rcl.undeclare_parameter(name)

    async def names(self, timeout: float | None = None) -> list[str]:
        """Names of the node's parameters."""
        return sorted(self._node.rcl.list_parameters([], 0).names)

    async def get(self, name: str, timeout: float | None = None) -> ParameterValue:
        """Return a parameter's value."""
        try:
            return self._value(self._node.rcl.get_parameter(name))
        except ParameterNotDeclaredException:
            raise ParameterUnknown(self._unknown(name)) from None

    async def set(self, name: str, value: ParameterValue, timeout: float | None = None) -> None:
        """Change a parameter."""
        try:
            before = self._node.rcl.get_parameter(name)
        except ParameterNotDeclaredException:
            raise ParameterUnknown(self._unknown(name)) from None
        [result] = self._node.rcl.set_parameters([parameter(name, value, before.type_)])
        if not result.successful:
            raise ParameterRefused(f"parameter {name} of {self.node} cannot be {value!r}: {result.reason}")

    def on_change(self, callback: Callable[[Mapping[str, ParameterValue]], None]) -> Callable[[], None]:
        """Call *callback* with changed parameters."""
        return self._parameter_events.listen(self.node, callback)

    def _value(self, told: Any) -> ParameterValue:
        value: ParameterValue = told.value
        if told.type_ == Parameter.Type.BYTE_ARRAY:
            return b"".join(told.value)
        return list(told.value) if told.type_ in ARRAYS else value

    def _unknown(self, name: str) -> str:
        known = sorted(self._node.rcl.list_parameters([], 0).names)
        return f"node {self.node} has no parameter {name}; it has {', '.join(known)}"


def _descriptor(default: Any, declaration: DeclaredParameter) -> Any:
    told = ParameterDescriptor(description=declaration.description, read_only=declaration.read_only)
    low, high = declaration.minimum, declaration.maximum
    if low is None and high is None:
        return told
    if default.type_ in (Parameter.Type.INTEGER, Parameter.Type.INTEGER_ARRAY):
        told.integer_range = [
            IntegerRange(
                from_value=-_LARGEST if low is None or low <= -_LARGEST else math.ceil(low),
                to_value=_LARGEST if high is None or high >= _LARGEST else math.floor(high),
            )
        ]
    else:
        told.floating_point_range = [
            FloatingPointRange(
                from_value=-math.inf if low is None else float(low),
                to_value=math.inf if high is None else float(high),
            )
        ]
    return told
