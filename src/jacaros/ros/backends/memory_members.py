"""What `jacaros.ros.backends.memory_graph` knows of those who are in it."""

import asyncio
from collections.abc import Callable
from typing import Any, Protocol

from jacaros.ros.action_calling import GoalSender
from jacaros.ros.backend import TopicEvent
from jacaros.ros.parameter_store import DeclaredParameters
from jacaros.ros.qos import QoS


class Vanishing(Protocol):
    """Something that can be gone without a word."""

    def vanish(self) -> None:
        """Be gone without a word."""
        ...


class GraphNode(Vanishing, Protocol):
    """A node."""

    declared: DeclaredParameters

    @property
    def node_name(self) -> str:
        """Absolute name of the node."""
        ...

    @property
    def loop(self) -> asyncio.AbstractEventLoop:
        """The loop on which it runs."""
        ...

    def set_connected(self, connected: bool) -> None:
        """Learn that the graph was found or lost."""
        ...


class TopicEnd(Protocol):
    """A publisher or a subscription."""

    type_name: str
    qos: QoS

    @property
    def node_name(self) -> str:
        """Absolute name of the node."""
        ...


class GraphSubscription(TopicEnd, Protocol):
    """A subscription."""

    put: Callable[[Any], None]

    def meet(self, publisher: "GraphPublisher") -> None:
        """Be connected to a publisher, or say why not."""
        ...

    def trouble(self, publisher: "GraphPublisher") -> TopicEvent | None:
        """Why nothing can come from a publisher."""
        ...

    def choose_way(self) -> None:
        """Let messages come in as the topic's faults want it."""
        ...


class GraphPublisher(TopicEnd, Protocol):
    """A publisher."""

    def connect(self, subscription: GraphSubscription) -> None:
        """Send to a subscription."""
        ...

    def disconnect(self, subscription: GraphSubscription) -> None:
        """Send to a subscription no more."""
        ...

    def disconnect_all(self) -> None:
        """Send to nobody."""
        ...

    def refused(self, subscription: GraphSubscription) -> None:
        """Say that a subscription takes the topic for something else."""
        ...


class GraphService(Vanishing, Protocol):
    """A service."""

    name: str
    type_name: str

    def handle(self, request: Any, answer: asyncio.Future[Any]) -> None:
        """Answer one call."""
        ...


class GoalLine(Protocol):
    """An action client's line to the servers."""

    name: str
    sender: GoalSender

    @property
    def offered(self) -> bool:
        """Whether a server offers the action."""
        ...

    def server_came(self) -> None:
        """A server is there."""
        ...

    def server_went(self) -> None:
        """There is no server any more."""
        ...


class GraphActionServer(Vanishing, Protocol):
    """An action server."""

    name: str
    type_name: str
    vanished: bool

    def take(self, goal_id: str, request: Any, wire: GoalLine) -> None:
        """Judge a goal and begin with it."""
        ...

    def cancel(self, goal_id: str, wire: GoalLine) -> None:
        """Handle a request for cancelling."""
        ...
