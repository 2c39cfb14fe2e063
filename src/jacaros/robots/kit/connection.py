"""Publishers and subscribers at the other end: the property ``connected(Topic)``, a warning about topics without a
publisher, and the wait for the first subscriber. Messages sent before that are lost without an error."""

import asyncio
import math
from collections import deque
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass

from jacaros.robots.kit.options import ReadOption, one_of, positive
from jacaros.robots.ros.backend import Backend, GraphContents, TopicInfo, latching
from jacaros.robots.ros.errors import RosError, ServiceUnavailable
from jacaros.robots.ros.guarded import guarded_by, guards_of
from jacaros.robots.ros.names import message_type
from jacaros.robots.ros.node import Publisher, Subscription
from jacaros.robots.ros.waiting import MISSING_AFTER
from jacaros.runtime.clock import Clock
from jacaros.runtime.files.texts import did_you_mean

LOOK = 0.5
"""Seconds between two checks of who publishes a topic."""


@dataclass(eq=False)
class PublisherConnection:
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

    backend: Backend
    clock: Clock
    subscription: Subscription
    changed: Callable[[bool], None]
    expire: float | None = None

    def __post_init__(self) -> None:
        self.connected = False
        self._heard: float | None = None
        self._end = self.backend.on_connection(lambda _: self.look())
        self._look_again()

    def hear(self) -> None:
        """Note that a message arrived."""
        self._heard = self.clock.elapsed
        if not self.connected:
            self.look()

    def look(self) -> None:
        """Check the present state."""
        connected = self._is_connected()
        if connected != self.connected:
            self.connected = connected
            self.changed(connected)

    def close(self) -> None:
        """Stop checking."""
        self._end()
        self._timer.cancel()

    def _is_connected(self) -> bool:
        if self.subscription.publisher_count == 0:
            self._heard = None
            return False
        if self.expire is None:
            return True
        return self._heard is not None and self.clock.elapsed - self._heard < self.expire

    def _look_again(self) -> None:
        self.look()
        pause = LOOK if self.expire is None else min(LOOK, self.expire)
        self._timer = self.clock.call_later(pause, self._look_again)


