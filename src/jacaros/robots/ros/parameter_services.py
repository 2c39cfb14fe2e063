"""The parameters of other nodes: reports of changes, and the services that every node of ROS 2 has (``rcl_interfaces``)."""

from collections.abc import Callable, Mapping
from typing import Any

from jacaros.robots.ros.errors import CapabilityMissing, ParameterRefused, ParameterUnknown, ServerGone
from jacaros.robots.ros.node import Sample
from jacaros.robots.ros.parameter import DeclaredParameter, ParameterValue, checked_value
from jacaros.robots.ros.qos import QoS
from jacaros.robots.ros.services import Client
from jacaros.runtime.clock import Clock

EVENTS, EVENT_TYPE, EVENT_QUALITY = "/parameter_events", "rcl_interfaces/msg/ParameterEvent", QoS(depth=1000)

ParameterCallback = Callable[[Mapping[str, ParameterValue]], None]


class ParameterListeners:
    """The callbacks for changed parameters, by node."""

    def __init__(self) -> None:
        self._listeners: dict[str, list[ParameterCallback]] = {}

    def listen(self, node: str, callback: ParameterCallback) -> Callable[[], None]:
        """Call *callback* with changed parameters of a node. Return a function that removes it."""
        listeners = self._listeners.setdefault(node, [])
        listeners.append(callback)
        return lambda: listeners.remove(callback) if callback in listeners else None

    def of(self, node: str) -> list[ParameterCallback]:
        """Return the callbacks for a node."""
        return list(self._listeners.get(node, ()))


class ParameterEvents(ParameterListeners):
    """Reports changed parameters of all nodes from one subscription, which is made on first use.

    Args:
        subscribe: subscribes at the backend, given the topic, its type, the callback, and the quality of service.
        read: returns the value of an ``rcl_interfaces/msg/ParameterValue``, None for a parameter without one.
    """

    def __init__(
        self,
        subscribe: Callable[[str, str, Callable[[Sample], None], QoS], object],
        read: Callable[[Any], ParameterValue | None],
    ) -> None:
        super().__init__()
        self._subscribe = subscribe
        self._read = read
        self._joined = False

    def listen(self, node: str, callback: ParameterCallback) -> Callable[[], None]:
        """Call *callback* with changed parameters of a node. Return a function that removes it."""
        if not self._joined:
            self._joined = True
            self._subscribe(EVENTS, EVENT_TYPE, self._take, EVENT_QUALITY)
        return super().listen(node, callback)

    def _take(self, sample: Sample) -> None:
        event = sample.message
        if not (listeners := self.of(event.node)):
            return
        told = {
            each.name: self._read(each.value) for each in (*event.new_parameters, *event.changed_parameters)
        }
        known = {name: value for name, value in told.items() if value is not None}
        if known:
            for callback in listeners:
                callback(known)


NODE_SERVICES = frozenset(
    {
        "describe_parameters",
        "get_parameter_types",
        "get_parameters",
        "get_type_description",
        "list_parameters",
        "set_parameters",
        "set_parameters_atomically",
    }
)
"""Services that every node of ROS 2 offers, below its name."""

_KINDS = (bool, int, float, str, bytes)
"""The types of plain values, in the order of ``ParameterType``; bool is a subclass of int, so it comes first."""
_FIELDS = (
    "",
    "bool_value",
    "integer_value",
    "double_value",
    "string_value",
    "byte_array_value",
    "bool_array_value",
    "integer_array_value",
    "double_array_value",
    "string_array_value",
)
"""The field of ``ParameterValue`` for each number of ``ParameterType``; the first has none."""
_OCTETS, _TEXTS = 5, 9


