"""Parameters of the nodes of a ROS 2 robot: through the services that every node has, and ``/parameter_events``.

rosapi could be asked too, but it guesses the types of values from their text, and for the names of one node it asks all.
"""

from collections.abc import Mapping
from typing import Any

from jacaros.ros.backends.rosbridge_node import BridgeNode
from jacaros.ros.backends.rosbridge_services import BridgeClient
from jacaros.ros.errors import ParameterRefused, ParameterUnknown
from jacaros.ros.parameter import ParameterValue
from jacaros.ros.parameter_services import ParameterServices
from jacaros.ros.parameter_store import checked_value

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


class NodeParameters:
    """The parameters of one node.

    Args:
        node: calls.
        name: absolute name of the node that has them.
    """

    def __init__(self, node: BridgeNode, name: str) -> None:
        self.node = name
        self._node = node
        self._services = ParameterServices(name, self._client)

    async def names(self, timeout: float | None = None) -> list[str]:
        """Names of the node's parameters."""
        answer = await self._services.call("ListParameters", {"depth": 0}, timeout)
        return sorted(answer.result.names)

    async def get(self, name: str, timeout: float | None = None) -> ParameterValue:
        """Give a parameter's value."""
        answer = await self._services.call("GetParameters", {"names": [name]}, timeout)
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
        answer = await self._services.call("SetParameters", {"parameters": [told]}, timeout)
        if answer.results and answer.results[0].successful:
            return
        if not await self._type(name, timeout):
            raise ParameterUnknown(f"node {self.node} has no parameter {name}")
        reason = answer.results[0].reason if answer.results else "the node did not say why"
        raise ParameterRefused(f"parameter {name} of {self.node} cannot be {value!r}: {reason}")

    async def _type(self, name: str, timeout: float | None) -> int:
        """The number of a parameter's type; 0 for one that is not there."""
        answer = await self._services.call("GetParameterTypes", {"names": [name]}, timeout)
        return int(answer.types[0]) if len(answer.types) == 1 else _NOT_SET

    def _client(self, name: str, type_name: str) -> BridgeClient:
        client = BridgeClient(self._node, name, type_name)
        self._node.members.add(client)
        return client


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
