"""The shared state of the rosbridge backend: the connection, the version of ROS, and all entities at the server.

The server forgets its clients when the connection is lost, so everything is announced again after each connection.
"""

import asyncio
import contextlib
import itertools
from collections.abc import Callable, Coroutine
from dataclasses import dataclass
from functools import partial
from typing import Any, TypeVar

from jacaros.robots.ros.backend import Backend
from jacaros.robots.ros.drivers.rosbridge.link import RosbridgeLink
from jacaros.robots.ros.errors import CallTimedOut, ServiceError, ServiceUnavailable
from jacaros.robots.ros.handoff import post
from jacaros.robots.ros.lifetime import Lifetime
from jacaros.robots.ros.names import message_type
from jacaros.robots.ros.node import NodeSettings, TopicMultiplexer
from jacaros.robots.ros.protocols.rosbridge_messages import BridgeSchema, Translator, written_on_ros1
from jacaros.robots.ros.protocols.rosbridge_wire import PATIENCE, Polled, Requests
from jacaros.robots.ros.waiting import settle, within
from jacaros.runtime.clock import Timer

T = TypeVar("T")

FIRST_LOOK = 5.0
"""Seconds that starting waits for the first attempt to connect; a missing server refuses immediately."""
ATTEMPTS, PAUSE = 6, 0.5
"""Number of requests for the version of ROS, and seconds between them: rosapi may start after the server."""
SIGN_OF_2 = "/msg/"
"""Part of the names of types on ROS 2 only."""
CURE = (
    "on the robot, start `ros2 launch rosbridge_server rosbridge_websocket_launch.xml` (ROS 1: `roslaunch rosbridge_server "
    "rosbridge_websocket.launch`), and give its address with --bridge or ROSBRIDGE_URI"
)
FIRST_PAUSE, LONGEST_PAUSE = 1.0, 16.0
"""Seconds until the first check whether a topic was admitted, and the maximum between two; each pause doubles."""
MISSES = 3
"""Number of checks without the topic after which it counts as refused."""


OperationHandler = Callable[[dict[str, Any]], None]
"""Handles an operation of the server."""
_FIELDS = {
    "service_response": "id",
    "call_service": "service",
    "action_feedback": "id",
    "action_result": "id",
    "send_action_goal": "action",
    "cancel_action_goal": "action",
}
"""The field that names the addressee of each operation of the server, apart from ``publish``."""


