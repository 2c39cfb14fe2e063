"""The ROS 1 node of this process: joining the graph, staying in it, leaving it."""

import logging
import os
import time
from collections.abc import Callable, Collection, Mapping
from typing import Any

import rospy  # type: ignore[import-not-found]
import rospy.impl.registration as registration  # type: ignore[import-not-found]

from jacaros.ros.backend import Backend
from jacaros.ros.drivers.ros1.connections import (
    MessageHandlers,
    connect_streams,
    deliver_before_ready,
    log_to_standard_error,
    print_to_standard_error,
    report_parameter_changes,
    silence_closed_nodes,
)
from jacaros.ros.drivers.ros1.master import Heard, MasterLink, MismatchWatch, NodeActions, Offers, stay_local
from jacaros.ros.drivers.ros1.types import GenpySchema
from jacaros.ros.errors import RosError
from jacaros.ros.handoff import post
from jacaros.ros.lifetime import Lifetime
from jacaros.ros.node import NodeSettings
from jacaros.ros.topics import TopicMultiplexer

SENDING = 0.5
"""Seconds that closing waits for the last messages to be sent."""


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
        actions = NodeActions(
            self._join,
            _offers,
            _register_again,
            _heard,
            self._note_state,
            self._note_again,
            self._note_types,
            self._note_problem,
        )
        self.link = MasterLink(self.master_uri, self.node_name, actions)
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
        print_to_standard_error()
        deliver_before_ready()
        silence_closed_nodes()
        report_parameter_changes(self._note_parameter)
        looked = self.join()
        self.handlers.loop = self.loop
        connect_streams(self.handlers)
        self.link.start()
        await looked

    async def close(self) -> None:
        """Run the exit hooks and leave the graph."""
        self.close_actions()
        await self.lifetime.leave()
        self.close_members()
        self.left()

    def types_changed(self, types: Mapping[str, str]) -> None:
        """Take the types of all topics, in ROS 1's form; on the loop, when publishers have come or gone."""

    def definition_differs(self, topic: str, kind: str, theirs: str, ours: str) -> None:
        """Note that a publisher of *topic* has another definition of its type; on the loop."""

    def _join(self) -> None:
        # init_node reads its namespace from here.
        rospy.names._set_caller_id(f"{self.names.namespace}/unnamed")
        rospy.init_node(self.names.node_name, argv=[], disable_signals=True)
        log_to_standard_error()
        logging.getLogger("rospy.internal").addHandler(MismatchWatch(self._note_mismatch))
        rospy.on_shutdown(self._note_shutdown)

    def _leave(self) -> None:
        """Wait until the queues are empty, then end rospy, whose threads would keep the process alive."""
        wait_until_sent(list(self.unsent))
        self.link.stop()
        if self._loop is not None:
            # A signal may arrive while `start` waits for the link, which no longer answers.
            post(self._loop, self.looked)
        rospy.signal_shutdown("closed")

    def _note_state(self, present: bool) -> None:
        post(self.loop, self._state_changed, present)

    def _state_changed(self, present: bool) -> None:
        if present:
            self.found()
        else:
            help = "start it with `roscore`, or set ROS_MASTER_URI to its address"
            self.missing(f"ROS master at {self.master_uri}", help)

    def _note_again(self, names: list[str], all_of_them: bool) -> None:
        text = f"the ROS master had forgotten {', '.join(sorted(names))}; registered again"
        if all_of_them:
            text += "; the parameters stored in it are lost"
        post(self.loop, self.log, text)
        for callback in list(self.on_return):
            callback()

    def _note_types(self, types: Mapping[str, str]) -> None:
        post(self.loop, self.types_changed, types)

    def _note_mismatch(self, topic: str, kind: str, theirs: str, ours: str) -> None:
        post(self.loop, self.definition_differs, topic, kind, theirs, ours)

    def _note_parameter(self, name: str, value: Any) -> None:
        post(self.loop, self.parameter_changed, name, value)

    def parameter_changed(self, name: str, value: Any) -> None:
        """Pass on a changed parameter; on the loop."""
        for callback in list(self.on_parameter):
            try:
                callback(name, value)
            except Exception as problem:  # the other callbacks must still run
                self.log(f"a callback for changed parameters failed: {type(problem).__name__}: {problem}")

    def _note_problem(self, problem: Exception) -> None:
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


def _offers() -> Offers:
    topics, services = rospy.topics.get_topic_manager(), registration.get_service_manager()
    return topics.get_publications(), topics.get_subscriptions(), services.get_services()


def _heard() -> dict[str, Heard]:
    """Return the connected publishers, by topic."""
    topics = rospy.topics.get_topic_manager()
    return {
        name: (kind, {each.callerid_pub for each in subscriber.connections})
        for name, kind in topics.get_subscriptions()
        if (subscriber := topics.get_subscriber_impl(name)) is not None
    }


def _register_again(kind: int, name: str, detail: str) -> None:
    kinds = (registration.Registration.PUB, registration.Registration.SUB, registration.Registration.SRV)
    registration.get_registration_listeners().notify_added(name, detail, kinds[kind])
