"""Topics through the bridge, also those of ROS 1's actions."""

from collections import deque
from collections.abc import Callable
from typing import Any

from jacaros.ros.backend import Sample, TopicEvent, TopicTrouble
from jacaros.ros.drivers.rosbridge.node import BridgeNode
from jacaros.ros.orphans import Orphans
from jacaros.ros.protocols.rosbridge_requests import Sight
from jacaros.ros.qos import DEFAULT_QOS, QoS
from jacaros.ros.serving import published_message

WAITING = 300
"""Messages of each of an action's topics that may wait for the loop: none is dropped, so their order stays."""


class BridgePublisher:
    """Publisher of `RosbridgeBackend`.

    The server forgets what it knows of us when the connection is lost; then the topic is advertised again, and what is
    kept for late subscriptions is sent again.  Other messages are lost meanwhile: a velocity of a minute ago would be
    worse than none.
    """

    def __init__(
        self, node: BridgeNode, topic: str, type_name: str, qos: QoS, droppable: bool = True
    ) -> None:
        self.topic = topic
        self._node = node
        self._type_name = type_name
        self._droppable = droppable
        self._class = node.factory.message_class(type_name)
        self._qos = qos
        self._kept: deque[Any] = deque(maxlen=qos.depth if qos.durability == "transient_local" else 0)
        self._closed = False
        self._told: set[str] = set()
        self._subscribers = Sight(
            node.requests, "/rosapi/subscribers", {"topic": topic}, lambda seen: len(seen["subscribers"]), 0
        )
        self._number = node.number("advertise", topic)
        if node.attached:
            self.join()

    @property
    def subscription_count(self) -> int:
        """How many nodes subscribe, as the bridge said a second ago at most."""
        return self._subscribers.value if self._node.connected and not self._closed else 0

    def message(self, **fields: Any) -> Any:
        """Make a message of the topic's type."""
        return self._node.factory.make(self._type_name, fields)

    def publish(self, message: Any) -> None:
        """Send *message*."""
        if not isinstance(message, self._class):
            message = published_message(self._node.factory, self.topic, self._type_name, message)
        self._node.lifetime.send(self._pass_on, message)

    def _pass_on(self, message: Any) -> None:
        if self._closed:
            return
        self._kept.append(message)
        # Before the server has been asked whose graph this is, the notation is not known.
        if not self._node.attached or not self._send(message):
            self._node.note_loss(self.topic)

    def close(self) -> None:
        """Leave the topic."""
        if not self._closed:
            self._closed = True
            self._node.drop(self)
            self._node.admission.forget(self)
            self._node.send({"op": "unadvertise", "id": self._number, "topic": self.topic})

    def join(self) -> None:
        """Advertise the topic at a server that does not know us yet."""
        qos = self._qos
        operation = {
            "op": "advertise",
            "id": self._number,
            "topic": self.topic,
            "type": self.written_type(),
            "latch": qos.durability == "transient_local",
            "queue_size": qos.depth,
        }
        if self._node.ros_version == 2:
            operation["qos"] = _quality(qos)
        self._node.send(operation)
        self._node.admission.expect(self)
        for message in self._kept:
            self._send(message)

    def written_type(self) -> str:
        """The type as the server writes it."""
        return self._node.written_type(self._type_name)

    def refused(self, text: str) -> None:
        """The server does not publish for us."""
        if text not in self._told:
            self._told.add(text)
            self._node.log(f"what is published there goes nowhere: {text}")

    def _send(self, message: Any) -> bool:
        values = self._node.translator.encode(self._type_name, message)
        # What stops a robot at the end of the process must arrive, however slow the network is.
        droppable = self._droppable and not self._node.lifetime.leaving
        return self._node.send({"op": "publish", "topic": self.topic, "msg": values}, droppable)


