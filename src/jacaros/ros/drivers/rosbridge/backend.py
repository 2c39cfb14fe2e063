"""A robot behind a rosbridge server, for a machine without ROS: JSON over a WebSocket.

The server (``rosbridge_server`` of ROS 1 or ROS 2) is the node in the graph; we are one of its clients.  So the graph
knows us by the server's name, and what rosapi, the node beside it, does not tell cannot be known.  Which ROS it is, is
asked at each connection.  The message classes are those of the `memory` backend.

Everything happens on the loop; only exit hooks may send from another thread (see `Link`).
"""

import os
from collections.abc import Callable
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
from jacaros.ros.drivers.rosbridge.actions import BridgeActionClient, BridgeActionServer
from jacaros.ros.drivers.rosbridge.link import checked_url
from jacaros.ros.drivers.rosbridge.node import BridgeNode
from jacaros.ros.drivers.rosbridge.parameters import BridgeParameters, read
from jacaros.ros.drivers.rosbridge.services import BridgeClient, BridgeService, look
from jacaros.ros.drivers.rosbridge.topics import BridgePublisher, BridgeSubscription
from jacaros.ros.errors import CapabilityMissing
from jacaros.ros.graph import GraphContents
from jacaros.ros.names import action_type, message_type, service_type
from jacaros.ros.node import NodeSettings
from jacaros.ros.parameter_news import ParameterNews
from jacaros.ros.qos import DEFAULT_QOS, QoS

DEFAULT_URL = "ws://127.0.0.1:9090"


class RosbridgeBackend(BridgeNode):
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
        super().__init__(settings, checked_url(url or os.environ.get("ROSBRIDGE_URI") or DEFAULT_URL))
        self._news = ParameterNews(self.subscription, read)
        # Weakly: the node keeps them, until they are closed.
        self._services: WeakValueDictionary[str, BridgeService] = WeakValueDictionary()
        self._action_servers: WeakValueDictionary[str, BridgeActionServer] = WeakValueDictionary()

    @property
    def capabilities(self) -> frozenset[str]:  # type: ignore[override]
        """What can be done with the robot's ROS."""
        # Failed handlers are told of by those services of ROS 1 alone that are not served over a bridge.
        news = {PARAMETER_EVENTS} if self.ros_version == 2 else set()
        return frozenset({TOPICS, SERVICES, TRANSFORMS, ACTIONS, DISCOVERY, PARAMETERS, *news})

    def publisher(self, topic: str, type_name: str, qos: QoS = DEFAULT_QOS) -> BridgePublisher:
        """Make a publisher."""
        _refuse_deadline(qos)
        publisher = BridgePublisher(self, self.resolve(topic), message_type(type_name), qos)
        self.add(publisher)
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
        self.add(made)
        return made

    def service(self, name: str, type_name: str, handler: Handler) -> BridgeService:
        """Offer a service."""
        full_type = service_type(type_name)
        self._schema.service(full_type)
        service = BridgeService(self, self.resolve(name), full_type, handler)
        self._services[service.name] = service
        self.add(service)
        return service

    def client(self, name: str, type_name: str) -> BridgeClient:
        """Make a client of a service."""
        full_type = service_type(type_name)
        self._schema.service(full_type)
        client = BridgeClient(self, self.resolve(name), full_type)
        self.add(client)
        return client

    def action_client(self, name: str, type_name: str) -> BridgeActionClient:
        """Make a client of an action."""
        full_type = action_type(type_name)
        self._schema.action(full_type)
        client = BridgeActionClient(self, self.resolve(name), full_type)
        self.add(client)
        return client

    def action_server(
        self, name: str, type_name: str, execute: Execute, policy: ActionPolicy = DEFAULT_POLICY
    ) -> BridgeActionServer:
        """Offer an action."""
        full_type = action_type(type_name)
        self._schema.action(full_type)
        server = BridgeActionServer(self, self.resolve(name), full_type, execute, policy)
        self._action_servers[server.name] = server
        self.add(server)
        return server

    def parameters(self, node: str | None = None) -> BridgeParameters:
        """Give the parameters of a node; our own can be used on ROS 1 alone, where the master keeps them."""
        return BridgeParameters(self, self.node_name if node is None else self.resolve(node), self._news)

    async def contents(self, timeout: float = 5.0) -> GraphContents:
        """Look at the graph."""
        return await look(self, timeout)

    # What the server sends:

    def _received(self, message: dict[str, Any]) -> None:
        operation = message["op"]
        if operation == "publish":
            feed = self.feeds.get(str(message.get("topic")))
            if feed is not None:
                feed.put(message.get("msg"))
        else:  # in its turn, after the messages of topics that came before
            self.loop.call_soon(self._dispatch, operation, message)

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
        feed = next((feed for feed in self.feeds.values() if feed.number == number), None)
        if feed is not None:
            feed.refused(f"topic {feed.topic}: the rosbridge server refuses it: {text}")
        elif number in self.goals and "nknown operation" in text:
            self.goals[number].refused(number, text)
        elif text not in self._told and not number.startswith("send_action_goal:"):
            self._told.add(text)
            self.log(f"the rosbridge server says: {text}")


def _refuse_deadline(qos: QoS) -> None:
    if qos.deadline is not None:
        raise CapabilityMissing(
            "deadlines: the rosbridge backend cannot watch them; --ros ros2 and --ros memory can"
        )


BACKEND: type[Backend] = RosbridgeBackend
