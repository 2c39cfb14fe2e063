"""One client of the bridge: what it asked for, and what it is sent."""

import asyncio
import itertools
import json
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import cbor2
from conversion import Mismatch, from_json, short, to_cbor, to_json
from goals import AdvertisedAction

from jacaros.robots.ros.errors import CallFailed, CallTimedOut
from jacaros.robots.ros.names import message_type, request_type, response_type, service_type
from jacaros.robots.ros.node import Sample
from jacaros.robots.ros.qos import QoS
from jacaros.runtime.errors import JacarosError

if TYPE_CHECKING:
    from server import Bridge

DEFAULT_TIMEOUT = 5.0
"""Seconds of a call without ``timeout`` (the server's parameter ``default_call_service_timeout``)."""
PARAMETER_EVENTS = "/parameter_events"
STATUS_SUFFIX = "/_action/status"
ACTION_OPERATIONS = (
    *("send_action_goal", "cancel_action_goal", "advertise_action", "unadvertise_action"),
    *("action_feedback", "action_result"),
)


class Refused(Exception):
    """The operation cannot be done; the words go into a status message."""


class Connection:
    """A client.

    Args:
        bridge: the server.
        write: sends a frame, binary or not.
    """

    def __init__(self, bridge: "Bridge", write: Callable[[bytes, bool], None]) -> None:
        self.bridge = bridge
        self._write = write
        self._publishers: dict[str, tuple[str, Any, set[str]]] = {}
        self._subscriptions: dict[str, tuple[str, Any, set[str]]] = {}
        self._statuses: set[str] = set()
        self._hears_of_parameters = False
        self._services: dict[str, AdvertisedService] = {}
        self._actions: dict[str, AdvertisedAction] = {}
        self._tasks: set[asyncio.Task[None]] = set()
        self._alive = True

    def receive(self, payload: bytes) -> None:
        """Do what a frame of the client asks for."""
        message = json.loads(payload)
        operation, number = message.get("op"), message.get("id")
        method = getattr(self, f"_op_{operation}", None)
        if method is None or (not self.bridge.knows_actions and operation in ACTION_OPERATIONS):
            self.status(
                "error", f"Unknown operation: {operation}.  Allowed operations: ['advertise', ...]", number
            )
            return
        try:
            method(message)
        except (Refused, Mismatch, JacarosError, KeyError) as problem:
            self.status("error", f"{operation}: {problem}", number)

    def send(self, message: dict[str, Any]) -> None:
        """Send an operation to the client."""
        if self._alive:
            self._write(json.dumps(message).encode(), False)

    def send_packed(self, message: dict[str, Any]) -> None:
        """Send an operation as CBOR."""
        if self._alive:
            self._write(cbor2.dumps(message), True)

    def say(self, text: str) -> None:
        """Send a frame as it is."""
        self._write(text.encode(), False)

    def status(self, level: str, text: str, number: str | None) -> None:
        """Say something, if the server is one that talks: rosbridge_suite keeps it for its own log."""
        if not self.bridge.talkative:
            return
        said = {"op": "status", "level": level, "msg": text}
        self.send(said | ({"id": number} if number is not None else {}))

    def close(self) -> None:
        """Give up all that the client had; goals that it has sent go on."""
        self._alive = False
        for _, publisher, _ in self._publishers.values():
            self.bridge.unregister_later(publisher)
        for _, subscription, _ in self._subscriptions.values():
            subscription.close()
        for served in (*self._services.values(), *self._actions.values()):
            served.close()

    # Topics

    def _op_advertise(self, message: dict[str, Any]) -> None:
        topic, kind = message["topic"], message_type(message["type"])
        self._require_type(topic, kind, self._publishers)
        if topic not in self._publishers:
            given = message.get("qos") or {}
            latch = message.get("latch", False)
            qos = QoS(
                given.get("reliability", "reliable"),
                given.get("durability", "transient_local" if latch else "volatile"),
                given.get("depth") or message.get("queue_size") or 100,
            )
            self._publishers[topic] = (kind, self.bridge.node.publisher(topic, kind, qos), set())
        self._publishers[topic][2].add(message.get("id") or "")

    def _op_unadvertise(self, message: dict[str, Any]) -> None:
        self._leave(self._publishers, message)

    def _op_publish(self, message: dict[str, Any]) -> None:
        topic = message["topic"]
        if topic not in self._publishers:
            raise Refused(f"Cannot infer topic type for topic {topic} as it is not yet advertised")
        kind, publisher, _ = self._publishers[topic]
        publisher.publish(from_json(self.bridge.node, kind, message.get("msg", {}), self.bridge.ros1))

    def _op_subscribe(self, message: dict[str, Any]) -> None:
        topic, kind = message["topic"], message_type(message["type"])
        if topic.endswith(STATUS_SUFFIX):
            self._statuses.add(topic.removesuffix(STATUS_SUFFIX))
            self.tell_status(topic.removesuffix(STATUS_SUFFIX))
            return
        if topic == PARAMETER_EVENTS:
            self._hears_of_parameters = True
            return
        self._require_type(topic, kind, self._subscriptions)
        _, old, numbers = self._subscriptions.pop(topic, (kind, None, set()))
        if old is not None:  # a second subscription of a client sees what is latched, as a new one
            old.close()

        def receive(sample: Sample) -> None:
            if message.get("compression") == "cbor":
                packed = to_cbor(self.bridge.node, kind, sample.message, self.bridge.ros1)
                self.send_packed({"op": "publish", "topic": topic, "msg": packed})
                return
            values = to_json(self.bridge.node, kind, sample.message, self.bridge.ros1)
            self.send({"op": "publish", "topic": topic, "msg": values})

        given = message.get("qos") or {}
        latched = given.get("durability") == "transient_local" or self.bridge.is_latched(topic)
        qos = QoS(
            "best_effort", "transient_local" if latched else "volatile", message.get("queue_length") or 100
        )
        made = self.bridge.node.subscription(topic, kind, receive, qos)
        self._subscriptions[topic] = (kind, made, numbers | {message.get("id") or ""})

    def _op_unsubscribe(self, message: dict[str, Any]) -> None:
        self._statuses.discard(message["topic"].removesuffix(STATUS_SUFFIX))
        self._leave(self._subscriptions, message)

    def _leave(self, table: dict[str, tuple[str, Any, set[str]]], message: dict[str, Any]) -> None:
        topic, number = message["topic"], message.get("id")
        if topic in table:
            _, member, numbers = table[topic]
            numbers.discard(number or "")
            if number is None or not numbers:
                del table[topic]
                if table is self._publishers:
                    self.bridge.unregister_later(member)
                else:
                    member.close()

    def _require_type(self, topic: str, kind: str, ours: dict[str, tuple[str, Any, set[str]]]) -> None:
        known = ours[topic][0] if topic in ours else self.bridge.topic_type(topic)
        if known not in (None, kind):
            written = f"with type {short(kind)} but it is already established with type {short(str(known))}"
            raise Refused(f"Tried to register topic {topic} {written}")
        self.bridge.node.factory.fields(kind)

    def tell_parameters(self, event: dict[str, Any]) -> None:
        """Send a message of ``/parameter_events``, if the client wants it."""
        if self._hears_of_parameters:
            self.send({"op": "publish", "topic": PARAMETER_EVENTS, "msg": event})

    def tell_status(self, action: str) -> None:
        """Send what the status topic of an action shows, if the client wants it."""
        if action in self._statuses:
            values = self.bridge.goals.status_array(action)
            if values["status_list"]:
                self.send({"op": "publish", "topic": action + STATUS_SUFFIX, "msg": values})

    # Services

    def _op_call_service(self, message: dict[str, Any]) -> None:
        self._begin(self._call(message))

    async def _call(self, message: dict[str, Any]) -> None:
        name, number = message["service"], message.get("id")
        answer = {"op": "service_response", "service": name}
        if number is not None:
            answer["id"] = number
        try:
            values = await self._values(name, message)
            if values is not None:
                self.send(answer | {"values": values, "result": True})
        except (CallFailed, Mismatch) as problem:
            self.status("error", f"call_service {type(problem).__name__}: {problem}", number)
            self.send(answer | {"values": str(problem), "result": False})

    async def _values(self, name: str, message: dict[str, Any]) -> dict[str, Any] | None:
        bridge, arguments = self.bridge, message.get("args") or {}
        if name.startswith("/rosapi/"):
            return await bridge.rosapi.call(name, arguments)
        if not bridge.ros1 and (values := await bridge.parameters.call(name, arguments)) is not None:
            return values
        kind = (await bridge.node.contents()).services.get(name)
        if kind is None:
            raise CallFailed(f"Service {name} does not exist")
        request = from_json(bridge.node, request_type(kind), arguments, bridge.ros1)
        client = bridge.node.client(name, kind)
        timeout = message.get("timeout", DEFAULT_TIMEOUT)
        try:
            response = await client.call(request, timeout or None)
        except CallTimedOut:
            raise CallFailed("Timeout exceeded while waiting for service response") from None
        except CallFailed:
            if not bridge.ros1:
                return None  # ROS 2 reports this to no client
            raise
        finally:
            client.close()
        return to_json(bridge.node, response_type(kind), response, bridge.ros1)

    def _op_advertise_service(self, message: dict[str, Any]) -> None:
        name = message["service"]
        if name in self._services:
            self._services.pop(name).close()
        self._services[name] = AdvertisedService(self, name, message["type"])

    def _op_unadvertise_service(self, message: dict[str, Any]) -> None:
        if message["service"] not in self._services:
            raise Refused(
                f"Service {message['service']} has not been advertised via rosbridge, can't unadvertise."
            )
        self._services.pop(message["service"]).close()

    def _op_service_response(self, message: dict[str, Any]) -> None:
        if message["service"] not in self._services:
            raise Refused(f"Service {message['service']} has not been advertised via rosbridge.")
        self._services[message["service"]].response(message)

    # Actions

    def _op_send_action_goal(self, message: dict[str, Any]) -> None:
        # The genuine server carries goals on when their client has gone.
        self.bridge.begin(self.bridge.goals.send(self, message))

    def _op_cancel_action_goal(self, message: dict[str, Any]) -> None:
        self.bridge.begin(self.bridge.goals.cancel(message))

    def _op_advertise_action(self, message: dict[str, Any]) -> None:
        name = message["action"]
        if name in self._actions:
            self._actions.pop(name).close()
        self._actions[name] = AdvertisedAction(self, name, message["type"])

    def _op_unadvertise_action(self, message: dict[str, Any]) -> None:
        if message["action"] in self._actions:
            self._actions.pop(message["action"]).close()

    def _op_action_feedback(self, message: dict[str, Any]) -> None:
        self._actions[message["action"]].feedback(message)

    def _op_action_result(self, message: dict[str, Any]) -> None:
        self._actions[message["action"]].result(message)

    def _begin(self, work: Any) -> None:
        self.bridge.begin(work)


