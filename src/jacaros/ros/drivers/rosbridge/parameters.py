"""Parameters over the bridge: those of a ROS 2 node, or of the ROS 1 master through rosapi."""

import json
from collections.abc import Callable, Mapping
from typing import Any, NoReturn

from jacaros.ros.drivers.rosbridge.node import BridgeNode
from jacaros.ros.drivers.rosbridge.services import BridgeClient
from jacaros.ros.errors import CallFailed, CapabilityMissing, ParameterRefused, ParameterUnknown
from jacaros.ros.parameter import Declaration, ParameterValue
from jacaros.ros.parameter_news import ParameterNews
from jacaros.ros.parameter_services import ParameterServices
from jacaros.ros.parameter_store import checked_value

_ABSENT = "jacaros: no such parameter"
"""The default that is asked for: rosapi has no other way to say that there is no parameter."""


class BridgeParameters:
    """Parameters of one node, seen from outside.

    Args:
        backend: asks.
        node: absolute name of the node.
        news: tells of changes on ROS 2.
    """

    def __init__(self, backend: BridgeNode, node: str, news: ParameterNews) -> None:
        self.node = node
        self._backend = backend
        self._news = news
        self._of_node = NodeParameters(backend, node)
        self._of_master = MasterParameters(backend, node)

    def declare(self, name: str, declaration: Declaration) -> ParameterValue:
        """Always raises `CapabilityMissing`: over a bridge we are no node whose parameters others could see."""
        self._missing(f"parameter {name} cannot be declared")

    def withdraw(self, name: str) -> None:
        """Always raises `CapabilityMissing`, as `declare`."""
        self._missing(f"parameter {name} cannot be withdrawn")

    async def names(self, timeout: float | None = None) -> list[str]:
        """Names of the node's parameters, sorted."""
        return await self._parameters.names(timeout)

    async def get(self, name: str, timeout: float | None = None) -> ParameterValue:
        """Give a parameter's value."""
        return await self._parameters.get(name, timeout)

    async def set(self, name: str, value: ParameterValue, timeout: float | None = None) -> None:
        """Change a parameter."""
        await self._parameters.set(name, value, timeout)

    def on_change(self, callback: Callable[[Mapping[str, ParameterValue]], None]) -> Callable[[], None]:
        """Have *callback* called with what changed; on ROS 2, for rosapi of ROS 1 tells no changes."""
        if self._backend.ros_version == 1:
            self._missing(f"news of changed parameters of {self.node}")
        self._require_other()
        return self._news.listen(self.node, callback)

    @property
    def _parameters(self) -> "NodeParameters | MasterParameters":
        if self._backend.ros_version == 1:
            return self._of_master
        self._require_other()
        return self._of_node

    def _require_other(self) -> None:
        """On ROS 2 parameters belong to nodes, and we are none."""
        if self.node == self._backend.node_name:
            raise CapabilityMissing(
                "parameters of our own: over rosbridge we are no node of the graph, so there are none, and none change; "
                "name another node"
            )

    def _missing(self, what: str) -> NoReturn:
        raise CapabilityMissing(
            f"{what}: the rosbridge backend cannot do this; it is done on the robot itself, with --ros ros2"
        )


class MasterParameters:
    """What the ROS 1 master keeps below a node's name, through rosapi.

    Args:
        backend: asks.
        node: absolute name of the node.
    """

    def __init__(self, backend: BridgeNode, node: str) -> None:
        self._backend = backend
        self._node = node

    async def names(self, timeout: float | None = None) -> list[str]:
        """Names of the node's parameters."""
        answer = await self._backend.rosapi("get_param_names", {}, timeout)
        prefix = f"{self._node}/"
        return sorted(name.removeprefix(prefix) for name in answer["names"] if name.startswith(prefix))

    async def get(self, name: str, timeout: float | None = None) -> ParameterValue:
        """Give a parameter's value."""
        arguments = {"name": f"{self._node}/{name}", "default_value": json.dumps(_ABSENT)}
        answer = await self._backend.rosapi("get_param", arguments, timeout)
        text = answer.get("value", "")
        try:
            value = json.loads(text) if text != "" else _ABSENT
        except ValueError:
            value = text
        if value == _ABSENT or value is None:
            raise ParameterUnknown(f"node {self._node} has no parameter {name}")
        return self._plain(name, value)

    async def set(self, name: str, value: ParameterValue, timeout: float | None = None) -> None:
        """Change a parameter."""
        if isinstance(value, bytes):
            raise ParameterRefused(
                f"parameter {name}: the rosbridge protocol carries no octets in parameters"
            )
        if self._plain_or_none(value) is None:
            raise ParameterRefused(f"no parameter holds {value!r}, which is to be that of {name}")
        arguments = {"name": f"{self._node}/{name}", "value": json.dumps(value)}
        await self._backend.rosapi("set_param", arguments, timeout)

    def _plain(self, name: str, value: Any) -> ParameterValue:
        plain = self._plain_or_none(value)
        if plain is not None:
            return plain
        if isinstance(value, dict):
            raise ParameterUnknown(f"{name} of {self._node} is a group: ask for its parts, {name}/PART")
        raise CallFailed(f"parameter {name} of node {self._node} has a value that is none of ours: {value!r}")

    def _plain_or_none(self, value: Any) -> ParameterValue | None:
        if isinstance(value, bool | int | float | str):
            return value
        if isinstance(value, list):
            for kinds in ((bool,), (int,), (int, float), (str,)):
                # bool is a kind of int, and a list of both is none of ours
                if all(
                    isinstance(each, kinds) and (bool in kinds or not isinstance(each, bool))
                    for each in value
                ):
                    return value
        return None


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
        self._node.keep(client)
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
