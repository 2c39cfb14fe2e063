"""The link to the ROS master: a thread that finds it, keeps the node registered and does what blocks.

A rospy node registers once; when the master is restarted, live nodes are forgotten by it for good.  So this
thread compares what the master knows about the node with what the node offers, four times a second, and
registers again what is missing.  And since rospy blocks for ever in registering while the master is away, all
registering is done here, right after the master was seen alive.
"""

import http.client
import logging
import os
import re
import threading
import urllib.parse
import xmlrpc.client
from collections import deque
from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from jacaros.ros.errors import CallFailed, MessageMismatch, ServiceError, ServiceUnavailable

PUBLICATION, SUBSCRIPTION, SERVICE = range(3)

PERIOD = 0.25
"""Seconds between two looks at the master."""
PATIENCE = 2.0
"""Seconds after which a master that does not answer is called away."""

UNHEARD = 20
"""Looks after which a publisher that the master knows, and that is not connected, is asked for again."""
SELDOM = 240
"""Looks between two such attempts at most; at first it is tried more often."""

Offers = tuple[Iterable[tuple[str, str]], ...]
"""Publications, subscriptions and services of this node: names with types or addresses."""
Heard = tuple[str, Collection[str]]
"""Type of a topic and names of nodes."""
_AWAY = (OSError, http.client.HTTPException, xmlrpc.client.Error)


@dataclass(frozen=True)
class NodeActions:
    """What the link does with the node; all are called on the link's thread.

    Attributes:
        join: registers the node for the first time.
        offers: tells what the node offers now.
        register: registers one name again; the number says which kind: `PUBLICATION`, `SUBSCRIPTION`, `SERVICE`.
        heard: tells the publishers that are connected to each topic that this node listens to.
        on_state: is told whether the master is there, at the first look and at every change.
        on_again: is told the names that were registered again, and whether these are all the node has: then the
            master was restarted.
        on_types: is told the types of the topics that somebody publishes, as on ROS 1, whenever publishers have
            come or gone.
        on_problem: is told of work that failed.
    """

    join: Callable[[], None]
    offers: Callable[[], Offers]
    register: Callable[[int, str, str], None]
    heard: Callable[[], Mapping[str, Heard]]
    on_state: Callable[[bool], None]
    on_again: Callable[[list[str], bool], None]
    on_types: Callable[[dict[str, str]], None]
    on_problem: Callable[[Exception], None]


class Master:
    """Questions to the master, each of which blocks.

    Args:
        uri: the master's address.
        caller: absolute name of the node that asks.
    """

    def __init__(self, uri: str, caller: str) -> None:
        self.uri = uri
        self._caller = caller

    def ask(self, method: str, *arguments: Any) -> Any:
        """Call a method of the master's interface (ROS wiki, "Master API") and give its value.

        Raises:
            ServiceUnavailable: the master is away.
            CallFailed: it refused; the text is its own.
        """
        try:
            with xmlrpc.client.ServerProxy(
                self.uri, transport=_ImpatientTransport(use_builtin_types=True), use_builtin_types=True
            ) as proxy:
                answer: Any = getattr(proxy, method)(self._caller, *arguments)
        except _AWAY as problem:
            raise ServiceUnavailable(f"the ROS master at {self.uri} does not answer ({problem})") from None
        code, text, value = answer
        if code != 1:
            raise CallFailed(str(text))
        return value