@dataclass(eq=False)
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

    backend: Backend
    clock: Clock
    subscription: Subscription
    type_name: str
    log: Callable[[str], None]
    heard: Callable[[], bool]

    def __post_init__(self) -> None:
        self._connected = self.backend.connected
        self._search: asyncio.Task[None] | None = None
        self._wait()

    def _wait(self) -> None:
        self._timer = self.clock.call_later(MISSING_AFTER, self._look)

    def _look(self) -> None:
        connected_before, self._connected = self._connected, self.backend.connected
        if not (connected_before and self._connected):
            self._wait()  # discovery is incomplete just after the graph was found
        elif not self.heard():
            self._search = asyncio.ensure_future(self._report())

    async def _report(self) -> None:
        contents = GraphContents()
        with suppress(RosError):
            try:
                contents = await self.backend.contents()
            except ServiceUnavailable as unknown:  # without rosapi, a publisher cannot be looked for
                topic = f"topic {self.subscription.topic} ({self.type_name})"
                self.log(f"no message on {topic}; the graph cannot be queried: {unknown}")
                return
        info = contents.topics.get(self.subscription.topic)
        # The count may be unknown where another process is asked for it; the contents are what it just said.
        if self.subscription.publisher_count == 0 and not (info and info.publishers):
            self._report_missing(contents)
        else:
            self._report_silent(info)

    def _report_silent(self, info: TopicInfo | None) -> None:
        topic = self.subscription.topic
        nodes = "" if self.subscription.latched else latching(info)
        if nodes:
            self.log(
                f"no message on topic {topic}: {nodes} latches its messages, and earlier ones were not requested\n"
                "  help: write `qos: latched` (in Python: qos=LATCHED)"
            )
        elif info is not None and self.backend.name == "rosbridge":
            self.log(
                f"no message on topic {topic} ({self.type_name}) yet, although it has a publisher\n"
                "  help: a rosbridge server sends nothing if it cannot convert the type; its log says so"
            )

    def _report_missing(self, contents: GraphContents) -> None:
        topic = self.subscription.topic
        near = contents.near_topics(topic, message_type(self.type_name), "publishers")
        self.log(
            f"no publisher on topic {topic} ({self.type_name}); still listening"
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

MATCH_OPTIONS: Mapping[str, ReadOption] = {"match_timeout": positive, "unmatched": one_of("warn", "fail")}
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


@dataclass(eq=False)
class Matching:
    """Delay the operations that publish on a topic so that the first message arrives.

    Args:
        publisher: sends the messages.
        timeout: seconds to wait; 0.0 in a graph where subscribers are matched immediately.
        missed: called when no subscriber was matched in time; an exception ends the operation.
        covered: returns whether the guards have found that number of subscribers, too.
    """

    publisher: Publisher
    timeout: float
    missed: Missed
    covered: Callable[[int], bool] = lambda count: True

    def __post_init__(self) -> None:
        self._vain = False
        self._line: deque[object] = deque()
        """Waiting messages, in order: a later one must not overtake them when a subscriber is matched."""

    def exists(self) -> bool:
        """Return whether a message may be sent now: a subscriber is matched, and no earlier message is waiting."""
        return not self._line and self._matched()

    def _matched(self) -> bool:
        count = self.publisher.subscription_count
        if count and self.covered(count):
            self._vain = False
            return True
        return False

    @property
    def _limit(self) -> float:
        """The maximum wait in seconds: for a subscriber, or for a guard that has not found the subscriber yet."""
        return max(self.timeout, GUARD_TIMEOUT) if self.publisher.subscription_count else self.timeout

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
            for _ in range(math.ceil(self.timeout / TURN)):
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
        if not self._vain or (always and not self.publisher.subscription_count):
            while looks < math.ceil(self._limit / MATCH_LOOK):
                looks += 1
                yield MATCH_LOOK
                if self._matched():
                    yield SETTLING
                    return
        again, self._vain = self._vain, True
        self.missed(self.publisher.topic, self._limit, again)


# Other nodes that command the same robot: a base follows whichever command came last, so motions end in wrong places.

EMBEDDED_WORLD = frozenset({"/world"})
"""The node of the embedded world, in this process or of `jacaros sim`: the robot itself, with its navigation."""

RIVALS_LOOK = 1.0
"""Seconds between two queries. Only a publisher that two of them find counts: discovery also finds those that are
leaving."""


@dataclass(eq=False)
class OtherPublishers:
    """Watch the publishers of a velocity topic that belong neither to the run nor to its guard.

    Args:
        backend: the node of the run.
        clock: measures the pauses.
        watched: absolute name of the topic.
        changed: called with a node and whether it publishes now.
        log: takes a warning about a node that no other artifact of the run has reported.
    """

    backend: Backend
    clock: Clock
    watched: str
    changed: Callable[[str, bool], None]
    log: Callable[[str], None]

    def __post_init__(self) -> None:
        self._own = guards_of(self.backend.node_name) | EMBEDDED_WORLD
        self._found: frozenset[str] = frozenset()
        self._shown: frozenset[str] = frozenset()
        self._query: asyncio.Task[None] | None = None
        self._timer = self.clock.call_later(RIVALS_LOOK, self._look)

    def close(self) -> None:
        """Stop watching."""
        self._timer.cancel()
        if self._query is not None:
            self._query.cancel()

    def _look(self) -> None:
        self._query = asyncio.ensure_future(self._ask())

    async def _ask(self) -> None:
        with suppress(RosError):  # the graph cannot be reached now, or not be queried at all
            found = frozenset(await self.backend.other_publishers(self.watched))
            before, self._found = self._found, found - self._own
            self._show(self._found & before)
        self._timer = self.clock.call_later(RIVALS_LOOK, self._look)

    def _show(self, nodes: frozenset[str]) -> None:
        before, self._shown = self._shown, nodes
        for node in sorted(before ^ nodes):
            self.changed(node, node in nodes)
            if node in nodes and guarded_by(self.backend).is_news((self.watched, node)):
                self.log(
                    f"warning: {node} also publishes on {self.watched}: the robot follows whichever command came last\n"
                    "  help: give every source a topic of its own, and let twist_mux choose between them"
                )
