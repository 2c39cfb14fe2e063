"""Publishers and subscriptions of `jacaros.ros.drivers.memory.backend`.

Publishing is the innermost loop of every run on this backend: what is rare (faults, deadlines) replaces
`MemorySubscription.put` instead of being asked for at each message.
"""

from collections import deque
from collections.abc import Callable
from functools import partial
from typing import Any

from jacaros.clock import Timer
from jacaros.ros.backend import Sample, TopicEvent, TopicTrouble
from jacaros.ros.drivers.memory.graph import GraphPublisher, GraphSubscription
from jacaros.ros.drivers.memory.node import MemoryNode
from jacaros.ros.qos import QoS, incompatibility
from jacaros.ros.serving import published_message


class MemoryPublisher:
    """Publisher of `MemoryBackend`."""

    def __init__(self, node: MemoryNode, topic: str, type_name: str, qos: QoS) -> None:
        self.topic = topic
        self.type_name = type_name
        self.qos = qos
        self._node = node
        self._class = node.factory.message_class(type_name)
        self._receivers: list[GraphSubscription] = []
        self.kept: deque[Any] = deque(maxlen=qos.depth if qos.durability == "transient_local" else 0)
        self._shared = node.graph.topic(topic)
        self._shared.publishers.append(self)
        for subscription in self._shared.subscriptions:
            subscription.meet(self)
        node.graph.published_by(self)

    @property
    def node_name(self) -> str:
        """Absolute name of the node."""
        return self._node.node_name

    @property
    def subscription_count(self) -> int:
        """How many subscriptions are connected now."""
        return len(self._receivers)

    def message(self, **fields: Any) -> Any:
        """Make a message of the topic's type."""
        return self._node.factory.make(self.type_name, fields)

    def publish(self, message: Any) -> None:
        """Hand *message* to all subscriptions."""
        if not isinstance(message, self._class):
            message = published_message(self._node.factory, self.topic, self.type_name, message)
        if not self._node.lifetime.admits():
            return
        self.kept.append(message)
        for subscription in self._receivers:
            subscription.put(message)

    def connect(self, subscription: GraphSubscription) -> None:
        """Send to a new subscription from now on, and what is kept for late ones at once."""
        self._receivers.append(subscription)
        if subscription.qos.durability == "transient_local":
            for message in self.kept:
                subscription.put(message)

    def disconnect(self, subscription: GraphSubscription) -> None:
        """Send to a subscription no more."""
        if subscription in self._receivers:
            self._receivers.remove(subscription)

    def disconnect_all(self) -> None:
        """Send to nobody."""
        self._receivers = []

    def refused(self, subscription: GraphSubscription) -> None:
        """Say that a subscription takes this topic for something else; when it is ours, it says so itself."""
        if subscription.node_name != self.node_name:
            self._node.log(
                f"topic {self.topic}: {subscription.node_name} takes it for {subscription.type_name} and gets nothing of "
                f"what is published here as {self.type_name}"
            )

    def close(self) -> None:
        """Leave the topic."""
        if self in self._shared.publishers:
            self._shared.publishers.remove(self)
        self._receivers = []
        self._node.forget(self)


