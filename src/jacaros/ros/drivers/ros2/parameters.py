"""Parameters of ROS 2's nodes: our own through rclpy, others' through their services, changes on
``/parameter_events``."""

import math
import threading
from collections.abc import Callable, Mapping
from typing import Any

from rcl_interfaces.msg import (  # type: ignore[import-not-found]
    FloatingPointRange,
    IntegerRange,
    ParameterDescriptor,
    ParameterType,
    SetParametersResult,
)
from rclpy.exceptions import (  # type: ignore[import-not-found]
    InvalidParameterException,
    InvalidParameterTypeException,
    InvalidParameterValueException,
    ParameterAlreadyDeclaredException,
    ParameterNotDeclaredException,
)
from rclpy.parameter import Parameter, parameter_value_to_python  # type: ignore[import-not-found]

from jacaros.ros.drivers.ros2.node import Ros2Node
from jacaros.ros.drivers.ros2.services import Ros2Client
from jacaros.ros.drivers.ros2.types import parameter, plain_value
from jacaros.ros.errors import CapabilityMissing, ParameterRefused, ParameterUnknown, ServerGone
from jacaros.ros.handoff import LoopEnded, ask
from jacaros.ros.parameter import Declaration, ParameterValue, checked_value, fault_of
from jacaros.ros.parameter_events import ParameterEvents, ParameterServices

_LARGEST = 2**63 - 1


def read_value(told: Any) -> ParameterValue | None:
    """Read a ``rcl_interfaces/msg/ParameterValue``; None for a parameter without a value."""
    value: ParameterValue | None = plain_value(parameter_value_to_python(told))
    return value


class OwnParameters:
    """The parameters of our own node.

    rclpy stores them and serves other nodes on its thread; decisions about new values are made on the loop.
    """

    def __init__(self, node: Ros2Node, events: ParameterEvents) -> None:
        self.node = node.node_name
        self._node = node
        self._parameter_events = events
        self._judges: dict[str, Callable[[ParameterValue], str | None]] = {}
        self._loops_thread = threading.get_ident()
        node.rcl.add_on_set_parameters_callback(self._judge)

    def declare(self, name: str, declaration: Declaration) -> ParameterValue:
        """Declare a parameter."""
        value = default = parameter(name, declaration.default)
        given = self._node.given_parameters.take(name)
        if given is not None:
            # rclpy's own error messages do not say what to write.
            for candidate in (checked_value(declaration.default), given):
                if (fault := fault_of(candidate, declaration)) is not None:
                    raise ParameterRefused(f"parameter {name} of {self.node} is {fault}")
            value = parameter(name, given, default.type_)
        if declaration.accept is not None and not self._node.rcl.has_parameter(name):
            self._judges[name] = declaration.accept
        try:
            made = self._node.rcl.declare_parameter(
                name, value.value, _descriptor(default, declaration), ignore_override=True
            )
        except ParameterAlreadyDeclaredException:
            raise ParameterRefused(f"parameter {name} of {self.node} is already declared") from None
        except (
            InvalidParameterException,
            InvalidParameterValueException,
            InvalidParameterTypeException,
            ValueError,
        ) as problem:
            self._judges.pop(name, None)
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
        self._judges.pop(name, None)

    async def names(self, timeout: float | None = None) -> list[str]:
        """Names of the node's parameters."""
        return self._names()

    def _names(self) -> list[str]:
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
        value: ParameterValue = (
            b"" if told.type_ == Parameter.Type.BYTE_ARRAY and not told.value else (plain_value(told.value))
        )
        return value

    def _unknown(self, name: str) -> str:
        return f"node {self.node} has no parameter {name}; it has {', '.join(self._names())}"

    def _judge(self, changes: list[Any]) -> Any:
        """Decide about changes; called by rclpy on the thread that makes them."""
        for change in changes:
            accept = self._judges.get(change.name)
            if accept is not None and (reason := self._judged(accept, self._value(change))) is not None:
                return SetParametersResult(successful=False, reason=reason)
        return SetParametersResult(successful=True)

    def _judged(self, accept: Callable[[ParameterValue], str | None], value: ParameterValue) -> str | None:
        def judge(report: Callable[[str | None, Exception | None], None]) -> None:
            try:
                report(accept(value), None)
            except Exception as problem:  # the node keeps running, and the caller receives the reason
                reason = f"{type(problem).__name__}: {problem}"
                self._node.log(f"the check of a parameter of {self.node} failed: {reason}")
                report(reason, None)

        if threading.get_ident() == self._loops_thread:
            told: list[str | None] = []
            judge(lambda reason, _: told.append(reason))
            return told[0]
        try:
            return ask(self._node.loop, judge, lambda: self._node.ended)
        except LoopEnded:
            return "the node is leaving"


