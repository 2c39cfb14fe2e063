"""The shared state of the nodes of one process: topics, services, actions, and whether they reach each other.

Tests inject faults: `MemoryGraph.disturb`, `vanish`, `interrupt` and `restore`.
"""

import asyncio
import random
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol

from jacaros.ros.action_calling import GoalSender
from jacaros.ros.errors import RosError
from jacaros.ros.graph import Endpoint, GraphContents, TopicInfo
from jacaros.ros.parameter import ParameterValue
from jacaros.ros.parameter_store import DeclaredParameters
from jacaros.ros.qos import QoS


class GraphEntity(Protocol):
    """An entity that can disappear without notice."""

    def vanish(self) -> None:
        """Disappear without notice."""
        ...


class GraphNode(GraphEntity, Protocol):
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
        """Note that the graph was found or lost."""
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

    @property
    def arrive(self) -> Callable[[Any], None]:
        """Takes a message from a publisher."""
        ...

    def meet(self, publisher: "GraphPublisher") -> None:
        """Connect to a publisher, or report why that is impossible."""
        ...

    def fits(self, publisher: "GraphPublisher") -> bool:
        """Return whether messages of a publisher arrive."""
        ...

    def choose_way(self) -> None:
        """Select the delivery path for the topic's faults."""
        ...


class GraphPublisher(TopicEnd, Protocol):
    """A publisher."""

    def connect(self, subscription: GraphSubscription) -> None:
        """Send to a subscription."""
        ...

    def disconnect(self, subscription: GraphSubscription) -> None:
        """Stop sending to a subscription."""
        ...

    def disconnect_all(self) -> None:
        """Stop sending to all subscriptions."""
        ...

    def refused(self, subscription: GraphSubscription) -> None:
        """Report that a subscription expects another type."""
        ...


class GraphService(GraphEntity, Protocol):
    """A service."""

    name: str
    type_name: str

    def handle(self, request: Any, answer: asyncio.Future[Any]) -> None:
        """Answer one call."""
        ...


class GoalLine(Protocol):
    """An action client's connection to the servers."""

    name: str
    sender: GoalSender

    @property
    def offered(self) -> bool:
        """Whether a server offers the action."""
        ...

    def server_came(self) -> None:
        """Note that there is a server."""
        ...

    def server_went(self) -> None:
        """Note that there is no server."""
        ...


class GraphActionServer(GraphEntity, Protocol):
    """An action server."""

    name: str
    type_name: str
    vanished: bool

    def take(self, goal_id: str, request: Any, wire: GoalLine) -> None:
        """Accept a goal and begin it, or reject it."""
        ...

    def cancel(self, goal_id: str, wire: GoalLine) -> None:
        """Handle a request to cancel."""
        ...


Disturbance = Callable[[Any], Sequence[float]]
"""Takes a message; returns the delays in seconds after which copies of it arrive: none if it is lost."""


def delayed(seconds: float, jitter: float = 0.0, seed: int = 0) -> Disturbance:
    """Delay every message.

    Args:
        seconds: minimum delay.
        jitter: maximum of a random additional delay, so that messages overtake each other.
        seed: seed of the jitter.
    """
    chance = random.Random(seed)
    return lambda message: (seconds + chance.uniform(0.0, jitter) if jitter else seconds,)


def dropped(share: float = 1.0, seed: int = 0) -> Disturbance:
    """Drop messages.

    Args:
        share: fraction of the messages, from 0 to 1; 1 drops all.
        seed: seed of the choice.
    """
    chance = random.Random(seed)
    return lambda message: () if chance.random() < share else (0.0,)


def duplicated(copies: int = 2, apart: float = 0.0) -> Disturbance:
    """Deliver every message several times.

    Args:
        copies: number of copies.
        apart: seconds between two copies.
    """
    return lambda message: [number * apart for number in range(copies)]


def both(first: Disturbance, second: Disturbance) -> Disturbance:
    """Combine two disturbances: *second* applies to each copy that *first* lets through."""
    return lambda message: [late + later for late in first(message) for later in second(message)]


