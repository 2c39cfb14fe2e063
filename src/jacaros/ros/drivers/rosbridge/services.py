"""Services through the bridge, as client and server, and rosapi's services for the graph and for parameters."""

import asyncio
import json
from collections.abc import Callable, Iterable, Mapping
from functools import partial
from typing import Any

from jacaros.ros.backend import Handler
from jacaros.ros.calling import AttemptingClient, ServerWatch
from jacaros.ros.drivers.rosbridge.node import BridgeNode
from jacaros.ros.errors import (
    CallFailed,
    CapabilityMissing,
    MessageMismatch,
    ParameterRefused,
    ParameterUnknown,
    ServiceError,
)
from jacaros.ros.graph import Endpoint, GraphContents, TopicInfo
from jacaros.ros.names import action_type, message_type, request_type, response_type, service_type
from jacaros.ros.parameter import Declaration, ParameterValue, checked_value
from jacaros.ros.parameter_events import ParameterEvents
from jacaros.ros.parameter_services import NodeParameters
from jacaros.ros.serving import Responder
from jacaros.ros.waiting import settle, within

_NOT_OUR_DEFINITION = ("does not have a field", "message requires a", "Expected a JSON object")
"""Parts of the server's error for a request that does not match its definition."""

FOR_EVER = 86400.0
"""Time-out of a call without one, for servers that would otherwise use five seconds."""


class BridgeClient(AttemptingClient):
    """Client of `RosbridgeBackend`."""

    _node: BridgeNode  # pyright: ignore[reportIncompatibleVariableOverride]

    def __init__(self, node: BridgeNode, name: str, type_name: str) -> None:
        node.schema.service(type_name)
        super().__init__(node, name, type_name)  # pyright: ignore[reportArgumentType]
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
        answer = self._pending.new()
        arguments = node.translator.encode(request_type(self._type_name), message)
        patience = FOR_EVER if rest is None else rest
        number = node.requests.begin(self.name, arguments, partial(settle, answer), patience)
        try:
            with ServerWatch(node.clock, self.name, answer, lambda: self._offered.value):
                values = await within(node.clock, answer, rest)
        except CallFailed as problem:
            if "Timeout exceeded" in str(problem) and rest is not None:
                raise TimeoutError from None
            if any(words in str(problem) for words in _NOT_OUR_DEFINITION):
                raise MessageMismatch(str(problem), self._type_name) from None
            raise
        finally:
            node.requests.forget(number)
        try:
            return node.translator.decode(response_type(self._type_name), values)
        except ValueError as problem:
            raise CallFailed(
                f"service {self.name}: the response is not a {self._type_name}: {problem}"
            ) from None

    def close(self) -> None:
        """Close the client."""
        self._node.forget(self)
        self._pending.close()


class BridgeService:
    """Service of `RosbridgeBackend`."""

    def __init__(self, node: BridgeNode, name: str, type_name: str, handler: Handler) -> None:
        node.schema.service(type_name)
        node.handlers["call_service", name] = self._called
        self.name = name
        self._node = node
        self._type_name = type_name
        self._responder = Responder(node.factory, name, type_name, handler, node.log)
        self._closed = False
        if node.attached:
            self.join()

    def join(self) -> None:
        """Offer the service at a server that does not know us yet."""
        kind = self._node.written_type(self._type_name)
        self._node.send({"op": "advertise_service", "type": kind, "service": self.name})

    def close(self) -> None:
        """Stop offering the service."""
        self._responder.close()
        if not self._closed:
            self._closed = True
            self._node.forget(self)
            self._node.unhandle(self._called, "call_service", self.name)
            self._node.send({"op": "unadvertise_service", "service": self.name})

    def _called(self, message: dict[str, Any]) -> None:
        node, number = self._node, message.get("id")
        try:
            request = node.translator.decode(request_type(self._type_name), message.get("args") or {})
        except ValueError as problem:
            node.log(f"service {self.name}: the request is not a {self._type_name}: {problem}")
            return

        def done(response: Any, problem: ServiceError | None) -> None:
            answer = {"op": "service_response", "id": number, "service": self.name}
            if problem is None:
                answer["values"] = node.translator.encode(response_type(self._type_name), response)
                node.send(answer | {"result": True})
            # The server cannot pass on a failure (it would send a response of zeros): as on ROS 2, the call gets no
            # answer.

        self._responder.answer(request, done)


