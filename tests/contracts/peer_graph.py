"""Commands of a peer about parameters, transforms, the graph's contents and its log."""

import asyncio
from dataclasses import asdict
from typing import Any

from jacaros.robots.ros.backend import Backend
from jacaros.robots.ros.parameter import DeclaredParameter
from jacaros.runtime.clock import Clock


class GraphCommands:
    """A part of `peer.Peer`."""

    _backend: Backend
    _clock: Clock

    def __init__(self) -> None:
        self._changes: dict[str, list[dict[str, Any]]] = {}
        self._ends: dict[str, Any] = {}
        self._lookups: dict[str, asyncio.Task[Any]] = {}

    # Parameters

    def declare(self, name: str, default: Any, node: str | None = None, **more: Any) -> Any:
        return self._backend.parameters(node).declare(name, DeclaredParameter(default, **more))

    def withdraw(self, name: str, node: str | None = None) -> None:
        self._backend.parameters(node).withdraw(name)

    def given_parameters_without_use(self) -> list[str]:
        return self._backend.given_parameters.untaken()

    def parameter_node(self, node: str | None = None) -> str:
        return self._backend.parameters(node).node

    async def parameter_names(self, node: str | None = None, timeout: float | None = None) -> list[str]:
        return await self._backend.parameters(node).names(timeout)

    async def get_parameter(self, name: str, node: str | None = None, timeout: float | None = None) -> Any:
        return await self._backend.parameters(node).get(name, timeout)

    async def set_parameter(
        self, name: str, value: Any, node: str | None = None, timeout: float | None = None
    ) -> None:
        await self._backend.parameters(node).set(name, value, timeout)

    def watch_parameters(self, key: str, node: str | None = None) -> None:
        seen = self._changes.setdefault(key, [])
        self._ends[key] = self._backend.parameters(node).on_change(lambda change: seen.append(dict(change)))

    def parameter_changes(self, key: str) -> list[dict[str, Any]]:
        return self._changes[key]

    def unwatch_parameters(self, key: str) -> None:
        self._ends.pop(key)()

    # Transforms

    def listen_to_transforms(self) -> None:
        self._backend.tf_listen()

    def send_transform(
        self, parent: str, child: str, x: float, yaw_z: float = 0.0, yaw_w: float = 1.0, **more: Any
    ) -> None:
        stamp, static = more.get("stamp", 0.0), more.get("static", False)
        transform = {"translation": {"x": x}, "rotation": {"z": yaw_z, "w": yaw_w}}
        header = {"frame_id": parent, "stamp": stamp}
        self._backend.tf_broadcast(
            {"header": header, "child_frame_id": child, "transform": transform}, static
        )

    def look_up(self, target: str, source: str, stamp: float | None = None) -> dict[str, Any]:
        found = self._backend.tf_lookup(target, source, stamp)
        return {"x": found.translation[0], "y": found.translation[1], "yaw": found.yaw, "stamp": found.stamp}

    async def wait_for_transform(
        self, target: str, source: str, stamp: float | None = None, timeout: float | None = None
    ) -> dict[str, Any]:
        await self._backend.tf_wait(target, source, stamp, timeout)
        return self.look_up(target, source, stamp)

    def begin_wait_for_transform(
        self, key: str, target: str, source: str, stamp: float | None = None, timeout: float | None = None
    ) -> None:
        self._lookups[key] = asyncio.get_running_loop().create_task(
            self.wait_for_transform(target, source, stamp, timeout)
        )

    async def end_wait_for_transform(self, key: str) -> dict[str, Any]:
        found: dict[str, Any] = await self._lookups.pop(key)
        return found

    # The graph

    async def contents(self) -> dict[str, Any]:
        found = await self._backend.contents(timeout=60.0)
        return asdict(found)

    def rosout(self, level: str, text: str) -> None:
        self._backend.rosout(level, text)

    def ros_version(self) -> int:
        return self._backend.ros_version
