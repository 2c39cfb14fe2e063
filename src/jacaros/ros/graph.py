"""The contents of the graph: topics, services, actions and nodes, with their types."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from typing import Literal

from jacaros.ros.names import near_names
from jacaros.ros.qos import QoS


@dataclass(frozen=True, slots=True)
class Endpoint:
    """A publisher or subscription of any node.

    Attributes:
        node: absolute name of its node; empty if the middleware does not report it.
        qos: its offer or request; None if the middleware does not report it.
    """

    node: str = ""
    qos: QoS | None = None


@dataclass(frozen=True, slots=True)
class TopicInfo:
    """A topic.

    Attributes:
        name: absolute name.
        types: types of its messages in full form, sorted; more than one is a mistake of some node.
        publishers, subscriptions: its endpoints.
    """

    name: str
    types: tuple[str, ...]
    publishers: tuple[Endpoint, ...] = ()
    subscriptions: tuple[Endpoint, ...] = ()


def latching(topic: TopicInfo | None) -> str:
    """Return the nodes whose publishers store messages for late subscriptions; empty if none is known."""
    ends = () if topic is None else topic.publishers
    names = {
        each.node or "an unknown node"
        for each in ends
        if each.qos is not None and each.qos.durability == "transient_local"
    }
    return ", ".join(sorted(names))


@dataclass(frozen=True, slots=True)
class GraphContents:
    """A snapshot of the graph.

    The topics and services behind actions, parameters and logging are not included in `topics` and `services`: those
    below ``…/_action/``, actionlib's five, parameter services, ``/rosout``, ``/parameter_events``.

    Attributes:
        topics: by absolute name.
        services: absolute name → type in full form ("" if unknown).
        actions: absolute name → type in full form, such as ``nav2_msgs/action/NavigateToPose``.
        nodes: absolute names, sorted.
    """

    topics: dict[str, TopicInfo] = field(default_factory=dict)
    services: dict[str, str] = field(default_factory=dict)
    actions: dict[str, str] = field(default_factory=dict)
    nodes: tuple[str, ...] = ()

    def near_topics(
        self, name: str, type_name: str, end: Literal["publishers", "subscriptions"]
    ) -> list[str]:
        """Return up to three topics that *name* may mean: of the same type, otherwise of a similar name.

        Args:
            name: absolute name of the missing topic.
            type_name: its type in full form; empty if unknown.
            end: the endpoints that a suggested topic must have.
        """
        used = {each: info.types for each, info in self.topics.items() if getattr(info, end)}
        return near_names(name, used, alike(type_name, used))


def alike(type_name: str, types: Mapping[str, Collection[str]]) -> list[str]:
    """Return the names with a type, sorted; none if the type says nothing about the meaning, such as a string.

    Args:
        type_name: full form; empty if unknown.
        types: the types of each name.
    """
    if type_name.startswith(("std_msgs/", "std_srvs/")):
        return []
    return sorted(name for name, theirs in types.items() if type_name in theirs)
