"""The services with which ROS 2's nodes serve their parameters, for the nodes of a graph inside the process."""

from collections.abc import Mapping
from typing import Any

from conversion import to_json

from jacaros.robots.ros.errors import CallFailed, ParameterRefused, ParameterUnknown
from jacaros.robots.ros.node import Node

SERVICES = {
    "get_parameters": "rcl_interfaces/srv/GetParameters",
    "get_parameter_types": "rcl_interfaces/srv/GetParameterTypes",
    "set_parameters": "rcl_interfaces/srv/SetParameters",
    "list_parameters": "rcl_interfaces/srv/ListParameters",
}
FIELDS = (
    *("", "bool_value", "integer_value", "double_value", "string_value", "byte_array_value"),
    *("bool_array_value", "integer_array_value", "double_array_value", "string_array_value"),
)
NUMBERS = {bool: 1, int: 2, float: 3, str: 4, bytes: 5}


class ParameterServices:
    """Answers for the nodes.

    Args:
        node: asks them.
    """

    def __init__(self, node: Node) -> None:
        self._node = node

    async def type_of(self, service: str) -> str:
        """The type of a service, if it is one of these and its node is there, else \"\"."""
        node, _, name = service.rpartition("/")
        nodes = (await self._node.contents()).nodes
        return SERVICES[name] if name in SERVICES and node in nodes else ""

    async def call(self, service: str, arguments: dict[str, Any]) -> dict[str, Any] | None:
        """Answer one call; None for any other service."""
        node, _, name = service.rpartition("/")
        if name not in SERVICES:
            return None
        if not await self.type_of(service):
            raise CallFailed(f"Service {service} does not exist")
        parameters = self._node.parameters(node)
        if name == "list_parameters":
            return {"result": {"names": await parameters.names(), "prefixes": []}}
        if name == "set_parameters":
            return {"results": [await self._set(parameters, each) for each in arguments["parameters"]]}
        values = [await self._get(parameters, each) for each in arguments["names"]]
        if name == "get_parameters":
            return {"values": values}
        import base64

        return {"types": base64.b64encode(bytes(each["type"] for each in values)).decode()}

    def event(self, node: str, changed: Mapping[str, Any]) -> dict[str, Any]:
        """A message of ``/parameter_events``."""
        told = [{"name": name, "value": written(value)} for name, value in changed.items()]
        made = self._node.factory.make(
            "rcl_interfaces/msg/ParameterEvent", {"node": node, "changed_parameters": told}
        )
        values: dict[str, Any] = to_json(self._node, "rcl_interfaces/msg/ParameterEvent", made, False)
        return values

    async def _get(self, parameters: Any, name: str) -> dict[str, Any]:
        try:
            return written(await parameters.get(name))
        except ParameterUnknown:
            return {"type": 0}

    async def _set(self, parameters: Any, told: dict[str, Any]) -> dict[str, Any]:
        value = told["value"][FIELDS[told["value"]["type"]]]
        try:
            await parameters.set(told["name"], bytes(value) if told["value"]["type"] == 5 else value)
        except (ParameterUnknown, ParameterRefused) as problem:
            return {"successful": False, "reason": str(problem)}
        return {"successful": True, "reason": ""}


def written(value: Any) -> dict[str, Any]:
    """A value as ``rcl_interfaces/msg/ParameterValue``."""
    one = value[0] if isinstance(value, list) and value else "" if isinstance(value, list) else value
    number = NUMBERS[type(one)] + (5 if isinstance(value, list) else 0)
    return {"type": number, FIELDS[number]: list(value) if isinstance(value, bytes) else value}
