"""What rclpy knows of the graph: who is there, with which types, and with which quality of service."""

from typing import Any

import rclpy.duration  # type: ignore[import-not-found]
import rclpy.qos  # type: ignore[import-not-found]

from jacaros.ros.drivers.ros2.node import Ros2Node
from jacaros.ros.graph import Endpoint, GraphContents, TopicInfo
from jacaros.ros.protocols.ros2_actions import ACTION, FEEDBACK, SEND_GOAL
from jacaros.ros.qos import QoS

INFRASTRUCTURE = frozenset({"/rosout", "/parameter_events"})
NODE_SERVICES = frozenset(
    {
        "describe_parameters",
        "get_parameter_types",
        "get_parameters",
        "get_type_description",
        "list_parameters",
        "set_parameters",
        "set_parameters_atomically",
    }
)
"""What every node offers, below its name."""


def absolute(namespace: str, name: str) -> str:
    """Put a node's name together."""
    return f"{namespace.rstrip('/')}/{name}"


def endpoint(info: Any) -> Endpoint:
    """Read what rclpy tells of an endpoint."""
    name = "" if info.node_name.startswith("_") else absolute(info.node_namespace, info.node_name)
    return Endpoint(name, quality(info.qos_profile))


def foreign_types(node: Ros2Node, topic: str, type_name: str) -> dict[str, str]:
    """Types other than *type_name* that are published on a topic, each with one of the nodes that do it."""
    ours = node.schema.graph_type(type_name)
    told = node.rcl.get_publishers_info_by_topic(topic)
    return {
        info.topic_type: endpoint(info).node or "an unknown node" for info in told if info.topic_type != ours
    }


def own_types(node: Ros2Node, topic: str) -> list[list[str]]:
    """With which types our own node is at a topic."""
    names = node.names
    told = [
        *node.rcl.get_publisher_names_and_types_by_node(names.node_name, names.namespace or "/"),
        *node.rcl.get_subscriber_names_and_types_by_node(names.node_name, names.namespace or "/"),
    ]
    return [types for name, types in told if name == topic]


def service_mismatch(node: Ros2Node, name: str, type_name: str) -> str | None:
    """Tell that a service is there with another type only; None when all is well, or nothing is known."""
    return _mismatch(node, "service", name, name, type_name, "")


def action_mismatch(node: Ros2Node, name: str, type_name: str) -> str | None:
    """Tell that an action is there with another type only; None when all is well, or nothing is known."""
    return _mismatch(node, "action", name, name + SEND_GOAL, type_name, "_SendGoal")


def _mismatch(node: Ros2Node, what: str, name: str, service: str, type_name: str, ending: str) -> str | None:
    ours = node.schema.graph_type(type_name) + ending
    told = _offered_types(node, service)
    if not told or ours in told:
        return None
    theirs = told[0].removesuffix(ending)
    text = f"{what} {name} is of type {node.schema.usual_type(theirs)}, not {type_name}"
    if node.schema.usual_type(ours.removesuffix(ending)) == theirs != ours.removesuffix(ending):
        package = theirs.split("/")[0].replace("_", "-")
        text = (
            f"{what} {name} is of the genuine type {theirs}, of which only a look-alike is installed here: "
            f"install ros-<distribution>-{package}"
        )
    return text


def _offered_types(node: Ros2Node, name: str) -> list[str]:
    """The types of a service as its servers have them; what rcl tells by names counts clients too, and so ourselves."""
    told = node.rcl.get_publishers_info_by_topic(f"rr{name}Reply", no_mangle=True)
    # On DDS they are called like nav2_msgs::action::dds_::NavigateToPose_SendGoal_Response_.
    plain = {info.topic_type.replace("::dds_::", "::").replace("::", "/") for info in told}
    return sorted(type_name.removesuffix("_Response_") for type_name in plain)


