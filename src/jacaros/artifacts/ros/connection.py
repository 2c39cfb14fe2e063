"""Whether a topic is connected: the observable property ``connected(Topic)``."""

from collections.abc import Callable
from weakref import WeakKeyDictionary, WeakSet

from jacaros.clock import Clock
from jacaros.ros.backend import Backend, Sample, Subscription

LOOK = 0.5
"""Seconds between two looks at who publishes a topic."""


class Connection:
    """Follows whether a publisher of a topic is connected.

    `Backend.connected` does not count: topics of ROS 1 outlive the master, and where they do not outlive the graph, no
    publisher is connected.

    Args:
        backend: the node that listens.
        clock: measures the times.
        subscription: to the topic.
        changed: told whether it is connected, whenever that changes; at first it is not.
        expire: it is also lost when no message came for so many seconds; None: never for that.
    """

    def __init__(
        self,
        backend: Backend,
        clock: Clock,
        subscription: Subscription,
        changed: Callable[[bool], None],
        expire: float | None = None,
    ) -> None:
        self.connected = False
        self._clock, self._subscription, self._changed, self._expire = clock, subscription, changed, expire
        self._heard: float | None = None
        self._closed = False
        _watch(backend, self)
        self._look_again()

    def hear(self, sample: Sample) -> None:
        """A message came."""
        self._heard = self._clock.elapsed
        if not self.connected:
            self.look()

    def look(self) -> None:
        """See how it is now."""
        if not self._closed:
            connected = self._is_connected()
            if connected != self.connected:
                self.connected = connected
                self._changed(connected)

    def close(self) -> None:
        """Look no more."""
        self._closed = True
        self._timer.cancel()

    def _is_connected(self) -> bool:
        if self._subscription.publisher_count == 0:
            self._heard = None
            return False
        if self._expire is None:
            return True
        return self._heard is not None and self._clock.elapsed - self._heard < self._expire

    def _look_again(self) -> None:
        self.look()
        pause = LOOK if self._expire is None else min(LOOK, self._expire)
        self._timer = self._clock.call_later(pause, self._look_again)


_watched: WeakKeyDictionary[Backend, WeakSet[Connection]] = WeakKeyDictionary()


def _watch(backend: Backend, connection: Connection) -> None:
    """Let a connection look at once when the graph is found or lost; a backend knows no way to stop that."""
    connections = _watched.get(backend)
    if connections is None:
        connections = _watched[backend] = WeakSet()

        def tell(connected: bool, everybody: WeakSet[Connection] = connections) -> None:
            for each in list(everybody):
                each.look()

        backend.on_connection(tell)
    connections.add(connection)