class TopicFeed:
    """The process's one subscription of a topic at the server, shared by ours.

    The server sends a topic's messages once to each client, however often it subscribes; so what a late subscription must
    see of a latched topic is kept here.
    """

    def __init__(self, node: BridgeNode, topic: str, type_name: str) -> None:
        self.topic = topic
        self._type_name = type_name
        self.number = node.number("subscribe", topic)
        self._node = node
        self._sinks: tuple[BridgeSubscription, ...] = ()
        self._last: Any = None
        self._depth = 0
        self.publishers = Sight(
            node.requests, "/rosapi/publishers", {"topic": topic}, lambda seen: len(seen["publishers"]), 0
        )

    def add(self, sink: "BridgeSubscription") -> None:
        """Serve *sink* too."""
        self._sinks = (*self._sinks, sink)
        if sink.latched and self._last is not None:
            sink.put(self._last)
        self._depth = max(self._depth, sink.depth)
        # Once only, though a longer queue would be right for a later sink: to a client that subscribes again the server
        # sends the next message twice, and the latched one again.
        if len(self._sinks) == 1 and self._node.attached:
            self.join()

    def remove(self, sink: "BridgeSubscription") -> None:
        """Serve *sink* no longer; unsubscribe at the server when it was the last one."""
        self._sinks = tuple(other for other in self._sinks if other is not sink)
        if not self._sinks:
            self._node.drop_feed(self)
            self._node.send({"op": "unsubscribe", "id": self.number, "topic": self.topic})

    def join(self) -> None:
        """Subscribe at a server that does not know us yet."""
        operation = {
            "op": "subscribe",
            "id": self.number,
            "topic": self.topic,
            "type": self.written_type(),
            "queue_length": self._depth,
        }
        if self._node.packs and self._node.translator.packs(self._type_name):
            operation["compression"] = "cbor"
        # Without qos the server chooses what goes with all publishers that it sees.  But if there are none yet, it does not
        # get what they will have said before it knows them.
        if self._node.ros_version == 2 and any(sink.latched for sink in self._sinks):
            operation["qos"] = _quality(QoS(durability="transient_local", depth=self._depth))
        self._node.send(operation)
        self._node.admission.expect(self)

    def written_type(self) -> str:
        """The type as the server writes it."""
        return self._node.written_type(self._type_name)

    def lost(self) -> None:
        """The link is down: what is latched comes again, and may be another then."""
        self._last = None

    def put(self, values: Any) -> None:
        """Take a message of the server, not decoded yet."""
        self._last = values
        for sink in self._sinks:
            sink.put(values)

    def refused(self, text: str) -> None:
        """The server does not give us the topic."""
        for sink in self._sinks:
            sink.trouble(text)


class BridgeSubscription:
    """Subscription of `RosbridgeBackend`.

    Messages are decoded when it is their turn: what a full queue drops costs nothing.

    Args:
        waiting: messages that may wait for their turn; as many as *qos* says by default.
    """

    def __init__(
        self,
        node: BridgeNode,
        topic: str,
        type_name: str,
        callback: Callable[[Sample], None],
        qos: QoS,
        on_event: Callable[[TopicEvent], None] | None,
        waiting: int | None = None,
    ) -> None:
        self.topic = topic
        self.depth = qos.depth
        self.latched = qos.durability == "transient_local"
        self._node = node
        self._type_name = type_name
        self._callback = callback
        self._on_event = on_event
        self._told: set[str] = set()
        self._waiting: deque[Any] = deque(maxlen=waiting or qos.depth)
        feed = node.feeds.get(topic)
        if not isinstance(feed, TopicFeed):
            feed = node.feeds[topic] = TopicFeed(node, topic, type_name)
        self._feed = feed
        self._closed = False
        self._feed.add(self)

    @property
    def publisher_count(self) -> int:
        """How many nodes publish, as the bridge said a second ago at most."""
        return self._feed.publishers.value if self._node.connected and not self._closed else 0

    def close(self) -> None:
        """Leave the topic."""
        self._waiting.clear()
        if not self._closed:
            self._closed = True
            self._node.drop(self)
            self._feed.remove(self)

    def trouble(self, text: str) -> None:
        """Tell that the server does not send what we want, once for each reason."""
        if text in self._told:
            return
        self._told.add(text)
        if self._on_event is not None:
            self._on_event(TopicEvent(TopicTrouble.OTHER_TYPE, text))
        else:
            self._node.log(text)

    def put(self, values: Any) -> None:
        """Queue a message for a turn of the loop; the oldest is dropped when the queue is full."""
        self._waiting.append(values)
        self._node.loop.call_soon(self._deliver_next)

    def _deliver_next(self) -> None:
        if not self._waiting:  # a later message pushed this turn's one out, or the subscription was closed
            return
        try:
            message = self._node.translator.decode(self._type_name, self._waiting.popleft())
        except ValueError as problem:
            self.trouble(f"topic {self.topic}: a message is no {self._type_name}: {problem}")
        else:
            self._callback(self._node.sample(message, self.topic))
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
        made = BridgePublisher(self._node, topic, type_name, qos, droppable=False)
        self._node.add(made)
        return made

    def subscription(
        self, topic: str, type_name: str, callback: Callable[[Sample], None], qos: QoS = DEFAULT_QOS
    ) -> BridgeSubscription:
        """Have *callback* called for every message."""
        made = BridgeSubscription(self._node, topic, type_name, callback, qos, None, WAITING)
        self._node.add(made)
        return made

    def add_exit_hook(self, hook: Callable[[], None]) -> Callable[[], None]:
        """Have *hook* called when the process stops."""
        return self._node.add_exit_hook(hook)
