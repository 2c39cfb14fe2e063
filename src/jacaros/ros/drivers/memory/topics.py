"""Publishers and subscriptions of `jacaros.ros.drivers.memory.backend`.

Publishing is the innermost loop of every run on this backend: rare features (faults, deadlines) replace
`MemorySubscription.arrive` instead of being checked for each message.
"""

from collections import deque
from collections.abc import Callable
from functools import partial
from typing import Any

from jacaros.ros.drivers.memory.graph import GraphPublisher, GraphSubscription
from jacaros.ros.drivers.memory.node import MemoryNode
from jacaros.ros.node import Wanted
from jacaros.ros.qos import QoS, incompatibility
from jacaros.ros.topics import TopicPublisher, TopicSubscription
from jacaros.runtime.clock import Timer


class MemoryPublisher(TopicPublisher[MemoryNode]):
    """Publisher of `MemoryBackend`."""

    def __init__(self, node: MemoryNode, topic: str, type_name: str, qos: QoS) -> None:
        super().__init__(node, topic, type_name, qos)
        self._receivers: list[GraphSubscription] = []
        self.kept: deque[Any] = deque(maxlen=qos.depth if self.latched else 0)
        self._shared = node.graph.topic(topic)
        self._shared.publishers.append(self)
        for subscription in self._shared.subscriptions:
            subscription.meet(self)

    @property
    def subscription_count(self) -> int:
        """Number of connected subscriptions."""
        return len(self._receivers)

    def _send(self, message: Any) -> None:
        self.kept.append(message)
        for subscription in self._receivers:
            subscription.arrive(message)

    def connect(self, subscription: GraphSubscription) -> None:
        """Send to a new subscription from now on, and send it the latched messages immediately."""
        self._receivers.append(subscription)
        if subscription.qos.durability != "volatile":
            for message in self.kept:
                subscription.arrive(message)

    def disconnect(self, subscription: GraphSubscription) -> None:
        """Stop sending to a subscription."""
        if subscription in self._receivers:
            self._receivers.remove(subscription)

    def disconnect_all(self) -> None:
        """Stop sending to all subscriptions."""
        self._receivers = []

    def refused(self, subscription: GraphSubscription) -> None:
        """Report that a subscription expects another type; one of our own reports it itself."""
        if subscription.node_name != self.node_name:
            self._node.log(
                f"topic {self.topic}: {subscription.node_name} expects {subscription.type_name} and does not receive "
                f"what is published here as {self.type_name}"
            )

    def _leave(self) -> None:
        self._shared.publishers.remove(self)
        self._receivers = []


class MemorySubscription(TopicSubscription[MemoryNode]):
    """Subscription of `MemoryBackend`."""

    def __init__(self, node: MemoryNode, wanted: Wanted) -> None:
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

    def meet(self, publisher: GraphPublisher) -> None:
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

    def fits(self, publisher: GraphPublisher) -> bool:
        """Return whether messages of a publisher arrive."""
        return publisher.type_name == self.type_name and incompatibility(publisher.qos, self.qos) is None

    def _put_in_time(self, message: Any) -> None:
        assert self._deadline is not None
        self._deadline.kept()
        self.put(message)

    def _leave(self) -> None:
        self._shared.subscriptions.remove(self)
        for publisher in self._shared.publishers:
            publisher.disconnect(self)
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
