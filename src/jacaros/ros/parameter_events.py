"""Parameters of the nodes of other processes: reports of changes, and the services of ROS 2 that read and set them."""

from collections.abc import Callable, Mapping
from typing import Any

from jacaros.ros.node import Sample
from jacaros.ros.parameter import ParameterValue
from jacaros.ros.qos import QoS
from jacaros.ros.services import Client

EVENTS, EVENT_TYPE, EVENT_QUALITY = "/parameter_events", "rcl_interfaces/msg/ParameterEvent", QoS(depth=1000)

Listener = Callable[[Mapping[str, ParameterValue]], None]


class ParameterListeners:
    """The callbacks for changed parameters, by node."""

    def __init__(self) -> None:
        self._listeners: dict[str, list[Listener]] = {}

    def listen(self, node: str, callback: Listener) -> Callable[[], None]:
        """Call *callback* with changed parameters of a node. Return a function that removes it."""
        listeners = self._listeners.setdefault(node, [])
        listeners.append(callback)
        return lambda: listeners.remove(callback) if callback in listeners else None

    def of(self, node: str) -> list[Listener]:
        """Return the callbacks for a node."""
        return list(self._listeners.get(node, ()))


class ParameterEvents(ParameterListeners):
    """Reports changed parameters of all nodes from one subscription, which is made on first use.

    Args:
        subscribe: subscribes at the backend, given the topic, its type, the callback, and the quality of service.
        read: returns the value of an ``rcl_interfaces/msg/ParameterValue``, None for a parameter without one.
    """

    def __init__(
        self,
        subscribe: Callable[[str, str, Callable[[Sample], None], QoS], object],
        read: Callable[[Any], ParameterValue | None],
    ) -> None:
        super().__init__()
        self._subscribe = subscribe
        self._read = read
        self._joined = False

    def listen(self, node: str, callback: Listener) -> Callable[[], None]:
        """Call *callback* with changed parameters of a node. Return a function that removes it."""
        if not self._joined:
            self._joined = True
            self._subscribe(EVENTS, EVENT_TYPE, self._take, EVENT_QUALITY)
        return super().listen(node, callback)

    def _take(self, sample: Sample) -> None:
        event = sample.message
        if not (listeners := self.of(event.node)):
            return
        told = {
            each.name: self._read(each.value) for each in (*event.new_parameters, *event.changed_parameters)
        }
        known = {name: value for name, value in told.items() if value is not None}
        if known:
            for callback in listeners:
                callback(known)


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
