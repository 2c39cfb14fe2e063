"""ROS 1 through rospy: one node per process, callbacks on the loop, registrations kept up to date.

Nothing here waits on the loop: joining, registering and calling services happen in threads, see
`jacaros.robots.ros.drivers.ros1.node`. The addresses are rospy's: ``ROS_MASTER_URI``, ``ROS_IP``, ``ROS_HOSTNAME``; if
none is given and the master runs on this machine, all traffic stays on the loopback interface.
"""

import socket
from collections.abc import Iterable, Mapping
from concurrent.futures import ThreadPoolExecutor
from io import BytesIO
from typing import Any

import rosgraph.network  # type: ignore[import-not-found]

from jacaros.robots.ros.action_client import ActionClient
from jacaros.robots.ros.actionlib import ActionlibServer, ActionlibWire
from jacaros.robots.ros.backend import Backend, Endpoint, GraphContents, TopicInfo
from jacaros.robots.ros.drivers.ros1.node import PATIENCE, Master, Ros1Node
from jacaros.robots.ros.drivers.ros1.services import Ros1Client, Ros1Parameters, Ros1Service, give
from jacaros.robots.ros.drivers.ros1.topics import Ros1Publisher, Ros1Subscription
from jacaros.robots.ros.drivers.ros1.types import ROS1_PACKAGES
from jacaros.robots.ros.errors import CallTimedOut, ServiceError
from jacaros.robots.ros.handoff import in_thread
from jacaros.robots.ros.node import Capability, NodeSettings, Parts
from jacaros.robots.ros.waiting import within


def _action_client(node: Ros1Node, name: str, type_name: str) -> ActionClient:
    sender = ActionClient(
        node.clock, node.log, node.factory, name, type_name, node.leaving_goals, node.orphans
    )
    sender.wire = ActionlibWire(node, sender)
    return sender


class Ros1Backend(Ros1Node):
    """The ROS 1 node of this process.

    Args:
        settings: names, clock and log; the default namespace is ``ROS_NAMESPACE``.
    """

    capabilities = frozenset(Capability) - {
        Capability.QOS,
        Capability.GRAPH_QOS,
        Capability.DEADLINES,
        Capability.DECLARED_PARAMETERS,
    }

    parts = Parts(
        publisher=Ros1Publisher,
        subscription=Ros1Subscription,
        service=Ros1Service,
        client=Ros1Client,
        action_client=_action_client,
        action_server=ActionlibServer,
    )

    def __init__(self, settings: NodeSettings) -> None:
        super().__init__(settings)
        give(self)

    def parameters(self, node: str | None = None) -> Ros1Parameters:
        """Return the parameters below a node's name."""
        return Ros1Parameters(self, node)

    async def contents(self, timeout: float = 5.0) -> GraphContents:
        """Return the contents of the graph."""
        return await graph_contents(self, timeout)

    async def _publishers(self, topic: str) -> list[str]:
        nodes = list(self.link.publishers.get(topic, ()))
        if nodes == [self.node_name]:
            return nodes
        master = Master(self.master_uri, self.node_name)
        own = self.node_name
        return await in_thread(
            self.loop, lambda: [node for node in nodes if node == own or master.reaches(node)], "graph"
        )


ACTION_TOPICS = ("goal", "cancel", "status", "feedback", "result")
LOG_TOPICS = frozenset({"/rosout", "/rosout_agg"})
LOG_SERVICES = ("/get_loggers", "/set_logger_level")
_ROS2_TYPES = {f"{package}/{full.rsplit('/', 1)[1]}": full for full, package in ROS1_PACKAGES.items()}

SystemState = list[list[tuple[str, list[str]]]]
"""The master's answer: publications, subscriptions and services, each with their nodes."""


async def graph_contents(node: Ros1Node, timeout: float) -> GraphContents:
    """Return the contents of the graph; see `jacaros.robots.ros.backend.Backend.contents`."""
    work = in_thread(node.loop, lambda: _look(Master(node.master_uri, node.node_name)), "graph")
    try:
        return await within(node.clock, work, timeout)
    except TimeoutError:
        raise CallTimedOut(f"the ROS graph did not answer within {timeout:g} s") from None


def _look(master: Master) -> GraphContents:
    state: SystemState = master.ask("getSystemState")
    types: dict[str, str] = dict(master.ask("getTopicTypes"))
    named = _actions(types)
    hidden = LOG_TOPICS | {f"{action}/{part}" for action in named for part in ACTION_TOPICS}
    # The master remembers the types of unused topics; and clients alone do not make an action.
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


def _topics(state: SystemState, types: Mapping[str, str], hidden: Iterable[str]) -> dict[str, TopicInfo]:
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
    """Convert ``nav_msgs/Odometry`` to full form; nothing for ``*``, which listeners to any type use."""
    package, _, name = ros1_type.partition("/")
    return (f"{package}/{kind}/{name}",) if name else ()


def _actions(types: Mapping[str, str]) -> dict[str, str]:
    """Return actions by their five topics, with types in full form."""
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
    """Ask the node that offers a service for its type; "" if it does not answer."""
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


BACKEND: type[Backend] = Ros1Backend
