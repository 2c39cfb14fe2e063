"""The ROS graph of a world with faults: messages of the world can be lost, late or wrong, and goals aborted.

Faults act where the world joins the graph, so they affect agents and all other nodes alike.
"""

import asyncio
import copy
import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from functools import partial
from typing import Any, cast

from jacaros.robots.ros.action import Abort, ActionPolicy, ActionServer, ExecuteCallback, ServerGoal
from jacaros.robots.ros.backend import Backend
from jacaros.robots.ros.message import field_names
from jacaros.robots.ros.node import Publisher, Sample, Subscription
from jacaros.robots.ros.qos import DEFAULT_QOS, QoS
from jacaros.robots.world.physics.faults import Faults, TopicFault
from jacaros.runtime.clock import Clock
from jacaros.runtime.errors import UsageError
from jacaros.runtime.files.texts import suggestion

_KEPT = frozenset(
    {"header", "angle_min", "angle_max", "angle_increment", "range_min", "range_max", "scan_time"}
)
"""Fields that describe a sensor and are not measurements."""
Late = tuple[float, Any]
"""A message, with its delay in seconds."""


def disturbed(by: TopicFault, message: Any) -> Sequence[Late]:
    """Return what a fault delivers instead of a message."""
    fault = by.fault
    match fault.kind:
        case "dead":
            return ()
        case "frozen":
            if by.first is None:
                by.first = copy.deepcopy(message)
                return ((0.0, message),)
            repeated = copy.deepcopy(by.first)
            if hasattr(message, "header"):
                repeated.header.stamp = message.header.stamp
            return ((0.0, repeated),)
        case "nan":
            return ((0.0, _without_numbers(copy.deepcopy(message))),)
        case "lost":
            return () if by.draw() < fault.share else ((0.0, message),)
        case "delayed":
            return ((fault.seconds + fault.jitter * by.draw(), message),)
    return [(0.0, message)] * fault.copies


def _without_numbers(message: Any) -> Any:
    """Set all floating-point measurements to NaN."""
    for name in field_names(message) or ():
        value = getattr(message, name)
        if name in _KEPT or "covariance" in name:
            continue
        if isinstance(value, float):
            setattr(message, name, math.nan)
        elif field_names(value):
            _without_numbers(value)
        elif not isinstance(value, str | bytes) and isinstance(value, Iterable):
            # For arrays, the items as Python values.
            items = list(getattr(value, "tolist", value.__iter__)())
            if items and all(isinstance(item, float) for item in items):
                setattr(message, name, [math.nan] * len(items))
    return message


class FaultyGraph:
    """A graph with faults on some topics and actions; everything else is unchanged.

    Args:
        backend: the graph.
        faults: faults of the world.
        clock: clock for delayed messages.
    """

    def __init__(self, backend: Backend, faults: Faults, clock: Clock) -> None:
        self._backend, self._faults, self._clock = backend, faults, clock
        self._made: set[str] = set()
        self._offered: set[str] = set()

    def __getattr__(self, name: str) -> Any:
        return getattr(self._backend, name)

    def publisher(self, topic: str, type_name: str, qos: QoS = DEFAULT_QOS) -> Publisher:
        """Make a publisher, a faulty one if the topic has faults."""
        self._made.add(topic)
        publisher = self._backend.publisher(topic, type_name, qos)
        if topic not in self._faults.topics:
            return publisher
        return cast(Publisher, _FaultyPublisher(publisher, partial(self._pass_on, topic, publisher.publish)))

    def subscription(self, topic: str, type_name: str, callback: Callable[[Sample], None]) -> Subscription:
        """Make a subscription, a faulty one if the topic has faults."""
        self._made.add(topic)

        def hear(sample: Sample) -> None:
            self._pass_on(topic, lambda message: callback(replace(sample, message=message)), sample.message)

        return self._backend.subscription(
            topic, type_name, hear if topic in self._faults.topics else callback
        )

    def action_server(
        self, action: str, type_name: str, execute: ExecuteCallback, policy: ActionPolicy
    ) -> ActionServer:
        """Offer an action, a faulty one if its goals have faults."""
        self._offered.add(action)
        if action not in self._faults.actions:
            return self._backend.action_server(action, type_name, execute, policy)

        async def carry_out(goal: ServerGoal) -> Any:
            aborted: list[str] = []
            work = asyncio.ensure_future(execute(goal))

            def abort(fault: str) -> None:
                aborted.append(f"aborted by the fault {fault}")
                work.cancel()

            end = self._faults.watch_goal(action, abort)
            try:
                return await work
            except asyncio.CancelledError:
                if not aborted:
                    raise
                raise Abort(aborted[0]) from None
            finally:
                end()

        return self._backend.action_server(action, type_name, carry_out, policy)

    def check(self) -> None:
        """Check, after the world has joined the graph, that the faults concern only its topics and actions.

        Raises:
            UsageError: a fault has an unknown topic or action.
        """
        for fault in self._faults.by_name.values():
            _check_name(fault.name, "topic", fault.topic, self._made)
            _check_name(fault.name, "action", fault.action, self._offered)

    def _pass_on(self, topic: str, send: Callable[[Any], None], message: Any) -> None:
        passing: Sequence[Late] = ((0.0, message),)
        for fault in self._faults.disturbances(topic):
            before = passing
            passing = [(late + later, out) for late, each in passing for later, out in disturbed(fault, each)]
            if _ids(passing) != _ids(before):
                self._faults.acts(fault.fault.name)
        for late, each in passing:
            if late > 0.0:
                self._clock.call_later(late, partial(send, each))
            else:
                send(each)


def _ids(messages: Sequence[Late]) -> list[tuple[float, int]]:
    return [(late, id(message)) for late, message in messages]


def _check_name(fault: str, what: str, name: str, known: set[str]) -> None:
    if name and name not in known:
        help = suggestion(name, sorted(known), f"{what}s of the world: {', '.join(sorted(known)) or 'none'}")
        raise UsageError(f"fault {fault}: unknown {what} {name}; {help}")


class _FaultyPublisher:
    def __init__(self, publisher: Publisher, publish: Callable[[Any], None]) -> None:
        self._publisher = publisher
        self.publish = publish

    def __getattr__(self, name: str) -> Any:
        return getattr(self._publisher, name)
