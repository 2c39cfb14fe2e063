"""Services of ROS 1, as server and client, and its parameters: a tree of values that the master stores for all
nodes."""

import asyncio
from collections.abc import Callable, Iterator, Mapping
from datetime import datetime
from typing import Any, NoReturn

import rospy  # type: ignore[import-not-found]

from jacaros.robots.ros.drivers.ros1.node import Master, Ros1Node, call_failure
from jacaros.robots.ros.errors import (
    CallFailed,
    CapabilityMissing,
    NameInvalid,
    ParameterRefused,
    ParameterUnknown,
    ServiceUnavailable,
)
from jacaros.robots.ros.handoff import LoopEnded, ask, in_thread, post
from jacaros.robots.ros.parameter import DeclaredParameter, ParameterValue, checked_value
from jacaros.robots.ros.services import Handler, ServiceClient, ServiceServer, call_when_offered
from jacaros.robots.ros.waiting import WaitLog, settle, within


class Ros1Service(ServiceServer[Ros1Node]):
    """Service of `Ros1Backend`."""

    def __init__(self, node: Ros1Node, name: str, type_name: str, handler: Handler) -> None:
        super().__init__(node, name, type_name, handler)
        self._class = node.schema.service_class(type_name)
        self._service: Any = None
        node.link.do(self._register)

    def _leave(self) -> None:
        self._node.link.do(self._unregister)

    def _register(self) -> None:
        self._service = rospy.Service(self.name, self._class, self._serve)

    def _unregister(self) -> None:
        if self._service is not None:
            self._service.shutdown("closed")

    def _serve(self, request: Any) -> Any:
        """Let the loop answer; on rospy's thread of this connection."""
        node = self._node
        try:
            return ask(node.loop, lambda done: self.answer(request, done), lambda: node.lifetime.leaving)
        except CallFailed as problem:
            raise rospy.ServiceException(str(problem)) from None
        except LoopEnded:
            raise rospy.ServiceException(f"service {self.name}: the node is shutting down") from None


class Ros1Client(ServiceClient[Ros1Node]):
    """Client of `Ros1Backend`."""

    def __init__(self, node: Ros1Node, name: str, type_name: str) -> None:
        super().__init__(node, name, type_name)
        self._class = node.schema.service_class(type_name)

    @property
    def ready(self) -> bool:
        """Whether a node offers the service, according to the master at most 0.25 s ago."""
        return self.name in self._node.link.services

    def _may_be_called(self) -> bool:
        return self.ready

    async def _attempt(self, message: Any, rest: float | None) -> Any:
        answer = self._new_answer()

        def finished(work: asyncio.Future[Any]) -> None:
            problem = work.exception()
            settle(answer, None if problem else work.result(), call_failure(self.name, problem))

        # A proxy for each call, because rospy's does not support concurrent calls. Only persistent ones can be closed
        # from outside, and a server that never answers would block its thread forever.
        proxy = rospy.ServiceProxy(self.name, self._class, persistent=True)

        def call() -> Any:
            try:
                return proxy(message)
            finally:
                proxy.close()

        in_thread(self._node.loop, call, f"call {self.name}").add_done_callback(finished)
        try:
            return await within(self._node.clock, answer, rest)
        finally:
            proxy.close()


WHOLE_NUMBERS = range(-(2**31), 2**31)
"""The range of XML-RPC."""


