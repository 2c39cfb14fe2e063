"""The services of rosapi, the node beside a rosbridge server, for a graph inside the process."""

import json
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from conversion import short
from parameters import ParameterServices

from jacaros.robots.ros.errors import CallFailed, JacarosError
from jacaros.robots.ros.interfaces import BUILT_IN, split
from jacaros.robots.ros.node import Node

ACTIONLIB = ("goal", "cancel", "feedback", "result", "status")


class RosApi:
    """Answers about the graph of *node*.

    Args:
        node: looks.
        ros1: answer as rosapi of ROS 1 does.
        under_way: actions with clients that `Node.contents` does not tell.

    Attributes:
        master: the parameters of ROS 1, by absolute name.
        running: whether there is such a node.
    """

    def __init__(self, node: Node, ros1: bool, under_way: Sequence[str] = ()) -> None:
        self._node = node
        self._under_way = under_way
        self._parameters = ParameterServices(node)
        self._ros1 = ros1
        self.master: dict[str, Any] = {}
        self.running = True
        self._services: dict[str, Callable[..., Any]] = {
            name: getattr(self, "_services_list" if name == "services" else f"_{name}")
            for name in (
                *("topics", "services", "nodes", "publishers", "subscribers", "service_type"),
                *(("get_param", "set_param", "get_param_names") if ros1 else ("action_type",)),
                "action_servers",
            )
        }
        if not ros1:
            self._services["get_ros_version"] = lambda: {"version": 2, "distro": "jazzy"}

    @property
    def names(self) -> list[str]:
        """Absolute names of the services."""
        return [f"/rosapi/{name}" for name in self._services]

    def remove(self, name: str) -> None:
        """Have no service *name*, as older versions."""
        del self._services[name]

    async def call(self, service: str, arguments: dict[str, Any]) -> dict[str, Any]:
        """Answer one call; raises `CallFailed` with what rosbridge would say."""
        answer = self._services.get(service.removeprefix("/rosapi/"))
        if answer is None or not self.running:
            raise CallFailed(f"Service {service} does not exist")
        try:
            result = answer(**arguments)
            return await result if hasattr(result, "__await__") else result
        except (JacarosError, TypeError, KeyError) as problem:
            raise CallFailed(str(problem)) from None

    async def _contents(self) -> Any:
        return await self._node.contents()

    async def _topics(self) -> dict[str, Any]:
        topics = (await self._contents()).topics
        found = {name: self._written(info.types[0]) for name, info in topics.items()}
        if not self._ros1:
            found["/parameter_events"] = "rcl_interfaces/msg/ParameterEvent"
        found["/rosout"] = "rosgraph_msgs/Log" if self._ros1 else "rcl_interfaces/msg/Log"
        return {"topics": list(found), "types": list(found.values())}

    async def _services_list(self) -> dict[str, Any]:
        return {"services": [*(await self._contents()).services, *self.names]}

    async def _nodes(self) -> dict[str, Any]:
        return {"nodes": [*(await self._contents()).nodes, "/rosapi"]}

    async def _publishers(self, topic: str) -> dict[str, Any]:
        # The hidden topics of actions are left out, as in the original.
        info = (await self._contents()).topics.get(topic)
        return {"publishers": sorted({each.node for each in info.publishers}) if info else []}

    async def _subscribers(self, topic: str) -> dict[str, Any]:
        info = (await self._contents()).topics.get(topic)
        return {"subscribers": sorted({each.node for each in info.subscriptions}) if info else []}

    async def _service_type(self, service: str) -> dict[str, Any]:
        found = (await self._contents()).services.get(service, "")
        if not found and not self._ros1:
            found = await self._parameters.type_of(service)
        return {"type": self._written(found)}

    async def _action_servers(self) -> dict[str, Any]:
        contents = await self._contents()
        # The genuine one goes by the names of topics, which a client alone makes too.
        names = {*contents.actions, *self._under_way}
        for name in contents.topics:
            stem = name.removesuffix("/status")
            if all(f"{stem}/{part}" in contents.topics for part in ACTIONLIB):
                names.add(stem)
        return {"action_servers": sorted(names)}

    async def _action_type(self, action: str) -> dict[str, Any]:
        return {"type": (await self._contents()).actions.get(action, "")}

    def _get_param(self, name: str, default_value: str = "") -> dict[str, Any]:
        return {"value": json.dumps(self.master[name]) if name in self.master else default_value}

    def _set_param(self, name: str, value: str) -> dict[str, Any]:
        self.master[name] = json.loads(value)
        return {}

    def _get_param_names(self) -> dict[str, Any]:
        return {"names": sorted(self.master)}

    def _written(self, type_name: str) -> str:
        return short(type_name) if self._ros1 and type_name else type_name


def write_ros1_types(folder: Path) -> None:
    """Write what ROS 1 has beyond ROS 2: the messages of actionlib's topics for our actions."""
    for path in BUILT_IN.glob("*/action/*.action"):
        package, name = path.parts[-3], path.stem
        parts = split(f"{package}/action/{name}", path.read_text())
        header = "std_msgs/Header header\n"
        status = f"{header}actionlib_msgs/GoalStatus status\n"
        texts = {
            **{name + part.rpartition("_")[2]: text for part, text in parts.items()},
            f"{name}ActionGoal": f"{header}actionlib_msgs/GoalID goal_id\n{package}/{name}Goal goal\n",
            f"{name}ActionResult": f"{status}{package}/{name}Result result\n",
            f"{name}ActionFeedback": f"{status}{package}/{name}Feedback feedback\n",
        }
        for message, text in texts.items():
            _write(folder, f"{package}/{message}", text)


def _write(folder: Path, name: str, text: str) -> None:
    package, message = name.split("/")
    (folder / package / "msg").mkdir(parents=True, exist_ok=True)
    (folder / package / "msg" / f"{message}.msg").write_text(text)
