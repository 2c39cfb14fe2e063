"""Join a graph to inspect it, and report what to do if it is empty or unreachable."""

import os
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import dataclass

from jacaros.cli.usage import usage_error
from jacaros.errors import JacarosError
from jacaros.mas.options import RunOptions
from jacaros.mas.ros_graph import RosGraph
from jacaros.ros.backend import Backend, Endpoint, GraphContents, TopicInfo
from jacaros.ros.errors import CapabilityMissing, RosError
from jacaros.ros.middleware import middleware
from jacaros.runtime.clock import Clock, VirtualClock, WallClock

FIRST_LOOK = 1.0
"""Seconds for which the embedded world runs before its graph is read."""
DISCOVERY = 2.0
"""Seconds that ROS 2 may take to discover all nodes."""
PAUSE = 0.5
"""Seconds between two readings; the graph is complete when they are equal."""


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
