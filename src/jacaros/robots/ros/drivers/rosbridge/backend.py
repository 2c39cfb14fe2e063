"""A robot behind a rosbridge server, for a machine without ROS: JSON over a WebSocket.

The server (``rosbridge_server`` of ROS 1 or ROS 2) is the node in the graph; we are one of its clients. So the graph
knows us by the server's name, and what rosapi, the node next to it, does not report remains unknown. The version of
ROS is requested at each connection. The message classes are those of the `memory` backend.

Everything happens on the loop; only exit hooks may send from another thread (see `Link`).
"""

import asyncio
from collections.abc import Iterable
from typing import Any

from jacaros.robots.ros.backend import Backend, Endpoint, GraphContents, TopicInfo
from jacaros.robots.ros.drivers.rosbridge.actions import BridgeActionClient, BridgeActionServer
from jacaros.robots.ros.drivers.rosbridge.node import BridgeNode
from jacaros.robots.ros.drivers.rosbridge.services import (
    BridgeClient,
    BridgeParameters,
    BridgeService,
)
from jacaros.robots.ros.drivers.rosbridge.topics import BridgePublisher, BridgeSubscription
from jacaros.robots.ros.errors import CallFailed, CapabilityMissing, ServiceError
from jacaros.robots.ros.names import action_type, message_type, service_type
from jacaros.robots.ros.node import Capability, NodeSettings, Parts
from jacaros.robots.ros.open import GraphAddress
from jacaros.robots.ros.parameter_services import NODE_SERVICES, ParameterEvents, read_value
from jacaros.robots.ros.protocols.rosbridge_wire import PATIENCE

_ACTIONLIB = ("goal", "cancel", "feedback", "result", "status")
_LOGS = ("/rosout", "/rosout_agg", "/parameter_events")
AT_ONCE = 8
"""Number of concurrent requests; older servers answer them in turn anyway."""


class _Look:
    """One look at the graph according to rosapi."""

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
        or last in NODE_SERVICES
        or last in ("get_loggers", "set_logger_level", "get_logger_levels", "set_logger_levels")
        or name.startswith("/rosapi/")  # the services that we use
    )


class RosbridgeBackend(BridgeNode):
    """A client of a rosbridge server.

    Args:
        settings: names, clock and log.
        url: address of the server; default: ``ROSBRIDGE_URI``, else port 9090 of this machine.
    """

    name = "rosbridge"
    parts = Parts(
        publisher=BridgePublisher,
        subscription=BridgeSubscription,
        service=BridgeService,
        client=BridgeClient,
        action_client=BridgeActionClient,
        action_server=BridgeActionServer,
    )

    def __init__(self, settings: NodeSettings, url: str | None = None) -> None:
        if settings.parameters:
            raise CapabilityMissing(
                f"parameter {next(iter(settings.parameters))} cannot be set: over rosbridge there is no node of our own, "
                "and so there are no parameters"
            )
        super().__init__(settings, url or GraphAddress("rosbridge").identity)
        self._parameter_events = ParameterEvents(self.subscription, read_value)

    @property
    def capabilities(self) -> frozenset[Capability]:  # type: ignore[override]
        """The capabilities with the robot's version of ROS."""
        # Only services of ROS 1 that are not served over a bridge report failed handlers.
        events = {Capability.PARAMETER_EVENTS} if self.ros_version == 2 else set()
        return frozenset(
            {
                Capability.TOPICS,
                Capability.SERVICES,
                Capability.TRANSFORMS,
                Capability.ACTIONS,
                Capability.DISCOVERY,
                Capability.PARAMETERS,
                *events,
            }
        )

    def parameters(self, node: str | None = None) -> BridgeParameters:
        """Return the parameters of a node; our own exist on ROS 1 only, where the master stores them."""
        return BridgeParameters(
            self, self.node_name if node is None else self.resolve(node), self._parameter_events
        )

    async def contents(self, timeout: float = 5.0) -> GraphContents:
        """Return the contents of the graph."""
        try:
            async with asyncio.timeout(timeout):
                return await _Look(self).contents()
        except TimeoutError:
            raise CallFailed(
                f"rosapi did not return the contents of the graph within {timeout:g} s"
            ) from None

    async def _publishers(self, topic: str) -> list[str]:
        answer = await self.rosapi("publishers", {"topic": topic}, PATIENCE)
        # The server publishes for its clients, and does not tell which.
        return [name for name in absolute(answer["publishers"]) if "rosbridge" not in name]


BACKEND: type[Backend] = RosbridgeBackend
