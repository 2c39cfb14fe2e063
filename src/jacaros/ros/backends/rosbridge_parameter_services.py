"""Parameters of the nodes of a ROS 2 robot: through the services that every node has, and ``/parameter_events``.

rosapi could be asked too, but it guesses the types of values from their text, and for the names of one node it asks all.
"""

from collections.abc import Callable, Mapping
from typing import Any

from jacaros.ros.backend import Sample
from jacaros.ros.backends.rosbridge_node import BridgeNode
from jacaros.ros.backends.rosbridge_services import BridgeClient
from jacaros.ros.backends.rosbridge_topics import BridgeSubscription
from jacaros.ros.errors import ParameterRefused, ParameterUnknown
from jacaros.ros.parameter import ParameterValue
from jacaros.ros.parameter_store import checked_value
from jacaros.ros.qos import QoS

EVENTS, EVENT_TYPE, EVENT_QUALITY = "/parameter_events", "rcl_interfaces/msg/ParameterEvent", QoS(depth=1000)
_FIELDS = {
    1: "bool_value",
    2: "integer_value",
    3: "double_value",
    4: "string_value",
    5: "byte_array_value",
    6: "bool_array_value",
    7: "integer_array_value",
    8: "double_array_value",
    9: "string_array_value",
}
"""Where ``rcl_interfaces/msg/ParameterValue`` has a value, by the numbers of ``ParameterType``."""
_NUMBERS: Mapping[type, int] = {bool: 1, int: 2, float: 3, str: 4, bytes: 5}
_LIST_NUMBERS: Mapping[type, int] = {bool: 6, int: 7, float: 8, str: 9}
_TEXTS, _NOT_SET = 9, 0

Listener = Callable[[Mapping[str, ParameterValue]], None]


class ParameterNews:
    """Tells of changed parameters of all nodes, from the one topic; joined at the first use.

    Args:
        node: subscribes.
    """

    def __init__(self, node: BridgeNode) -> None:
        self._node = node
        self._subscription: BridgeSubscription | None = None
        self._listeners: dict[str, list[Listener]] = {}

    def listen(self, node_name: str, callback: Listener) -> Callable[[], None]:
        """Have *callback* called with what changes at a node; the result ends that."""
        if self._subscription is None:
            self._subscription = BridgeSubscription(
                self._node, EVENTS, EVENT_TYPE, self._take, EVENT_QUALITY, None
            )
            self._node.members.add(self._subscription)
        listeners = self._listeners.setdefault(node_name, [])
        listeners.append(callback)

        def end() -> None:
            if callback in listeners:
                listeners.remove(callback)

        return end

    def _take(self, sample: Sample) -> None:
        event = sample.message
        listeners = self._listeners.get(event.node)
        if not listeners:
            return
        told = {each.name: read(each.value) for each in (*event.new_parameters, *event.changed_parameters)}
        known = {name: value for name, value in told.items() if value is not None}
        if known:
            for callback in list(listeners):
                callback(known)


class NodeParameters:
    """The parameters of one node.

    Args:
        node: calls.
        name: absolute name of the node that has them.
    """

    def __init__(self, node: BridgeNode, name: str) -> None:
        self.node = name
        self._node = node
        self._clients: dict[str, BridgeClient] = {}

    async def names(self, timeout: float | None = None) -> list[str]:
        """Names of the node's parameters."""
        answer = await self._call("ListParameters", {"depth": 0}, timeout)
        return sorted(answer.result.names)

    async def get(self, name: str, timeout: float | None = None) -> ParameterValue:
        """Give a parameter's value."""
        answer = await self._call("GetParameters", {"names": [name]}, timeout)
        value = read(answer.values[0]) if len(answer.values) == 1 else None
        if value is None:
            raise ParameterUnknown(f"node {self.node} has no parameter {name}, or it has no value")
        return value

    async def set(self, name: str, value: ParameterValue, timeout: float | None = None) -> None:
        """Change a parameter."""
        wanted = checked_value(value)
        number = _NUMBERS.get(type(wanted))
        if isinstance(wanted, list):
            number = _LIST_NUMBERS[type(wanted[0])] if wanted else await self._type(name, timeout) or _TEXTS
        assert number is not None, f"checked_value has let {wanted!r} pass"
        given = list(wanted) if isinstance(wanted, bytes) else wanted
        told = {"name": name, "value": {"type": number, _FIELDS[number]: given}}
        answer = await self._call("SetParameters", {"parameters": [told]}, timeout)
        if answer.results and answer.results[0].successful:
            return
        if not await self._type(name, timeout):
            raise ParameterUnknown(f"node {self.node} has no parameter {name}")
        reason = answer.results[0].reason if answer.results else "the node did not say why"
        raise ParameterRefused(f"parameter {name} of {self.node} cannot be {value!r}: {reason}")

    async def _type(self, name: str, timeout: float | None) -> int:
        """The number of a parameter's type; 0 for one that is not there."""
        answer = await self._call("GetParameterTypes", {"names": [name]}, timeout)
        return int(answer.types[0]) if len(answer.types) == 1 else _NOT_SET

    async def _call(self, service: str, request: Mapping[str, Any], timeout: float | None) -> Any:
        client = self._clients.get(service)
        if client is None:
            name = "".join(f"_{letter.lower()}" if letter.isupper() else letter for letter in service)
            client = BridgeClient(self._node, f"{self.node}/{name[1:]}", f"rcl_interfaces/srv/{service}")
            self._clients[service] = client
            self._node.members.add(client)
        return await client.call(request, timeout)


def read(told: Any) -> ParameterValue | None:
    """Read a ``rcl_interfaces/msg/ParameterValue``; None for a parameter without a value."""
    field = _FIELDS.get(int(told.type))
    if field is None:
        return None
    value = getattr(told, field)
    if field == "byte_array_value":
        return bytes(int(octet) & 255 for octet in value)
    if field.endswith("array_value"):
        plain: list[Any] = value.tolist() if hasattr(value, "tolist") else list(value)
        return plain
    single: ParameterValue = value
    return single
