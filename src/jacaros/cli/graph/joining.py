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

FIRST_LOOK = 1.0
"""Seconds for which the embedded world runs before it is looked at."""
DISCOVERY = 2.0
"""Seconds that ROS 2 may take to find all nodes."""
PAUSE = 0.5
"""Seconds between two looks; when they see the same, that is all."""


_WORLDS = {
    "memory": "give it a world: --world house",
    "ros1": "a world: jacaros sim house --ros ros1",
    "rosbridge": "a world in the graph of the bridge: jacaros sim house --ros ros1 (or ros2)",
}


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
    try:
        seen = await _settled(backend, clock, timeout)
    except CapabilityMissing:
        raise
    except RosError as error:
        raise NothingThere(f"{error}. {_cure(options)}") from error
    if not (seen.topics or seen.services or seen.actions or seen.nodes):
        cure = _cure(options) if options.ros == "ros2" else f"Start the robot, or {_WORLDS[options.ros]}"
        raise NothingThere(f"nobody else is in the {_graph_name(options)}. {cure}")
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
        return f"ROS 2 graph of domain {_domain(options)}"
    return f"graph ({options.ros})"


def _domain(options: RunOptions) -> str:
    given = options.domain_id
    return os.environ.get("ROS_DOMAIN_ID", "0") if given is None else str(given)


def _cure(options: RunOptions) -> str:
    if options.ros == "ros2":
        return (
            "Is the robot, or `jacaros sim house --ros ros2`, running? It must have the same domain (--domain-id N or "
            "ROS_DOMAIN_ID) and the same ROS_AUTOMATIC_DISCOVERY_RANGE; a long --timeout helps on slow networks"
        )
    if options.ros == "ros1":
        return "Start the robot or `roscore`, or say where its master is: --master http://robot.lab.example:11311"
    return "Start rosbridge on the robot, or say where it is: --bridge ws://robot.lab.example:9090"
