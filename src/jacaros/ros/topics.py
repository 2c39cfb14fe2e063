"""One subscription of a topic at the middleware for many readers in the process."""

import threading
from collections.abc import Callable, Iterable
from typing import Any, Generic, TypeVar

from jacaros.ros.node import N, TopicSubscription, TopicTrouble, Wanted

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