_ACTIONLIB = ("goal", "cancel", "feedback", "result", "status")
_PARAMETER_SERVICES = (
    "describe_parameters",
    "get_parameter_types",
    "get_parameters",
    "get_type_description",
    "list_parameters",
    "set_parameters",
    "set_parameters_atomically",
)
_LOGS = ("/rosout", "/rosout_agg", "/parameter_events")
AT_ONCE = 8
"""Number of concurrent requests; older servers answer them in turn anyway."""


async def look(backend: BridgeNode, timeout: float) -> GraphContents:
    """Return the contents of the graph according to rosapi. Raises `ServiceError`."""
    try:
        async with asyncio.timeout(timeout):
            return await _Look(backend).contents()
    except TimeoutError:
        raise CallFailed(f"rosapi did not return the contents of the graph within {timeout:g} s") from None


class _Look:
    def __init__(self, backend: BridgeNode) -> None:
        self._backend = backend
        self._gate = asyncio.Semaphore(AT_ONCE)

    async def contents(self) -> GraphContents:
        topics, services, nodes, actions = await asyncio.gather(
            self._ask("topics"),
            self._ask("services"),
            self._ask("nodes"),
            self._known("action_servers", "action_servers", ()),
        )
        types = dict(zip(topics["topics"], topics["types"], strict=True))
        hidden = {f"{action}/{part}" for action in actions for part in _ACTIONLIB}
        shown = [
            name for name in types if name not in _LOGS and name not in hidden and "/_action/" not in name
        ]
        infos = await asyncio.gather(*(self._topic(name, types[name]) for name in shown))
        plain = [name for name in services["services"] if not _is_internal(name)]
        kinds = await asyncio.gather(
            *(self._known("service_type", "type", "", service=name) for name in plain)
        )
        found = await asyncio.gather(*(self._action(name, types) for name in actions))
        return GraphContents(
            {info.name: info for info in infos},
            {name: _full(service_type, kind) for name, kind in zip(plain, kinds, strict=True)},
            {name: kind for name, kind, served in found if served},
            tuple(sorted(absolute(nodes["nodes"]))),
        )

    async def _topic(self, name: str, kind: str) -> TopicInfo:
        publishers, subscribers = await asyncio.gather(
            self._ask("publishers", topic=name), self._ask("subscribers", topic=name)
        )
        return TopicInfo(
            name,
            tuple(sorted(_full(message_type, each) for each in kind.split(",") if each)),
            tuple(Endpoint(node) for node in absolute(publishers["publishers"])),
            tuple(Endpoint(node) for node in absolute(subscribers["subscribers"])),
        )

    async def _action(self, name: str, types: dict[str, str]) -> tuple[str, str, bool]:
        """Return an action's name, its type, and whether a server offers it."""
        goal = types.get(f"{name}/goal", "")
        if goal.endswith("ActionGoal"):  # ROS 1
            # rosapi of ROS 1 uses the names of topics, and a client alone has all five, too.
            servers = await self._ask("publishers", topic=f"{name}/status")
            return name, _full(action_type, goal.removesuffix("ActionGoal")), bool(servers["publishers"])
        kind = await self._known("action_type", "type", "", action=name)
        return name, _full(action_type, kind), True

    async def _known(self, what: str, field: str, unknown: Any, **arguments: str) -> Any:
        """Return a field of an answer, *unknown* if an older server has none."""
        try:
            return (await self._ask(what, **arguments)).get(field, unknown)
        except ServiceError:
            return unknown

    async def _ask(self, what: str, **arguments: str) -> dict[str, Any]:
        async with self._gate:
            answer: dict[str, Any] = await self._backend.rosapi(what, arguments)
            return answer


def _full(form: Any, name: str) -> str:
    return str(form(name)) if name else ""


def absolute(names: Iterable[str]) -> list[str]:
    """Return names with the slash that rosapi omits."""
    return [name if name.startswith("/") else f"/{name}" for name in names]


def _is_internal(name: str) -> bool:
    last = name.rsplit("/", 1)[-1]
    return (
        "/_action/" in name
        or last in _PARAMETER_SERVICES
        or last in ("get_loggers", "set_logger_level", "get_logger_levels", "set_logger_levels")
        or name.startswith("/rosapi/")  # the services that we use
    )


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

    def declare(self, name: str, declaration: Declaration) -> ParameterValue:
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
