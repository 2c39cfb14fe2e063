"""A robot behind a rosbridge server, for a machine without ROS: JSON over a WebSocket.

The server (``rosbridge_server`` of ROS 1 or ROS 2) is the node in the graph; we are one of its clients.  So the graph
knows us by the server's name, and what rosapi, the node beside it, does not tell cannot be known.  Which ROS it is, is
asked at each connection.  The message classes are those of the `memory` backend.

Everything happens on the loop; only exit hooks may send from another thread (see `Link`).
"""

import asyncio
import contextlib
import os
from collections.abc import Callable
from functools import partial
from typing import Any
from weakref import WeakValueDictionary

from jacaros.ros.action import ActionPolicy, Execute
from jacaros.ros.backend import (
    ACTIONS,
    DEFAULT_POLICY,
    DISCOVERY,
    PARAMETER_EVENTS,
    PARAMETERS,
    SERVICES,
    TOPICS,
    TRANSFORMS,
    Backend,
    Handler,
    Sample,
    TopicEvent,
)
from jacaros.ros.backends.rosbridge_goals import BridgeActionClient, BridgeActionServer
from jacaros.ros.backends.rosbridge_graph import look
from jacaros.ros.backends.rosbridge_greeting import PATIENCE, greet
from jacaros.ros.backends.rosbridge_link import Link, checked_url
from jacaros.ros.backends.rosbridge_members import Members
from jacaros.ros.backends.rosbridge_messages import Translator
from jacaros.ros.backends.rosbridge_parameter_services import read
from jacaros.ros.backends.rosbridge_parameters import BridgeParameters
from jacaros.ros.backends.rosbridge_requests import Requests
from jacaros.ros.backends.rosbridge_services import BridgeClient, BridgeService
from jacaros.ros.backends.rosbridge_topics import BridgePublisher, BridgeSubscription
from jacaros.ros.backends.rosbridge_types import BridgeSchema, written_on_ros1
from jacaros.ros.calling import settle
from jacaros.ros.errors import CallFailed, CallTimedOut, CapabilityMissing, ServiceUnavailable
from jacaros.ros.graph import GraphContents
from jacaros.ros.handoff import post
from jacaros.ros.lifetime import Lifetime
from jacaros.ros.names import action_type, message_type, service_type
from jacaros.ros.node import Node, NodeSettings
from jacaros.ros.parameter_news import ParameterNews
from jacaros.ros.qos import DEFAULT_QOS, QoS
from jacaros.ros.waiting import Waiting, within

DEFAULT_URL = "ws://127.0.0.1:9090"
FIRST_LOOK = 5.0
"""Seconds that starting waits for the first attempt to connect; a server that is not there refuses at once."""
SENDING = 0.5
"""Seconds that closing waits for the messages published last to leave."""
DOING = 1.0
"""Seconds that closing waits until the server has done what it was sent last."""
FETCHING = 3.0
"""Seconds that the loop may be held up by asking for a type that nobody here knows."""
CURE = (
    "On the robot, start `ros2 launch rosbridge_server rosbridge_websocket_launch.xml` (ROS 1: `roslaunch rosbridge_server "
    "rosbridge_websocket.launch`), and give its address with --bridge or ROSBRIDGE_URI."
)


