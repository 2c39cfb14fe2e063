"""What the nodes of one process share: who is at which topic, who offers what, and whether they reach each other.

Tests make it misbehave: `MemoryGraph.disturb`, `vanish`, `interrupt` and `restore`.
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
    """Something that can be gone without a word."""

    def vanish(self) -> None:
        """Be gone without a word."""
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

    @property
    def arrive(self) -> Callable[[Any], None]:
        """Takes a message from a publisher."""
        ...

    def meet(self, publisher: "GraphPublisher") -> None:
        """Be connected to a publisher, or say why not."""
        ...

    def fits(self, publisher: "GraphPublisher") -> bool:
        """Whether messages of a publisher come."""
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


class GraphService(GraphEntity, Protocol):
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


class GraphActionServer(GraphEntity, Protocol):
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


Disturbance = Callable[[Any], Sequence[float]]
"""Takes a message; gives the delays in seconds after which copies of it arrive: none when it is lost."""


def delayed(seconds: float, jitter: float = 0.0, seed: int = 0) -> Disturbance:
    """Let every message come late.

    Args:
        seconds: by so much.
        jitter: and by up to so much more, at random, so that messages overtake each other.
        seed: of the jitter.
    """
    chance = random.Random(seed)
    return lambda message: (seconds + chance.uniform(0.0, jitter) if jitter else seconds,)


def dropped(share: float = 1.0, seed: int = 0) -> Disturbance:
    """Lose messages.

    Args:
        share: of the messages, from 0 to 1; 1 loses all.
        seed: of the choice.
    """
    chance = random.Random(seed)
    return lambda message: () if chance.random() < share else (0.0,)


def duplicated(copies: int = 2, apart: float = 0.0) -> Disturbance:
    """Let every message come several times.

    Args:
        copies: how often.
        apart: seconds between two copies.
    """
    return lambda message: [number * apart for number in range(copies)]


def both(first: Disturbance, second: Disturbance) -> Disturbance:
    """Let two things happen to each message: each copy that *first* lets through suffers *second*."""
    return lambda message: [late + later for late in first(message) for later in second(message)]


HIDDEN = ("/rosout", "/parameter_events")
"""Topics that every graph has; `GraphContents` leaves them out."""


@dataclass
class Topic:
    """Who is at a topic, and what happens to its messages on the way (None: nothing)."""

    publishers: list[GraphPublisher] = field(default_factory=list)
    subscriptions: list[GraphSubscription] = field(default_factory=list)
    disturbance: Disturbance | None = None

    def info(self, name: str) -> TopicInfo:
        """What others are told of it."""
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
        self._publisher_watchers: list[Callable[[GraphPublisher], None]] = []
        self._parameter_listeners: dict[str, list[Callable[[Mapping[str, ParameterValue]], None]]] = {}

    # Nodes

    def join(self, node: GraphNode) -> None:
        """Make *node* known; a newer one of the same name takes over."""
        self._loop = node.loop
        self._nodes[node.node_name] = node
        self._arrived(f"node {node.node_name}")

    def leave(self, node: GraphNode) -> None:
        """Forget *node*."""
        if self._nodes.get(node.node_name) is node:
            del self._nodes[node.node_name]

    def node(self, name: str) -> GraphNode | None:
        """The node called *name*, if it can be reached."""
        return self._nodes.get(name) if self.up else None

    def contents(self) -> GraphContents:
        """All that is here now."""
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
        """Give the topic called *name*."""
        return self._topics.setdefault(name, Topic())

    def watch_publishers(self, watcher: Callable[[GraphPublisher], None]) -> None:
        """Have *watcher* called with each publisher that is there, and with each that comes, before it publishes."""
        self._publisher_watchers.append(watcher)
        for topic in list(self._topics.values()):
            for publisher in list(topic.publishers):
                watcher(publisher)

    def published_by(self, publisher: GraphPublisher) -> None:
        """Tell those who watch of a new publisher."""
        for watcher in self._publisher_watchers:
            watcher(publisher)

    def topics(self) -> dict[str, str]:
        """Names of all topics in use with their types."""
        return {name: topic.types[0] for name, topic in self.contents().topics.items()}

    # Services

    def offer(self, service: GraphService) -> None:
        """Make *service* reachable; a newer one of the same name takes over, as on ROS 1."""
        self._services[service.name] = service
        self._arrived(f"service {service.name}")

    def withdraw(self, service: GraphService) -> None:
        """Take *service* out again."""
        if self._services.get(service.name) is service:
            del self._services[service.name]

    def server(self, name: str) -> GraphService | None:
        """The service called *name*, if it is offered."""
        return self._services.get(name) if self.up else None

    # Actions

    def offer_action(self, server: GraphActionServer) -> None:
        """Make an action reachable; a newer server of the same name takes over."""
        self._actions[server.name] = server
        for wire in self._wires.get(server.name, []):
            wire.server_came()

    def withdraw_action(self, server: GraphActionServer) -> None:
        """Take an action out again."""
        if self._actions.get(server.name) is server:
            del self._actions[server.name]
            for wire in list(self._wires.get(server.name, [])):
                wire.server_went()

    def action_server(self, name: str) -> GraphActionServer | None:
        """The action called *name*, if it is offered."""
        return self._actions.get(name) if self.up else None

    def connect(self, wire: GoalLine) -> None:
        """Tell an action client when servers come and go."""
        self._wires.setdefault(wire.name, []).append(wire)

    def disconnect(self, wire: GoalLine) -> None:
        """Tell it no more."""
        if wire in self._wires.get(wire.name, []):
            self._wires[wire.name].remove(wire)

    # Parameters

    def listen_to_parameters(
        self, node: str, callback: Callable[[Mapping[str, ParameterValue]], None]
    ) -> Callable[[], None]:
        """Tell *callback* of the changed parameters of *node*; the result ends that."""
        listeners = self._parameter_listeners.setdefault(node, [])
        listeners.append(callback)
        return lambda: listeners.remove(callback) if callback in listeners else None

    def parameters_changed(self, node: str, changed: Mapping[str, ParameterValue]) -> None:
        """Tell those who listen, in a later turn of the loop."""
        if self.up:
            for callback in self._parameter_listeners.get(node, []):
                self.tell(callback, changed)

    # Waiting and being told

    def arrival(self, what: str) -> asyncio.Future[None]:
        """A future that is done when something (``service /add``, ``node /sim``) has come."""
        future: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        self._awaited.setdefault(what, []).append(future)
        return future

    def tell(self, callback: Callable[..., None], *arguments: Any) -> None:
        """Call *callback* in a later turn of the loop; while the graph is interrupted, after that."""
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

    # Faults, for tests

    def disturb(self, topic: str, disturbance: Disturbance) -> Callable[[], None]:
        """Delay, duplicate or drop the messages of a topic from now on.

        Args:
            topic: absolute name.
            disturbance: for each message and subscription, the delays in seconds after which copies arrive; see
                `jacaros.ros.drivers.memory.faults`.

        Returns:
            what ends it.
        """
        disturbed = self.topic(topic)

        def become(disturbance: Disturbance | None) -> None:
            disturbed.disturbance = disturbance
            for subscription in disturbed.subscriptions:
                subscription.choose_way()

        become(disturbance)
        return lambda: become(None)

    def vanish(self, name: str) -> None:
        """Take away a node, service or action server without a word, as when its process is killed.

        Clients of its services and actions get no answer; no exit hooks run; what its code still publishes goes nowhere.

        Raises:
            RosError: there is nothing of that name.
        """
        tables: tuple[Mapping[str, GraphEntity], ...] = (self._nodes, self._services, self._actions)
        found = [table[name] for table in tables if name in table]
        if not found:
            raise RosError(f"there is no node, service or action {name}")
        for member in found:
            member.vanish()

    def interrupt(self) -> None:
        """Cut all nodes off from each other, as when the network or the master is gone.

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
        """End `interrupt`: all find each other again; answers that were on their way arrive."""
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
