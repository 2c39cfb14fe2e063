"""The ROS 1 node of this process: joining the graph, staying in it, leaving it; and the link to the ROS master.

A rospy node registers once; a restarted master has forgotten all running nodes. So a thread compares the master's
knowledge of the node with what the node offers, four times a second, and registers again what is missing. Since rospy
blocks forever in registering while the master is away, all registering is done there, right after the master has
answered.
"""

import http.client
import logging
import os
import re
import threading
import time
import urllib.parse
import xmlrpc.client
from collections import deque
from collections.abc import Callable, Collection, Mapping
from functools import partial
from typing import Any

import rospy  # type: ignore[import-not-found]
import rospy.impl.registration as registration  # type: ignore[import-not-found]

from jacaros.robots.ros.backend import Backend
from jacaros.robots.ros.drivers.ros1.connections import MessageHandlers, log_to_standard_error, mend_rospy
from jacaros.robots.ros.drivers.ros1.types import GenpySchema
from jacaros.robots.ros.errors import CallFailed, MessageMismatch, RosError, ServiceError, ServiceUnavailable
from jacaros.robots.ros.handoff import post
from jacaros.robots.ros.lifetime import Lifetime
from jacaros.robots.ros.names import message_type
from jacaros.robots.ros.node import NodeSettings, TopicMultiplexer
from jacaros.robots.ros.services import server_gone

SENDING = 0.5
"""Seconds that closing waits for the last messages to be sent."""
PERIOD = 0.25
"""Seconds between two checks of the master."""
PATIENCE = 2.0
"""Seconds after which a silent master counts as gone."""

UNHEARD = 20
"""Number of checks after which a known but unconnected publisher is connected again."""
SELDOM = 240
"""Maximum number of checks between two such attempts; at first it is tried more often."""
_AWAY = (OSError, http.client.HTTPException, xmlrpc.client.Error)


class Ros1Node(Backend):
    """The base of topics, services, actions and parameters of ROS 1.

    Args:
        settings: names, clock and log; the default namespace is ``ROS_NAMESPACE``.
    """

    name = "ros1"
    ros_version = 1
    _started = False

    def __init__(self, settings: NodeSettings) -> None:
        self.schema = GenpySchema(settings.interface_paths)
        super().__init__(settings, self.schema, Lifetime(settings.log, self._leave, threaded=True))
        self.master_uri = os.environ.setdefault("ROS_MASTER_URI", "http://localhost:11311")
        self.link = MasterLink(self)
        self.handlers = MessageHandlers(self.log)
        self.multiplexers: dict[str, TopicMultiplexer[Any]] = {}
        self.types: Mapping[str, str] = {}
        """The types of all topics, from the master."""
        self.unsent: dict[Callable[[], bool], None] = {}
        """Functions of publishers that return whether messages remain to be sent."""
        self.on_return: dict[Callable[[], None], None] = {}
        """Called on the link's thread after the master had forgotten this node."""
        self.on_parameter: dict[Callable[[str, Any], None], None] = {}
        """Called on the loop with name and value of a changed parameter."""
        self._refused = ""

    async def start(self) -> None:
        """Join the graph, or log that the master is missing and keep trying in the background."""
        if Ros1Node._started:
            raise RosError("ROS 1 allows one node per process, and this process already had one")
        Ros1Node._started = True
        stay_local(self.master_uri)
        looked = self.join()
        self.handlers.loop = self.loop
        mend_rospy(self.handlers, partial(post, self.loop, self.parameter_changed))
        self.link.start()
        await looked

    async def close(self) -> None:
        """Run the exit hooks and leave the graph."""
        self.close_actions()
        await self.lifetime.leave()
        self.close_members()
        self.left()

    def types_changed(self, types: Mapping[str, str]) -> None:
        """Report to subscriptions that their topic has another type; on the loop, when publishers have come or gone."""
        self.types = {topic: message_type(kind) for topic, kind in types.items() if kind != "*"}
        for topic, multiplexer in self.multiplexers.items():
            multiplexer.see_type(self.types.get(topic))

    def definition_differs(self, topic: str, kind: str, theirs: str, ours: str) -> None:
        """Report to subscriptions that a publisher has another definition of the type: another md5 sum; on the loop."""
        if topic in self.multiplexers:
            package, _, name = kind.partition("/")
            self.multiplexers[topic].report(
                f"topic {topic}: a publisher has another definition of {package}/msg/{name} (md5 sum {theirs}, here "
                f"{ours}): nothing will be received from it; install its version of {package} here"
            )

    def join_rospy(self) -> None:
        """Register the node for the first time; on the thread of the link."""
        # init_node reads its namespace from here.
        rospy.names._set_caller_id(f"{self.names.namespace}/unnamed")
        rospy.init_node(self.names.node_name, argv=[], disable_signals=True)
        log_to_standard_error()
        logging.getLogger("rospy.internal").addHandler(MismatchWatch(self))
        rospy.on_shutdown(self._note_shutdown)

    def _leave(self) -> None:
        """Wait until the queues are empty, then end rospy, whose threads would keep the process alive."""
        wait_until_sent(list(self.unsent))
        self.link.stop()
        if self._loop is not None:
            # A signal may arrive while `start` waits for the link, which no longer answers.
            post(self._loop, self.looked)
        rospy.signal_shutdown("closed")

    def master_seen(self, present: bool) -> None:
        """Note that the master was found or is missing; on the loop."""
        if present:
            self.found()
        else:
            help = "start it with `roscore`, or set ROS_MASTER_URI to its address"
            self.missing(f"ROS master at {self.master_uri}", help)

    def note_again(self, names: list[str], all_of_them: bool) -> None:
        """Note which names were registered again: if they are all that the node has, the master was restarted."""
        text = f"the ROS master had forgotten {', '.join(sorted(names))}; registered again"
        if all_of_them:
            text += "; the parameters stored in it are lost"
        post(self.loop, self.log, text)
        for callback in list(self.on_return):
            callback()

    def parameter_changed(self, name: str, value: Any) -> None:
        """Pass on a changed parameter; on the loop."""
        for callback in list(self.on_parameter):
            try:
                callback(name, value)
            except Exception as problem:  # the other callbacks must still run
                self.log(f"a callback for changed parameters failed: {type(problem).__name__}: {problem}")

    def note_problem(self, problem: Exception) -> None:
        """Log failed work of the link."""
        text = f"rospy refused: {type(problem).__name__}: {problem}"
        if text != self._refused:  # failed work is repeated with each check of the master
            self._refused = text
            post(self.loop, self.log, text)

    def _note_shutdown(self) -> None:
        """On rospy's thread: our node was shut down, most likely by a newer node of the same name."""
        if not self.lifetime.leaving:
            post(self.loop, self.log, f"node {self.node_name} was shut down from outside; is its name taken?")
            post(self.loop, self.set_connected, False)
            self.link.stop()


