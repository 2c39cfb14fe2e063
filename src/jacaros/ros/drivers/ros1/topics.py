"""Topics of ROS 1: publishers, subscriptions, and what the process shares between them."""

import threading
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import rospy  # type: ignore[import-not-found]

from jacaros.ros.backend import Sample, TopicEvent, TopicTrouble
from jacaros.ros.drivers.ros1.node import Ros1Node, wait_until_sent
from jacaros.ros.errors import MessageMismatch
from jacaros.ros.handoff import Handoff, post
from jacaros.ros.qos import QoS
from jacaros.ros.serving import published_message


class Ros1Publisher:
    """Publisher of `Ros1Backend`."""

    def __init__(self, node: Ros1Node, topic: str, type_name: str, qos: QoS) -> None:
        self.topic = topic
        self._node = node
        self._type_name = type_name
        self._class = node.factory.message_class(type_name)
        self._qos = qos
        self._lock = threading.Lock()
        self._early: deque[Any] = deque(maxlen=qos.depth)
        self._publisher: Any = None
        self._closed = False
        node.members[self] = None
        node.unsent[self._sent] = None
        node.link.do(self._register)

    @property
    def subscription_count(self) -> int:
        """How many subscriptions are connected now."""
        publisher = self._publisher
        return 0 if publisher is None else int(publisher.get_num_connections())

    def message(self, **fields: Any) -> Any:
        """Make a message of the topic's type."""
        return self._node.factory.make(self._type_name, fields)

    def publish(self, message: Any) -> None:
        """Queue *message* for sending."""
        if not isinstance(message, self._class):
            message = published_message(self._node.factory, self.topic, self._type_name, message)
        self._node.lifetime.send(self._send, message)

    def _send(self, message: Any) -> None:
        if self._closed:
            return
        with self._lock:
            if self._publisher is None:
                self._early.append(message)
                return
        try:
            self._publisher.publish(message)
        except rospy.ROSSerializationException as problem:
            raise MessageMismatch(f"topic {self.topic}: {problem}", self._type_name) from None
        except rospy.ROSException:  # the node was shut down while this message was on its way
            self._closed = True

    def close(self) -> None:
        """Leave the topic."""
        if not self._closed:
            self._closed = True
            self._node.members.pop(self, None)
            self._node.link.do(self._unregister)

    def _sent(self) -> bool:
        """Whether nothing waits in the queues to the subscriptions."""
        implementation = getattr(self._publisher, "impl", None)
        connections = list(getattr(implementation, "connections", None) or ())
        return not any(connection.busy for connection in connections)

    def _register(self) -> None:
        latch = self._qos.durability == "transient_local"
        publisher = rospy.Publisher(self.topic, self._class, latch=latch, queue_size=self._qos.depth)
        with self._lock:
            for message in self._early:
                try:
                    publisher.publish(message)
                except rospy.ROSException as problem:  # a field that does not fit shows only now
                    post(
                        self._node.loop,
                        self._node.log,
                        f"topic {self.topic}: a message was dropped: {problem}",
                    )
            self._early.clear()
            self._publisher = publisher

    def _unregister(self) -> None:
        self._node.unsent.pop(self._sent, None)
        if self._publisher is not None:
            wait_until_sent([self._sent])
            self._publisher.unregister()


