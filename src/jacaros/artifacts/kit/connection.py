"""Publishers and subscribers at the other end: the property ``connected(Topic)``, a warning about topics without a
publisher, and the wait for the first subscriber. Messages sent before that are lost without an error."""

import asyncio
import math
from collections import deque
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from weakref import WeakKeyDictionary, WeakSet

from jacaros.artifacts.kit.options import Reader, one_of, positive
from jacaros.files.texts import did_you_mean
from jacaros.ros.backend import Backend, GraphContents, TopicInfo, latching
from jacaros.ros.errors import RosError, ServiceUnavailable
from jacaros.ros.names import message_type
from jacaros.ros.node import Publisher, Sample, Subscription
from jacaros.ros.waiting import MISSING_AFTER
from jacaros.runtime.clock import Clock

LOOK = 0.5
"""Seconds between two checks of who publishes a topic."""


class Connection:
    """Track whether a publisher of a topic is connected.

    `Backend.connected` is not used: topics of ROS 1 survive the master, and elsewhere a lost graph has no connected
    publishers.

    Args:
        backend: the subscribing node.
        clock: measures the times.
        subscription: subscription of the topic.
        changed: called with the state whenever it changes; the initial state is not connected.
        expire: the topic also counts as lost after this number of seconds without a message; None: never.
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
        """Note that a message arrived."""
        self._heard = self._clock.elapsed
        if not self.connected:
            self.look()

    def look(self) -> None:
        """Check the present state."""
        if not self._closed:
            connected = self._is_connected()
            if connected != self.connected:
                self.connected = connected
                self._changed(connected)

    def close(self) -> None:
        """Stop checking."""
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
    """Check a connection immediately when the graph is found or lost. A backend cannot remove such a callback."""
    connections = _watched.get(backend)
    if connections is None:
        connections = _watched[backend] = WeakSet()

        def report(connected: bool, everybody: WeakSet[Connection] = connections) -> None:
            for each in list(everybody):
                each.look()

        backend.on_connection(report)
    connections.add(connection)


class MissingTopic:
    """Log a warning if no message of a topic has arrived after `MISSING_AFTER` seconds, and the graph shows why.

    It has no publisher, or one whose latched message was missed, or a rosbridge server that may not convert its type.
    Nothing is logged while the graph cannot be reached; the backend reports that.

    Args:
        backend: the subscribing node.
        clock: measures the seconds.
        subscription: subscription of the topic.
        type_name: message type.
        log: called with one line.
        heard: returns whether a message has arrived.
    """

    def __init__(
        self,
        backend: Backend,
        clock: Clock,
        subscription: Subscription,
        type_name: str,
        log: Callable[[str], None],
        heard: Callable[[], bool],
    ) -> None:
        self._backend, self._clock = backend, clock
        self._subscription, self._type_name = subscription, type_name
        self._log, self._heard = log, heard
        self._connected = backend.connected
        self._search: asyncio.Task[None] | None = None
        self._wait()

    def _wait(self) -> None:
        self._timer = self._clock.call_later(MISSING_AFTER, self._look)

    def _look(self) -> None:
        connected_before, self._connected = self._connected, self._backend.connected
        if not (connected_before and self._connected):
            self._wait()  # discovery is incomplete just after the graph was found
        elif not self._heard():
            self._search = asyncio.ensure_future(self._report())

    async def _report(self) -> None:
        contents = GraphContents()
        with suppress(RosError):
            try:
                contents = await self._backend.contents()
            except ServiceUnavailable as unknown:  # without rosapi, a publisher cannot be looked for
                topic = f"topic {self._subscription.topic} ({self._type_name})"
                self._log(f"no message on {topic}; the graph cannot be queried: {unknown}")
                return
        info = contents.topics.get(self._subscription.topic)
        # The count may be unknown where another process is asked for it; the contents are what it just said.
        if self._subscription.publisher_count == 0 and not (info and info.publishers):
            self._report_missing(contents)
        else:
            self._report_silent(info)

    def _report_silent(self, info: TopicInfo | None) -> None:
        topic = self._subscription.topic
        nodes = "" if self._subscription.latched else latching(info)
        if nodes:
            self._log(
                f"no message on topic {topic}: {nodes} latches its messages, and earlier ones were not requested\n"
                "  help: write `qos: latched` (in Python: qos=LATCHED)"
            )
        elif info is not None and self._backend.name == "rosbridge":
            self._log(
                f"no message on topic {topic} ({self._type_name}) yet, although it has a publisher\n"
                "  help: a rosbridge server sends nothing if it cannot convert the type; its log says so"
            )

    def _report_missing(self, contents: GraphContents) -> None:
        topic = self._subscription.topic
        near = contents.near_topics(topic, message_type(self._type_name), "publishers")
        self._log(
            f"no publisher on topic {topic} ({self._type_name}); still listening"
            + (
                f"\n  help: {did_you_mean(near)} `--namespace NAME` and `--remap OLD:=NEW` change the names of a run"
                if near
                else "; is the node that publishes it running?"
            )
        )

    def close(self) -> None:
        """Stop logging."""
        self._timer.cancel()
        if self._search is not None:
            self._search.cancel()


MATCH_TIMEOUT = 3.0
"""Default number of seconds that an operation waits for a subscriber. First discovery on ROS 2 can take two."""

GUARD_TIMEOUT = 10.0
"""Seconds that an operation waits until a guard can stop it. Under load, discovery has taken three."""

MATCH_OPTIONS: Mapping[str, Reader] = {"match_timeout": positive, "unmatched": one_of("warn", "fail")}
"""Options of artifacts whose operations publish."""

MATCH_LOOK = 0.05
"""Seconds between two checks of the number of subscribers."""

TURN = 0.005
"""Seconds between two checks of the queue of waiting messages."""

SETTLING = 0.2
"""Seconds between the first match and the first message: the other end may still be matching, and so may a bridge's
own publisher and further subscribers."""


Missed = Callable[[str, float, bool], None]
"""Called with the topic, the seconds, and whether the previous wait also timed out."""


class Matching:
    """Delay the operations that publish on a topic so that the first message arrives.

    Args:
        publisher: sends the messages.
        timeout: seconds to wait; 0.0 in a graph where subscribers are matched immediately.
        missed: called when no subscriber was matched in time; an exception ends the operation.
        covered: returns whether the guards have found that number of subscribers, too.
    """

    def __init__(
        self,
        publisher: Publisher,
        timeout: float,
        missed: Missed,
        covered: Callable[[int], bool] = lambda count: True,
    ) -> None:
        self._publisher = publisher
        self._timeout = timeout
        self._missed = missed
        self._covered = covered
        self._vain = False
        self._line: deque[object] = deque()
        """Waiting messages, in order: a later one must not overtake them when a subscriber is matched."""

    def exists(self) -> bool:
        """Return whether a message may be sent now: a subscriber is matched, and no earlier message is waiting."""
        return not self._line and self._matched()

    def _matched(self) -> bool:
        count = self._publisher.subscription_count
        if count and self._covered(count):
            self._vain = False
            return True
        return False

    @property
    def _limit(self) -> float:
        """The maximum wait in seconds: for a subscriber, or for a guard that has not found the subscriber yet."""
        return max(self._timeout, GUARD_TIMEOUT) if self._publisher.subscription_count else self._timeout

    def pauses(self, always: bool = False) -> Iterator[float]:
        """Yield the seconds of each pause until messages arrive or the time is over.

        There are no pauses while a subscriber is matched. After a wait that timed out it also yields nothing until one
        is matched, so that a topic without subscribers delays only the first operation. Send the message as soon as
        the iterator ends: the next message in the queue may then be sent.

        Args:
            always: wait again after a wait that timed out: for open-loop motions, which go wrong when a command is
                lost.
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
            while self._line[0] is not claim:  # suspended messages ahead lose their place
                self._line.popleft()
            yield from self._first_pauses(always)
        finally:
            if claim in self._line:
                self._line.remove(claim)

    def _first_pauses(self, always: bool) -> Iterator[float]:
        """Yield the pauses of the first message in the queue."""
        if self._matched():  # the messages ahead have waited
            return
        looks = 0
        if not self._vain or (always and not self._publisher.subscription_count):
            while looks < math.ceil(self._limit / MATCH_LOOK):
                looks += 1
                yield MATCH_LOOK
                if self._matched():
                    yield SETTLING
                    return
        again, self._vain = self._vain, True
        self._missed(self._publisher.topic, self._limit, again)
