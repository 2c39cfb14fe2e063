"""Joining a graph for a look: our node, what else is there, and what to say when nothing is."""

import os
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import dataclass

from jacaros.clock import Clock, VirtualClock, WallClock
from jacaros.errors import JacarosError, UsageError
from jacaros.mas.options import RunOptions
from jacaros.mas.ros_graph import RosGraph
from jacaros.ros.backend import Backend
from jacaros.ros.errors import CapabilityMissing, RosError
from jacaros.ros.graph import Endpoint, GraphContents, TopicInfo
from jacaros.ros.middleware import middleware

FIRST_LOOK = 1.0
"""Seconds for which the embedded world runs before it is looked at."""
DISCOVERY = 2.0
"""Seconds that ROS 2 may take to find all nodes."""
PAUSE = 0.5
"""Seconds between two looks; when they see the same, that is all."""


class NothingThere(JacarosError):
    """The graph cannot be reached, or nobody else is in it; the text says what to do."""


@dataclass(frozen=True, slots=True)
class Joined:
    """A graph that we have joined.

    Attributes:
        backend: our node.
        clock: of the graph.
        contents: what else is there.
        timeout: seconds to wait for an answer of somebody.
    """

    backend: Backend
    clock: Clock
    contents: GraphContents
    timeout: float


def clock_for(options: RunOptions) -> Clock:
    """The clock on which the graph is looked at: the embedded world runs as fast as it can."""
    return WallClock() if options.real_graph else VirtualClock()


@asynccontextmanager
async def joined(options: RunOptions, clock: Clock, timeout: float) -> AsyncIterator[Joined]:
    """Join the graph, look at it, and leave it at the end.

    Args:
        options: which graph; on ``memory`` also which world.
        clock: see `clock_for`.
        timeout: seconds after which nothing more is awaited.

    Raises:
        UsageError: options that cannot go together.
        NothingThere: the graph cannot be reached, or is empty.
        BackendUnavailable: the client library is not installed.
    """
    options.check()
    if options.world is not None and options.real_graph:
        raise UsageError("--world goes with --ros memory; start one in a real graph with `jacaros sim`")
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
    """What is there when two looks see the same; where nobody knows all nodes, not before they were found."""
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
    """The graph as it is without one node: ours is there for the look alone."""
    topics = {}
    for name, info in contents.topics.items():
        publishers = _others(info.publishers, node)
        subscriptions = _others(info.subscriptions, node)
        if publishers or subscriptions:
            topics[name] = TopicInfo(name, info.types, publishers, subscriptions)
    nodes = tuple(each for each in contents.nodes if each != node)
    return GraphContents(topics, contents.services, contents.actions, nodes)


def _others(endpoints: tuple[Endpoint, ...], node: str) -> tuple[Endpoint, ...]:
    return tuple(each for each in endpoints if each.node != node)


def _graph_name(options: RunOptions) -> str:
    if options.ros == "ros2":
        return f"ROS 2 graph of domain {options.identity}"
    return f"graph ({options.ros})"