class TopicFeed:
    """The process's one rospy subscriber of a topic, shared by our subscriptions.

    rospy itself shows a latched message only to the first subscriber in a process.
    """

    def __init__(self, node: Ros1Node, topic: str, type_name: str) -> None:
        self.type_name = type_name
        self._node = node
        self._topic = topic
        self._class: Any = node.factory.message_class(type_name)
        self._subscriptions: tuple[Ros1Subscription, ...] = ()
        self._lock = threading.Lock()
        self._latched: dict[str, Any] = {}
        self._subscriber: Any = None
        node.takers[topic] = self._take
        node.link.do(self._register)

    @property
    def publisher_count(self) -> int:
        """How many publishers are connected now."""
        subscriber = self._subscriber
        return 0 if subscriber is None else int(subscriber.get_num_connections())

    def add(self, subscription: "Ros1Subscription") -> None:
        """Let *subscription* have the messages, the latched ones first."""
        with self._lock:
            self._subscriptions = (*self._subscriptions, subscription)
            if self._latched:
                connected = self._connected()
                # What a publisher that has gone said last is said by nobody any more.
                self._latched = {name: each for name, each in self._latched.items() if name in connected}
            for message in self._latched.values():
                subscription.queue.put(message)

    def _connected(self) -> set[str]:
        """The nodes whose messages come."""
        connections = getattr(getattr(self._subscriber, "impl", None), "connections", None) or ()
        return {connection.callerid_pub for connection in list(connections)}

    def remove(self, subscription: "Ros1Subscription") -> bool:
        """Forget *subscription*; True when it was the last."""
        with self._lock:
            self._subscriptions = tuple(other for other in self._subscriptions if other is not subscription)
            return not self._subscriptions

    def see_type(self, type_name: str) -> None:
        """Be told which type the topic has at the master."""
        if type_name in ("*", self._class._type):
            return
        package, _, name = type_name.partition("/")
        text = (
            f"topic {self._topic} carries {package}/msg/{name}, but {self.type_name} was asked for: "
            f"nothing will be received; write {package}/msg/{name}"
        )
        self.tell(text)

    def tell(self, text: str) -> None:
        """Tell all subscriptions that messages of others are not ours."""
        for subscription in self._subscriptions:
            subscription.tell(text)

    def close(self) -> None:
        """Leave the topic."""
        if self._node.takers.get(self._topic) == self._take:
            del self._node.takers[self._topic]
        self._node.link.do(self._unregister)

    def _register(self) -> None:
        self._subscriber = rospy.Subscriber(self._topic, self._class, self._receive, tcp_nodelay=True)

    def _unregister(self) -> None:
        if self._subscriber is not None:
            self._subscriber.unregister()

    def _receive(self, message: Any) -> None:
        header = message._connection_header or {}
        with self._lock:
            if header.get("latching") == "1":
                self._latched[header.get("callerid", "")] = message
            for subscription in self._subscriptions:
                subscription.queue.put(message)

    def _take(self, messages: Sequence[Any], header: Mapping[str, str]) -> None:
        """Take messages that came together, on the loop."""
        if header.get("latching") == "1":
            with self._lock:
                self._latched[header.get("callerid", "")] = messages[-1]
        for subscription in self._subscriptions:
            subscription.queue.put_here(*messages)
        self._node.delivered()


class Feeds:
    """The feeds of a node by topic.

    Args:
        node: whose they are.
    """

    def __init__(self, node: Ros1Node) -> None:
        self._node = node
        self._feeds: dict[str, TopicFeed] = {}
        self._types: Mapping[str, str] = {}

    def get(self, topic: str, type_name: str) -> TopicFeed:
        """Give the process's subscriber of *topic*, made at its first use, then of the type asked for first."""
        if topic not in self._feeds:
            self._feeds[topic] = TopicFeed(self._node, topic, type_name)
        return self._feeds[topic]

    def drop(self, topic: str) -> None:
        """Leave *topic*: nobody here listens to it any more."""
        self._feeds.pop(topic).close()

    def see_types(self, types: Mapping[str, str] | None = None) -> None:
        """Compare the types of all topics, as the master has them, with what was asked for."""
        if types is not None:
            self._types = types
        for topic, feed in self._feeds.items():
            if topic in self._types:
                feed.see_type(self._types[topic])

    def see_definition(self, topic: str, kind: str, theirs: str, ours: str) -> None:
        """Be told that a publisher's definition of a type (as on ROS 1) has another md5 sum than ours."""
        if topic in self._feeds:
            package, _, name = kind.partition("/")
            self._feeds[topic].tell(
                f"topic {topic}: a publisher has another definition of {package}/msg/{name} (md5 sum {theirs}, here "
                f"{ours}): nothing will be received from it; install its version of {package} here"
            )


class Ros1Subscription:
    """Subscription of `Ros1Backend`."""

    def __init__(
        self,
        node: Ros1Node,
        feeds: Feeds,
        topic: str,
        type_name: str,
        callback: Callable[[Sample], None],
        qos: QoS,
        on_event: Callable[[TopicEvent], None] | None,
    ) -> None:
        self.topic = topic
        self._node = node
        self._feeds = feeds
        self._on_event = on_event
        self._told: set[str] = set()
        self.queue: Handoff[Any] = Handoff(
            node.loop, qos.depth, lambda message: callback(node.sample(message, topic))
        )
        self._closed = False
        self._feed = feeds.get(topic, type_name)
        self._fed = self._feed.type_name == type_name
        if self._fed:
            self._feed.add(self)
        else:
            self.tell(
                f"topic {topic} is received as {self._feed.type_name} in this process already, not as "
                f"{type_name}: nothing will be received; write {self._feed.type_name}"
            )
        node.members[self] = None

    @property
    def publisher_count(self) -> int:
        """How many publishers are connected now."""
        return self._feed.publisher_count if self._fed else 0

    def tell(self, text: str) -> None:
        """Say once that the topic has another type."""
        if text in self._told or self._closed:
            return
        self._told.add(text)
        if self._on_event is None:
            self._node.log(text)
        else:
            event = TopicEvent(TopicTrouble.OTHER_TYPE, text)
            self._node.loop.call_soon(self._on_event, event)

    def close(self) -> None:
        """Leave the topic."""
        self.queue.close()
        if self._closed:
            return
        self._closed = True
        self._node.members.pop(self, None)
        if self._fed and self._feed.remove(self):
            self._feeds.drop(self.topic)
