"""What is in the graph, as rosapi tells it."""

import asyncio
from collections.abc import Iterable
from typing import Any

from jacaros.ros.backends.rosbridge_node import BridgeNode
from jacaros.ros.errors import CallFailed, ServiceError
from jacaros.ros.graph import Endpoint, GraphContents, TopicInfo
from jacaros.ros.names import action_type, message_type, service_type

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
