"""The warning about a simulator whose clock the run does not follow."""

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import pytest

from jacaros.robots.ros.errors import ParameterUnknown, ServiceUnavailable
from jacaros.robots.ros.node import Capability
from jacaros.runtime.clock import VirtualClock, run
from jacaros.runtime.mas.graph_warnings import GraphTime


class Graph:
    """A ROS 1 graph whose master may set ``use_sim_time``, and appears late."""

    ros_version = 1
    capabilities = frozenset({Capability.PARAMETERS})
    connected = False

    def __init__(self, simulated: bool | Exception) -> None:
        self._simulated = simulated
        self.asked = 0
        self.tell: Callable[[bool], None] = lambda present: None
        self.clock: Callable[[object], None] | None = None

    def on_connection(self, callback: Callable[[bool], None]) -> None:
        self.tell = callback

    def subscription(self, topic: str, _type: str, callback: Callable[[object], None], _qos: object) -> Any:
        self.clock = callback
        return SimpleNamespace(close=lambda: setattr(self, "clock", None))

    def parameters(self, node: str) -> Any:
        assert node == "/"
        return SimpleNamespace(get=self._get)

    async def _get(self, name: str, timeout: float) -> bool:
        assert (name, timeout > 0) == ("use_sim_time", True)
        self.asked += 1
        if isinstance(self._simulated, Exception):
            raise self._simulated
        return self._simulated


def told(graph: Any, clock_comes: bool = False) -> list[str]:
    """The log for a graph whose master is found after a while."""
    lines: list[str] = []
    clock = VirtualClock()

    async def main() -> None:
        time = GraphTime(graph, lines.append)
        await clock.sleep(1)
        assert graph.asked == 0
        for present in (True, False, True):
            graph.tell(present)
            await clock.sleep(1)
        if clock_comes and graph.clock is not None:
            graph.clock("a time")
        time.close()
        assert graph.clock is None

    run(main, clock)
    return lines


@pytest.mark.parametrize("clock_comes", [False, True])
def test_a_simulators_clock_is_reported_once_in_a_run_in_real_time(clock_comes: bool) -> None:
    graph = Graph(True)
    (line,) = told(graph, clock_comes)
    assert "use_sim_time" in line
    assert "run with --clock ros" in line
    assert graph.asked == 1


@pytest.mark.parametrize("says", [False, ParameterUnknown("none"), ServiceUnavailable("gone")])
def test_real_time_causes_no_warning(says: bool | Exception) -> None:
    assert told(Graph(says)) == []


def test_a_clock_alone_is_reported() -> None:
    (line,) = told(Graph(ParameterUnknown("none")), clock_comes=True)
    assert "a simulator publishes its time on /clock" in line
