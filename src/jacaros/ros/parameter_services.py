"""The services of ROS 2 that read and set the parameters of other nodes."""

from collections.abc import Callable, Mapping
from typing import Any

from jacaros.ros.services import Client


class ParameterServices:
    """The parameter services of one node; a client is made on first use.

    Args:
        node: absolute name of the node that has the parameters.
        make_client: makes the client of a service, by name and type, and closes it with our node.
    """

    def __init__(self, node: str, make_client: Callable[[str, str], Client]) -> None:
        self._node = node
        self._make_client = make_client
        self._clients: dict[str, Client] = {}

    def client(self, service: str) -> Client:
        """Return the client of a service, such as ``GetParameters`` of ``rcl_interfaces``."""
        client = self._clients.get(service)
        if client is None:
            name = "".join(f"_{letter.lower()}" if letter.isupper() else letter for letter in service)
            client = self._make_client(f"{self._node}/{name[1:]}", f"rcl_interfaces/srv/{service}")
            self._clients[service] = client
        return client

    async def call(self, service: str, request: Mapping[str, Any], timeout: float | None) -> Any:
        """Call a service and return its response; *timeout* in seconds."""
        return await self.client(service).call(request, timeout)
