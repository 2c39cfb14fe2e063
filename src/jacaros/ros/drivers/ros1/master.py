"""The link to the ROS master: a thread that finds it, keeps the node registered and makes blocking calls.

A rospy node registers once; a restarted master has forgotten all running nodes. So this thread compares the master's
knowledge of the node with what the node offers, four times a second, and registers again what is missing. Since rospy
blocks forever in registering while the master is away, all registering is done here, right after the master has
answered.
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

from jacaros.ros.errors import CallFailed, MessageMismatch, RosError, ServiceError, ServiceUnavailable
from jacaros.ros.services import server_gone

PUBLICATION, SUBSCRIPTION, SERVICE = range(3)

PERIOD = 0.25
"""Seconds between two checks of the master."""
PATIENCE = 2.0
"""Seconds after which a silent master counts as gone."""

UNHEARD = 20
"""Number of checks after which a known but unconnected publisher is connected again."""
SELDOM = 240
"""Maximum number of checks between two such attempts; at first it is tried more often."""

Offers = tuple[Iterable[tuple[str, str]], ...]
"""Publications, subscriptions and services of this node: names with types or addresses."""
Heard = tuple[str, Collection[str]]
"""Type of a topic and names of nodes."""
_AWAY = (OSError, http.client.HTTPException, xmlrpc.client.Error)


@dataclass(frozen=True)
class NodeActions:
    """The node's callbacks for the link; all are called on the link's thread.

    Attributes:
        join: registers the node for the first time.
        offers: returns what the node offers now.
        register: registers one name again; the number is its kind: `PUBLICATION`, `SUBSCRIPTION`, `SERVICE`.
        heard: returns the connected publishers of each topic that this node subscribes to.
        on_state: called with whether the master is there, at the first check and at every change.
        on_again: called with the names that were registered again, and whether these are all the node has: then the
            master was restarted.
        on_types: called with the types of published topics, in ROS 1's form, whenever publishers come or go.
        on_problem: called with failed work.
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
    """Blocking requests to the master.

    Args:
        uri: the master's address.
        caller: absolute name of the calling node.
    """

    def __init__(self, uri: str, caller: str) -> None:
        self.uri = uri
        self._caller = caller

    def ask(self, method: str, *arguments: Any) -> Any:
        """Call a method of the master's interface (ROS wiki, "Master API") and return its value.

        Raises:
            ServiceUnavailable: the master does not answer.
            CallFailed: it refused, with this text.
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

    def reaches(self, node: str) -> bool:
        """Return whether a node answers: the master lists nodes that were killed until `rosnode cleanup`."""
        try:
            Master(self.ask("lookupNode", node), self._caller).ask("getPid")
        except RosError:
            return False
        return True


class MasterLink:
    """Keeps one node registered with the master.

    Args:
        uri: the master's address.
        node_name: absolute name of the node.
        actions: callbacks of the node.
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
        """Topic and publisher → number of consecutive checks without a connection."""
        self.services: frozenset[str] = frozenset()
        self.publishers: Mapping[str, Collection[str]] = {}
        """Nodes that publish, by topic."""

    def start(self) -> None:
        """Start the thread."""
        threading.Thread(target=self._run, name="ROS master link", daemon=True).start()

    def stop(self) -> None:
        """End the thread after its present job."""
        self._stopping = True
        self._wake.set()

    def do(self, job: Callable[[], None]) -> None:
        """Run *job* on the link's thread while the master is there, in the order of the calls."""
        self._jobs.append(job)
        self._wake.set()

    def _run(self) -> None:
        while not self._stopping:
            self._wake.clear()
            try:
                self._look()
            except Exception as problem:  # the link must survive whatever rospy raises
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
            except Exception as problem:  # one failed registration must not block the others
                self._actions.on_problem(problem)

    def _known(self) -> list[Any] | None:
        """Return the master's state: three lists of [name, [nodes]]; None if it does not answer."""
        try:
            state: list[Any] = self._master.ask("getSystemState")
        except ServiceError:
            return None
        self.services = frozenset(name for name, _ in state[2])
        self.publishers = dict(state[0])
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
        """Connect to publishers that are known but not connected: rospy does not do so after a network failure."""
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
    """Times out, so that a master behind a dead network does not block the link for minutes."""

    def make_connection(self, host: Any) -> http.client.HTTPConnection:
        connection = super().make_connection(host)
        connection.timeout = PATIENCE
        return connection


def stay_local(uri: str) -> None:
    """Make rospy use only the loopback interface if the master is on this machine and no address is set."""
    host = urllib.parse.urlsplit(uri).hostname or ""
    if "ROS_IP" in os.environ or "ROS_HOSTNAME" in os.environ:
        return
    if host == "localhost" or host.startswith("127."):
        os.environ["ROS_IP"] = "127.0.0.1"


def call_failure(service: str, problem: BaseException | None) -> Exception | None:
    """Translate an exception of rospy's service call; most of its reasons are only in the text."""
    if problem is None:
        return None
    text = str(problem)
    missing = "unavailable" in text or "unable to contact master" in text
    if missing or ("unable to connect to service" in text and "md5sum" not in text):
        return ServiceUnavailable(f"no node offers service {service}")
    if "transport error" in text:
        return server_gone(service)
    if type(problem).__name__ == "ROSSerializationException":
        return MessageMismatch(f"service {service}: {text}")
    return CallFailed(f"service {service}: {text}")


_TEXT = re.compile(
    r"wants topic \[?(?P<topic>/[\w/]+)\]? to have datatype/md5sum \[(?P<ours>[\w/]+)/(?P<our_md5>\w+)\], "
    r"but our version has \[(?P<theirs>[\w/]+)/(?P<their_md5>\w+)\]"
)
"""The answer of publishers of rospy and roscpp to a subscriber that they refuse."""


class MismatchWatch(logging.Handler):
    """Reads rospy's own log for refusals by publishers.

    Args:
        report: called with topic, type in ROS 1's form, the publisher's md5 sum and ours; on a thread of rospy's.
    """

    def __init__(self, report: Callable[[str, str, str, str], None]) -> None:
        super().__init__(logging.ERROR)
        self._report = report

    def emit(self, record: logging.LogRecord) -> None:
        """Handle one line."""
        found = _TEXT.search(record.getMessage())
        # The master reports other types earlier; see `TopicMultiplexer.see_type`.
        if found is not None and found["ours"] == found["theirs"]:
            self._report(found["topic"], found["ours"], found["their_md5"], found["our_md5"])
