"""The graph as rclpy knows it: nodes, types, and quality of service."""

from typing import Any

import rclpy.duration  # type: ignore[import-not-found]
import rclpy.qos  # type: ignore[import-not-found]

from jacaros.robots.ros.backend import Endpoint, GraphContents, TopicInfo
from jacaros.robots.ros.drivers.ros2.node import Ros2Node
from jacaros.robots.ros.parameter_services import NODE_SERVICES
from jacaros.robots.ros.protocols.ros2_actions import ACTION, FEEDBACK, SEND_GOAL
from jacaros.robots.ros.qos import QoS

INFRASTRUCTURE = frozenset({"/rosout", "/parameter_events"})


def absolute(namespace: str, name: str) -> str:
    """Return a node's absolute name."""
    return f"{namespace.rstrip('/')}/{name}"


def endpoint(info: Any) -> Endpoint:
    """Convert rclpy's description of an endpoint."""
    name = "" if info.node_name.startswith("_") else absolute(info.node_namespace, info.node_name)
    return Endpoint(name, quality(info.qos_profile))


def foreign_types(node: Ros2Node, topic: str, type_name: str) -> dict[str, str]:
    """Return the types other than *type_name* that are published on a topic, each with one of its publishers."""
    ours = node.schema.graph_type(type_name)
    told = node.rcl.get_publishers_info_by_topic(topic)
    return {
        info.topic_type: endpoint(info).node or "an unknown node" for info in told if info.topic_type != ours
    }


_OFFERED = {"service": ("", ""), "action": (SEND_GOAL, "_SendGoal")}
"""What follows the name and the type in the service that shows that something is offered."""


def mismatch(node: Ros2Node, what: str, name: str, type_name: str) -> str | None:
    """Return a problem if a service or action (*what*) exists with another type only.

    None if none exists, or nothing is known.
    """
    suffix, ending = _OFFERED[what]
    ours = node.schema.graph_type(type_name)
    told = [each.removesuffix(ending) for each in _offered_types(node, name + suffix)]
    if not told or ours in told:
        return None
    theirs = told[0]
    if node.schema.usual_type(ours) == theirs != ours:
        package = theirs.split("/")[0].replace("_", "-")
        return (
            f"{what} {name} has the original type {theirs}, but only a substitute is installed here: "
            f"install ros-<distribution>-{package}"
        )
    return f"{what} {name} is of type {node.schema.usual_type(theirs)}, not {type_name}"


def _offered_types(node: Ros2Node, name: str) -> list[str]:
    """Return the types of a service according to its servers; rcl's names include clients, and thus ourselves."""
    told = node.rcl.get_publishers_info_by_topic(f"rr{name}Reply", no_mangle=True)
    # On DDS they have names such as nav2_msgs::action::dds_::NavigateToPose_SendGoal_Response_.
    plain = {info.topic_type.replace("::dds_::", "::").replace("::", "/") for info in told}
    return sorted(type_name.removesuffix("_Response_") for type_name in plain)


def contents(node: Ros2Node) -> GraphContents:
    """Return the graph as it is known now."""
    rcl = node.rcl
    nodes = sorted({absolute(space, name) for name, space in rcl.get_node_names_and_namespaces()})
    topics: dict[str, TopicInfo] = {}
    actions: dict[str, str] = {}
    for name, types in rcl.get_topic_names_and_types():
        if name.endswith(FEEDBACK):
            servers = rcl.get_publishers_info_by_topic(name)
            if servers:  # otherwise there are only clients
                told = servers[0].topic_type.removesuffix("_FeedbackMessage")
                actions[name.removesuffix(FEEDBACK)] = node.schema.usual_type(told)
        elif ACTION not in name and name not in INFRASTRUCTURE:
            topics[name] = _topic(node, name, types)
    services: dict[str, str] = {}
    for name, types in rcl.get_service_names_and_types():
        # By type, not by node: the services of a node that has ended are known longer than the node.
        of_node = name.rpartition("/")[2] in NODE_SERVICES and all(map(_is_of_nodes, types))
        if ACTION not in name and not of_node and rcl.count_services(name):
            services[name] = node.schema.usual_type(sorted(types)[0]) if types else ""
    # Names of tools begin with an underscore; ROS 2's own lists do not show them either.
    shown = (each for each in nodes if not each.rpartition("/")[2].startswith("_"))
    return GraphContents(topics, services, actions, tuple(shown))


def _is_of_nodes(type_name: str) -> bool:
    return type_name.startswith(("rcl_interfaces/", "type_description_interfaces/"))


def _topic(node: Ros2Node, name: str, types: list[str]) -> TopicInfo:
    return TopicInfo(
        name,
        tuple(sorted({node.schema.usual_type(told) for told in types})),
        tuple(endpoint(info) for info in node.rcl.get_publishers_info_by_topic(name)),
        tuple(endpoint(info) for info in node.rcl.get_subscriptions_info_by_topic(name)),
    )


def publishers_in(rcl: Any, topic: str, no_mangle: bool = False) -> frozenset[bytes]:
    """Return the identities of a topic's publishers that a node of rclpy knows."""
    told = rcl.get_publishers_info_by_topic(topic, no_mangle=no_mangle)
    return frozenset(bytes(info.endpoint_gid) for info in told)


def action_servers(rcl: Any, name: str) -> frozenset[bytes]:
    """Return the identities of an action's servers that a node of rclpy knows; a restarted server has a new one."""
    return publishers_in(rcl, name + FEEDBACK)


def service_servers(rcl: Any, name: str) -> frozenset[bytes]:
    """Return the identities of a service's servers that a node of rclpy knows, if the middleware builds services from
    topics, as all DDS ones do."""
    return publishers_in(rcl, f"rr{name}Reply", no_mangle=True)


_FOREVER = 2**62
"""Nanoseconds from which a deadline means none; the middlewares use different numbers."""


def profile(qos: QoS) -> Any:
    """Convert to rclpy's profile."""
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
    """Convert rclpy's profile of another endpoint."""
    reliability, durability = rclpy.qos.ReliabilityPolicy, rclpy.qos.DurabilityPolicy
    nanoseconds = given.deadline.nanoseconds
    return QoS(
        reliability="best_effort" if given.reliability == reliability.BEST_EFFORT else "reliable",
        durability="transient_local" if given.durability == durability.TRANSIENT_LOCAL else "volatile",
        depth=max(1, given.depth),  # some middlewares do not report it
        deadline=nanoseconds * 1e-9 if 0 < nanoseconds < _FOREVER else None,
    )
