"""The ROS graph of a world with faults: messages of the world can be lost, late or wrong, and goals aborted.

Faults act where the world joins the graph, so they affect agents and all other nodes alike.
"""

import asyncio
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import Any, cast

from jacaros.errors import UsageError
from jacaros.files.texts import suggestion
from jacaros.ros.action import Abort, ActionServer, Execute, ServerGoal
from jacaros.ros.backend import Backend
from jacaros.ros.node import Publisher, Sample, Subscription
from jacaros.runtime.clock import Clock
from jacaros.sim.faults.schedule import Faults


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

    def action_server(
        self,
        action: str,
        type_name: str,
        execute: Execute,
        *arguments: Any,
        **keywords: Any,
    ) -> ActionServer:
        """Offer an action, a faulty one if its goals have faults."""
        self._offered.add(action)
        if action not in self._faults.actions:
            return self._backend.action_server(action, type_name, execute, *arguments, **keywords)

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

        return self._backend.action_server(action, type_name, carry_out, *arguments, **keywords)

    def check(self) -> None:
        """Check, after the world has joined the graph, that the faults concern only its topics and actions.

        Raises:
            UsageError: a fault has an unknown topic or action.
        """
        for fault in self._faults.by_name.values():
            _check_name(fault.name, "topic", fault.topic, self._made)
            _check_name(fault.name, "action", fault.action, self._offered)

    def _pass_on(self, topic: str, message: Any, send: Callable[[Any], None]) -> None:
        passing: Sequence[tuple[float, Any]] = ((0.0, message),)
        for effect in self._faults.effects(topic):
            passing = [(late + later, out) for late, each in passing for later, out in effect(each)]
        for late, each in passing:
            if late > 0.0:
                self._clock.call_later(late, partial(send, each))
            else:
                send(each)


def _check_name(fault: str, what: str, name: str, known: set[str]) -> None:
    if name and name not in known:
        help = suggestion(name, sorted(known), f"{what}s of the world: {', '.join(sorted(known)) or 'none'}")
        raise UsageError(f"fault {fault}: unknown {what} {name}; {help}")


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
