"""Topics of ROS 1: publishers, subscriptions, and the connections they share in a process."""

import threading
from collections import deque
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, cast

import rospy  # type: ignore[import-not-found]

from jacaros.robots.ros.drivers.ros1.node import Ros1Node, wait_until_sent
from jacaros.robots.ros.errors import MessageMismatch
from jacaros.robots.ros.handoff import Handoff, post
from jacaros.robots.ros.names import message_type
from jacaros.robots.ros.node import SharedSubscription, SubscriptionOptions, TopicMultiplexer, TopicPublisher
from jacaros.robots.ros.qos import QoS


class Ros1Publisher(TopicPublisher[Ros1Node]):
    """Publisher of `Ros1Backend`."""

    def __init__(self, node: Ros1Node, topic: str, type_name: str, qos: QoS) -> None:
        super().__init__(node, topic, type_name, qos)
        self._lock = threading.Lock()
        self._early: deque[Any] = deque(maxlen=qos.depth)
        self._publisher: Any = None
        node.unsent[self._sent] = None
        node.link.do(self._register)

    @property
    def subscription_count(self) -> int:
        """Number of connected subscriptions."""
        publisher = self._publisher
        return 0 if publisher is None else int(publisher.get_num_connections())

    def _send(self, message: Any) -> None:
        with self._lock:
            if self._publisher is None:
                self._early.append(message)
                return
        try:
            self._publisher.publish(message)
        except rospy.ROSSerializationException as problem:
            raise MessageMismatch(f"topic {self.topic}: {problem}", self.type_name) from None
        except rospy.ROSException:  # the node was shut down while this message was on its way
            self._closed = True

    def _leave(self) -> None:
        self._node.link.do(self._unregister)

    def _sent(self) -> bool:
        """Whether the queues to the subscriptions are empty."""
        implementation = getattr(self._publisher, "impl", None)
        connections = list(getattr(implementation, "connections", None) or ())
        return not any(connection.busy for connection in connections)

    def _register(self) -> None:
        publisher = rospy.Publisher(self.topic, self._class, latch=self.latched, queue_size=self.qos.depth)
        with self._lock:
            for message in self._early:
                try:
                    publisher.publish(message)
                except rospy.ROSException as problem:  # a mismatch is only detected here
                    post(
                        self._node.loop,
                        self._node.log,
                        f"topic {self.topic}: message dropped: {problem}",
                    )
            self._early.clear()
            self._publisher = publisher

    def _unregister(self) -> None:
        self._node.unsent.pop(self._sent, None)
        if self._publisher is not None:
            wait_until_sent([self._sent])
            self._publisher.unregister()


class Ros1Multiplexer(TopicMultiplexer["Ros1Subscription"]):
    """The process's only rospy subscriber of a topic.

    rospy itself delivers a latched message only to the first subscriber in a process.
    """

    def __init__(self, node: Ros1Node, topic: str, type_name: str) -> None:
        super().__init__(topic, type_name)
        self._node = node
        self._class = cast("Any", node.factory.message_class(type_name))
        self.known_as = message_type(self._class._type)
        self._latched: dict[str, Any] = {}
        self._subscriber: Any = None
        node.handlers[topic] = self._take
        node.link.do(self._register)

    @property
    def publisher_count(self) -> int:
        """Number of connected publishers."""
        subscriber = self._subscriber
        return 0 if subscriber is None else int(subscriber.get_num_connections())

    def latched(self, reader: Any) -> Iterable[Any]:
        """Return the last message of each connected publisher; those of disconnected publishers no longer count."""
        if self._latched:
            connections = getattr(getattr(self._subscriber, "impl", None), "connections", None) or ()
            connected = {connection.callerid_pub for connection in list(connections)}
            self._latched = {name: each for name, each in self._latched.items() if name in connected}
        return self._latched.values()

    def _leave(self) -> None:
        if self._node.handlers.get(self.topic) == self._take:
            del self._node.handlers[self.topic]
        self._node.link.do(self._unregister)

    def _register(self) -> None:
        self._subscriber = rospy.Subscriber(self.topic, self._class, self._receive, tcp_nodelay=True)

    def _unregister(self) -> None:
        if self._subscriber is not None:
            self._subscriber.unregister()

    def _receive(self, message: Any) -> None:
        header = message._connection_header or {}
        with self.lock:
            if header.get("latching") == "1":
                self._latched[header.get("callerid", "")] = message
            self.put(message)

    def _take(self, messages: Sequence[Any], header: Mapping[str, str]) -> None:
        """Handle messages that arrived together, on the loop."""
        if header.get("latching") == "1":
            with self.lock:
                self._latched[header.get("callerid", "")] = messages[-1]
        for subscription in self.readers:
            subscription.queue.put_here(*messages)
        self._node.delivered()


class Ros1Subscription(SharedSubscription[Ros1Node]):
    """Subscription of `Ros1Backend`."""

    def __init__(self, node: Ros1Node, wanted: SubscriptionOptions) -> None:
        self.queue: Handoff[Any] = Handoff(node.loop, wanted.qos.depth, self.deliver)
        super().__init__(node, wanted, node.multiplexers, Ros1Multiplexer)
        if self._multiplexer is not None:
            self._multiplexer.see_type(node.types.get(self.topic))

    @property
    def latched(self) -> bool:
        """Whether a publisher stores its last message; on ROS 1 every subscription receives it."""
        return self._multiplexer is not None and bool(tuple(self._multiplexer.latched(self)))

    def put(self, message: Any) -> None:
        """Queue a message, from any thread of rospy's."""
        self.queue.put(message)

    def _leave(self) -> None:
        self.queue.close()
        super()._leave()
