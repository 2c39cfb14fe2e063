"""Topics through the bridge, including those of ROS 1's actions."""

from collections import deque
from collections.abc import Iterable
from functools import partial
from typing import Any

from jacaros.robots.ros.drivers.rosbridge.node import BridgeNode
from jacaros.robots.ros.node import (
    SharedSubscription,
    SubscriptionOptions,
    TopicMultiplexer,
    TopicPublisher,
    TopicTrouble,
)
from jacaros.robots.ros.protocols.rosbridge_wire import LOOK_STEADILY
from jacaros.robots.ros.qos import QoS
from jacaros.runtime.clock import Timer

WAITING = 300
"""Number of messages of each of an action's topics that may wait for the loop: none is dropped, and their order is
kept."""


class BridgePublisher(TopicPublisher[BridgeNode]):
    """Publisher of `RosbridgeBackend`.

    The server forgets us when the connection is lost; then the topic is advertised again, and latched messages are
    sent again. Other messages are lost meanwhile: a velocity from a minute ago would do harm.
    """

    def __init__(self, node: BridgeNode, topic: str, type_name: str, qos: QoS) -> None:
        super().__init__(node, topic, type_name, qos)
        # A lost goal or request to cancel would not be repeated.
        self._droppable = not _is_of_action(type_name)
        self._kept: deque[Any] = deque(maxlen=qos.depth if self.latched else 0)
        self._subscribers = node.polled("subscribers", lambda seen: len(seen["subscribers"]), 0, topic=topic)
        self._number = node.number("advertise", topic)
        if node.attached:
            self.join()

    @property
    def subscription_count(self) -> int:
        """Number of subscribing nodes, according to the bridge at most 1 s ago."""
        return self._subscribers.value if self._node.connected and not self._closed else 0

    def join(self) -> None:
        """Advertise the topic at a server that does not know us yet."""
        operation = {
            "op": "advertise",
            "id": self._number,
            "topic": self.topic,
            "type": self._node.written_type(self.type_name),
            "latch": self.latched,
            "queue_size": self.qos.depth,
        }
        if self._node.ros_version == 2:
            operation["qos"] = _quality(self.qos)
        self._node.request(operation, self.join, lambda text: self.report(f"nothing is published: {text}"))
        for message in self._kept:
            self._pass_on(message)

    def _send(self, message: Any) -> None:
        self._kept.append(message)
        # Before the version of ROS is known, the notation is unknown.
        if not self._node.attached or not self._pass_on(message):
            self._node.note_loss(self.topic)

    def _pass_on(self, message: Any) -> bool:
        values = self._node.translator.encode(self.type_name, message)
        # A message that stops a robot at the end of the process must arrive, however slow the network is.
        droppable = self._droppable and not self._node.lifetime.leaving
        return self._node.send({"op": "publish", "topic": self.topic, "msg": values}, droppable)

    def _leave(self) -> None:
        self._node.admission.forget(self._number)
        self._node.send({"op": "unadvertise", "id": self._number, "topic": self.topic})


class BridgeMultiplexer(TopicMultiplexer["BridgeSubscription"]):
    """The process's only subscription of a topic at the server.

    The server sends each message once per client, however often it subscribes; so latched messages for late
    subscriptions are stored here. Messages are not decoded yet.
    """

    def __init__(self, node: BridgeNode, topic: str, type_name: str) -> None:
        super().__init__(topic, type_name)
        self._number = node.number("subscribe", topic)
        self._node = node
        self._last: Any = None
        self._late: Timer | None = None
        self._depth = 0
        self._publishers = node.polled("publishers", lambda seen: len(seen["publishers"]), 0, topic=topic)

    @property
    def publisher_count(self) -> int:
        """Number of publishing nodes, according to the bridge at most 1 s ago."""
        return self._publishers.value if self._node.connected else 0

    def add(self, reader: "BridgeSubscription") -> None:
        """Add a subscription."""
        super().add(reader)
        self._depth = max(self._depth, reader.qos.depth)
        # Subscribe only once, though a later reader may need a longer queue: after a second subscription the server
        # sends the next message twice, and the latched one again.
        if len(self.readers) == 1 and self._node.attached:
            self.join()

    def latched(self, reader: "BridgeSubscription") -> Iterable[Any]:
        """Return the latched message."""
        return (self._last,) if reader.qos.durability != "volatile" and self._last is not None else ()

    def join(self) -> None:
        """Subscribe at a server that does not know us yet."""
        operation = {
            "op": "subscribe",
            "id": self._number,
            "topic": self.topic,
            "type": self._node.written_type(self.type_name),
            "queue_length": self._depth,
        }
        if self._node.translator.packs(self.type_name):
            operation["compression"] = "cbor"
        # Without qos the server chooses one that matches all publishers that it knows. But if none exist yet, it
        # misses what they publish before they discover it.
        durabilities = {reader.qos.durability for reader in self.readers if self._node.ros_version == 2}
        if "transient_local" in durabilities:
            operation["qos"] = _quality(QoS(durability="transient_local", depth=self._depth))
        elif "best_available" in durabilities:
            self._look_later(operation)
        self._node.request(operation, self.join, self.report)

    def _look_later(self, operation: dict[str, Any]) -> None:
        self._late = self._node.clock.call_later(LOOK_STEADILY, partial(self._look_for_late, operation))

    def _look_for_late(self, operation: dict[str, Any]) -> None:
        """Subscribe again when the first publisher has appeared: then the server requests its stored message."""
        if self._last is None and self._node.attached and self.readers:
            if self.publisher_count:
                self._node.send(operation)
            else:
                self._look_later(operation)

    def lost(self) -> None:
        """Forget the latched message."""
        self._last = None
        self._stop_looking()

    def put(self, message: Any) -> None:
        """Handle a message of the server."""
        self._last = message
        super().put(message)

    def _stop_looking(self) -> None:
        if self._late is not None:
            self._late.cancel()

    def _leave(self) -> None:
        self._stop_looking()
        self._node.admission.forget(self._number)
        self._node.send({"op": "unsubscribe", "id": self._number, "topic": self.topic})


class BridgeSubscription(SharedSubscription[BridgeNode]):
    """Subscription of `RosbridgeBackend`.

    Messages are decoded when they are delivered, so messages dropped from a full queue cost nothing.
    """

    def __init__(self, node: BridgeNode, wanted: SubscriptionOptions) -> None:
        super().__init__(node, wanted, node.multiplexers, BridgeMultiplexer)
        if _is_of_action(wanted.type_name):  # the result must not arrive before its feedback
            self._waiting = deque(self._waiting, WAITING)

    def deliver(self, message: Any) -> None:
        """Decode a message and deliver it."""
        try:
            decoded = self._node.translator.decode(self.type_name, message)
        except ValueError as problem:
            text = f"topic {self.topic}: the message is not a {self.type_name}: {problem}"
            self.report(TopicTrouble.OTHER_TYPE, text, text)
        else:
            super().deliver(decoded)
            self._node.delivered()


def _is_of_action(type_name: str) -> bool:
    """Return whether a type is that of a topic of ROS 1's actions, which the protocol of rosbridge does not know."""
    return "/action/" in type_name or type_name.startswith("actionlib_msgs/")


def _quality(qos: QoS) -> dict[str, Any]:
    return {
        "history": "keep_last",
        "depth": qos.depth,
        "reliability": qos.reliability,
        "durability": qos.durability,
    }
