"""Services through the bridge, both ways."""

from functools import partial
from typing import Any

from jacaros.ros.backend import Handler
from jacaros.ros.backends.rosbridge_node import BridgeNode
from jacaros.ros.backends.rosbridge_requests import Sight
from jacaros.ros.calling import AttemptingClient, ServerWatch, settle
from jacaros.ros.errors import CallFailed, MessageMismatch, ServiceError
from jacaros.ros.names import request_type, response_type
from jacaros.ros.serving import Responder
from jacaros.ros.waiting import within

_NOT_OUR_DEFINITION = ("does not have a field", "message requires a", "Expected a JSON object")
"""What the server says of a request whose fields are others in its definition."""

FOR_EVER = 86400.0
"""The time-out of a call without one, for servers that would choose five seconds themselves."""


class BridgeClient(AttemptingClient):
    """Client of `RosbridgeBackend`."""

    _node: BridgeNode  # pyright: ignore[reportIncompatibleVariableOverride]

    def __init__(self, node: BridgeNode, name: str, type_name: str) -> None:
        super().__init__(node, name, type_name)  # pyright: ignore[reportArgumentType]
        self._offered = Sight(
            node.requests, "/rosapi/service_type", {"service": name}, lambda seen: bool(seen["type"]), False
        )

    @property
    def ready(self) -> bool:
        """Whether somebody offers the service, as the bridge said a second ago at most."""
        return self._node.connected and self._offered.value

    def _may_be_called(self) -> bool:
        return self.ready

    async def _attempt(self, message: Any, rest: float | None) -> Any:
        node = self._node
        node.require_connection(self.name)
        answer = self._pending.new()
        arguments = node.translator.encode(request_type(self._type_name), message)
        patience = FOR_EVER if rest is None else rest
        number = node.requests.begin(self.name, arguments, partial(settle, answer), patience)
        try:
            with ServerWatch(node.clock, self.name, answer, lambda: self._offered.value):
                values = await within(node.clock, answer, rest)
        except CallFailed as problem:
            if "Timeout exceeded" in str(problem) and rest is not None:
                raise TimeoutError from None
            if any(words in str(problem) for words in _NOT_OUR_DEFINITION):
                raise MessageMismatch(str(problem), self._type_name) from None
            raise
        finally:
            node.requests.forget(number)
        try:
            return node.translator.decode(response_type(self._type_name), values)
        except ValueError as problem:
            raise CallFailed(
                f"service {self.name}: the response is no {self._type_name}: {problem}"
            ) from None

    def close(self) -> None:
        """Give the client up."""
        self._node.members.drop(self)
        self._pending.close()


class BridgeService:
    """Service of `RosbridgeBackend`."""

    def __init__(self, node: BridgeNode, name: str, type_name: str, handler: Handler) -> None:
        self.name = name
        self._node = node
        self._type_name = type_name
        self._responder = Responder(node.factory, name, type_name, handler, node.log)
        self._closed = False
        if node.attached:
            self.join()

    def join(self) -> None:
        """Offer the service at a server that does not know us yet."""
        kind = self._node.written_type(self._type_name)
        self._node.send({"op": "advertise_service", "type": kind, "service": self.name})

    def close(self) -> None:
        """Stop to offer the service."""
        self._responder.close()
        if not self._closed:
            self._closed = True
            self._node.members.drop(self)
            self._node.send({"op": "unadvertise_service", "service": self.name})

    def called(self, message: dict[str, Any]) -> None:
        """Take a request of the server; on the loop."""
        node, number = self._node, message.get("id")
        try:
            request = node.translator.decode(request_type(self._type_name), message.get("args") or {})
        except ValueError as problem:
            node.log(f"service {self.name}: a request is no {self._type_name}: {problem}")
            return

        def done(response: Any, problem: ServiceError | None) -> None:
            answer = {"op": "service_response", "id": number, "service": self.name}
            if problem is None:
                answer["values"] = node.translator.encode(response_type(self._type_name), response)
                node.send(answer | {"result": True})
            # The server has no way to pass a failure on (it would send a response of zeros): as on ROS 2 the call
            # gets no answer.

        self._responder.answer(request, done)
