"""Where the time of a message is spent in the agents' process on ROS 1: `jacaros run`, with a time stamp at each stop.

Started by ``latency.py ros1 --profile``; prints a table of medians when the run ends.
"""

import functools
import statistics
import sys
import time
from itertools import pairwise
from typing import Any

from jacaros.agents.mind.mind import Mind
from jacaros.robots.artifacts.odometry import Odometer
from jacaros.robots.ros.drivers.ros1.connections import InletTransport
from jacaros.robots.ros.drivers.ros1.streams import Inlet, Outbox
from jacaros.robots.ros.drivers.ros1.topics import Ros1Publisher
from jacaros.robots.ros.node import TopicMultiplexer
from jacaros.runtime.cli.main import main
from jacaros.runtime.mas.agents.host import AgentHost

STOPS: tuple[tuple[type, str, str], ...] = (
    (Inlet, "_read", ""),
    (InletTransport, "_take", "read the socket"),
    (TopicMultiplexer, "_take", "deserialize the message (genpy)"),
    (Odometer, "take", "deliver it to the artifact"),
    (Mind, "perceive", "artifact: read values, step, observation, percepts"),
    (Mind, "run", "give the agent its turn"),
    (AgentHost, "act", "mind: belief, event, plan, step"),
    (Ros1Publisher, "publish", "body, operation, and making the command"),
    (Outbox, "send", "serialize the command (rospy)"),
)
"""Class, method, and what has been done since the stop before when the method is called."""
SENT = "write to the socket"
SLEPT = 0.005
"""Seconds without a message after which the next message finds the process asleep."""

_journey: list[float] = []
_ended: list[float] = [0.0]
_journeys: dict[bool, list[list[float]]] = {True: [], False: []}


def watch(place: int, owner: type, name: str) -> None:
    """Have the method *name* of *owner*, the stop number *place*, note when it is called."""
    method = getattr(owner, name)

    @functools.wraps(method)
    def noting(*arguments: Any, **named: Any) -> Any:
        if place == 0:
            _journey.clear()
        here = len(_journey) == place
        if here:
            _journey.append(time.perf_counter())
        result = method(*arguments, **named)
        if here and place == len(STOPS) - 1:
            end()
        return result

    setattr(owner, name, noting)


def end() -> None:
    """Note that the command has been written."""
    moments = [*_journey, time.perf_counter()]
    slept = moments[0] - _ended[0] > SLEPT
    _journeys[slept].append([later - earlier for earlier, later in pairwise(moments)])
    _ended[0] = moments[-1]


def table() -> str:
    """Return medians in microseconds: after a sleep, and for messages in a row."""
    names = [what for _, _, what in STOPS[1:]] + [SENT]
    columns = [
        [1e6 * statistics.median(steps) for steps in zip(*_journeys[slept], strict=True)]
        for slept in (True, False)
    ]
    lines = [f"{'microseconds, median':52} {'after 10 ms of sleep':>22} {'flat out':>9}"]
    lines += [f"{name:52} {a:22.1f} {b:9.1f}" for name, a, b in zip(names, *columns, strict=True)]
    lines.append(f"{'all':52} {sum(columns[0]):22.1f} {sum(columns[1]):9.1f}")
    return "\n".join(lines)


if __name__ == "__main__":
    for number, (owner, name, _) in enumerate(STOPS):
        watch(number, owner, name)
    sys.argv[0] = "jacaros"
    try:
        main()
    finally:
        print(table() if all(_journeys.values()) else "no message has become a command", file=sys.stderr)
