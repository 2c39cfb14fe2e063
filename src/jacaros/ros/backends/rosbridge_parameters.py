"""Parameters over the bridge: those of a ROS 2 node, or of the ROS 1 master through rosapi."""

import json
from collections.abc import Callable, Mapping
from typing import Any, NoReturn

from jacaros.ros.backends.rosbridge_node import BridgeNode
from jacaros.ros.backends.rosbridge_parameter_services import NodeParameters
from jacaros.ros.errors import CallFailed, CapabilityMissing, ParameterRefused, ParameterUnknown
from jacaros.ros.parameter import Declaration, ParameterValue
from jacaros.ros.parameter_news import ParameterNews

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