class Ros1Parameters:
    """The parameters below the name of a node.

    Args:
        node: asks the master.
        name: name of the node; None for our own, ``/`` for all parameters of the master.
    """

    def __init__(self, node: Ros1Node, name: str | None) -> None:
        self._backend = node
        if name is None:
            self.node = node.node_name
        else:
            self.node = "/" if name == "/" else node.resolve(name)
        self._prefix = "/" if self.node == "/" else f"{self.node}/"
        self._master = Master(node.master_uri, node.node_name)

    def declare(self, name: str, declaration: DeclaredParameter) -> NoReturn:
        """Refuse: ROS 1 has no declarations."""
        raise CapabilityMissing(
            f"parameter {name} cannot be declared: on ROS 1 the master stores the parameters and accepts any name and "
            "value; read it with `get`, and set it if it does not exist"
        )

    def withdraw(self, name: str) -> NoReturn:
        """Refuse: ROS 1 has no declarations."""
        raise CapabilityMissing(f"parameter {name} cannot be withdrawn: on ROS 1 nothing is declared")

    async def names(self, timeout: float | None = None) -> list[str]:
        """Names of the parameters below the node, sorted."""
        everything = await self._ask(timeout, "getParamNames")
        return sorted(name[len(self._prefix) :] for name in everything if name.startswith(self._prefix))

    async def get(self, name: str, timeout: float | None = None) -> ParameterValue:
        """Return a parameter's value."""
        key = self._key(name)
        try:
            value = await self._ask(timeout, "getParam", key)
        except CallFailed:
            raise ParameterUnknown(f"the ROS master has no parameter {key}") from None
        if isinstance(value, dict):
            if not value:
                raise ParameterUnknown(f"the ROS master has no parameter {key}")
            parts = ", ".join(f"{name}/{part}" for part, _ in _leaves(value))
            raise ParameterUnknown(f"parameter {key} is a mapping; read its parts: {parts}")
        given: ParameterValue = _given(value)
        return given

    async def set(self, name: str, value: ParameterValue, timeout: float | None = None) -> None:
        """Change a parameter, or add it."""
        key = self._key(name)
        plain = _plain(key, value)
        await self._ask(timeout, "setParam", key, plain)
        # The master does not report a change to the node that made it.
        self._backend.parameter_changed(key, plain)

    def on_change(self, callback: Callable[[Mapping[str, ParameterValue]], None]) -> Callable[[], None]:
        """Call *callback* with changed parameters below the node."""
        backend = self._backend

        def told(key: str, value: Any) -> None:
            key = f"/{key.strip('/')}"
            if not key.startswith(self._prefix) and f"{key}/" != self._prefix:
                return
            name = key[len(self._prefix) :]
            # An empty mapping means that the parameter was deleted.
            changed = dict(_leaves(value, name)) if isinstance(value, dict) else {name: _given(value)}
            if changed:
                callback(changed)

        def begin() -> None:
            if not ended:
                backend.on_parameter[told] = None

        def subscribe() -> None:
            self._master.ask("subscribeParam", rospy.get_node_uri(), self.node)
            post(backend.loop, begin)

        def again() -> None:
            backend.link.do(subscribe)

        def end() -> None:
            ended.append(True)
            backend.on_parameter.pop(told, None)
            backend.on_return.pop(again, None)

        ended: list[bool] = []
        backend.on_return[again] = None
        again()
        return end

    def _key(self, name: str) -> str:
        key = name if name.startswith("/") else self._prefix + name.removeprefix("~")
        if not key.strip("/") or "//" in key or key.endswith("/"):
            raise NameInvalid(f"{name!r} is not a parameter name; write it like wheels/radius")
        return key

    async def _ask(self, timeout: float | None, method: str, *arguments: Any) -> Any:
        """Ask the master in a thread, repeatedly while it is away, until the time is over."""
        backend = self._backend

        async def attempt(rest: float | None) -> Any:
            answer = in_thread(backend.loop, lambda: self._master.ask(method, *arguments), method)
            return await within(backend.clock, answer, rest)

        waiting = WaitLog(backend.clock, backend.log, f"ROS master at {self._master.uri}")
        try:
            return await call_when_offered(waiting, attempt, timeout, lambda: False)
        except ServiceUnavailable:
            raise ServiceUnavailable(f"the {waiting.what} did not answer within {timeout:g} s") from None


def give(node: Ros1Node) -> None:
    """Set parameters of our own node from outside, now and after each restart of the master.

    Raises:
        ParameterRefused: the master cannot store a value.
    """
    plain = {}
    for name, value in node.given_parameters.items():
        node.given_parameters.take(name)  # nothing is declared on ROS 1: all nodes see it, as with rospy
        key = f"{node.node_name}/{name.removeprefix('~')}"
        plain[key] = _plain(key, value)
    master = Master(node.master_uri, node.node_name)

    def set_all() -> None:
        for key, value in plain.items():
            master.ask("setParam", key, value)

    def again() -> None:
        node.link.do(set_all)

    if plain:
        node.on_return[again] = None
        again()


def _leaves(value: Mapping[str, Any], path: str = "") -> Iterator[tuple[str, Any]]:
    for name, part in value.items():
        where = f"{path}/{name}" if path else name
        if isinstance(part, dict):
            yield from _leaves(part, where)
        else:
            yield where, _given(part)


def _given(value: Any) -> Any:
    """Convert a value of the master to the types of the port: XML-RPC's times become texts (ISO 8601)."""
    if isinstance(value, datetime):
        return value.isoformat()
    return [_given(each) for each in value] if isinstance(value, list) else value


def _plain(key: str, value: Any) -> Any:
    """Check that the master can store *value*, and return it in plain types."""
    if isinstance(value, Mapping):
        part = next(iter(value), "a")
        raise ParameterRefused(f"parameter {key}: a mapping must be set by its parts, such as {key}/{part}")
    try:
        plain = checked_value(value.tolist() if hasattr(value, "tolist") else value)
    except ParameterRefused as problem:
        raise ParameterRefused(f"parameter {key}: {problem}") from None
    for element in plain if isinstance(plain, list) else [plain]:
        if isinstance(element, int) and element not in WHOLE_NUMBERS:
            raise ParameterRefused(
                f"parameter {key}: the ROS master stores integers of 32 bits; {element} is too large; write {element}.0"
            )
    return plain
