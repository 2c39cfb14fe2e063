"""The nodes of one process, their publishers and subscriptions, and the graph that they share.

Publishing is the innermost loop of every run on this backend: rare features (faults, deadlines) replace
`MemorySubscription.arrive` instead of being checked for each message.

Tests inject faults: `MemoryGraph.disturb`, `vanish`, `interrupt` and `restore`.
"""

import asyncio
import itertools
import random
from collections import defaultdict, deque
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any, Literal

from jacaros.robots.ros.backend import Backend, Endpoint, GraphContents, TopicInfo
from jacaros.robots.ros.errors import RosError
from jacaros.robots.ros.lifetime import Lifetime
from jacaros.robots.ros.node import M, NodeSettings, SubscriptionOptions, TopicPublisher, TopicSubscription
from jacaros.robots.ros.parameter import DeclaredParameters, ParameterValue
from jacaros.robots.ros.parameter_services import ParameterListeners
from jacaros.robots.ros.qos import QoS, incompatibility
from jacaros.robots.ros.typestore import DefinitionSchema
from jacaros.robots.ros.waiting import settle
from jacaros.runtime.clock import Timer

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

    publishers: list["MemoryPublisher"] = field(default_factory=list)
    subscriptions: list["MemorySubscription"] = field(default_factory=list)
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


EntityKind = Literal["node", "service", "action"]
"""What can be in a graph besides topics."""


class MemoryGraph:
    """Topics, services, actions and parameters shared by the nodes of one process."""

    def __init__(self) -> None:
        self.up = True
        self.parameter_listeners = ParameterListeners()
        self._loop: asyncio.AbstractEventLoop | None = None
        self._topics: dict[str, Topic] = {}
        self._members: dict[EntityKind, dict[str, Any]] = {"node": {}, "service": {}, "action": {}}
        self._watchers: dict[tuple[EntityKind, str], list[Callable[[bool], None]]] = defaultdict(list)
        self._held: list[tuple[Callable[..., None], tuple[Any, ...]]] = []

    def join(self, node: "MemoryNode") -> None:
        """Add *node*."""
        self._loop = node.loop
        self.offer("node", node.node_name, node)

    def offer(self, kind: EntityKind, name: str, member: Any) -> None:
        """Make *member* reachable; a newer one of the same name replaces it, as on ROS 1."""
        self._members[kind][name] = member
        if self.up:
            self._report(kind, name, True)

    def withdraw(self, kind: EntityKind, name: str, member: Any) -> None:
        """Remove *member*."""
        if self._members[kind].get(name) is member:
            del self._members[kind][name]
            self._report(kind, name, False)

    def find(self, kind: EntityKind, name: str) -> Any:
        """Return the node, service or action server *name*, if it can be reached; otherwise None."""
        return self._members[kind].get(name) if self.up else None

    def watch(self, kind: EntityKind, name: str, told: Callable[[bool], None]) -> Callable[[], None]:
        """Call *told* with whether a member can be reached, when it comes or goes. Return a function that ends this."""
        watchers = self._watchers[kind, name]
        watchers.append(told)
        return lambda: watchers.remove(told) if told in watchers else None

    def arrival(self, kind: EntityKind, name: str) -> asyncio.Future[None]:
        """Return a future that is done when a member has appeared."""
        future: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        end = self.watch(kind, name, lambda present: settle(future, None, None) if present else None)
        future.add_done_callback(lambda _: end())
        return future

    def _report(self, kind: EntityKind, name: str, present: bool) -> None:
        for told in list(self._watchers[kind, name]):
            told(present)

    def contents(self) -> GraphContents:
        """Return everything in the graph."""
        services, actions = (
            {name: member.type_name for name, member in sorted(self._members[kind].items())}
            for kind in ("service", "action")
        )
        topics = {
            name: topic.info(name)
            for name, topic in sorted(self._topics.items())
            if name not in HIDDEN and (topic.publishers or topic.subscriptions)
        }
        return GraphContents(topics, services, actions, tuple(sorted(self._members["node"])))

    def topic(self, name: str) -> Topic:
        """Return the topic *name*."""
        return self._topics.setdefault(name, Topic())

    def topics(self) -> dict[str, str]:
        """Names of all topics in use with their types."""
        return {name: topic.types[0] for name, topic in self.contents().topics.items()}

    def tell(self, callback: Callable[..., None], *arguments: Any) -> None:
        """Call *callback* in a later turn of the loop; while the graph is interrupted, after the interruption."""
        if self.up and self._loop is not None:
            if not self._loop.is_closed():
                self._loop.call_soon(callback, *arguments)
        else:
            self._held.append((callback, arguments))

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
        found = [members[name] for members in self._members.values() if name in members]
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
                publisher.receivers = []
        for kind, name in list(self._watchers):
            self._report(kind, name, False)
        for node in list(self._members["node"].values()):
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
        for kind, name in list(self._watchers):
            if name in self._members[kind]:
                self._report(kind, name, True)
        for node in list(self._members["node"].values()):
            node.set_connected(True)


