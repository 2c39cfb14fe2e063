"""Topics through the bridge, also those of ROS 1's actions."""

from collections import deque
from collections.abc import Callable, Iterable
from typing import Any

from jacaros.ros.backend import Sample, TopicTrouble
from jacaros.ros.drivers.rosbridge.node import BridgeNode
from jacaros.ros.node import Wanted
from jacaros.ros.orphans import Orphans
from jacaros.ros.protocols.rosbridge_requests import Polled
from jacaros.ros.qos import DEFAULT_QOS, QoS
from jacaros.ros.topics import SharedSubscription, TopicMultiplexer, TopicPublisher

WAITING = 300
"""Messages of each of an action's topics that may wait for the loop: none is dropped, so their order stays."""


class BridgePublisher(TopicPublisher[BridgeNode]):
    """Publisher of `RosbridgeBackend`.

    The server forgets what it knows of us when the connection is lost; then the topic is advertised again, and what is
    kept for late subscriptions is sent again.  Other messages are lost meanwhile: a velocity of a minute ago would be
    worse than none.
    """

    def __init__(
        self, node: BridgeNode, topic: str, type_name: str, qos: QoS, droppable: bool = True
    ) -> None:
        super().__init__(node, topic, type_name, qos)
        self._droppable = droppable
        self._kept: deque[Any] = deque(maxlen=qos.depth if self.latched else 0)
        self._subscribers = Polled(
            node.requests, "/rosapi/subscribers", {"topic": topic}, lambda seen: len(seen["subscribers"]), 0
        )
        self._number = node.number("advertise", topic)
        if node.attached:
            self.join()

    @property
    def subscription_count(self) -> int:
        """How many nodes subscribe, as the bridge said a second ago at most."""
        return self._subscribers.value if self._node.connected and not self._closed else 0

    def join(self) -> None:
        """Advertise the topic at a server that does not know us yet."""
        operation = {
            "op": "advertise",
            "id": self._number,
            "topic": self.topic,
            "type": self.written_type(),
            "latch": self.latched,
            "queue_size": self.qos.depth,
        }
        if self._node.ros_version == 2:
            operation["qos"] = _quality(self.qos)
        self._node.send(operation)
        self._node.admission.expect(self)
        for message in self._kept:
            self._pass_on(message)

    def written_type(self) -> str:
        """The type as the server writes it."""
        return self._node.written_type(self.type_name)

    def refused(self, text: str) -> None:
        """The server does not publish for us."""
        self.report(f"what is published there goes nowhere: {text}")

    def _send(self, message: Any) -> None:
        self._kept.append(message)
        # Before the server has been asked whose graph this is, the notation is not known.
        if not self._node.attached or not self._pass_on(message):
            self._node.note_loss(self.topic)

    def _pass_on(self, message: Any) -> bool:
        values = self._node.translator.encode(self.type_name, message)
        # What stops a robot at the end of the process must arrive, however slow the network is.
        droppable = self._droppable and not self._node.lifetime.leaving
        return self._node.send({"op": "publish", "topic": self.topic, "msg": values}, droppable)

    def _leave(self) -> None:
        self._node.admission.forget(self)
        self._node.send({"op": "unadvertise", "id": self._number, "topic": self.topic})