class BridgeNode(Backend):
    """A client of a rosbridge server, as seen by its parts.

    Args:
        settings: names, clock and log.
        url: address of the server.

    Attributes:
        attached: whether there is a connection and the version of ROS is known.
        handlers: what handles operations of the server, by the operation and the value of its field in `_FIELDS`.
    """

    def __init__(self, settings: NodeSettings, url: str) -> None:
        self.url = url
        self._link = RosbridgeLink(self.url, self._link_up, self._link_down, self._received, self._say)
        self.requests = Requests(self._link.send)
        self.schema = BridgeSchema(settings.interface_paths)
        super().__init__(settings, self.schema, Lifetime(settings.log, self._leave, threaded=True))
        self.translator = Translator(self.schema)
        self.admission = Admission(self)
        self.multiplexers: dict[str, TopicMultiplexer[Any]] = {}
        self.handlers: dict[tuple[str, str], OperationHandler] = {}
        self.attached = False
        self._numbers = itertools.count(1)
        self._tasks: set[asyncio.Task[None]] = set()
        self._lost_topics: set[str] = set()
        self._reported: set[str] = set()

    @property
    def ros_version(self) -> int:  # type: ignore[override]
        """Version of the robot; 2 until the first connection."""
        return self.translator.ros_version

    async def start(self) -> None:
        """Connect, or log that the server is missing and keep trying in the background."""
        looked = self.join()
        self._link.start()
        await asyncio.wait([looked], timeout=FIRST_LOOK)
        if not self._link.up and not looked.done():
            self._await_server()
        else:
            await looked

    async def close(self) -> None:
        """Run the exit hooks and disconnect."""
        await self.lifetime.leave()
        self._link.stop()
        self._cancel_tasks()
        self.attached = False
        self.admission.close()
        self.close_members()
        self.requests.fail_all()
        self.left()

    def rosout(self, level: str, text: str) -> None:
        """Write a line to the graph's log; without a connection it is dropped."""
        if self.connected:
            super().rosout(level, text)

    # Interface for the parts:

    def number(self, operation: str, name: str) -> str:
        """Return an id for an operation; the server quotes it in status messages."""
        return f"{operation}:{name}:{next(self._numbers)}"

    def unhandle(self, handler: OperationHandler, operation: str, whose: str) -> None:
        """Deregister from `handlers`, unless a newer entity of the same name has taken the place."""
        if self.handlers.get((operation, whose)) == handler:
            del self.handlers[operation, whose]

    def send(self, operation: dict[str, Any], droppable: bool = False) -> bool:
        """Send an operation to a server that knows us, from any thread. Return False if it is lost."""
        return self.attached and self._link.send(operation, droppable)

    def request(
        self, operation: dict[str, Any], repeat: Callable[[], None], refused: Callable[[str], None]
    ) -> None:
        """Subscribe or advertise, and check that the server does so.

        Args:
            operation: the operation.
            repeat: sends it again, when the server no longer refuses it.
            refused: takes the reason why the server refuses it.
        """
        self.send(operation)
        request = _Request(operation["topic"], operation["type"], repeat, refused)
        self.admission.expect(operation["id"], request)

    def written_type(self, type_name: str) -> str:
        """Return the server's name of a type."""
        return written_on_ros1(type_name) if self.ros_version == 1 else type_name

    def require_connection(self, service: str) -> None:
        """Raise `ServiceUnavailable` if there is no server."""
        if not self.connected:
            raise ServiceUnavailable(
                f"service {service}: no connection to the rosbridge server at {self.url}"
            )

    def note_loss(self, topic: str) -> None:
        """Log lost messages, once per topic and interruption; from any thread."""
        if topic not in self._lost_topics:
            self._lost_topics.add(topic)
            self._say(
                f"topic {topic}: messages are lost: the rosbridge server at {self.url} is away or too slow, or does "
                f"not take messages of this size"
            )

    def polled(
        self, service: str, read: Callable[[dict[str, Any]], T], unknown: T, /, **arguments: str
    ) -> Polled[T]:
        """Return a value that a service of rosapi reports; see `Polled`."""
        return Polled(self.requests, f"/rosapi/{service}", arguments, read, unknown)

    async def rosapi(self, service: str, arguments: dict[str, Any], timeout: float | None = None) -> Any:
        """Call a service of rosapi and return the fields of its response.

        Raises:
            ServiceUnavailable: rosapi does not run.
            CallTimedOut, CallFailed: as `Client.call`.
        """
        self.require_connection(f"/rosapi/{service}")
        return await self._rosapi(service, arguments, timeout)

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

    # Interface for the link:

    def _link_up(self) -> None:
        self._cancel_tasks()
        self._lost_topics.clear()
        self._reported.clear()
        self._begin(self._greet())

    async def _greet(self) -> None:
        """Find out the version of ROS, and announce everything to the server."""
        found = await self._ask_for_version()
        if found is None:
            self.log(
                f"the rosbridge server at {self.url} has no rosapi node, so the graph cannot be queried; assuming ROS 2; "
                "its launch file starts both"
            )
        self.translator.ros_version = found or 2
        self.attached = True
        self._for_all("join")
        self.found()

    async def _ask_for_version(self) -> int | None:
        """Return the version of ROS; None if rosapi does not answer."""
        for _ in range(ATTEMPTS):
            # Neither ROS 1 nor early ROS 2 has this service.
            with contextlib.suppress(ServiceError, KeyError, TypeError, ValueError):
                return int((await self._rosapi("get_ros_version", {}, PATIENCE))["version"])
            with contextlib.suppress(ServiceError, KeyError, TypeError):
                types = (await self._rosapi("topics", {}, PATIENCE))["types"]
                return 2 if any(SIGN_OF_2 in kind for kind in types) else 1
            await self.clock.sleep(PAUSE)
        return None

    def _link_down(self) -> None:
        self.attached = False
        self._cancel_tasks()
        self.requests.fail_all()
        self._for_all("lost")
        self._await_server()

    def _for_all(self, method: str) -> None:
        """Let all entities announce themselves to a server that does not know us yet, or note that it is lost."""
        for each in (*self.multiplexers.values(), *self.members):
            if (call := getattr(each, method, None)) is not None:
                call()

    def _begin(self, work: Coroutine[Any, Any, None]) -> None:
        task = self.loop.create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    def _cancel_tasks(self) -> None:
        for task in self._tasks:
            task.cancel()

    def _await_server(self) -> None:
        self.missing(f"rosbridge server at {self.url}", CURE)

    def _received(self, message: dict[str, Any]) -> None:
        if message["op"] == "publish":
            multiplexer = self.multiplexers.get(str(message.get("topic")))
            if multiplexer is not None:
                multiplexer.put(message.get("msg"))
        else:  # in order, after earlier messages of topics
            self.loop.call_soon(self._dispatch, message["op"], message)

    def _dispatch(self, operation: str, message: dict[str, Any]) -> None:
        whose = str(message.get(_FIELDS.get(operation, "")))
        handler = self.handlers.get((operation, whose))
        try:
            if handler is not None:
                handler(message)
            elif operation == "service_response":
                self.requests.answered(message)
            elif operation == "status" and message.get("level") in ("error", "warning"):
                self._note_status(str(message.get("msg")))
        except (TypeError, ValueError, KeyError, AttributeError) as problem:
            self.log(f"the rosbridge server sent an invalid {operation}: {problem}")

    def _note_status(self, text: str) -> None:
        """Log a status message once; rosbridge_suite keeps them for its own log, but not every server does."""
        if text not in self._reported:
            self._reported.add(text)
            self.log(f"message of the rosbridge server: {text}")

    def _say(self, text: str) -> None:
        post(self.loop, self.log, text)

    def _leave(self) -> None:
        # A server discards pending operations when its client leaves; an answer shows that all earlier ones are done.
        self._link.finish(self.requests.operation("/rosapi/get_time", {}))