class MemoryNode(Backend):
    """The part of `jacaros.robots.ros.drivers.memory.backend.MemoryBackend` that its entities use.

    Args:
        settings: names, clock and log.
        graph: the graph to join; default: a new one.
    """

    def __init__(self, settings: NodeSettings, graph: MemoryGraph | None = None) -> None:
        self.schema = DefinitionSchema(settings.interface_paths)
        super().__init__(settings, self.schema, Lifetime(settings.log))
        self.graph = graph if graph is not None else MemoryGraph()
        self.declared = DeclaredParameters(
            self.node_name,
            self.given_parameters,
            self._parameters_changed,
        )
        self.vanished = False
        self._goal_numbers = itertools.count(1)

    def keep(self, member: M) -> M:
        """Close *member* with the node. Raises `RosError` if the node has vanished."""
        if self.vanished:
            member.close()
            raise RosError(f"node {self.node_name} was taken away from the graph")
        return super().keep(member)

    def new_goal_id(self) -> str:
        """Return a numbered id for a goal of this node."""
        return f"{self.node_name}-{next(self._goal_numbers)}"

    def _parameters_changed(self, changed: Mapping[str, ParameterValue]) -> None:
        if self.graph.up:
            for callback in self.graph.parameter_listeners.of(self.node_name):
                self.graph.tell(callback, changed)

    def vanish(self) -> None:
        """Disappear without notice, as a killed process does; see `MemoryGraph.vanish`."""
        self.vanished = True
        for member in list(self.members):
            getattr(member, "vanish", member.close)()
        self.members.clear()
        self.graph.withdraw("node", self.node_name, self)


class MemoryPublisher(TopicPublisher[MemoryNode]):
    """Publisher of `MemoryBackend`."""

    def __init__(self, node: MemoryNode, topic: str, type_name: str, qos: QoS) -> None:
        super().__init__(node, topic, type_name, qos)
        self.receivers: list[MemorySubscription] = []
        self.kept: deque[Any] = deque(maxlen=qos.depth if self.latched else 0)
        self._shared = node.graph.topic(topic)
        self._shared.publishers.append(self)
        for subscription in self._shared.subscriptions:
            subscription.meet(self)

    @property
    def subscription_count(self) -> int:
        """Number of connected subscriptions."""
        return len(self.receivers)

    def _send(self, message: Any) -> None:
        self.kept.append(message)
        for subscription in self.receivers:
            subscription.arrive(message)

    def connect(self, subscription: "MemorySubscription") -> None:
        """Send to a new subscription from now on, and send it the latched messages immediately."""
        self.receivers.append(subscription)
        if subscription.qos.durability != "volatile":
            for message in self.kept:
                subscription.arrive(message)

    def refused(self, subscription: "MemorySubscription") -> None:
        """Report that a subscription expects another type; one of our own reports it itself."""
        if subscription.node_name != self.node_name:
            self._node.log(
                f"topic {self.topic}: {subscription.node_name} expects {subscription.type_name} and does not receive "
                f"what is published here as {self.type_name}"
            )

    def _leave(self) -> None:
        self._shared.publishers.remove(self)
        self.receivers = []


