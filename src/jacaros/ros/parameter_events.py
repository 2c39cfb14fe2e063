"""Changed parameters of ROS 2's nodes, from ``/parameter_events`` (``rcl_interfaces/msg/ParameterEvent``)."""

from collections.abc import Callable, Mapping
from typing import Any

from jacaros.ros.node import Sample
from jacaros.ros.parameter import ParameterValue
from jacaros.ros.qos import QoS

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