class RosbridgeBackend(Node):
    """A client of a rosbridge server.

    Args:
        settings: names, clock and reports.
        url: address of the server; ``ROSBRIDGE_URI`` without it, and else port 9090 of this machine.
    """

    name = "rosbridge"

    def __init__(self, settings: NodeSettings, url: str | None = None) -> None:
        if settings.parameters:
            raise CapabilityMissing(
                f"parameter {next(iter(settings.parameters))} cannot be given: over rosbridge we are no node of the graph, "
                "and have no parameters"
            )
        self.url = checked_url(url or os.environ.get("ROSBRIDGE_URI") or DEFAULT_URL)
        self._link = Link(self.url, self._link_up, self._link_down, self._received, self._say)
        self.requests = Requests(self._link.send, self._link.ask)
        self._schema = BridgeSchema(settings.interface_paths, self._ask_for_type, self._cannot_ask)
        super().__init__(settings, self._schema, Lifetime(settings.log, self._leave, threaded=True))
        self.translator = Translator(self._schema)
        self.members = Members(self)
        self.goals: dict[str, Any] = {}
        self._news = ParameterNews(self.subscription, read)
        self.attached = False
        self.packs = False
        self._has_rosapi = False
        # Weakly: the members keep them, until they are closed.
        self._services: WeakValueDictionary[str, BridgeService] = WeakValueDictionary()
        self._action_servers: WeakValueDictionary[str, BridgeActionServer] = WeakValueDictionary()
        self._greeting: asyncio.Task[None] | None = None
        self._first_look: asyncio.Future[None] | None = None
        self._waiting: Waiting | None = None
        self._ended_at = ""
        """The type at which rosapi went away."""
        self._checks: set[asyncio.Task[None]] = set()
        self._lost_topics: set[str] = set()
        self._told: set[str] = set()

    @property
    def ros_version(self) -> int:  # type: ignore[override]
        """Of the robot; 2 until the first connection."""
        return self.translator.ros_version

    @property
    def capabilities(self) -> frozenset[str]:  # type: ignore[override]
        """What can be done with the robot's ROS."""
        # Failed handlers are told of by those services of ROS 1 alone that are not served over a bridge.
        news = {PARAMETER_EVENTS} if self.ros_version == 2 else set()
        return frozenset({TOPICS, SERVICES, TRANSFORMS, ACTIONS, DISCOVERY, PARAMETERS, *news})

    async def start(self) -> None:
        """Connect, or say that the server is awaited and go on trying in the background."""
        self._loop = asyncio.get_running_loop()
        self._first_look = self._loop.create_future()
        self.lifetime.join()
        self._link.start()
        await asyncio.wait([self._first_look], timeout=FIRST_LOOK)
        if not self._link.up and not self._first_look.done():
            self._await_server()
        else:
            await self._first_look

    async def close(self) -> None:
        """Run the exit hooks and disconnect."""
        await self.lifetime.leave()
        self._link.stop()
        if self._greeting is not None:
            self._greeting.cancel()
        for check in self._checks:
            check.cancel()
        self.attached = False
        self.members.close()
        self.requests.fail_all()
        if self._waiting is not None:
            self._waiting.__exit__(RuntimeError, None, None)
            self._waiting = None
        self.set_connected(False)

    def publisher(self, topic: str, type_name: str, qos: QoS = DEFAULT_QOS) -> BridgePublisher:
        """Make a publisher."""
        _refuse_deadline(qos)
        publisher = BridgePublisher(self, self.resolve(topic), message_type(type_name), qos)
        self.members.add(publisher)
        return publisher

    def subscription(
        self,
        topic: str,
        type_name: str,
        callback: Callable[[Sample], None],
        qos: QoS = DEFAULT_QOS,
        on_event: Callable[[TopicEvent], None] | None = None,
    ) -> BridgeSubscription:
        """Have *callback* called for every message."""
        _refuse_deadline(qos)
        full_type = message_type(type_name)
        self.factory.fields(full_type)
        made = BridgeSubscription(self, self.resolve(topic), full_type, callback, qos, on_event)
        self.members.add(made)
        return made

    def service(self, name: str, type_name: str, handler: Handler) -> BridgeService:
        """Offer a service."""
        full_type = service_type(type_name)
        self._schema.service(full_type)
        service = BridgeService(self, self.resolve(name), full_type, handler)
        self._services[service.name] = service
        self.members.add(service)
        return service

    def client(self, name: str, type_name: str) -> BridgeClient:
        """Make a client of a service."""
        full_type = service_type(type_name)
        self._schema.service(full_type)
        client = BridgeClient(self, self.resolve(name), full_type)
        self.members.add(client)
        return client

    def action_client(self, name: str, type_name: str) -> BridgeActionClient:
        """Make a client of an action."""
        full_type = action_type(type_name)
        self._schema.action(full_type)
        client = BridgeActionClient(self, self.resolve(name), full_type)
        self.members.add(client)
        return client

    def action_server(
        self, name: str, type_name: str, execute: Execute, policy: ActionPolicy = DEFAULT_POLICY
    ) -> BridgeActionServer:
        """Offer an action."""
        full_type = action_type(type_name)
        self._schema.action(full_type)
        server = BridgeActionServer(self, self.resolve(name), full_type, execute, policy)
        self._action_servers[server.name] = server
        self.members.add(server)
        return server

    def parameters(self, node: str | None = None) -> BridgeParameters:
        """Give the parameters of a node; our own can be used on ROS 1 alone, where the master keeps them."""
        return BridgeParameters(self, self.node_name if node is None else self.resolve(node), self._news)

    async def contents(self, timeout: float = 5.0) -> GraphContents:
        """Look at the graph."""
        return await look(self, timeout)

    def rosout(self, level: str, text: str) -> None:
        """Write a line to the graph's log; while there is no connection nobody would read it."""
        if self.connected:
            super().rosout(level, text)

    # For the parts of this backend:

    def send(self, operation: dict[str, Any], droppable: bool = False) -> bool:
        """Send an operation to the server that knows us, from any thread; False when it is lost."""
        return self.attached and self._link.send(operation, droppable)

    def written_type(self, type_name: str) -> str:
        """A type in full form as the server writes it."""
        return written_on_ros1(type_name) if self.ros_version == 1 else type_name

    def require_connection(self, service: str) -> None:
        """Raise `ServiceUnavailable` while there is no server."""
        if not self.connected:
            raise ServiceUnavailable(
                f"service {service}: there is no connection to the rosbridge server at {self.url}"
            )

    def note_loss(self, topic: str) -> None:
        """Say that messages are lost, once a topic and an interruption; from any thread."""
        if topic not in self._lost_topics:
            self._lost_topics.add(topic)
            self._say(
                f"messages for {topic} are lost: the rosbridge server at {self.url} is away or too slow"
            )

    async def rosapi(self, service: str, arguments: dict[str, Any], timeout: float | None = None) -> Any:
        """Call a service of rosapi and give the fields of its response.

        Raises:
            ServiceUnavailable: rosapi does not run.
            CallTimedOut, CallFailed: as `Client.call`.
        """
        self.require_connection(f"/rosapi/{service}")
        try:
            return await self._rosapi(service, arguments, timeout)
        except (ServiceUnavailable, CallTimedOut) as problem:
            raise type(problem)(f"{problem}{self._loss_of_rosapi()}") from None

    async def _rosapi(self, service: str, arguments: dict[str, Any], timeout: float | None) -> Any:
        answer: asyncio.Future[Any] = self.loop.create_future()
        number = self.requests.begin(f"/rosapi/{service}", arguments, partial(settle, answer), timeout)
        try:
            return await within(self.clock, answer, timeout)
        except TimeoutError:
            about = ", ".join(str(value) for value in arguments.values())
            raise CallTimedOut(f"rosapi did not answer {service}({about}) within {timeout:g} s") from None
        finally:
            self.requests.forget(number)

    # For the link:

    def _received(self, message: dict[str, Any]) -> None:
        operation = message["op"]
        if operation == "publish":
            feed = self.members.known_feed(str(message.get("topic")))
            if feed is not None:
                feed.put(message.get("msg"))
        else:  # in its turn, after the messages of topics that came before
            self.loop.call_soon(self._dispatch, operation, message)

    def _link_up(self) -> None:
        if self._greeting is not None:
            self._greeting.cancel()
        self._ended_at = ""
        self._lost_topics.clear()
        self._told.clear()
        self._greeting = self.loop.create_task(self._greet())

    async def _greet(self) -> None:
        """Find out whose graph it is, and tell the server all that we have."""
        found = await greet(self._rosapi, self.clock, lambda: self._link.up)
        if found is None:
            return
        if not found.told:
            self.log(
                f"the rosbridge server at {self.url} has no rosapi beside it, so nothing can be looked up; ROS 2 is "
                "assumed. Its launch file starts both"
            )
        self.translator.ros_version, self.packs = found.ros_version, found.packs
        self._has_rosapi = found.told
        self.attached = True
        self.members.join()
        if self._waiting is not None:
            self._waiting.__exit__(None, None, None)
            self._waiting = None
        self.set_connected(True)
        if self._first_look is not None and not self._first_look.done():
            self._first_look.set_result(None)

    def _link_down(self) -> None:
        self.attached = False
        if self._greeting is not None:
            self._greeting.cancel()
        self.requests.fail_all()
        self.members.lost()
        if not self.lifetime.leaving:
            self._await_server()
        self.set_connected(False)

    def _await_server(self) -> None:
        if self._waiting is None:
            what = f"rosbridge server at {self.url}"
            self._waiting = Waiting(self.clock, self.log, what, CURE).__enter__()
        if self._first_look is not None and not self._first_look.done():
            self._first_look.set_result(None)

    def _dispatch(self, operation: str, message: dict[str, Any]) -> None:
        try:
            self._do(operation, message)
        except (TypeError, ValueError, KeyError, AttributeError) as problem:
            self.log(
                f"the rosbridge server sent {operation} with something that cannot be understood: {problem}"
            )

    def _do(self, operation: str, message: dict[str, Any]) -> None:
        number = str(message.get("id"))
        if operation == "service_response":
            self.requests.answered(message)
        elif operation == "call_service":
            service = self._services.get(str(message.get("service")))
            if service is not None:
                service.called(message)
        elif operation == "status":
            self._note_status(message, number)
        elif operation in ("action_feedback", "action_result"):
            goals = self.goals.get(number)
            if goals is not None and operation == "action_feedback":
                goals.feedback(number, message.get("values"))
            elif goals is not None:
                goals.result(number, message)
        elif operation in ("send_action_goal", "cancel_action_goal"):
            server = self._action_servers.get(str(message.get("action")))
            if server is not None and operation == "send_action_goal":
                server.goal(message)
            elif server is not None:
                server.cancel(number)

    def _note_status(self, message: dict[str, Any], number: str) -> None:
        """The server has something to say, mostly that it did not do what was asked."""
        text = str(message.get("msg"))
        if message.get("level") not in ("error", "warning") or number.startswith("call_service:"):
            return  # a failed call is answered as well
        feed = self.members.feed_of(number)
        if feed is not None:
            feed.refused(f"topic {feed.topic}: the rosbridge server refuses it: {text}")
        elif number in self.goals and "nknown operation" in text:
            self.goals[number].refused(number, text)
        elif text not in self._told and not number.startswith("send_action_goal:"):
            self._told.add(text)
            self.log(f"the rosbridge server says: {text}")

    def _say(self, text: str) -> None:
        post(self.loop, self.log, text)

    def _ask_for_type(self, service: str, arguments: dict[str, Any]) -> dict[str, Any] | None:
        answer = None
        try:
            answer = self.requests.call_blocking(service, arguments, FETCHING)
        finally:
            if answer is None:
                post(self.loop, self._check_rosapi, str(arguments["type"]))
        return answer

    def _check_rosapi(self, asked: str) -> None:
        """Find out whether rosapi still runs: genuine ones end at some types that they are asked for."""
        check = self.loop.create_task(self._look_for_rosapi(asked))
        self._checks.add(check)
        check.add_done_callback(self._checks.discard)

    async def _look_for_rosapi(self, asked: str) -> None:
        try:
            await self._rosapi("topics", {}, PATIENCE)
            self._ended_at = ""
        except (ServiceUnavailable, CallTimedOut) as problem:
            if self._has_rosapi and not self._ended_at:
                self._ended_at = asked
                self.log(f"{problem}{self._loss_of_rosapi()}")
        except CallFailed:
            pass  # the link is lost, which is reported

    def _loss_of_rosapi(self) -> str:
        if not self._ended_at:
            return ""
        return (
            f": rosapi went away when it was asked for the type {self._ended_at}. Start rosapi again on the robot, and "
            "name a folder with the definition of this type (in a mapping file: interfaces)"
        )

    def _cannot_ask(self) -> str | None:
        if self.attached:
            return None
        return f"the rosbridge server at {self.url} would be asked, but there is no connection to it"

    def _leave(self) -> None:
        # A server forgets what it has received and not done yet when its client leaves; an answer says that all before it
        # is done.
        with contextlib.suppress(TimeoutError):
            self.requests.call_blocking("/rosapi/get_time", {}, DOING)
        self._link.finish(SENDING)


def _refuse_deadline(qos: QoS) -> None:
    if qos.deadline is not None:
        raise CapabilityMissing(
            "deadlines: the rosbridge backend cannot watch them; --ros ros2 and --ros memory can"
        )


BACKEND: type[Backend] = RosbridgeBackend
