"""Services through the bridge, both ways, and what rosapi's services tell of the graph."""

import asyncio
from collections.abc import Iterable
from functools import partial
from typing import Any

from jacaros.ros.backend import Handler
from jacaros.ros.calling import AttemptingClient, ServerWatch, settle
from jacaros.ros.drivers.rosbridge.node import BridgeNode
from jacaros.ros.errors import CallFailed, MessageMismatch, ServiceError
from jacaros.ros.graph import Endpoint, GraphContents, TopicInfo
from jacaros.ros.names import action_type, message_type, request_type, response_type, service_type
from jacaros.ros.protocols.rosbridge_requests import Sight
from jacaros.ros.serving import Responder
from jacaros.ros.waiting import within

_NOT_OUR_DEFINITION = ("does not have a field", "message requires a", "Expected a JSON object")
"""What the server says of a request whose fields are others in its definition."""

FOR_EVER = 86400.0
"""The time-out of a call without one, for servers that would choose five seconds themselves."""


class BridgeClient(AttemptingClient):
    """Client of `RosbridgeBackend`."""

    _node: BridgeNode  # pyright: ignore[reportIncompatibleVariableOverride]

    def __init__(self, node: BridgeNode, name: str, type_name: str) -> None:
        node.schema.service(type_name)
        super().__init__(node, name, type_name)  # pyright: ignore[reportArgumentType]
        self._offered = Sight(
            node.requests, "/rosapi/service_type", {"service": name}, lambda seen: bool(seen["type"]), False
        )

    @property
    def ready(self) -> bool:
        """Whether somebody offers the service, as the bridge said a second ago at most."""
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
                f"service {self.name}: the response is no {self._type_name}: {problem}"
            ) from None

    def close(self) -> None:
        """Give the client up."""
        self._node.forget(self)
        self._pending.close()


class BridgeService:
    """Service of `RosbridgeBackend`."""

    def __init__(self, node: BridgeNode, name: str, type_name: str, handler: Handler) -> None:
        node.schema.service(type_name)
        node.services[name] = self
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
        """Stop to offer the service."""
        self._responder.close()
        if not self._closed:
            self._closed = True
            self._node.forget(self)
            self._node.send({"op": "unadvertise_service", "service": self.name})

    def called(self, message: dict[str, Any]) -> None:
        """Take a request of the server; on the loop."""
        node, number = self._node, message.get("id")
        try:
            request = node.translator.decode(request_type(self._type_name), message.get("args") or {})
        except ValueError as problem:
            node.log(f"service {self.name}: a request is no {self._type_name}: {problem}")
            return

        def done(response: Any, problem: ServiceError | None) -> None:
            answer = {"op": "service_response", "id": number, "service": self.name}
            if problem is None:
                answer["values"] = node.translator.encode(response_type(self._type_name), response)
                node.send(answer | {"result": True})
            # The server has no way to pass a failure on (it would send a response of zeros): as on ROS 2 the call
            # gets no answer.

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
"""Questions under way at the same time: older servers answer one after the other anyway."""


async def look(backend: BridgeNode, timeout: float) -> GraphContents:
    """Ask rosapi for all that is there; raises `ServiceError`."""
    try:
        async with asyncio.timeout(timeout):
            return await _Look(backend).contents()
    except TimeoutError:
        raise CallFailed(f"rosapi did not tell the graph's contents within {timeout:g} s") from None


class _Look:
    def __init__(self, backend: BridgeNode) -> None:
        self._backend = backend
        self._gate = asyncio.Semaphore(AT_ONCE)

    async def contents(self) -> GraphContents:
        topics, services, nodes, actions = await asyncio.gather(
            self._ask("topics"), self._ask("services"), self._ask("nodes"), self._action_servers()
        )
        types = dict(zip(topics["topics"], topics["types"], strict=True))
        hidden = {f"{action}/{part}" for action in actions for part in _ACTIONLIB}
        shown = [
            name for name in types if name not in _LOGS and name not in hidden and "/_action/" not in name
        ]
        infos = await asyncio.gather(*(self._topic(name, types[name]) for name in shown))
        plain = [name for name in services["services"] if not _is_internal(name)]
        kinds = await asyncio.gather(*(self._type("service_type", "service", name) for name in plain))
        found = await asyncio.gather(*(self._action(name, types) for name in actions))
        return GraphContents(
            {info.name: info for info in infos},
            {name: _full(service_type, kind) for name, kind in zip(plain, kinds, strict=True)},
            {name: kind for name, kind, served in found if served},
            tuple(sorted(_absolute(nodes["nodes"]))),
        )

    async def _topic(self, name: str, kind: str) -> TopicInfo:
        publishers, subscribers = await asyncio.gather(
            self._ask("publishers", topic=name), self._ask("subscribers", topic=name)
        )
        return TopicInfo(
            name,
            tuple(sorted(_full(message_type, each) for each in kind.split(",") if each)),
            tuple(Endpoint(node) for node in _absolute(publishers["publishers"])),
            tuple(Endpoint(node) for node in _absolute(subscribers["subscribers"])),
        )

    async def _action_servers(self) -> list[str]:
        try:
            answer = await self._ask("action_servers")
        except ServiceError:  # an older server
            return []
        return list(answer.get("action_servers", ()))

    async def _action(self, name: str, types: dict[str, str]) -> tuple[str, str, bool]:
        """Its name, its type, and whether somebody serves it."""
        goal = types.get(f"{name}/goal", "")
        if goal.endswith("ActionGoal"):  # ROS 1
            # rosapi of ROS 1 goes by the names of topics, and a client alone makes all five too.
            servers = await self._ask("publishers", topic=f"{name}/status")
            return name, _full(action_type, goal.removesuffix("ActionGoal")), bool(servers["publishers"])
        kind = await self._type("action_type", "action", name)
        return name, _full(action_type, kind), True

    async def _type(self, service: str, argument: str, name: str) -> str:
        try:
            return str((await self._ask(service, **{argument: name})).get("type", ""))
        except ServiceError:
            return ""

    async def _ask(self, what: str, **arguments: str) -> dict[str, Any]:
        async with self._gate:
            answer: dict[str, Any] = await self._backend.rosapi(what, arguments)
            return answer


def _full(form: Any, name: str) -> str:
    return str(form(name)) if name else ""


def _absolute(names: Iterable[str]) -> list[str]:
    return [name if name.startswith("/") else f"/{name}" for name in names]


def _is_internal(name: str) -> bool:
    last = name.rsplit("/", 1)[-1]
    return (
        "/_action/" in name
        or last in _PARAMETER_SERVICES
        or last in ("get_loggers", "set_logger_level", "get_logger_levels", "set_logger_levels")
        or name.startswith("/rosapi/")  # what we look with
    )
