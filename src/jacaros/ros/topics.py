"""Publishers and subscriptions independent of the middleware: checks, reports of problems, multiplexers for many
readers.

A driver derives from these classes and only defines how a message is sent and received.
"""

import threading
from collections import deque
from collections.abc import Callable, Iterable
from typing import Any, Generic, TypeVar

from jacaros.ros.backend import Sample, TopicEvent, TopicTrouble
from jacaros.ros.node import Node, Wanted
from jacaros.ros.qos import QoS
from jacaros.ros.serving import published_message
from jacaros.runtime.trace import CURRENT

N = TypeVar("N", bound=Node)


class _TopicEnd(Generic[N]):
    """The common part of publishers and subscriptions."""

    def __init__(self, node: N, topic: str, type_name: str, qos: QoS) -> None:
        self.topic = topic
        self.type_name = type_name
        self.qos = qos
        self._node = node
        self._closed = False
        self._reported: set[object] = set()

    @property
    def node_name(self) -> str:
        """Absolute name of the node."""
        return self._node.node_name

    @property
    def latched(self) -> bool:
        """Whether messages are stored for late subscriptions, or received from before this one."""
        return self.qos.durability != "volatile"

    def close(self) -> None:
        """Leave the topic."""
        if not self._closed:
            self._closed = True
            self._node.forget(self)
            self._leave()

    def _leave(self) -> None:
        """Leave the topic, once."""
        raise NotImplementedError


class TopicPublisher(_TopicEnd[N]):
    """A publisher; a driver defines `_send` and `_leave`.

    Args:
        node: its node.
        topic: absolute name.
        type_name: message type in full form.
        qos: offered quality of service.

    Attributes:
        watcher: see `jacaros.ros.backend.Publisher`.
    """

    watcher: Callable[[Any], None] | None = None

    def __init__(self, node: N, topic: str, type_name: str, qos: QoS) -> None:
        super().__init__(node, topic, type_name, qos)
        self._class = node.factory.message_class(type_name)

    @property
    def sent_topic(self) -> str:
        """Absolute name of the topic that this publishes on, see `Node.other_publishers`."""
        return self.topic

    def message(self, **fields: Any) -> Any:
        """Make a message of the topic's type."""
        return self._node.factory.make(self.type_name, fields)

    def publish(self, message: Any) -> None:
        """Send *message*, unless the node is shutting down and this is not an exit hook; see `Lifetime.send`."""
        if not isinstance(message, self._class):
            message = published_message(self._node.factory, self.topic, self.type_name, message)
        if not self._closed:
            if self.watcher is not None:
                self.watcher(message)
            self._node.lifetime.send(self._send, message)
            if self._node.tracer is not None:
                self._node.tracer.sent_message(self.topic, message, CURRENT.get())

    def report(self, text: str, key: object = None) -> None:
        """Log why messages are not received, once for each *key* (default: the text)."""
        if not self._closed and (key or text) not in self._reported:
            self._reported.add(key or text)
            self._node.log(text)

    def _send(self, message: Any) -> None:
        """Send a message of the topic's class; from any thread when the process ends."""
        raise NotImplementedError


class TopicSubscription(_TopicEnd[N]):
    """A subscription; a driver passes messages to `deliver`, or to `put` if each must wait for its turn.

    Args:
        node: its node.
        wanted: topic, type and callbacks.
    """

    def __init__(self, node: N, wanted: Wanted) -> None:
        super().__init__(node, wanted.topic, wanted.type_name, wanted.qos)
        self._callback = wanted.callback
        self._on_event = wanted.on_event
        self._waiting: deque[Any] = deque(maxlen=wanted.qos.depth)
        self._loop = node.loop

    @property
    def received_topic(self) -> str:
        """Absolute name of the topic whose messages arrive here, see `Node.receivers`."""
        return self.topic

    def put(self, message: Any) -> None:
        """Queue *message* for a turn of the loop, on the loop; the oldest is dropped if the queue is full."""
        if not self._loop.is_closed():
            self._waiting.append(message)
            self._loop.call_soon(self._deliver_next)

    def deliver(self, message: Any) -> None:
        """Deliver a message, on the loop."""
        node = self._node
        why = None if node.tracer is None else node.tracer.received_message(self.topic, message)
        self._callback(Sample(message, self.topic, node.clock.now(), why))

    def report(self, trouble: TopicTrouble, text: str, key: object = None) -> None:
        """Report a problem, on the loop.

        Args:
            trouble: its kind.
            text: one line of text.
            key: report it once for each key; None: each time.
        """
        if self._closed or key in self._reported:
            return
        if key is not None:
            self._reported.add(key)
        if self._on_event is None:
            self._node.log(text)
        else:
            # Later, because the subscriber does not have the subscription yet.
            self._loop.call_soon(self._tell_now, TopicEvent(trouble, text))

    def report_type_mismatch(self, who: str, theirs: str) -> None:
        """Report, once for each type, that messages of another type are published."""
        self.report(
            TopicTrouble.OTHER_TYPE,
            f"topic {self.topic}: {who} publishes {theirs}, not {self.type_name}; to receive it, write {theirs} here",
            theirs,
        )

    def report_qos(self, problem: str, whose: str = "", key: object = None) -> None:
        """Report that a publisher (*whose*: which one is not connected) offers less than is requested."""
        self.report(
            TopicTrouble.INCOMPATIBLE_QOS,
            f"topic {self.topic}: incompatible QoS: not connected{whose}: {problem}; "
            "request at most what the publisher offers",
            key,
        )

    def report_deadline(self, first: bool) -> None:
        """Report that a deadline passed without a message; only the *first* after a message is logged."""
        if first or self._on_event is not None:
            self.report(
                TopicTrouble.DEADLINE_MISSED,
                f"topic {self.topic}: no message within the deadline of {self.qos.deadline:g} s",
            )

    def close(self) -> None:
        """Leave the topic; the callback is no longer called."""
        self._waiting.clear()
        super().close()

    def _tell_now(self, event: TopicEvent) -> None:
        if self._on_event is not None and not self._closed:
            self._on_event(event)

    def _deliver_next(self) -> None:
        # Empty if a later message pushed this turn's message out, or the subscription was closed.
        if self._waiting:
            self.deliver(self._waiting.popleft())