class BridgeMultiplexer(TopicMultiplexer["BridgeSubscription"]):
    """The process's one subscription of a topic at the server.

    The server sends a topic's messages once to each client, however often it subscribes; so what a late subscription must
    see of a latched topic is kept here.  Messages are not decoded yet.
    """

    def __init__(self, node: BridgeNode, topic: str, type_name: str) -> None:
        super().__init__(topic, type_name)
        self._number = node.number("subscribe", topic)
        self._node = node
        self._last: Any = None
        self._depth = 0
        self._publishers = Polled(
            node.requests, "/rosapi/publishers", {"topic": topic}, lambda seen: len(seen["publishers"]), 0
        )

    @property
    def publisher_count(self) -> int:
        """How many nodes publish, as the bridge said a second ago at most."""
        return self._publishers.value if self._node.connected else 0

    def add(self, reader: "BridgeSubscription") -> None:
        """Serve *reader* too."""
        super().add(reader)
        self._depth = max(self._depth, reader.qos.depth)
        # Once only, though a longer queue would be right for a later one: to a client that subscribes again the server
        # sends the next message twice, and the latched one again.
        if len(self.readers) == 1 and self._node.attached:
            self.join()

    def latched(self, reader: "BridgeSubscription") -> Iterable[Any]:
        """What was said last."""
        return (self._last,) if reader.latched and self._last is not None else ()

    def join(self) -> None:
        """Subscribe at a server that does not know us yet."""
        operation = {
            "op": "subscribe",
            "id": self._number,
            "topic": self.topic,
            "type": self.written_type(),
            "queue_length": self._depth,
        }
        if self._node.packs and self._node.translator.packs(self.type_name):
            operation["compression"] = "cbor"
        # Without qos the server chooses what goes with all publishers that it sees.  But if there are none yet, it does not
        # get what they will have said before it knows them.
        if self._node.ros_version == 2 and any(reader.latched for reader in self.readers):
            operation["qos"] = _quality(QoS(durability="transient_local", depth=self._depth))
        self._node.send(operation)
        self._node.admission.expect(self)

    def written_type(self) -> str:
        """The type as the server writes it."""
        return self._node.written_type(self.type_name)

    def lost(self) -> None:
        """Forget what is latched."""
        self._last = None

    def put(self, message: Any) -> None:
        """Take a message of the server."""
        self._last = message
        super().put(message)

    def refused(self, text: str) -> None:
        """The server does not give us the topic."""
        self.report(text)

    def _leave(self) -> None:
        self._node.admission.forget(self)
        self._node.send({"op": "unsubscribe", "id": self._number, "topic": self.topic})


class BridgeSubscription(SharedSubscription[BridgeNode]):
    """Subscription of `RosbridgeBackend`.

    Messages are decoded when it is their turn: what a full queue drops costs nothing.

    Args:
        waiting: messages that may wait for their turn; as many as *qos* says by default.
    """

    def __init__(self, node: BridgeNode, wanted: Wanted, waiting: int | None = None) -> None:
        super().__init__(node, wanted, node.multiplexers, BridgeMultiplexer)
        if waiting is not None:
            self._waiting = deque(self._waiting, waiting)

    def deliver(self, message: Any) -> None:
        """Decode a message and hand it over."""
        try:
            decoded = self._node.translator.decode(self.type_name, message)
        except ValueError as problem:
            text = f"topic {self.topic}: a message is no {self.type_name}: {problem}"
            self.report(TopicTrouble.OTHER_TYPE, text, text)
        else:
            super().deliver(decoded)
            self._node.delivered()


def _quality(qos: QoS) -> dict[str, Any]:
    return {
        "history": "keep_last",
        "depth": qos.depth,
        "reliability": qos.reliability,
        "durability": qos.durability,
    }


class ActionTopics:
    """Where `ActionlibWire` and `ActionlibServer` have the topics of one action of a ROS 1 robot, an `ActionTopicsNode`.

    The rosbridge protocol knows no actions of ROS 1, so goals, requests for cancelling and news are ordinary messages of
    the types that actionlib wraps around an action's own (``pkg/NameActionGoal`` and so on).

    What comes on them is delivered in the order in which it came: the end of a goal not before its feedback.  And what
    goes out is not dropped because the network is slow: a lost request for cancelling would not be repeated.

    Args:
        node: the backend.
    """

    def __init__(self, node: BridgeNode) -> None:
        self._node = node
        self.clock = node.clock
        self.log = node.log
        self.factory = node.factory

    @property
    def orphans(self) -> Orphans:
        """What recognises goals of earlier runs."""
        return self._node.orphans

    @property
    def node_name(self) -> str:
        """Absolute name of the node."""
        return self._node.node_name

    def publisher(self, topic: str, type_name: str, qos: QoS = DEFAULT_QOS) -> BridgePublisher:
        """Make a publisher."""
        return self._node.keep(BridgePublisher(self._node, topic, type_name, qos, droppable=False))

    def subscription(
        self, topic: str, type_name: str, callback: Callable[[Sample], None], qos: QoS = DEFAULT_QOS
    ) -> BridgeSubscription:
        """Have *callback* called for every message."""
        return self._node.keep(
            BridgeSubscription(self._node, Wanted(topic, type_name, callback, qos), WAITING)
        )

    def add_exit_hook(self, hook: Callable[[], None]) -> Callable[[], None]:
        """Have *hook* called when the process stops."""
        return self._node.add_exit_hook(hook)
