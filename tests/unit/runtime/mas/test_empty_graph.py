"""The warning about a graph without other nodes."""

import asyncio
from types import SimpleNamespace
from typing import Any

import pytest

from jacaros.robots.ros.backend import Endpoint, GraphContents, TopicInfo
from jacaros.robots.ros.errors import CallFailed
from jacaros.runtime.clock import VirtualClock, run
from jacaros.runtime.mas.graph_warnings import EmptyGraph


@pytest.fixture
def clock() -> VirtualClock:
    return VirtualClock()


@pytest.fixture(autouse=True)
def play(clock: VirtualClock):
    return lambda scene: run(scene, clock)


def watched(contents: GraphContents | Exception, clock: Any, lines: list[str]) -> EmptyGraph:
    """The warning about a graph with these contents."""

    async def look(timeout: float | None = None) -> GraphContents:
        if isinstance(contents, Exception):
            raise contents
        return contents

    backend: Any = SimpleNamespace(node_name="/agents", contents=look)
    return EmptyGraph(backend, clock, "the ROS 2 graph of domain 7", lines.append)


OWN = TopicInfo("/cmd_vel", ("geometry_msgs/msg/Twist",), (Endpoint("/agents"),))


ALONE = GraphContents({}, {}, {}, ("/agents",))


async def test_an_empty_graph_is_reported_once_unless_the_run_has_ended(clock, logs) -> None:
    graph = watched(GraphContents({"/cmd_vel": OWN}, {}, {}, ("/agents",)), clock, logs)
    await clock.sleep(60)
    graph.close()
    (line,) = logs
    assert line.startswith("no other node is in the ROS 2 graph of domain 7; check that the robot is running")
    watched(ALONE, clock, logs).close()
    await clock.sleep(60)
    assert logs == [line]


@pytest.mark.parametrize(
    "contents",
    [
        GraphContents({}, {}, {}, ("/agents", "/robot")),
        GraphContents({"/odom": TopicInfo("/odom", (), (Endpoint(""),))}, {}, {}, ("/agents",)),
        GraphContents({"/cmd_vel": TopicInfo("/cmd_vel", (), (), (Endpoint("/base"),))}, {}, {}, ()),
        CallFailed("no answer"),
    ],
    ids=["a node", "a publisher whose node is not known yet", "a subscription", "nothing is known"],
)
async def test_other_nodes_or_an_unknown_graph_are_not_reported(contents, clock, logs) -> None:
    graph = watched(contents, clock, logs)
    await clock.sleep(60)
    graph.close()
    assert logs == []


class LateClock:
    """A clock whose sleepers wake up late, as those of a loop that is busy with something else."""

    def __init__(self) -> None:
        self.elapsed = 0.0
        self._sleepers: list[tuple[float, asyncio.Future[None]]] = []

    async def sleep(self, delay: float) -> None:
        self._sleepers.append((self.elapsed + delay, asyncio.get_running_loop().create_future()))
        await self._sleepers[-1][1]

    async def ring(self, late: float) -> None:
        """Wake the sleeper this number of seconds late."""
        for _ in range(3):
            await asyncio.sleep(0)
        for when, sleeper in self._sleepers:
            self.elapsed = when + late
            sleeper.set_result(None)
        self._sleepers.clear()


@pytest.mark.parametrize(("late", "seconds"), [(0.0, 3), (0.05, 30)])
async def test_a_busy_loop_gives_others_more_time_to_be_found(late: float, seconds: float, logs) -> None:
    clock = LateClock()
    graph = watched(ALONE, clock, logs)
    while clock.elapsed < seconds - 0.2:
        await clock.ring(late)
        assert logs == []
    for _ in range(3):
        await clock.ring(late)
    assert len(logs) == 1
    graph.close()