R = TypeVar("R", bound=TopicSubscription[Any])
F = TypeVar("F", bound="TopicMultiplexer[Any]")


class TopicMultiplexer(Generic[R]):
    """The process's only subscription of a topic at the middleware, shared by ours; a driver defines `_leave`.

    Args:
        topic: absolute name.
        type_name: message type in full form: that of the first subscription.
    """

    def __init__(self, topic: str, type_name: str) -> None:
        self.topic = topic
        self.type_name = type_name
        self.known_as = type_name
        """The graph's name of the type: those of actionlib, for instance, have names of their own."""
        self.readers: tuple[R, ...] = ()
        self.lock = threading.Lock()
        """Held while readers or latched messages change."""

    @property
    def publisher_count(self) -> int:
        """Number of connected publishers."""
        raise NotImplementedError

    def add(self, reader: R) -> None:
        """Add *reader*, which receives the latched messages first."""
        with self.lock:
            self.readers = (*self.readers, reader)
            for message in self.latched(reader):
                reader.put(message)

    def remove(self, reader: R) -> bool:
        """Remove *reader*. Return True if it was the last one, and the topic was left."""
        with self.lock:
            self.readers = tuple(other for other in self.readers if other is not reader)
            last = not self.readers
        if last:
            self._leave()
        return last

    def join(self) -> None:
        """Subscribe at a server that does not know us yet."""

    def lost(self) -> None:
        """Note that the server is gone. Latched messages are delivered again on reconnect and may have changed."""

    def latched(self, reader: R) -> Iterable[Any]:
        """Return the latched messages for a late *reader*."""
        return ()

    def put(self, message: Any) -> None:
        """Pass a message to all readers."""
        for reader in self.readers:
            reader.put(message)

    def see_type(self, type_name: str | None) -> None:
        """Check the type of the topic in the graph, if it is known."""
        if type_name not in (None, self.known_as):
            self.report(
                f"topic {self.topic}: expected {self.type_name}, found {type_name}: nothing will be received; "
                f"write {type_name}"
            )

    def report(self, text: str) -> None:
        """Report to each reader, once, that the published type is not the requested one."""
        for reader in self.readers:
            reader.report(TopicTrouble.OTHER_TYPE, text, text)

    def _leave(self) -> None:
        """Leave the topic: it has no readers."""
        raise NotImplementedError


class SharedSubscription(TopicSubscription[N]):
    """A subscription that reads from a multiplexer, which is made with the first one of its topic and closed with the
    last.

    Args:
        multiplexers: those of the node, by topic.
        new_multiplexer: makes one for a node, a topic and a type.
        node, wanted: as for `TopicSubscription`.
    """

    def __init__(
        self, node: N, wanted: Wanted, multiplexers: dict[str, F], new_multiplexer: Callable[[N, str, str], F]
    ) -> None:
        super().__init__(node, wanted)
        topic, type_name = wanted.topic, wanted.type_name
        self._multiplexers = multiplexers
        if topic not in multiplexers:
            multiplexers[topic] = new_multiplexer(node, topic, type_name)
        self._multiplexer: TopicMultiplexer[Any] | None = multiplexers[topic]
        if self._multiplexer.type_name == type_name:
            self._multiplexer.add(self)
        else:
            self.report(
                TopicTrouble.OTHER_TYPE,
                f"topic {topic} is received as {self._multiplexer.type_name} in this process already, not as {type_name}: "
                f"nothing will be received; write {self._multiplexer.type_name}",
            )
            self._multiplexer = None

    @property
    def publisher_count(self) -> int:
        """Number of connected publishers."""
        return 0 if self._multiplexer is None or self._closed else self._multiplexer.publisher_count

    def _leave(self) -> None:
        if (
            self._multiplexer is not None
            and self._multiplexer.remove(self)
            and self._multiplexers.get(self.topic) is self._multiplexer
        ):
            del self._multiplexers[self.topic]