class MemorySubscription:
    """Subscription of `MemoryBackend`."""

    put: Callable[[Any], None]
    """Takes a message from a publisher."""

    def __init__(
        self,
        node: MemoryNode,
        topic: str,
        type_name: str,
        callback: Callable[[Sample], None],
        qos: QoS,
        on_event: Callable[[TopicEvent], None] | None,
    ) -> None:
        self.topic = topic
        self.type_name = type_name
        self.qos = qos
        self._node = node
        self._callback = callback
        self._on_event = on_event
        self._closed = False
        self._waiting: deque[Any] = deque(maxlen=qos.depth)
        self._deadline = None if qos.deadline is None else _Deadline(node, qos.deadline, self._missed)
        self._shared = node.graph.topic(topic)
        self._shared.subscriptions.append(self)  # pyright: ignore[reportArgumentType]
        self.choose_way()
        for publisher in self._shared.publishers:
            self.meet(publisher)

    @property
    def node_name(self) -> str:
        """Absolute name of the node."""
        return self._node.node_name

    @property
    def publisher_count(self) -> int:
        """How many publishers are connected now."""
        if not self._node.graph.up:
            return 0
        return sum(1 for publisher in self._shared.publishers if self.trouble(publisher) is None)

    def meet(self, publisher: GraphPublisher) -> None:
        """Be connected to a publisher, or say why not."""
        trouble = self.trouble(publisher)
        if trouble is not None:
            if trouble.trouble is TopicTrouble.OTHER_TYPE:
                publisher.refused(self)  # pyright: ignore[reportArgumentType]
            self._tell(trouble)
        elif self._node.graph.up:
            publisher.connect(self)  # pyright: ignore[reportArgumentType]

    def trouble(self, publisher: GraphPublisher) -> TopicEvent | None:
        """Why nothing can come from a publisher."""
        if publisher.type_name != self.type_name:
            return TopicEvent(
                TopicTrouble.OTHER_TYPE,
                f"topic {self.topic}: {publisher.node_name} publishes {publisher.type_name}, not {self.type_name}; "
                f"write {publisher.type_name} here to receive it",
            )
        problem = incompatibility(publisher.qos, self.qos)
        if problem is None:
            return None
        return TopicEvent(
            TopicTrouble.INCOMPATIBLE_QOS,
            f"topic {self.topic}: not connected, because {problem}; ask for no more than is offered",
        )

    def choose_way(self) -> None:
        """Let messages come in with what is to be done to them on the way, and no more."""
        put = self._queue if self._deadline is None else self._queue_in_time
        fate = self._shared.fate
        if fate is None:
            self.put = put
            return

        def arrive(message: Any) -> None:
            if not self._closed:
                put(message)

        def suffer(message: Any) -> None:
            for delay in fate(message):
                if delay <= 0.0:
                    put(message)
                else:
                    self._node.clock.call_later(delay, partial(arrive, message))

        self.put = suffer

    def close(self) -> None:
        """Leave the topic."""
        self._closed = True
        if self in self._shared.subscriptions:
            self._shared.subscriptions.remove(self)
        for publisher in self._shared.publishers:
            publisher.disconnect(self)  # pyright: ignore[reportArgumentType]
        self._waiting.clear()
        if self._deadline is not None:
            self._deadline.stop()
        self._node.forget(self)

    def _queue(self, message: Any) -> None:
        """Queue *message* for a turn of the loop; the oldest is dropped when the queue is full."""
        loop = self._node.loop
        if not loop.is_closed():
            self._waiting.append(message)
            loop.call_soon(self._deliver_next)

    def _queue_in_time(self, message: Any) -> None:
        assert self._deadline is not None
        self._deadline.kept()
        self._queue(message)

    def _deliver_next(self) -> None:
        # Empty when a later message pushed this turn's one out, or when the subscription was closed.
        if self._waiting:
            self._callback(self._node.sample(self._waiting.popleft(), self.topic))

    def _missed(self, first: bool) -> None:
        if self._on_event is not None or first:
            text = f"topic {self.topic}: no message came for {self.qos.deadline:g} s, which is the deadline"
            self._tell(TopicEvent(TopicTrouble.DEADLINE_MISSED, text))

    def _tell(self, event: TopicEvent) -> None:
        if self._on_event is None:
            self._node.log(event.text)
        else:
            # Later: the one who subscribes does not have the subscription yet.
            self._node.loop.call_soon(self._tell_now, event)

    def _tell_now(self, event: TopicEvent) -> None:
        if self._on_event is not None and not self._closed:
            self._on_event(event)


class _Deadline:
    """Tells when messages do not come in time; it begins with the first message, as in DDS.

    Args:
        node: has the clock.
        seconds: longest time between two messages.
        missed: is called at every period without one; with True when it is the first after a message.
    """

    def __init__(self, node: MemoryNode, seconds: float, missed: Callable[[bool], None]) -> None:
        self._clock = node.clock
        self._seconds = seconds
        self._missed = missed
        self._last = 0.0
        self._missing = False
        self._timer: Timer | None = None

    def kept(self) -> None:
        """A message has come."""
        self._last = self._clock.elapsed
        self._missing = False
        if self._timer is None:
            self._wait(self._seconds)

    def stop(self) -> None:
        """Watch no longer."""
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
