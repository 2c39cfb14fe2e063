"""Services of ROS 1: offered, and called."""

import asyncio
from typing import Any

import rospy  # type: ignore[import-not-found]

from jacaros.ros.backend import Handler
from jacaros.ros.backends.ros1_master import call_failure
from jacaros.ros.backends.ros1_node import Ros1Node
from jacaros.ros.calling import AttemptingClient, settle
from jacaros.ros.errors import CallFailed
from jacaros.ros.handoff import LoopEnded, ask, in_thread
from jacaros.ros.serving import Responder
from jacaros.ros.waiting import within


class Ros1Service:
    """Service of `Ros1Backend`."""

    def __init__(self, node: Ros1Node, name: str, type_name: str, handler: Handler) -> None:
        self.name = name
        self._node = node
        self._class = node.schema.service_class(type_name)
        self._responder = Responder(node.factory, name, type_name, handler, node.log)
        self._service: Any = None
        self._closed = False
        node.members[self] = None
        node.link.do(self._register)

    def close(self) -> None:
        """Stop to offer the service."""
        if self._closed:
            return
        self._closed = True
        self._node.members.pop(self, None)
        self._responder.close()
        self._node.link.do(self._unregister)

    def _register(self) -> None:
        self._service = rospy.Service(self.name, self._class, self._serve)

    def _unregister(self) -> None:
        if self._service is not None:
            self._service.shutdown("closed")

    def _serve(self, request: Any) -> Any:
        """Have the loop answer; on rospy's thread of this connection."""
        node = self._node
        try:
            return ask(
                node.loop, lambda done: self._responder.answer(request, done), lambda: node.lifetime.leaving
            )
        except CallFailed as problem:
            raise rospy.ServiceException(str(problem)) from None
        except LoopEnded:
            raise rospy.ServiceException(f"service {self.name}: the node is shutting down") from None


class Ros1Client(AttemptingClient):
    """Client of `Ros1Backend`."""

    _node: Ros1Node  # pyright: ignore[reportIncompatibleVariableOverride]

    def __init__(self, node: Ros1Node, name: str, type_name: str) -> None:
        super().__init__(node, name, type_name)
        self._class = node.schema.service_class(type_name)
        node.members[self] = None

    @property
    def ready(self) -> bool:
        """Whether somebody offers the service, as the master said a quarter of a second ago at most."""
        return self.name in self._node.link.services

    def _may_be_called(self) -> bool:
        return self.ready

    async def _attempt(self, message: Any, rest: float | None) -> Any:
        answer = self._pending.new()

        def finished(work: asyncio.Future[Any]) -> None:
            problem = work.exception()
            settle(answer, None if problem else work.result(), call_failure(self.name, problem))

        # A proxy of its own for each call: rospy's is not made for several calls at a time.  Only one that is called
        # persistent can be closed from outside, and a server that never answers would keep its thread for ever.
        proxy = rospy.ServiceProxy(self.name, self._class, persistent=True)

        def call() -> Any:
            try:
                return proxy(message)
            finally:
                proxy.close()

        in_thread(self._node.loop, call, f"call {self.name}").add_done_callback(finished)
        try:
            return await within(self._node.clock, answer, rest)
        finally:
            proxy.close()

    def close(self) -> None:
        """Give the client up."""
        self._node.members.pop(self, None)
        self._pending.close()