class MasterLink:
    """Keeps one node registered with the master.

    Args:
        uri: the master's address.
        node_name: absolute name of the node.
        actions: what to do with the node.
    """

    def __init__(self, uri: str, node_name: str, actions: NodeActions) -> None:
        self._master = Master(uri, node_name)
        self._node_name = node_name
        self._actions = actions
        self._jobs: deque[Callable[[], None]] = deque()
        self._wake = threading.Event()
        self._stopping = False
        self._joined = False
        self._state: bool | None = None
        self._published: Any = None
        self._unheard: dict[tuple[str, str], int] = {}
        """Topic and publisher → at how many looks in a row it was not connected."""
        self.services: frozenset[str] = frozenset()

    def start(self) -> None:
        """Start the thread."""
        threading.Thread(target=self._run, name="ROS master link", daemon=True).start()

    def stop(self) -> None:
        """End the thread after what it is doing."""
        self._stopping = True
        self._wake.set()

    def do(self, job: Callable[[], None]) -> None:
        """Have *job* done on the link's thread while the master is there, in the order of asking."""
        self._jobs.append(job)
        self._wake.set()

    def _run(self) -> None:
        while not self._stopping:
            self._wake.clear()
            try:
                self._look()
            except Exception as problem:  # the link must outlive whatever rospy raises
                self._actions.on_problem(problem)
            self._wake.wait(PERIOD)

    def _look(self) -> None:
        known = self._known()
        if known is None:
            self._set_state(False)
            return
        if not self._joined:
            self._actions.join()
            self._joined = True
        else:
            self._register_missing(known)
            self._ask_for_unheard(dict(known[0]))
        self._set_state(True)
        self._look_at_types(known)
        while self._jobs and not self._stopping:
            job = self._jobs.popleft()
            try:
                job()
            except Exception as problem:  # one wrong registration must not keep the others back
                self._actions.on_problem(problem)

    def _known(self) -> list[Any] | None:
        """Ask the master for all it knows: three lists of [name, [nodes]]; None when it is away."""
        try:
            state: list[Any] = self._master.ask("getSystemState")
        except ServiceError:
            return None
        self.services = frozenset(name for name, _ in state[2])
        return state

    def _look_at_types(self, known: list[Any]) -> None:
        if known[0] == self._published:
            return
        published = {name for name, _ in known[0]}
        types = {name: kind for name, kind in self._master.ask("getTopicTypes") if name in published}
        self._published = known[0]
        self._actions.on_types(types)

    def _register_missing(self, known: list[Any]) -> None:
        again, kept = [], 0
        for kind, offers in enumerate(self._actions.offers()):
            names = {name for name, nodes in known[kind] if self._node_name in nodes}
            for name, detail in offers:
                if name in names:
                    kept += 1
                else:
                    self._actions.register(kind, name, detail)
                    again.append(name)
        if again:
            self._actions.on_again(again, kept == 0)

    def _ask_for_unheard(self, publishers: Mapping[str, Collection[str]]) -> None:
        """Have publishers connected that are there and not heard: after a break of the network rospy does not do so."""
        unheard: dict[tuple[str, str], int] = {}
        kinds: dict[str, str] = {}
        for topic, (kind, connected) in self._actions.heard().items():
            for node in publishers.get(topic, ()):
                if node not in connected:
                    looks = unheard[topic, node] = self._unheard.get((topic, node), 0) + 1
                    if looks in (UNHEARD, 2 * UNHEARD, 4 * UNHEARD) or looks % SELDOM == 0:
                        kinds[topic] = kind
        self._unheard = unheard
        for topic, kind in kinds.items():
            self._actions.register(SUBSCRIPTION, topic, kind)

    def _set_state(self, present: bool) -> None:
        if present != self._state:
            self._state = present
            self._actions.on_state(present)


class _ImpatientTransport(xmlrpc.client.Transport):
    """A master behind a dead network must not hold the link for minutes."""

    def make_connection(self, host: Any) -> http.client.HTTPConnection:
        connection = super().make_connection(host)
        connection.timeout = PATIENCE
        return connection


def stay_local(uri: str) -> None:
    """Have rospy use the loopback interface alone when the master is here and nothing else is said."""
    host = urllib.parse.urlsplit(uri).hostname or ""
    if "ROS_IP" in os.environ or "ROS_HOSTNAME" in os.environ:
        return
    if host == "localhost" or host.startswith("127."):
        os.environ["ROS_IP"] = "127.0.0.1"


def call_failure(service: str, problem: BaseException | None) -> Exception | None:
    """Translate what rospy raised in calling *service*; it tells most of its reasons in words only."""
    if problem is None:
        return None
    text = str(problem)
    missing = "unavailable" in text or "unable to contact master" in text
    if missing or ("unable to connect to service" in text and "md5sum" not in text):
        return ServiceUnavailable(f"nobody offers service {service}")
    if type(problem).__name__ == "ROSSerializationException":
        return MessageMismatch(f"service {service}: {text}")
    return CallFailed(f"service {service}: {text}")


_TEXT = re.compile(
    r"wants topic \[?(?P<topic>/[\w/]+)\]? to have datatype/md5sum \[(?P<ours>[\w/]+)/(?P<our_md5>\w+)\], "
    r"but our version has \[(?P<theirs>[\w/]+)/(?P<their_md5>\w+)\]"
)
"""What publishers of rospy and roscpp answer to a subscriber that they refuse."""


class MismatchWatch(logging.Handler):
    """Reads rospy's own log for refusals by publishers.

    Args:
        report: takes topic, type as on ROS 1, the publisher's md5 sum and ours; called on a thread of rospy's.
    """

    def __init__(self, report: Callable[[str, str, str, str], None]) -> None:
        super().__init__(logging.ERROR)
        self._report = report

    def emit(self, record: logging.LogRecord) -> None:
        """Read one line."""
        found = _TEXT.search(record.getMessage())
        # Other types are told by the master, and earlier; see `TopicMultiplexer.see_type`.
        if found is not None and found["ours"] == found["theirs"]:
            self._report(found["topic"], found["ours"], found["their_md5"], found["our_md5"])