def wait_until_sent(tests: Collection[Callable[[], bool]]) -> None:
    """Block until publishers have sent everything, according to their *tests*, or until `SENDING` is over."""
    deadline = time.monotonic() + SENDING
    while time.monotonic() < deadline and not all(sent() for sent in tests):
        time.sleep(0.005)
    time.sleep(0.02)  # a queue is emptied just before its messages are written


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


class MasterLink:
    """Keeps one node registered with the master.

    Args:
        node: the node; the thread of the link calls its methods, and posts what concerns its loop.
    """

    def __init__(self, node: "Ros1Node") -> None:
        self._node = node
        self._master = Master(node.master_uri, node.node_name)
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
                self._node.note_problem(problem)
            self._wake.wait(PERIOD)

    def _look(self) -> None:
        known = self._known()
        if known is None:
            self._set_state(False)
            return
        if not self._joined:
            self._node.join_rospy()
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
                self._node.note_problem(problem)

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
        post(self._node.loop, self._node.types_changed, types)

    def _register_missing(self, known: list[Any]) -> None:
        again, kept = [], 0
        topics, services = rospy.topics.get_topic_manager(), registration.get_service_manager()
        ours = (topics.get_publications(), topics.get_subscriptions(), services.get_services())
        for kind, offers, listed in zip(_KINDS, ours, known, strict=True):
            names = {name for name, nodes in listed if self._node.node_name in nodes}
            for name, detail in offers:
                if name in names:
                    kept += 1
                else:
                    _register(kind, name, detail)
                    again.append(name)
        if again:
            self._node.note_again(again, kept == 0)

    def _ask_for_unheard(self, publishers: Mapping[str, Collection[str]]) -> None:
        """Connect to publishers that are known but not connected: rospy does not do so after a network failure."""
        unheard: dict[tuple[str, str], int] = {}
        kinds: dict[str, str] = {}
        topics = rospy.topics.get_topic_manager()
        for topic, kind in topics.get_subscriptions():
            if (subscriber := topics.get_subscriber_impl(topic)) is None:
                continue
            connected = {each.callerid_pub for each in subscriber.connections}
            for node in publishers.get(topic, ()):
                if node not in connected:
                    looks = unheard[topic, node] = self._unheard.get((topic, node), 0) + 1
                    if looks in (UNHEARD, 2 * UNHEARD, 4 * UNHEARD) or looks % SELDOM == 0:
                        kinds[topic] = kind
        self._unheard = unheard
        for topic, kind in kinds.items():
            _register(registration.Registration.SUB, topic, kind)

    def _set_state(self, present: bool) -> None:
        if present != self._state:
            self._state = present
            post(self._node.loop, self._node.master_seen, present)


_KINDS = (registration.Registration.PUB, registration.Registration.SUB, registration.Registration.SRV)
"""Publications, subscriptions and services, in the order of the master's state."""


def _register(kind: Any, name: str, detail: str) -> None:
    """Register one name again; *detail* is the type of a topic or the address of a service."""
    registration.get_registration_listeners().notify_added(name, detail, kind)


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
    """Reads rospy's own log for refusals by publishers, on a thread of rospy's."""

    def __init__(self, node: "Ros1Node") -> None:
        super().__init__(logging.ERROR)
        self._node = node

    def emit(self, record: logging.LogRecord) -> None:
        """Handle one line."""
        found = _TEXT.search(record.getMessage())
        # The master reports other types earlier; see `TopicMultiplexer.see_type`.
        if found is not None and found["ours"] == found["theirs"]:
            post(
                self._node.loop,
                self._node.definition_differs,
                *found.group("topic", "ours", "their_md5", "our_md5"),
            )
