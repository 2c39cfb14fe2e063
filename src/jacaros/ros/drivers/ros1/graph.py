"""What is in a ROS 1 graph: the master knows names and nodes, the types of services are asked from their nodes."""

import socket
from collections.abc import Iterable, Mapping
from concurrent.futures import ThreadPoolExecutor
from io import BytesIO
from typing import Any

import rosgraph.network  # type: ignore[import-not-found]

from jacaros.ros.drivers.ros1.master import PATIENCE, Master
from jacaros.ros.drivers.ros1.node import Ros1Node
from jacaros.ros.drivers.ros1.types import ROS1_PACKAGES
from jacaros.ros.errors import CallTimedOut, ServiceError
from jacaros.ros.graph import Endpoint, GraphContents, TopicInfo
from jacaros.ros.handoff import in_thread
from jacaros.ros.waiting import within

ACTION_TOPICS = ("goal", "cancel", "status", "feedback", "result")
LOG_TOPICS = frozenset({"/rosout", "/rosout_agg"})
LOG_SERVICES = ("/get_loggers", "/set_logger_level")
_ROS2_TYPES = {f"{package}/{full.rsplit('/', 1)[1]}": full for full, package in ROS1_PACKAGES.items()}

State = list[list[tuple[str, list[str]]]]
"""The master's answer: publications, subscriptions and services, each with the nodes that have them."""


async def graph_contents(node: Ros1Node, timeout: float) -> GraphContents:
    """Look at the graph; see `jacaros.ros.backend.Backend.contents`."""
    work = in_thread(node.loop, lambda: _look(Master(node.master_uri, node.node_name)), "graph")
    try:
        return await within(node.clock, work, timeout)
    except TimeoutError:
        raise CallTimedOut(f"the ROS graph could not be looked at within {timeout:g} s") from None


def _look(master: Master) -> GraphContents:
    state: State = master.ask("getSystemState")
    types: dict[str, str] = dict(master.ask("getTopicTypes"))
    named = _actions(types)
    hidden = LOG_TOPICS | {f"{action}/{part}" for action in named for part in ACTION_TOPICS}
    # The master remembers the types of topics that nobody has any more; and clients alone are no action.
    published = {name for name, _ in state[0]}
    actions = {name: kind for name, kind in named.items() if f"{name}/status" in published}
    services = [name for name, _ in state[2] if not name.endswith(LOG_SERVICES)]
    with ThreadPoolExecutor(8, "service types") as pool:
        service_types = pool.map(lambda name: _service_type(master, name), services)
        return GraphContents(
            topics=_topics(state, types, hidden),
            services=dict(sorted(zip(services, service_types, strict=True))),
            actions=actions,
            nodes=tuple(sorted({node for kind in state for _, nodes in kind for node in nodes})),
        )


def _topics(state: State, types: Mapping[str, str], hidden: Iterable[str]) -> dict[str, TopicInfo]:
    publishers, subscribers = dict(state[0]), dict(state[1])
    return {
        name: TopicInfo(
            name,
            _full(types.get(name, "*"), "msg"),
            _endpoints(publishers.get(name, ())),
            _endpoints(subscribers.get(name, ())),
        )
        for name in sorted({*publishers, *subscribers} - set(hidden))
    }


def _endpoints(nodes: Iterable[str]) -> tuple[Endpoint, ...]:
    return tuple(Endpoint(node) for node in sorted(nodes))


def _full(ros1_type: str, kind: str) -> tuple[str, ...]:
    """``nav_msgs/Odometry`` in full form; nothing for ``*``, which listeners to any type say."""
    package, _, name = ros1_type.partition("/")
    return (f"{package}/{kind}/{name}",) if name else ()


def _actions(types: Mapping[str, str]) -> dict[str, str]:
    """Actions by their five topics, with types in full form."""
    found = {}
    for topic, kind in sorted(types.items()):
        action, _, part = topic.rpartition("/")
        if part != "goal" or not kind.endswith("ActionGoal"):
            continue
        base = kind.removesuffix("Goal")
        expected = {
            "cancel": "actionlib_msgs/GoalID",
            "status": "actionlib_msgs/GoalStatusArray",
            "feedback": f"{base}Feedback",
            "result": f"{base}Result",
        }
        if all(types.get(f"{action}/{name}") == kind for name, kind in expected.items()):
            found[action] = _full(base.removesuffix("Action"), "action")[0]
    return found


def _service_type(master: Master, name: str) -> str:
    """Ask the node that offers a service for its type; "" when it does not tell."""
    try:
        address = rosgraph.network.parse_http_host_and_port(
            master.ask("lookupService", name).replace("rosrpc://", "http://")
        )
        header = _probe(address, name)
    except (ServiceError, OSError, ValueError, rosgraph.network.ROSHandshakeException):
        return ""
    kind = str(header.get("type", ""))
    return _ROS2_TYPES.get(kind) or "".join(_full(kind, "srv"))


def _probe(address: tuple[str, int], name: str) -> dict[str, Any]:
    with socket.create_connection(address, timeout=PATIENCE) as connection:
        request = {"probe": "1", "md5sum": "*", "callerid": "/rosservice", "service": name}
        rosgraph.network.write_ros_handshake_header(connection, request)
        answer: dict[str, Any] = rosgraph.network.read_ros_handshake_header(connection, BytesIO(), 2048)
        return answer
