"""Services through the bridge, as client and server, and parameters."""

import json
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

from jacaros.robots.ros.drivers.rosbridge.node import BridgeNode
from jacaros.robots.ros.errors import (
    CallFailed,
    CapabilityMissing,
    MessageMismatch,
    ParameterRefused,
    ParameterUnknown,
    ServiceError,
)
from jacaros.robots.ros.names import request_type, response_type
from jacaros.robots.ros.parameter import DeclaredParameter, ParameterValue, checked_value
from jacaros.robots.ros.parameter_services import NodeParameters, ParameterEvents
from jacaros.robots.ros.services import Handler, ServerWatch, ServiceClient, ServiceServer
from jacaros.robots.ros.waiting import settle, within

_NOT_OUR_DEFINITION = ("does not have a field", "message requires a", "Expected a JSON object")
"""Parts of the server's error for a request that does not match its definition."""

FOR_EVER = 86400.0
"""Time-out of a call without one, for servers that would otherwise use five seconds."""


class BridgeClient(ServiceClient[BridgeNode]):
    """Client of `RosbridgeBackend`."""

    def __init__(self, node: BridgeNode, name: str, type_name: str) -> None:
        node.schema.load(type_name)
        super().__init__(node, name, type_name)
        self._offered = node.polled("service_type", lambda seen: bool(seen["type"]), False, service=name)

    @property
    def ready(self) -> bool:
        """Whether a node offers the service, according to the bridge at most 1 s ago."""
        return self._node.connected and self._offered.value

    def _may_be_called(self) -> bool:
        return self.ready

    async def _attempt(self, message: Any, rest: float | None) -> Any:
        node = self._node
        node.require_connection(self.name)
        answer = self._new_answer()
        arguments = node.translator.encode(request_type(self.type_name), message)
        patience = FOR_EVER if rest is None else rest
        number = node.requests.begin(self.name, arguments, partial(settle, answer), patience)
        try:
            with ServerWatch(node.clock, self.name, answer, lambda: self._offered.value):
                values = await within(node.clock, answer, rest)
        except CallFailed as problem:
            if "Timeout exceeded" in str(problem) and rest is not None:
                raise TimeoutError from None
            if any(words in str(problem) for words in _NOT_OUR_DEFINITION):
                raise MessageMismatch(str(problem), self.type_name) from None
            raise
        finally:
            node.requests.forget(number)
        try:
            return node.translator.decode(response_type(self.type_name), values)
        except ValueError as problem:
            raise CallFailed(
                f"service {self.name}: the response is not a {self.type_name}: {problem}"
            ) from None


class BridgeService(ServiceServer[BridgeNode]):
    """Service of `RosbridgeBackend`."""

    def __init__(self, node: BridgeNode, name: str, type_name: str, handler: Handler) -> None:
        node.schema.load(type_name)
        super().__init__(node, name, type_name, handler)
        node.handlers["call_service", name] = self._called
        if node.attached:
            self.join()

    def join(self) -> None:
        """Offer the service at a server that does not know us yet."""
        kind = self._node.written_type(self.type_name)
        self._node.send({"op": "advertise_service", "type": kind, "service": self.name})

    def _leave(self) -> None:
        self._node.unhandle(self._called, "call_service", self.name)
        self._node.send({"op": "unadvertise_service", "service": self.name})

    def _called(self, message: dict[str, Any]) -> None:
        node, number = self._node, message.get("id")
        try:
            request = node.translator.decode(request_type(self.type_name), message.get("args") or {})
        except ValueError as problem:
            node.log(f"service {self.name}: the request is not a {self.type_name}: {problem}")
            return

        def done(response: Any, problem: ServiceError | None) -> None:
            answer = {"op": "service_response", "id": number, "service": self.name}
            if problem is None:
                answer["values"] = node.translator.encode(response_type(self.type_name), response)
                node.send(answer | {"result": True})
            # The server cannot pass on a failure (it would send a response of zeros): as on ROS 2, the call gets no
            # answer.

        self.answer(request, done)


