"""The ROS graph of a run and the world on it."""

import asyncio
from collections.abc import Callable
from functools import partial
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from jacaros.robots.ros.errors import BackendUnavailable
from jacaros.robots.ros.open import open_backend as _open
from jacaros.robots.world import RobotEvent, WorldError
from jacaros.runtime.clock import WallClock, clock_of
from jacaros.runtime.mas.options import RunOptions
from jacaros.runtime.mas.ros_graph import RosGraph

Opened = Callable[[Callable[..., Any]], None]


def graph(own: str | Path | None = None, **options: Any) -> RosGraph:
    clock = clock_of(asyncio.get_running_loop())
    return RosGraph(RunOptions(**options), clock, "my system", own, lambda text: None)


async def test_nothing_is_created_before_its_first_use() -> None:
    ros = graph(seed=42)
    await ros.start()
    assert ros.world is None
    backend = ros.backend()
    assert ros.backend() is backend
    assert backend.node_name == "/my_system"
    assert ros.world is not None
    assert ros.world.description.name == "empty"
    assert ros.world.description.seed == 42, "the seed of the run"
    await ros.close()


async def test_the_robots_of_the_world_publish_topics() -> None:
    heard: list[float] = []
    ros = graph()
    ros.backend().subscription("/odom", "nav_msgs/msg/Odometry", lambda sample: heard.append(sample.stamp))
    await asyncio.sleep(1.02)
    await ros.close()
    assert len(heard) == 20


async def test_a_named_world_is_made_at_the_start() -> None:
    for ros in (graph("patrol"), graph("house", world="patrol"), graph(show_world=True)):
        await ros.start()
        assert ros.world is not None
        assert ros.world.description.name in ("patrol", "empty")
        await ros.close()
    with pytest.raises(WorldError, match="world not found: `nowhere`"):
        await graph("nowhere").start()


@pytest.fixture
def opened(monkeypatch: pytest.MonkeyPatch) -> Opened:
    """Let another function open backends."""
    return partial(monkeypatch.setattr, "jacaros.robots.ros.open.open_backend")


async def test_a_missing_library_is_reported_at_the_start(opened: Opened) -> None:
    def missing(*_: object, **__: object) -> None:
        raise BackendUnavailable("no rclpy")

    opened(missing)
    with pytest.raises(BackendUnavailable):
        await graph(ros="ros2").start()


class Elsewhere:
    """A real graph, as far as it matters here."""

    started = closed = connected = False
    ros_version = 2
    capabilities: frozenset[str] = frozenset()
    listening: Callable[[object], None] | None = None

    def after_delivery(self, callback: Callable[[], None]) -> None:
        del callback

    async def start(self) -> None:
        self.started = True

    async def close(self) -> None:
        self.closed = True

    def subscription(
        self, topic: str, type_name: str, callback: Callable[[object], None], qos: object
    ) -> Any:
        assert topic == "/clock"
        self.listening = callback
        return SimpleNamespace(close=lambda: setattr(self, "listening", None))


async def test_a_simulator_that_is_not_followed_is_reported_once(opened: Opened, logs: list[str]) -> None:
    backend = Elsewhere()
    opened(lambda *_, **__: backend)
    ros = RosGraph(RunOptions(ros="ros2"), WallClock(), "my system", None, logs.append)
    await ros.start()
    hear = backend.listening
    assert hear is not None
    hear("a time")
    hear("another that was on its way")
    assert backend.listening is None
    await ros.close()
    assert len(logs) == 1
    assert "run with --clock ros" in logs[0]


async def test_on_a_real_graph_the_projects_own_world_is_not_created(opened: Opened) -> None:
    backend = Elsewhere()
    opened(lambda *_, **__: backend)
    ros = graph("patrol", ros="ros2")
    await ros.start()
    assert backend.started
    assert ros.world is None
    assert ros.backend() is backend
    await ros.close()
    assert backend.closed
    opened(lambda _, *args, **kw: _open("memory", *args, **kw))
    ros = graph("nowhere", ros="ros1")
    await ros.start()
    assert ros.world is None
    await ros.close()


@pytest.mark.parametrize(("asked", "kept"), [(False, 2000), (True, 3000)])
async def test_the_ground_truth_is_kept_only_on_request(asked: bool, kept: int) -> None:
    ros = graph(keep_ground_truth=asked)
    ros.backend()
    assert ros.world is not None
    truth = ros.world.ground_truth
    for number in range(3000):
        truth.record_event(RobotEvent(number, "", "door_opened", 0.0, 0.0, 0.0, {"door": "gate"}))
    assert (len(truth.events) >= 3000) == asked
    assert len(truth.events) <= kept
    await ros.close()
