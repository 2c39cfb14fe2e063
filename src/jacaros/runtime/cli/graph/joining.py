"""Join a graph to inspect it, and listen to it: one message of a topic, rates, frames."""

import asyncio
import os
from collections.abc import AsyncIterator, Callable, Iterable
from contextlib import AbstractContextManager, ExitStack, asynccontextmanager, closing, suppress
from dataclasses import dataclass
from typing import Any

from jacaros.robots.ros.backend import Backend, GraphContents, TopicInfo
from jacaros.robots.ros.errors import CapabilityMissing, RosError
from jacaros.robots.ros.middleware import middleware
from jacaros.robots.ros.node import Sample, Subscription
from jacaros.robots.ros.qos import QoS
from jacaros.robots.ros.tf import ALL_STATIC, MESSAGE
from jacaros.robots.ros.waiting import within
from jacaros.runtime.cli.usage import usage_error
from jacaros.runtime.clock import Clock, VirtualClock, WallClock
from jacaros.runtime.errors import JacarosError
from jacaros.runtime.mas.options import RunOptions
from jacaros.runtime.mas.ros_graph import RosGraph

FIRST_LOOK = 1.0
"""Seconds for which the embedded world runs before its graph is read."""
DISCOVERY = 2.0
"""Seconds that ROS 2 may take to discover all nodes."""
PAUSE = 0.5
"""Seconds between two readings; the graph is complete when they are equal."""
RATE_OVER = 2.0
"""Seconds for which messages are counted."""
FRAMES_OVER = 2.0
"""Seconds in which each moving frame is published at least once (trees as in REP 105 are published at 10 Hz or more)."""

_FRAMES = {"/tf": QoS("best_effort", depth=100), "/tf_static": ALL_STATIC}
"""Many nodes publish frames at the same time, each its own."""


class NothingThere(JacarosError):
    """Raised when the graph is unreachable or has no other node; the text suggests what to do."""


@dataclass(frozen=True, slots=True)
class Joined:
    """A graph that our node has joined.

    Attributes:
        backend: our node.
        clock: of the graph.
        contents: the graph without our node.
        timeout: seconds to wait for a reply.
    """

    backend: Backend
    clock: Clock
    contents: GraphContents
    timeout: float


def clock_for(options: RunOptions) -> Clock:
    """Return the clock for inspecting a graph: the embedded world runs as fast as possible."""
    return WallClock() if options.real_graph else VirtualClock()


@asynccontextmanager
async def joined(options: RunOptions, clock: Clock, timeout: float) -> AsyncIterator[Joined]:
    """Join a graph, read it, and leave it at the end.

    Args:
        options: kind and address of the graph; for ``memory`` also the world.
        clock: see `clock_for`.
        timeout: seconds to wait for nodes and replies.

    Raises:
        UsageError: the options cannot be combined.
        NothingThere: the graph is unreachable or empty.
        BackendUnavailable: the client library is not installed.
    """
    options.check()
    if options.world is not None and options.real_graph:
        raise usage_error("--world needs --ros memory", "`jacaros sim` runs a world in a real graph")
    graph = RosGraph(options, clock, f"jacaros_ros_{os.getpid()}", None, lambda line: None)
    try:
        await graph.start()
        backend = graph.backend()
        contents = await _look(backend, clock, options, timeout)
        yield Joined(backend, clock, contents, timeout)
    finally:
        await graph.close()


async def _look(backend: Backend, clock: Clock, options: RunOptions, timeout: float) -> GraphContents:
    kind = middleware(options.ros)
    try:
        seen = await _settled(backend, clock, timeout)
    except CapabilityMissing:
        raise
    except RosError as error:
        raise NothingThere(f"{error}. {kind.unreachable}".rstrip()) from error
    if not (seen.topics or seen.services or seen.actions or seen.nodes):
        help = kind.deserted or kind.unreachable
        raise NothingThere(f"no other node is in the {_graph_name(options)}. {help}".rstrip())
    return seen


async def _settled(backend: Backend, clock: Clock, timeout: float) -> GraphContents:
    """Return the graph when two readings are equal; where discovery takes time, not before it may be complete."""
    if clock.virtual:
        await clock.sleep(FIRST_LOOK)
        return without(await backend.contents(timeout), backend.node_name)
    begin = clock.elapsed
    found = without(await backend.contents(timeout), backend.node_name)
    if backend.ros_version == 1:
        return found
    while clock.elapsed - begin < timeout:
        await clock.sleep(PAUSE)
        before, found = found, without(await backend.contents(timeout), backend.node_name)
        if found == before and found.nodes and clock.elapsed - begin >= DISCOVERY:
            break
    return found


