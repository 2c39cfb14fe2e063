"""Faults of messages: a sensor that is dead, frozen or tells nonsense, and a line that loses, delays or repeats.

They happen where the world meets the graph, so that agents and all other nodes suffer them alike.
"""

import copy
import difflib
import math
import random
from collections.abc import Callable, Iterable, Sequence
from dataclasses import fields, is_dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Any, cast

from jacaros.clock import Clock
from jacaros.errors import UsageError
from jacaros.ros.backend import Backend, Publisher, Sample, Subscription
from jacaros.sim.faults.description import Fault

if TYPE_CHECKING:
    from jacaros.sim.faults.schedule import Faults

Way = Callable[[Any], Sequence[tuple[float, Any]]]
"""Takes a message; gives what arrives in its place, each after so many seconds: nothing when it is lost."""

_KEPT = frozenset(
    {"header", "angle_min", "angle_max", "angle_increment", "range_min", "range_max", "scan_time"}
)
"""What describes a sensor, and is no measurement."""


def way_of(fault: Fault, seed: int) -> Way:
    """What a fault does to each message of its topic from now on."""
    chance = random.Random(f"{seed}/{fault.name}/messages")
    if fault.kind == "dead":
        return lambda message: ()
    if fault.kind == "frozen":
        return _Frozen().replace
    if fault.kind == "nan":
        return lambda message: ((0.0, _without_numbers(copy.deepcopy(message))),)
    if fault.kind == "lost":
        return lambda message: () if chance.random() < fault.share else ((0.0, message),)
    if fault.kind == "delayed":
        return lambda message: ((fault.seconds + fault.jitter * chance.random(), message),)
    return lambda message: [(0.0, message)] * fault.copies


class _Frozen:
    """Repeats the first message, with the stamps of those that it replaces."""

    def __init__(self) -> None:
        self._first: Any = None

    def replace(self, message: Any) -> Sequence[tuple[float, Any]]:
        if self._first is None:
            self._first = copy.deepcopy(message)
        repeated = copy.deepcopy(self._first)
        if hasattr(message, "header"):
            repeated.header.stamp = message.header.stamp
        return ((0.0, repeated),)


def _without_numbers(message: Any) -> Any:
    """Write NaN into every floating-point field that is a measurement."""
    for name in _fields(message):
        value = getattr(message, name)
        if name in _KEPT or "covariance" in name:
            continue
        if isinstance(value, float):
            setattr(message, name, math.nan)
        elif _fields(value):
            _without_numbers(value)
        elif not isinstance(value, str | bytes) and isinstance(value, Iterable):
            # Of arrays (numpy's, and array.array, as of ROS 2) the items as Python has them.
            items = value.tolist() if hasattr(value, "tolist") else list(value)
            if items and all(isinstance(item, float) for item in items):
                setattr(message, name, [math.nan] * len(items))
    return message


def _fields(value: Any) -> list[str]:
    """The fields of a message of any middleware; none for what is no message."""
    if is_dataclass(value):
        return [field.name for field in fields(value)]
    return [
        slot.removeprefix("_") for slot in getattr(type(value), "__slots__", ()) if slot != "_check_fields"
    ]


class FaultyGraph:
    """A graph whose topics have faults; all else is as it is.

    Args:
        backend: the graph.
        faults: of the world.
        clock: of late messages.
    """

    def __init__(self, backend: Backend, faults: "Faults", clock: Clock) -> None:
        self._backend, self._faults, self._clock = backend, faults, clock
        self._made: set[str] = set()

    def __getattr__(self, name: str) -> Any:
        return getattr(self._backend, name)

    def publisher(self, topic: str, *arguments: Any, **keywords: Any) -> Publisher:
        """Make a publisher, a faulty one if the topic has faults."""
        self._made.add(topic)
        publisher = self._backend.publisher(topic, *arguments, **keywords)
        if topic not in self._faults.topics:
            return publisher
        return cast(Publisher, _FaultyPublisher(publisher, topic, self._pass_on))

    def subscription(
        self, topic: str, type_name: str, callback: Callable[[Sample], None], *arguments: Any, **keywords: Any
    ) -> Subscription:
        """Make a subscription, a faulty one if the topic has faults."""
        self._made.add(topic)
        if topic not in self._faults.topics:
            return self._backend.subscription(topic, type_name, callback, *arguments, **keywords)

        def hear(sample: Sample) -> None:
            self._pass_on(topic, sample.message, lambda message: callback(replace(sample, message=message)))

        return self._backend.subscription(topic, type_name, hear, *arguments, **keywords)

    def check(self) -> None:
        """Refuse faults of topics that the world neither publishes nor hears, when it has joined them all.

        Raises:
            UsageError: for the first one.
        """
        for fault in self._faults.by_name.values():
            if fault.topic and fault.topic not in self._made:
                near = difflib.get_close_matches(fault.topic, self._made, 1)
                cure = f"did you mean {near[0]}?" if near else f"its topics: {', '.join(sorted(self._made))}"
                raise UsageError(f"fault {fault.name}: the world has no topic {fault.topic}; {cure}")

    def _pass_on(self, topic: str, message: Any, send: Callable[[Any], None]) -> None:
        passing: Sequence[tuple[float, Any]] = ((0.0, message),)
        for way in self._faults.ways(topic):
            passing = [(late + later, out) for late, each in passing for later, out in way(each)]
        for late, each in passing:
            if late > 0.0:
                self._clock.call_later(late, partial(send, each))
            else:
                send(each)


class _FaultyPublisher:
    """A publisher whose messages pass through faults."""

    def __init__(
        self, publisher: Publisher, topic: str, pass_on: Callable[[str, Any, Callable[[Any], None]], None]
    ) -> None:
        self._publisher, self._topic, self._pass_on = publisher, topic, pass_on

    def __getattr__(self, name: str) -> Any:
        return getattr(self._publisher, name)

    def publish(self, message: Any) -> None:
        """Send what the faults leave of a message."""
        self._pass_on(self._topic, message, self._publisher.publish)
