"""Is somebody there?  The property ``connected(Topic)``, a word about topics that nobody publishes, and the wait for a
first subscription: what is sent before that is lost, and no error says so.
"""

import math
from collections import deque
from collections.abc import Callable, Iterator, Mapping
from weakref import WeakKeyDictionary, WeakSet

from jacaros.artifacts.kit.options import Reader, one_of, positive
from jacaros.clock import Clock
from jacaros.ros.backend import Backend, Publisher, Sample, Subscription
from jacaros.ros.waiting import MISSING_AFTER

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

        def report(connected: bool, everybody: WeakSet[Connection] = connections) -> None:
            for each in list(everybody):
                each.look()

        backend.on_connection(report)
    connections.add(connection)


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


MATCH_TIMEOUT = 3.0
"""Seconds that an operation waits for a subscription by default.  First discovery on ROS 2 can take two."""

MATCH_OPTIONS: Mapping[str, Reader] = {"match_timeout": positive, "unmatched": one_of("warn", "fail")}
"""Options of artifacts whose operations publish."""

MATCH_LOOK = 0.05
"""Seconds between two looks at the number of subscriptions."""

TURN = 0.005
"""Seconds between two looks at the messages that wait in front."""

SETTLING = 0.2
"""Seconds between the first match and the first message: the other end may have to match too, as may a bridge's own
publisher and further subscriptions."""


Missed = Callable[[str, float, bool], None]
"""Takes the topic, the seconds, and whether the wait before was in vain as well."""


class Matching:
    """Paces the operations that publish on one topic, so that the first message arrives.

    Args:
        publisher: sends the messages.
        timeout: seconds to wait; 0.0 in a graph where subscriptions are matched immediately.
        missed: called when no subscription was matched in time; an exception ends the operation.
    """

    def __init__(self, publisher: Publisher, timeout: float, missed: Missed) -> None:
        self._publisher = publisher
        self._timeout = timeout
        self._missed = missed
        self._vain = False
        self._line: deque[object] = deque()
        """The messages that wait, in order: a later one must not overtake them when a subscription is matched."""

    def exists(self) -> bool:
        """Whether a message may be sent now: a subscription is matched, and no earlier message waits."""
        return not self._line and self._matched()

    def _matched(self) -> bool:
        if self._publisher.subscription_count:
            self._vain = False
            return True
        return False

    def pauses(self, always: bool = False) -> Iterator[float]:
        """Give the seconds to pause, one pause after the other, until messages arrive or the time is over.

        There are none while a subscription is matched.  After a wait in vain there are none either until one has been
        matched, so that a topic without subscribers delays only the first operation.  The message must be sent as soon
        as there are no more pauses: the next one in line may go then.

        Args:
            always: wait again after a wait in vain: for open-loop motions, which go wrong when a command is lost.
        """
        if self.exists():
            return
        claim = object()
        self._line.append(claim)
        try:
            for _ in range(math.ceil(self._timeout / TURN)):
                if self._line[0] is claim:
                    break
                yield TURN
            while self._line[0] is not claim:  # those in front are suspended, and lose their place
                self._line.popleft()
            yield from self._first_pauses(always)
        finally:
            if claim in self._line:
                self._line.remove(claim)

    def _first_pauses(self, always: bool) -> Iterator[float]:
        """Give the pauses of the first message in line."""
        if self._matched():  # those in front have waited
            return
        if not self._vain or always:
            for _ in range(math.ceil(self._timeout / MATCH_LOOK)):
                yield MATCH_LOOK
                if self._matched():
                    yield SETTLING
                    return
        again, self._vain = self._vain, True
        self._missed(self._publisher.topic, self._timeout, again)