_ABSENT = "jacaros: no such parameter"
"""The default in the request: rosapi has no other way to report a missing parameter."""


class BridgeParameters(NodeParameters):
    """Parameters of one node, seen from outside; on ROS 1 those of the master below its name, through rosapi.

    Args:
        backend: sends the requests.
        node: absolute name of the node.
        events: reports changes on ROS 2.
    """

    def __init__(self, backend: BridgeNode, node: str, events: ParameterEvents) -> None:
        super().__init__(backend.clock, node, self._make_bridge_client, events)
        self._backend = backend

    def declare(self, name: str, declaration: DeclaredParameter) -> ParameterValue:
        """Raise `CapabilityMissing`: over a bridge there is no node of our own with parameters."""
        raise self._missing(f"parameter {name} cannot be declared")

    def withdraw(self, name: str) -> None:
        """Raise `CapabilityMissing`, as `declare`."""
        raise self._missing(f"parameter {name} cannot be withdrawn")

    async def names(self, timeout: float | None = None) -> list[str]:
        """Names of the node's parameters, sorted."""
        if not self._are_of_master:
            return await super().names(timeout)
        answer = await self._backend.rosapi("get_param_names", {}, timeout)
        prefix = f"{self.node}/"
        return sorted(name.removeprefix(prefix) for name in answer["names"] if name.startswith(prefix))

    async def get(self, name: str, timeout: float | None = None) -> ParameterValue:
        """Return a parameter's value."""
        if not self._are_of_master:
            return await super().get(name, timeout)
        arguments = {"name": f"{self.node}/{name}", "default_value": json.dumps(_ABSENT)}
        text = (await self._backend.rosapi("get_param", arguments, timeout)).get("value", "")
        try:
            value = json.loads(text) if text != "" else _ABSENT
        except ValueError:
            value = text
        if value == _ABSENT or value is None:
            raise ParameterUnknown(f"node {self.node} has no parameter {name}")
        if isinstance(value, list) and {type(each) for each in value} == {int, float}:
            value = [float(each) for each in value]
        try:
            return checked_value(value)
        except ParameterRefused:
            text = f"parameter {name} of node {self.node} has an unsupported value: {value!r}"
            raise CallFailed(text) from None

    async def set(self, name: str, value: ParameterValue, timeout: float | None = None) -> None:
        """Change a parameter."""
        if not self._are_of_master:
            await super().set(name, value, timeout)
            return
        if isinstance(value, bytes):
            raise ParameterRefused(
                f"parameter {name}: the rosbridge protocol does not support bytes in parameters"
            )
        arguments = {"name": f"{self.node}/{name}", "value": json.dumps(checked_value(value))}
        await self._backend.rosapi("set_param", arguments, timeout)

    def on_change(self, callback: Callable[[Mapping[str, ParameterValue]], None]) -> Callable[[], None]:
        """Call *callback* with changed parameters; on ROS 2 only, because rosapi of ROS 1 does not report changes."""
        if self._are_of_master:
            raise self._missing(f"changes of parameters of {self.node} are not reported")
        return super().on_change(callback)

    @property
    def _are_of_master(self) -> bool:
        """Whether the robot has ROS 1. On ROS 2 parameters belong to nodes, and we have none."""
        if self._backend.ros_version == 2 and self.node == self._backend.node_name:
            raise CapabilityMissing(
                "over rosbridge there is no node of our own, and so there are no parameters of our own; "
                "name another node"
            )
        return self._backend.ros_version == 1

    def _missing(self, what: str) -> CapabilityMissing:
        return CapabilityMissing(f"{what} over rosbridge; run on the robot itself, with --ros ros2")

    def _make_bridge_client(self, name: str, type_name: str) -> BridgeClient:
        return self._backend.keep(BridgeClient(self._backend, name, type_name))
