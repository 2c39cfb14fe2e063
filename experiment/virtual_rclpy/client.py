"""``rclpy.client``: clients of services."""

from typing import TYPE_CHECKING, Any

from virtual_rclpy.messages import Interface
from virtual_rclpy.task import Future

if TYPE_CHECKING:
    from virtual_rclpy.node import Node


class Client:
    """Calls a service."""

    def __init__(self, node: "Node", srv_type: Interface, srv_name: str) -> None:
        self._graph = node.graph
        self._client = node.backend.client(srv_name, srv_type.type_name)
        self._calls: set[Any] = set()

    def service_is_ready(self) -> bool:
        """Return whether a node offers the service."""
        return bool(self._client.ready)

    def wait_for_service(self, timeout_sec: float | None = None) -> bool:
        """Wait until a node offers the service; return False at the timeout, in seconds."""
        return self._graph.wait_for(self.service_is_ready, timeout_sec)

    def call_async(self, request: Any) -> Future:
        """Call the service; the future's result is its response. It is never done if the call fails."""
        answer = Future(self._graph)
        call = self._graph.loop.create_task(self._call(request, answer))
        self._calls.add(call)
        call.add_done_callback(self._calls.discard)
        return answer

    async def _call(self, request: Any, answer: Future) -> None:
        answer.arrive(await self._client.call(request))
