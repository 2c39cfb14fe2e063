"""What is there in the graph: topics, services, actions and nodes, with their types."""

from dataclasses import dataclass, field

from jacaros.ros.qos import QoS


@dataclass(frozen=True, slots=True)
class Endpoint:
    """A publisher or subscription of somebody.

    Attributes:
        node: absolute name of its node; empty where the middleware does not tell.
        qos: what it offers or asks for; None where the middleware does not tell.
    """

    node: str = ""
    qos: QoS | None = None


@dataclass(frozen=True, slots=True)
class TopicInfo:
    """A topic.

    Attributes:
        name: absolute.
        types: types of its messages in full form, sorted; more than one is somebody's mistake.
        publishers, subscriptions: who is at it.
    """

    name: str
    types: tuple[str, ...]
    publishers: tuple[Endpoint, ...] = ()
    subscriptions: tuple[Endpoint, ...] = ()


@dataclass(frozen=True, slots=True)
class GraphContents:
    """All that is in the graph at a moment.

    The topics and services that actions, parameters and logging are made of are left out of `topics` and `services`:
    those below ``…/_action/``, actionlib's five, parameter services, ``/rosout``, ``/parameter_events``.

    Attributes:
        topics: by absolute name.
        services: absolute name → type in full form ("" where it cannot be known).
        actions: absolute name → type in full form, such as ``nav2_msgs/action/NavigateToPose``.
        nodes: absolute names, sorted.
    """

    topics: dict[str, TopicInfo] = field(default_factory=dict)
    services: dict[str, str] = field(default_factory=dict)
    actions: dict[str, str] = field(default_factory=dict)
    nodes: tuple[str, ...] = ()
