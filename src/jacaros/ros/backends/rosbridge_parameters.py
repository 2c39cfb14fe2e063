"""Parameters through rosapi: those of a ROS 2 node, or of the ROS 1 master."""

import json
from collections.abc import Callable, Mapping
from typing import Any, NoReturn

from jacaros.ros.backends.rosbridge_node import BridgeNode
from jacaros.ros.errors import CallFailed, CapabilityMissing, ParameterRefused, ParameterUnknown
from jacaros.ros.parameter import Declaration, ParameterValue

_ABSENT = "jacaros: no such parameter"
"""The default that is asked for: old servers have no other way to say that there is no parameter."""


class BridgeParameters:
    """Parameters of one node, seen through rosapi.

    Args:
        backend: asks.
        node: absolute name of the node.
    """

    def __init__(self, backend: BridgeNode, node: str) -> None:
        self.node = node
        self._backend = backend

    def declare(self, name: str, declaration: Declaration) -> ParameterValue:
        """Always raises `CapabilityMissing`: over a bridge we are no node whose parameters others could see."""
        self._missing(f"parameter {name} cannot be declared")

    def withdraw(self, name: str) -> None:
        """Always raises `CapabilityMissing`, as `declare`."""
        self._missing(f"parameter {name} cannot be withdrawn")

    async def names(self, timeout: float | None = None) -> list[str]:
        """Names of the node's parameters, sorted."""
        self._require_known()
        answer = await self._backend.rosapi("get_param_names", {}, timeout)
        prefix = self._prefix
        return sorted(name.removeprefix(prefix) for name in answer["names"] if name.startswith(prefix))

    async def get(self, name: str, timeout: float | None = None) -> ParameterValue:
        """Give a parameter's value."""
        self._require_known()
        arguments = {"name": self._prefix + name, "default_value": json.dumps(_ABSENT)}
        answer = await self._backend.rosapi("get_param", arguments, timeout)
        text = answer.get("value", "")
        try:
            value = json.loads(text) if text != "" else _ABSENT
        except ValueError:
            value = text
        if value == _ABSENT or value is None or answer.get("successful") is False:
            raise ParameterUnknown(f"node {self.node} has no parameter {name}")
        return self._plain(name, value)

    async def set(self, name: str, value: ParameterValue, timeout: float | None = None) -> None:
        """Change a parameter."""
        self._require_known()
        if isinstance(value, bytes):
            raise ParameterRefused(
                f"parameter {name}: the rosbridge protocol carries no octets in parameters"
            )
        if self._plain_or_none(value) is None:
            raise ParameterRefused(f"no parameter holds {value!r}, which is to be that of {name}")
        two = self._backend.ros_version == 2
        before = await self.get(name, timeout) if two else None
        arguments = {"name": self._prefix + name, "value": json.dumps(value)}
        answer = await self._backend.rosapi("set_param", arguments, timeout)
        if answer.get("successful") is False:
            raise ParameterRefused(
                f"node {self.node} refuses {value!r} for {name}: {answer.get('reason', '')}"
            )
        # Old servers say nothing at all of a refusal.
        if two and "successful" not in answer and await self.get(name, timeout) != value:
            raise ParameterRefused(f"node {self.node} keeps {before!r} for {name}: it refuses {value!r}")

    def on_change(self, callback: Callable[[Mapping[str, ParameterValue]], None]) -> Callable[[], None]:
        """Always raises `CapabilityMissing`: rosapi tells no changes."""
        self._missing(f"news of changed parameters of {self.node}")

    @property
    def _prefix(self) -> str:
        return f"{self.node}:" if self._backend.ros_version == 2 else f"{self.node}/"

    def _plain(self, name: str, value: Any) -> ParameterValue:
        plain = self._plain_or_none(value)
        if plain is not None:
            return plain
        if isinstance(value, dict):
            raise ParameterUnknown(f"{name} of {self.node} is a group: ask for its parts, {name}/PART")
        raise CallFailed(f"parameter {name} of node {self.node} has a value that is none of ours: {value!r}")

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

    def _require_known(self) -> None:
        """On ROS 2 parameters belong to nodes, and we are none."""
        if self._backend.ros_version == 2 and self.node == self._backend.node_name:
            raise CapabilityMissing(
                "parameters of our own: over rosbridge we are no node of the graph, so there are none; name another node"
            )

    def _missing(self, what: str) -> NoReturn:
        raise CapabilityMissing(
            f"{what}: the rosbridge backend cannot do this; it is done on the robot itself, with --ros ros2"
        )
