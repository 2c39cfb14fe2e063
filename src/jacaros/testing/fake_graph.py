"""The rest of the ROS graph in a test: publishes messages, receives what the run publishes, and answers services."""

import math
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

from jacaros.artifacts.mapping.encoding import builder
from jacaros.artifacts.mapping.read_operations import read_values
from jacaros.files.texts import suggestion
from jacaros.files.yaml import Problem, read_document
from jacaros.mas.ros_graph import RosGraph
from jacaros.ros.backend import Publisher, Sample, Service
from jacaros.ros.drivers.memory.services import MemoryClient
from jacaros.ros.errors import RosError
from jacaros.ros.message import to_seconds
from jacaros.ros.names import message_type, request_type, response_type, service_type
from jacaros.ros.qos import LATCHED, QoS

NODE = "test"
"""Name of the fake node."""
_ALL = QoS("best_effort", depth=10_000)
_TOLERANCE = 1e-6


@contextmanager
def _graph_errors() -> Iterator[None]:
    """Raise errors of the graph as ValueError."""
    try:
        yield
    except RosError as wrong:
        raise ValueError(str(wrong)) from None


class FakeGraph:
    """The other nodes of the in-process graph, played by a test.

    Messages are written as in mapping files, such as ``{pose.position.x: 1, header.stamp: now}``, or as nested Python
    mappings.

    Methods raise ValueError for an invalid name, type or field; the text says why.
    """

    def __init__(self, graph: RosGraph) -> None:
        self._ours: Any = graph.backend()  # of the in-process graph
        self.node = graph.companion(NODE)
        self._publishers: dict[str, Publisher] = {}
        self._services: dict[str, Service] = {}
        self._heard: dict[str, list[Any]] = {}
        self._types: dict[str, str] = {}
        self._asked: dict[str, list[Any]] = {}
        self.node.graph.watch_publishers(self._listen_to)

    @_graph_errors()
    def publish(self, topic: str, fields: str | Mapping[str, Any] = "", type_name: str = "") -> None:
        """Publish a message.

        Args:
            topic: name; a relative name is below ``/``.
            fields: values of fields; other fields are zero or empty.
            type_name: message type; default: the type of the topic's subscriptions.
        """
        name = self.node.resolve(topic)
        full = message_type(type_name) if type_name else self._type_of(name)
        given = self._fields(fields, full)
        if name not in self._publishers:
            self._publishers[name] = self.node.publisher(name, full, LATCHED)
        publisher = self._publishers[name]
        publisher.publish(publisher.message(**given))

    @_graph_errors()
    def answer(self, service: str, type_name: str, fields: str | Mapping[str, Any] = "") -> None:
        """Offer a service that always returns the same response; a second call replaces the response."""
        name, full = self.node.resolve(service), service_type(type_name)
        response = self._fields(fields, response_type(full))
        if name in self._services:
            self._services.pop(name).close()

        def handle(request: Any) -> Mapping[str, Any]:
            self._asked.setdefault(name, []).append(request)
            return response

        self._services[name] = self.node.service(name, full, handle)

    def published(self, topic: str) -> list[Any]:
        """Return the messages that artifacts of the run published on a topic, oldest first."""
        return self._heard.get(self.node.resolve(topic), [])

    def asked(self, service: str) -> list[Any]:
        """Return the requests received by a service of `answer`, oldest first."""
        return self._asked.get(self.node.resolve(service), [])

    def services_without_clients(self) -> Iterator[str]:
        """Yield an error for each service of `answer` that no artifact of the run can call, as its name is wrong."""
        clients = {each.name for each in self._ours.members if isinstance(each, MemoryClient)}
        for name in self._services:
            if name not in clients:
                listed = f"services that artifacts call: {', '.join(sorted(clients)) or 'none'}"
                yield f"no artifact calls the service {name} of fake_service; {suggestion(name, sorted(clients), listed)}"

    @_graph_errors()
    def hear(self, topic: str, type_name: str) -> None:
        """Subscribe to a topic, which makes its type known to the run."""
        self.node.subscription(topic, type_name, lambda sample: None, _ALL)

    def count_published(self, topic: str, fields: str) -> tuple[int, list[str]]:
        """Return the number of messages on a topic with these values, and all its messages as text."""
        name = self._name(topic)
        messages = self._heard.get(name, [])
        type_name = self._types.get(name) or self.node.graph.topics().get(name)
        return self._count(messages, fields, type_name) if type_name else (0, [])

    def count_asked(self, service: str, fields: str) -> tuple[int, list[str]]:
        """Return the number of requests to a service with these values, and all its requests as text."""
        name = self._name(service)
        offered = self.node.graph.contents().services
        if name not in self._services:
            raise ValueError(f"unknown service {name}; call fake_service first")
        return self._count(self.asked(name), fields, request_type(offered[name]))

    @_graph_errors()
    def _name(self, name: str) -> str:
        return str(self.node.resolve(name))

    def _count(self, messages: list[Any], fields: str, type_name: str) -> tuple[int, list[str]]:
        wanted = self._fields(fields, type_name) if fields else {}
        return sum(_has(message, wanted) for message in messages), [shown(each) for each in messages]

    def _listen_to(self, publisher: Any) -> None:
        """Receive what the run publishes from now on, without the messages of an embedded world."""
        name = publisher.topic
        if publisher.node_name != self._ours.node_name or name in self._heard:
            return
        messages = self._heard[name] = []
        self._types[name] = publisher.type_name

        def keep(sample: Sample) -> None:
            messages.append(sample.message)

        self.node.subscription(name, publisher.type_name, keep, _ALL)

    def _type_of(self, name: str) -> str:
        topics: dict[str, str] = self.node.graph.topics()
        if found := topics.get(name):
            return found
        help = suggestion(name, topics, "pass its type as the second argument", 2)
        raise ValueError(f"unknown type of {name}, which has no subscription; {help}")

    def _fields(self, fields: str | Mapping[str, Any], type_name: str) -> dict[str, Any]:
        if not isinstance(fields, str):
            return dict(fields)
        problems: list[Problem] = []
        values = read_values(read_document(fields, problems, "a message"), ())
        fill = builder(values, type_name, self.node, problems) if not problems else None
        if fill is None:
            text = "; ".join(
                f"{each.message}: {each.help}" if each.help else each.message for each in problems
            )
            raise ValueError(f"{fields}: {text}")
        return fill((), self.node.clock.now())