def without(contents: GraphContents, node: str) -> GraphContents:
    """Return the graph without one node: ours joined only to inspect it."""
    topics = {}
    for name, info in contents.topics.items():
        publishers, subscriptions = (
            tuple(each for each in ends if each.node != node)
            for ends in (info.publishers, info.subscriptions)
        )
        if publishers or subscriptions:
            topics[name] = TopicInfo(name, info.types, publishers, subscriptions)
    nodes = tuple(each for each in contents.nodes if each != node)
    return GraphContents(topics, contents.services, contents.actions, nodes)


def _graph_name(options: RunOptions) -> str:
    if options.ros == "ros2":
        return f"ROS 2 graph of domain {options.identity}"
    return f"graph ({options.ros})"


def hearing(info: TopicInfo) -> QoS:
    """Return the quality of service to receive from all publishers, latched messages included if all of them latch."""
    offers = [each.qos for each in info.publishers]
    keeps = bool(offers) and all(qos is not None and qos.durability == "transient_local" for qos in offers)
    sure = bool(offers) and all(qos is not None and qos.reliability == "reliable" for qos in offers)
    return QoS("reliable" if sure else "best_effort", "transient_local" if keeps else "volatile", 5)


def _receive(
    joined: Joined, topic: str, type_name: str, take: Callable[[Sample], None], qos: QoS
) -> AbstractContextManager[Subscription]:
    """Call *take* with the messages of a topic during a ``with`` statement."""
    return closing(joined.backend.subscription(topic, type_name, take, qos, on_event=lambda event: None))


async def one_message(joined: Joined, info: TopicInfo, timeout: float) -> Any:
    """Return the next message of a topic; None after *timeout* seconds."""
    heard: asyncio.Future[Any] = asyncio.get_running_loop().create_future()

    def take(sample: Sample) -> None:
        if not heard.done():
            heard.set_result(sample.message)

    with _receive(joined, info.name, info.types[0], take, hearing(info)), suppress(TimeoutError):
        return await within(joined.clock, heard, timeout)
    return None


async def rates(joined: Joined, topics: Iterable[TopicInfo]) -> dict[str, float]:
    """Return the rates of topics in Hz, measured for `RATE_OVER` seconds, without topics that cannot be received."""
    stamps: dict[str, list[float]] = {}

    def count(sample: Sample) -> None:
        stamps[sample.topic].append(sample.stamp)

    with ExitStack() as received:
        for info in topics:
            if info.publishers and len(info.types) == 1:
                with suppress(RosError):  # the type is not installed
                    received.enter_context(
                        _receive(joined, info.name, info.types[0], count, QoS("best_effort"))
                    )
                    stamps[info.name] = []
        await joined.clock.sleep(RATE_OVER)
    return {name: _rate(times) for name, times in stamps.items()}


def _rate(times: list[float]) -> float:
    """Return the rate in Hz, with one decimal."""
    if len(times) < 2 or times[-1] <= times[0]:
        return round(len(times) / RATE_OVER, 1)
    return round((len(times) - 1) / (times[-1] - times[0]), 1)


async def frames(joined: Joined) -> dict[str, str]:
    """Return the frames on ``/tf`` and ``/tf_static``, each with its parent; the parent of a root is empty."""
    found: dict[str, str] = {}

    def take(sample: Sample) -> None:
        for each in sample.message.transforms:
            parent = each.header.frame_id.lstrip("/")
            found[each.child_frame_id.lstrip("/")] = parent
            found.setdefault(parent, "")

    topics = joined.contents.topics
    # Some nodes publish static frames only once the other frames have a subscription, so they may not be publishers yet.
    if any(name in topics and topics[name].publishers for name in _FRAMES):
        with ExitStack() as received:
            for name, qos in _FRAMES.items():
                with suppress(RosError):
                    received.enter_context(_receive(joined, name, MESSAGE, take, qos))
            await joined.clock.sleep(FRAMES_OVER)
    return found


def root(frames: dict[str, str], frame: str) -> str:
    """Return the root of the tree that contains *frame*."""
    seen = {frame}
    while (parent := frames.get(frame, "")) and parent not in seen:
        seen.add(parent)
        frame = parent
    return frame