class MemorySubscription(TopicSubscription[MemoryNode]):
    """Subscription of `MemoryBackend`."""

    def __init__(self, node: MemoryNode, wanted: SubscriptionOptions) -> None:
        super().__init__(node, wanted)
        deadline = wanted.qos.deadline
        self._deadline = None if deadline is None else _Deadline(node, deadline, self.report_deadline)
        self._shared = node.graph.topic(self.topic)
        self.arrive: Callable[[Any], None] = self.put
        """Takes a message from a publisher."""
        self._shared.subscriptions.append(self)
        self.choose_way()
        for publisher in self._shared.publishers:
            self.meet(publisher)

    @property
    def publisher_count(self) -> int:
        """Number of connected publishers."""
        if not self._node.graph.up:
            return 0
        return sum(1 for publisher in self._shared.publishers if self.fits(publisher))

    @property
    def latched(self) -> bool:
        """Whether stored messages are received."""
        if self.qos.durability != "best_available":
            return super().latched
        offers = [publisher.qos.durability for publisher in self._shared.publishers if self.fits(publisher)]
        return all(offer == "transient_local" for offer in offers)

    def meet(self, publisher: MemoryPublisher) -> None:
        """Connect to a publisher, or report why that is impossible."""
        if publisher.type_name != self.type_name:
            publisher.refused(self)
            self.report_type_mismatch(publisher.node_name, publisher.type_name)
        elif (problem := incompatibility(publisher.qos, self.qos)) is not None:
            self.report_qos(problem)
        elif self._node.graph.up:
            publisher.connect(self)

    def choose_way(self) -> None:
        """Select the delivery path once, so the common case has no checks."""
        put = self.put if self._deadline is None else self._put_in_time
        disturbance = self._shared.disturbance
        if disturbance is None:
            self.arrive = put
            return

        def arrive(message: Any) -> None:
            if not self._closed:
                put(message)

        def suffer(message: Any) -> None:
            for delay in disturbance(message):
                if delay <= 0.0:
                    put(message)
                else:
                    self._node.clock.call_later(delay, partial(arrive, message))

        self.arrive = suffer

    def fits(self, publisher: MemoryPublisher) -> bool:
        """Return whether messages of a publisher arrive."""
        return publisher.type_name == self.type_name and incompatibility(publisher.qos, self.qos) is None

    def _put_in_time(self, message: Any) -> None:
        assert self._deadline is not None
        self._deadline.kept()
        self.put(message)

    def _leave(self) -> None:
        self._shared.subscriptions.remove(self)
        for publisher in self._shared.publishers:
            if self in publisher.receivers:
                publisher.receivers.remove(self)
        if self._deadline is not None:
            self._deadline.stop()


class _Deadline:
    """Detects missed deadlines, starting with the first message, as in DDS.

    Args:
        node: has the clock.
        seconds: maximum time between two messages.
        missed: called at every period without a message; with True for the first after a message.
    """

    def __init__(self, node: MemoryNode, seconds: float, missed: Callable[[bool], None]) -> None:
        self._clock = node.clock
        self._seconds = seconds
        self._missed = missed
        self._last = 0.0
        self._missing = False
        self._timer: Timer | None = None

    def kept(self) -> None:
        """Note that a message has arrived."""
        self._last = self._clock.elapsed
        self._missing = False
        if self._timer is None:
            self._wait(self._seconds)

    def stop(self) -> None:
        """Stop watching."""
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None

    def _wait(self, seconds: float) -> None:
        self._timer = self._clock.call_later(seconds, self._check)

    def _check(self) -> None:
        rest = self._last + self._seconds - self._clock.elapsed
        if rest > 1e-9:
            self._wait(rest)
            return
        first, self._missing = not self._missing, True
        self._last = self._clock.elapsed
        self._wait(self._seconds)
        self._missed(first)