def contents(node: Ros2Node) -> GraphContents:
    """Look at the graph as it is known now."""
    rcl = node.rcl
    nodes = sorted({absolute(space, name) for name, space in rcl.get_node_names_and_namespaces()})
    topics: dict[str, TopicInfo] = {}
    actions: dict[str, str] = {}
    for name, types in rcl.get_topic_names_and_types():
        if name.endswith(FEEDBACK):
            servers = rcl.get_publishers_info_by_topic(name)
            if servers:  # else it is only asked for
                told = servers[0].topic_type.removesuffix("_FeedbackMessage")
                actions[name.removesuffix(FEEDBACK)] = node.schema.usual_type(told)
        elif ACTION not in name and name not in INFRASTRUCTURE:
            topics[name] = _topic(node, name, types)
    services: dict[str, str] = {}
    for name, types in rcl.get_service_names_and_types():
        if ACTION not in name and not _belongs_to_node(name, nodes) and rcl.count_services(name):
            services[name] = node.schema.usual_type(sorted(types)[0]) if types else ""
    return GraphContents(topics, services, actions, tuple(node for node in nodes if _is_shown(node)))


def _topic(node: Ros2Node, name: str, types: list[str]) -> TopicInfo:
    return TopicInfo(
        name,
        tuple(sorted({node.schema.usual_type(told) for told in types})),
        tuple(endpoint(info) for info in node.rcl.get_publishers_info_by_topic(name)),
        tuple(endpoint(info) for info in node.rcl.get_subscriptions_info_by_topic(name)),
    )


def _belongs_to_node(service: str, nodes: list[str]) -> bool:
    """Whether a service is one of those that every node has."""
    owner, _, last = service.rpartition("/")
    return last in NODE_SERVICES and owner in nodes


def _is_shown(node: str) -> bool:
    """Nodes of tools begin with an underscore and are hidden, as in ROS 2's own lists."""
    return not node.rpartition("/")[2].startswith("_")


def publishers_in(rcl: Any, topic: str, no_mangle: bool = False) -> frozenset[bytes]:
    """The identities of those who publish a topic, as far as a node of rclpy knows."""
    told = rcl.get_publishers_info_by_topic(topic, no_mangle=no_mangle)
    return frozenset(bytes(info.endpoint_gid) for info in told)


def action_servers_in(rcl: Any, name: str) -> frozenset[bytes]:
    """The identities of those that offer an action, as far as a node of rclpy knows."""
    return publishers_in(rcl, name + FEEDBACK)


def action_servers(node: Ros2Node, name: str) -> frozenset[bytes]:
    """The identities of those that offer an action: a server that was started anew has another."""
    return action_servers_in(node.rcl, name)


def service_servers_in(rcl: Any, name: str) -> frozenset[bytes]:
    """The identities of those that offer a service, as far as a node of rclpy knows."""
    return publishers_in(rcl, f"rr{name}Reply", no_mangle=True)


def service_servers(node: Ros2Node, name: str) -> frozenset[bytes]:
    """The identities of those that offer a service, where the middleware makes services of topics, as all on DDS do."""
    return service_servers_in(node.rcl, name)


_FOREVER = 2**62
"""Nanoseconds from which on a deadline is none; the middlewares have several numbers for it."""


def profile(qos: QoS) -> Any:
    """Give rclpy's profile."""
    reliability, durability = rclpy.qos.ReliabilityPolicy, rclpy.qos.DurabilityPolicy
    told: dict[str, Any] = {}
    if qos.deadline is not None:
        told["deadline"] = rclpy.duration.Duration(seconds=qos.deadline)
    return rclpy.qos.QoSProfile(
        depth=qos.depth,
        reliability=reliability.RELIABLE if qos.reliability == "reliable" else reliability.BEST_EFFORT,
        durability=durability.TRANSIENT_LOCAL if qos.durability == "transient_local" else durability.VOLATILE,
        **told,
    )


def quality(given: Any) -> QoS:
    """Read rclpy's profile of somebody's endpoint."""
    reliability, durability = rclpy.qos.ReliabilityPolicy, rclpy.qos.DurabilityPolicy
    nanoseconds = given.deadline.nanoseconds
    return QoS(
        reliability="best_effort" if given.reliability == reliability.BEST_EFFORT else "reliable",
        durability="transient_local" if given.durability == durability.TRANSIENT_LOCAL else "volatile",
        depth=max(1, given.depth),  # not every middleware tells it
        deadline=nanoseconds * 1e-9 if 0 < nanoseconds < _FOREVER else None,
    )