def _has(given: Any, wanted: Any) -> bool:
    """Return whether a message or value has the wanted values; numbers may differ slightly."""
    if isinstance(wanted, Mapping):
        return all(_has(getattr(given, name), value) for name, value in wanted.items())
    if isinstance(wanted, list | tuple):
        return len(given) == len(wanted) and all(map(_has, given, wanted))
    if isinstance(wanted, float) or (isinstance(wanted, int) and not isinstance(wanted, bool)):
        if isinstance(given, bytes):
            return bool(given == bytes([int(wanted)]))
        if hasattr(given, "nanosec"):  # a time: a relative tolerance would accept any time of the same day
            return math.isclose(to_seconds(given), wanted, rel_tol=0.0, abs_tol=_TOLERANCE)
        return math.isclose(given, wanted, rel_tol=_TOLERANCE, abs_tol=_TOLERANCE)
    return bool(given == wanted)


def shown(message: Any) -> str:
    """Return a message as text, without fields that are zero or empty."""
    parts = [f"{name}: {text}" for name in _names(message) if (text := _shown(getattr(message, name)))]
    return f"{{{', '.join(parts)}}}"


def _shown(value: Any) -> str:
    """Return a value as text; empty if it is zero or empty."""
    if _names(value):
        text = shown(value)
        return "" if text == "{}" else text
    if hasattr(value, "__len__") and not isinstance(value, str):
        items = [_shown(each) or str(each) for each in list(value)[:5]]
        return f"[{', '.join(items)}{', ...' if len(value) > 5 else ''}]" if items else ""
    return f"{value:g}" if isinstance(value, float) and value else str(value or "")


def _names(value: Any) -> list[str]:
    fields = getattr(value, "__dataclass_fields__", ())
    return [name for name in fields if not name.startswith("__")]