class OtherParameters:
    """The parameters of another node, through the services of every node."""

    def __init__(self, node: Ros2Node, name: str, events: ParameterEvents) -> None:
        self.node = name
        self._node = node
        self._parameter_events = events
        self._services = ParameterServices(name, self._client)

    def declare(self, name: str, declaration: Declaration) -> ParameterValue:
        """Refuse: only the node itself can do that."""
        raise self._not_ours()

    def withdraw(self, name: str) -> None:
        """Refuse: only the node itself can do that."""
        raise self._not_ours()

    async def names(self, timeout: float | None = None) -> list[str]:
        """Names of the node's parameters."""
        answer = await self._read("ListParameters", {"depth": 0}, timeout)
        return sorted(answer.result.names)

    async def get(self, name: str, timeout: float | None = None) -> ParameterValue:
        """Return a parameter's value."""
        answer = await self._read("GetParameters", {"names": [name]}, timeout)
        value = plain_value(parameter_value_to_python(answer.values[0])) if len(answer.values) == 1 else None
        if value is None:
            raise ParameterUnknown(f"node {self.node} has no parameter {name}, or it has no value")
        if value == [] and answer.values[0].type == ParameterType.PARAMETER_BYTE_ARRAY:
            return b""
        return value  # type: ignore[no-any-return]

    async def set(self, name: str, value: ParameterValue, timeout: float | None = None) -> None:
        """Change a parameter."""
        kind = None
        if isinstance(value, list | tuple) and not value:
            kind = Parameter.Type(await self._type(name, timeout) or ParameterType.PARAMETER_STRING_ARRAY)
        wanted = parameter(name, value, kind).to_parameter_msg()
        answer = await self._services.call("SetParameters", {"parameters": [wanted]}, timeout)
        result = (
            answer.results[0] if answer.results else SetParametersResult(reason="the node gave no reason")
        )
        if result.successful:
            return
        if not await self._type(name, timeout):
            raise ParameterUnknown(f"node {self.node} has no parameter {name}")
        raise ParameterRefused(f"parameter {name} of {self.node} cannot be {value!r}: {result.reason}")

    def on_change(self, callback: Callable[[Mapping[str, ParameterValue]], None]) -> Callable[[], None]:
        """Call *callback* with changed parameters."""
        return self._parameter_events.listen(self.node, callback)

    def _not_ours(self) -> CapabilityMissing:
        return CapabilityMissing(
            f"only {self.node} itself can declare its parameters; {self._node.node_name} can only get and set them"
        )

    async def _type(self, name: str, timeout: float | None) -> int:
        """Return the number of a parameter's type; 0 if it does not exist."""
        answer = await self._read("GetParameterTypes", {"names": [name]}, timeout)
        return int(answer.types[0]) if len(answer.types) == 1 else ParameterType.PARAMETER_NOT_SET

    async def _read(self, service: str, request: Mapping[str, Any], timeout: float | None) -> Any:
        """Call a service, and call again if the node went away and is back: it was restarted without being noticed."""
        clock = self._node.clock
        deadline = None if timeout is None else clock.elapsed + timeout
        while True:
            try:
                rest = None if deadline is None else deadline - clock.elapsed
                return await self._services.call(service, request, rest)
            except ServerGone:
                late = deadline is not None and clock.elapsed >= deadline
                if late or not self._services.client(service).ready:
                    raise

    def _client(self, name: str, type_name: str) -> Ros2Client:
        return self._node.keep(Ros2Client(self._node, name, type_name, repeatable=True))


def _descriptor(default: Any, declaration: Declaration) -> Any:
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
