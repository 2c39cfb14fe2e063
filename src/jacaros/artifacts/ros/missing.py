"""A topic that nobody publishes is most often a mistake: tells people once, and goes on listening."""

from collections.abc import Callable

from jacaros.clock import Clock
from jacaros.ros.backend import Backend, Subscription
from jacaros.ros.waiting import MISSING_AFTER


class MissingTopic:
    """Tells in a log that a topic is missing when nobody publishes it after `MISSING_AFTER` seconds.

    While the graph cannot be reached nothing is told: that is a report of its own.

    Args:
        backend: the node that listens.
        clock: measures the seconds.
        subscription: to the topic.
        type_name: of its messages.
        log: takes one line.
    """

    def __init__(
        self,
        backend: Backend,
        clock: Clock,
        subscription: Subscription,
        type_name: str,
        log: Callable[[str], None],
    ) -> None:
        self._backend, self._clock = backend, clock
        self._subscription, self._type_name = subscription, type_name
        self._log = log
        self._connected = backend.connected
        self._wait()

    def _wait(self) -> None:
        self._timer = self._clock.call_later(MISSING_AFTER, self._look)

    def _look(self) -> None:
        connected_before, self._connected = self._connected, self._backend.connected
        if not (connected_before and self._connected):
            self._wait()  # a graph that has just been found has not told yet who is in it
        elif self._subscription.publisher_count == 0:
            self._log(
                f"the topic {self._subscription.topic} ({self._type_name}) is missing; still listening. "
                "Is the node that publishes it running?"
            )

    def close(self) -> None:
        """Tell nothing any more."""
        self._timer.cancel()