HIDDEN = ("/rosout", "/parameter_events")
"""Topics of every graph, which `GraphContents` omits."""


@dataclass
class Topic:
    """The entities of a topic, and the disturbance of its messages (None: none)."""

    publishers: list[GraphPublisher] = field(default_factory=list)
    subscriptions: list[GraphSubscription] = field(default_factory=list)
    disturbance: Disturbance | None = None

    def info(self, name: str) -> TopicInfo:
        """Return the description of the topic for `GraphContents`."""
        types = {publisher.type_name for publisher in self.publishers}
        types |= {subscription.type_name for subscription in self.subscriptions}
        return TopicInfo(
            name,
            tuple(sorted(types)),
            tuple(Endpoint(publisher.node_name, publisher.qos) for publisher in self.publishers),
            tuple(Endpoint(subscription.node_name, subscription.qos) for subscription in self.subscriptions),
        )


class MemoryGraph:
    """Topics, services, actions and parameters shared by the nodes of one process."""

    def __init__(self) -> None:
        self.up = True
        self._loop: asyncio.AbstractEventLoop | None = None
        self._topics: dict[str, Topic] = {}
        self._services: dict[str, GraphService] = {}
        self._actions: dict[str, GraphActionServer] = {}
        self._wires: dict[str, list[GoalLine]] = {}
        self._nodes: dict[str, GraphNode] = {}
        self._awaited: dict[str, list[asyncio.Future[None]]] = {}
        self._held: list[tuple[Callable[..., None], tuple[Any, ...]]] = []
        self._parameter_listeners: dict[str, list[Callable[[Mapping[str, ParameterValue]], None]]] = {}

    # Nodes

    def join(self, node: GraphNode) -> None:
        """Add *node*; a newer node of the same name replaces it."""
        self._loop = node.loop
        self._nodes[node.node_name] = node
        self._arrived(f"node {node.node_name}")

    def leave(self, node: GraphNode) -> None:
        """Remove *node*."""
        if self._nodes.get(node.node_name) is node:
            del self._nodes[node.node_name]

    def node(self, name: str) -> GraphNode | None:
        """Return the node *name*, if it can be reached."""
        return self._nodes.get(name) if self.up else None

    def contents(self) -> GraphContents:
        """Return everything in the graph."""
        return GraphContents(
            {
                name: topic.info(name)
                for name, topic in sorted(self._topics.items())
                if name not in HIDDEN and (topic.publishers or topic.subscriptions)
            },
            {name: service.type_name for name, service in sorted(self._services.items())},
            {name: server.type_name for name, server in sorted(self._actions.items())},
            tuple(sorted(self._nodes)),
        )

    # Topics

    def topic(self, name: str) -> Topic:
        """Return the topic *name*."""
        return self._topics.setdefault(name, Topic())

    def topics(self) -> dict[str, str]:
        """Names of all topics in use with their types."""
        return {name: topic.types[0] for name, topic in self.contents().topics.items()}

    # Services

    def offer(self, service: GraphService) -> None:
        """Make *service* reachable; a newer one of the same name replaces it, as on ROS 1."""
        self._services[service.name] = service
        self._arrived(f"service {service.name}")

    def withdraw(self, service: GraphService) -> None:
        """Remove *service*."""
        if self._services.get(service.name) is service:
            del self._services[service.name]

    def server(self, name: str) -> GraphService | None:
        """Return the service *name*, if it is offered."""
        return self._services.get(name) if self.up else None

    # Actions

    def offer_action(self, server: GraphActionServer) -> None:
        """Make an action reachable; a newer server of the same name replaces it."""
        self._actions[server.name] = server
        for wire in self._wires.get(server.name, []):
            wire.server_came()

    def withdraw_action(self, server: GraphActionServer) -> None:
        """Remove an action."""
        if self._actions.get(server.name) is server:
            del self._actions[server.name]
            for wire in list(self._wires.get(server.name, [])):
                wire.server_went()

    def action_server(self, name: str) -> GraphActionServer | None:
        """Return the action *name*, if it is offered."""
        return self._actions.get(name) if self.up else None

    def connect(self, wire: GoalLine) -> None:
        """Report to an action client when servers come and go."""
        self._wires.setdefault(wire.name, []).append(wire)

    def disconnect(self, wire: GoalLine) -> None:
        """Stop reporting to an action client."""
        if wire in self._wires.get(wire.name, []):
            self._wires[wire.name].remove(wire)

    # Parameters

    def listen_to_parameters(
        self, node: str, callback: Callable[[Mapping[str, ParameterValue]], None]
    ) -> Callable[[], None]:
        """Call *callback* with the changed parameters of *node*. Return a function that removes it."""
        listeners = self._parameter_listeners.setdefault(node, [])
        listeners.append(callback)
        return lambda: listeners.remove(callback) if callback in listeners else None

    def parameters_changed(self, node: str, changed: Mapping[str, ParameterValue]) -> None:
        """Report changes to the listeners, in a later turn of the loop."""
        if self.up:
            for callback in self._parameter_listeners.get(node, []):
                self.tell(callback, changed)

    # Waiting and callbacks

    def arrival(self, what: str) -> asyncio.Future[None]:
        """Return a future that is done when an entity (``service /add``, ``node /sim``) has appeared."""
        future: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        self._awaited.setdefault(what, []).append(future)
        return future

    def tell(self, callback: Callable[..., None], *arguments: Any) -> None:
        """Call *callback* in a later turn of the loop; while the graph is interrupted, after the interruption."""
        if self.up and self._loop is not None:
            if not self._loop.is_closed():
                self._loop.call_soon(callback, *arguments)
        else:
            self._held.append((callback, arguments))

    def _arrived(self, what: str) -> None:
        if self.up:
            for future in self._awaited.pop(what, []):
                if not future.done():
                    future.set_result(None)

    # Fault injection, for tests

    def disturb(self, topic: str, disturbance: Disturbance) -> Callable[[], None]:
        """Delay, duplicate or drop the messages of a topic from now on.

        Args:
            topic: absolute name.
            disturbance: for each message and subscription, the delays in seconds after which copies arrive; see
                `Disturbance`.

        Returns:
            A function that ends it.
        """
        disturbed = self.topic(topic)

        def become(disturbance: Disturbance | None) -> None:
            disturbed.disturbance = disturbance
            for subscription in disturbed.subscriptions:
                subscription.choose_way()

        become(disturbance)
        return lambda: become(None)

    def vanish(self, name: str) -> None:
        """Remove a node, service or action server without notice, as when its process is killed.

        Clients of its services and actions get no answer; no exit hooks run; further messages of its code are
        dropped.

        Raises:
            RosError: there is no entity of that name.
        """
        tables: tuple[Mapping[str, GraphEntity], ...] = (self._nodes, self._services, self._actions)
        found = [table[name] for table in tables if name in table]
        if not found:
            raise RosError(f"unknown node, service or action: {name}")
        for member in found:
            member.vanish()

    def interrupt(self) -> None:
        """Disconnect all nodes from each other, as when the network or the master fails.

        Messages are lost, services and actions cannot be reached, `Backend.connected` is false everywhere.
        """
        self.up = False
        for topic in self._topics.values():
            for publisher in topic.publishers:
                publisher.disconnect_all()
        for wire in self._all_wires():
            wire.server_went()
        for node in list(self._nodes.values()):
            node.set_connected(False)

    def restore(self) -> None:
        """End `interrupt`: all nodes find each other again, and pending answers arrive."""
        self.up = True
        held, self._held = self._held, []
        for callback, arguments in held:
            self.tell(callback, *arguments)
        for topic in self._topics.values():
            for publisher in topic.publishers:
                for subscription in topic.subscriptions:
                    if subscription.fits(publisher):
                        publisher.connect(subscription)
        for name in self._services:
            self._arrived(f"service {name}")
        for name in self._nodes:
            self._arrived(f"node {name}")
        for wire in self._all_wires():
            if wire.offered:
                wire.server_came()
        for node in list(self._nodes.values()):
            node.set_connected(True)

    def _all_wires(self) -> list[GoalLine]:
        return [wire for wires in self._wires.values() for wire in wires]