class AdvertisedService:
    """A service that a client serves."""

    _numbers = itertools.count(1)

    def __init__(self, connection: Connection, name: str, type_name: str) -> None:
        self._connection = connection
        self._name = name
        self._type = service_type(type_name)
        self._node = connection.bridge.node
        self._answers: dict[str, asyncio.Future[Any]] = {}
        self._service = self._node.service(name, self._type, self._handle)

    async def _handle(self, request: Any) -> Any:
        number = f"service_request:{self._name}:{next(self._numbers)}"
        answer = self._answers[number] = asyncio.get_running_loop().create_future()
        ros1 = self._connection.bridge.ros1
        arguments = to_json(self._node, request_type(self._type), request, ros1)
        self._connection.send({"op": "call_service", "id": number, "service": self._name, "args": arguments})
        return await answer

    def response(self, message: dict[str, Any]) -> None:
        """Pass a response on; whether it says that it is a failure does not matter to the genuine server."""
        values = message.get("values", {})
        if not isinstance(values, dict):
            raise Refused("Expected field values to be one of [dict]")
        answer = self._answers.pop(message["id"], None)
        response = from_json(self._node, response_type(self._type), values, self._connection.bridge.ros1)
        if answer is not None and not answer.done():
            answer.set_result(response)

    def close(self) -> None:
        """Stop to offer it; calls under way fail."""
        self._service.close()