@dataclass(slots=True)
class _Request:
    """A subscription or an advertisement: how to repeat it, and what to do if the server refuses it."""

    topic: str
    written_type: str
    repeat: Callable[[], None]
    refused: Callable[[str], None]
    misses: int = 0
    conflict: bool = False


class Admission:
    """Checks requested topics until they exist.

    rosbridge refuses silently: a topic of another type, a type that is not installed on the robot, or a name that it
    may not serve only appears in its own log. So the node checks the graph after each subscription and advertisement,
    until the topic exists with our type.

    Args:
        node: sends the requests.
    """

    def __init__(self, node: BridgeNode) -> None:
        self._node = node
        self._open: dict[str, _Request] = {}
        self._timer: Timer | None = None
        self._pause = FIRST_PAUSE

    def expect(self, number: str, request: _Request) -> None:
        """Note that a topic was just requested, by the id of the operation; on the loop."""
        if any(part.startswith("_") for part in request.topic.split("/")):
            return  # hidden: rosapi does not report it
        self._open[number] = request
        self._pause = FIRST_PAUSE
        self._look_later()

    def forget(self, number: str) -> None:
        """Stop checking a request."""
        self._open.pop(number, None)

    def close(self) -> None:
        """Stop checking."""
        self._open.clear()
        if self._timer is not None:
            self._timer.cancel()

    def _look_later(self) -> None:
        if self._timer is not None:
            self._timer.cancel()
        self._timer = self._node.clock.call_later(self._pause, self._look)

    def _look(self) -> None:
        self._timer = None
        if self._open and self._node.attached:
            self._node.requests.begin("/rosapi/topics", {}, self._judge)

    def _judge(self, values: dict[str, Any] | None, _: ServiceError | None) -> None:
        if values is not None and isinstance(values.get("topics"), list):
            types = dict(zip(values["topics"], values.get("types") or (), strict=False))
            for number, request in list(self._open.items()):
                self._compare(number, request, types.get(request.topic))
        if self._open:
            self._pause = min(self._pause * 2.0, LONGEST_PAUSE)
            self._look_later()

    def _compare(self, number: str, request: _Request, found: str | None) -> None:
        topic, wanted = request.topic, request.written_type
        if found in (None, "", "*"):
            request.misses += 1
            # rosapi of ROS 1 reports only published topics.
            if self._node.ros_version == 2 and request.misses == MISSES:
                request.conflict = True
                request.refused(
                    f"topic {topic}: requested from the rosbridge server, but not in the graph: is {wanted} "
                    "installed on the robot, and may the server serve this topic (its parameter topics_glob)?"
                )
        elif found != wanted:
            request.conflict = True
            request.refused(f"topic {topic} carries {message_type(str(found))}, not {message_type(wanted)}")
        else:
            del self._open[number]
            if request.conflict:  # it was refused, and would be accepted now
                request.repeat()
