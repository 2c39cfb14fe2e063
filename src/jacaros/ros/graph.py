"""The contents of the graph: topics, services, actions and nodes, with their types."""

from dataclasses import dataclass, field

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
