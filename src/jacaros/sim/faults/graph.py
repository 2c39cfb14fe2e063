"""The ROS graph of a world with faults: messages from and to the world can be lost, late or wrong.

Faults act where the world joins the graph, so they affect agents and all other nodes alike.
"""

import difflib
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import Any, cast

from jacaros.clock import Clock
from jacaros.errors import UsageError
from jacaros.ros.backend import Backend, Publisher, Sample, Subscription
from jacaros.sim.faults.schedule import Faults


class FaultyGraph:
    """A graph whose topics have faults; the rest is unchanged.

    Args:
        backend: the graph.
        faults: of the world.
        clock: for delayed messages.
    """

    def __init__(self, backend: Backend, faults: Faults, clock: Clock) -> None:
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
        """Check, after the world has joined all its topics, that the faults concern no others.

        Raises:
            UsageError: a fault has an unknown topic.
        """
        for fault in self._faults.by_name.values():
            if fault.topic and fault.topic not in self._made:
                near = difflib.get_close_matches(fault.topic, self._made, 1)
                cure = (
                    f"did you mean {near[0]}?"
                    if near
                    else f"topics of the world: {', '.join(sorted(self._made))}"
                )
                raise UsageError(f"fault {fault.name}: unknown topic {fault.topic}; {cure}")

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
    """A publisher whose messages are subject to faults."""

    def __init__(
        self, publisher: Publisher, topic: str, pass_on: Callable[[str, Any, Callable[[Any], None]], None]
    ) -> None:
        self._publisher, self._topic, self._pass_on = publisher, topic, pass_on

    def __getattr__(self, name: str) -> Any:
        return getattr(self._publisher, name)

    def publish(self, message: Any) -> None:
        """Publish a message as the faults change it, if they do not drop it."""
        self._pass_on(self._topic, message, self._publisher.publish)