class NodeParameters:
    """The parameters of another node; the client of a service is made on first use.

    Args:
        clock: measures the time-outs.
        node: absolute name of the node that has the parameters.
        make_client: makes the client of a service, by name and type, and closes it with our node.
        events: reports changes.
    """

    def __init__(
        self, clock: Clock, node: str, make_client: Callable[[str, str], Client], events: ParameterEvents
    ) -> None:
        self.node = node
        self._clock = clock
        self._make_client = make_client
        self._events = events
        self._clients: dict[str, Client] = {}

    def declare(self, name: str, declaration: DeclaredParameter) -> ParameterValue:
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
        value = read_value(answer.values[0]) if len(answer.values) == 1 else None
        if value is None:
            raise ParameterUnknown(f"node {self.node} has no parameter {name}, or it has no value")
        return value

    async def set(self, name: str, value: ParameterValue, timeout: float | None = None) -> None:
        """Change a parameter."""
        wanted = checked_value(value)
        number = await self._number(name, wanted, timeout)
        given = list(wanted) if isinstance(wanted, bytes) else wanted
        told = {"name": name, "value": {"type": number, _FIELDS[number]: given}}
        answer = await self._client("SetParameters").call({"parameters": [told]}, timeout)
        if answer.results and answer.results[0].successful:
            return
        if not await self._type(name, timeout):
            raise ParameterUnknown(f"node {self.node} has no parameter {name}")
        reason = answer.results[0].reason if answer.results else "the node gave no reason"
        raise ParameterRefused(f"parameter {name} of {self.node} cannot be {value!r}: {reason}")

    def on_change(self, callback: Callable[[Mapping[str, ParameterValue]], None]) -> Callable[[], None]:
        """Call *callback* with changed parameters."""
        return self._events.listen(self.node, callback)

    async def _number(self, name: str, value: ParameterValue, timeout: float | None) -> int:
        """Return the number of a value's type; an empty list has that of the parameter."""
        if value == []:
            number = await self._type(name, timeout)
            return number if number >= _OCTETS else _TEXTS
        one = value[0] if isinstance(value, list) else value
        number = next(number for number, kind in enumerate(_KINDS, 1) if isinstance(one, kind))
        return number + _OCTETS if isinstance(value, list) else number

    async def _type(self, name: str, timeout: float | None) -> int:
        """Return the number of a parameter's type; 0 if it does not exist."""
        answer = await self._read("GetParameterTypes", {"names": [name]}, timeout)
        return int(answer.types[0]) if len(answer.types) == 1 else 0

    async def _read(self, service: str, request: Mapping[str, Any], timeout: float | None) -> Any:
        """Call a service, and call again if the node went away and is back: it was restarted without being noticed."""
        clock, client = self._clock, self._client(service)
        deadline = None if timeout is None else clock.elapsed + timeout
        while True:
            try:
                return await client.call(request, None if deadline is None else deadline - clock.elapsed)
            except ServerGone:
                if (deadline is not None and clock.elapsed >= deadline) or not client.ready:
                    raise

    def _client(self, service: str) -> Client:
        """Return the client of a service, such as ``GetParameters``."""
        client = self._clients.get(service)
        if client is None:
            name = "".join(f"_{letter.lower()}" if letter.isupper() else letter for letter in service)
            client = self._make_client(f"{self.node}/{name[1:]}", f"rcl_interfaces/srv/{service}")
            self._clients[service] = client
        return client

    def _not_ours(self) -> CapabilityMissing:
        return CapabilityMissing(
            f"only {self.node} itself can declare its parameters; other nodes can only get and set them"
        )


def read_value(told: Any) -> ParameterValue | None:
    """Read a ``rcl_interfaces/msg/ParameterValue``; None for a parameter without a value."""
    if not 0 < told.type < len(_FIELDS):
        return None
    value: Any = getattr(told, _FIELDS[told.type])
    if told.type == _OCTETS:
        # rclpy has each octet as bytes of length one, rosbridge as a number that may be signed
        return b"".join(each if isinstance(each, bytes) else bytes((int(each) & 255,)) for each in value)
    if told.type > _OCTETS:
        value = value.tolist() if hasattr(value, "tolist") else list(value)
    plain: ParameterValue = value
    return plain
