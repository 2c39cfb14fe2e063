"""Topics of a robot's state, described once and published for each robot."""

from collections.abc import Callable, Mapping
from typing import Any

from jacaros.robots.ros.message import constant
from jacaros.robots.world.graph.on_graph import RobotOnGraph

FillMessage = Callable[[RobotOnGraph, Any], object]
"""Writes the state of a robot into a message."""
FieldsOf = Callable[[RobotOnGraph], Mapping[str, Any]]
Tick = Callable[[int], object]
"""Publishes if due at a tick of 20 Hz, after the world has caught up."""
Sensor = Callable[[RobotOnGraph], Tick]
"""Makes the topics of a sensor for one robot."""


def _nothing(at: RobotOnGraph, message: Any) -> None:
    """The fields say it all."""


def _no_fields(at: RobotOnGraph) -> Mapping[str, Any]:
    return {}


def sensor(
    topic: str,
    type_name: str,
    fill: FillMessage = _nothing,
    every: int = 1,
    *,
    fields: FieldsOf = _no_fields,
    frame: str = "base_link",
    changed: Callable[[RobotOnGraph], object] = bool,
    always: bool = False,
    optional: bool = False,
) -> Sensor:
    """Describe a topic that is published while there are subscriptions.

    Args:
        topic: name below the robot's namespace.
        type_name: message type.
        fill: fills a message, whose header has the time of the world.
        fields: returns fields to make the message with, such as long arrays, which are converted then.
        every: ticks between two messages.
        frame: of the header; "" for a message without one.
        changed: a state whose changes are published immediately.
        always: whether it is published without subscriptions, too.
        optional: whether the type need not be installed.
    """

    def start(at: RobotOnGraph) -> Tick:
        publisher = at.publisher(topic, type_name, optional=optional)
        before: object = None

        def publish(ticks: int) -> None:
            nonlocal before
            state = changed(at)
            due, before = ticks % every == 0 or state != before, state
            if due and (always or publisher.subscription_count):
                message = publisher.message(**fields(at))
                if frame:
                    at.fill_header(message.header, frame)
                fill(at, message)
                publisher.publish(message)

        return publish

    return start


def events(
    topic: str,
    type_name: str,
    active: Callable[[RobotOnGraph], frozenset[str]],
    field: str,
    states: tuple[str, str],
) -> Sensor:
    """Describe a topic with a message for each change of a switch of the robot.

    Args:
        topic: name below the robot's namespace.
        type_name: message type, with constants for switches and states.
        active: returns the active switches.
        field: field that names the switch.
        states: states of an inactive and of an active switch.
    """

    def start(at: RobotOnGraph) -> Tick:
        publisher = at.publisher(topic, type_name, optional=True)
        before: frozenset[str] = frozenset()

        def publish(ticks: int) -> None:
            nonlocal before
            if not publisher.subscription_count:
                return
            now = active(at)
            for switch in sorted(now ^ before):
                message = publisher.message()
                setattr(message, field, constant(message, switch))
                message.state = constant(message, states[switch in now])
                publisher.publish(message)
            before = now

        return publish

    return start
