"""The ROS graph of a run and the world on it."""

from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from jacaros.robots.ros.errors import BackendUnavailable
from jacaros.robots.ros.open import open_backend as _open
from jacaros.robots.world import RobotEvent, WorldError
from jacaros.runtime.clock import VirtualClock, WallClock, run
from jacaros.runtime.mas.options import RunOptions
from jacaros.runtime.mas.ros_graph import RosGraph


def graph(clock: VirtualClock, own: str | Path | None = None, **options: Any) -> RosGraph:
    return RosGraph(RunOptions(**options), clock, "my system", own, lambda text: None)


def test_nothing_is_created_before_its_first_use() -> None:
    clock = VirtualClock()

    async def main() -> None:
        ros = graph(clock)
        await ros.start()
        assert ros.world is None
        backend = ros.backend()
        assert ros.backend() is backend
        assert backend.node_name == "/my_system"
        assert ros.world is not None
        assert ros.world.description.name == "empty"
        await ros.close()

    run(main, clock)


def test_the_robots_of_the_world_publish_topics() -> None:
    clock = VirtualClock()
    heard: list[float] = []

    async def main() -> None:
        ros = graph(clock)
        ros.backend().subscription(
            "/odom", "nav_msgs/msg/Odometry", lambda sample: heard.append(sample.stamp)
        )
        await clock.sleep(1.02)
        await ros.close()

    run(main, clock)
    assert len(heard) == 20


def test_a_named_world_is_made_at_the_start() -> None:
    clock = VirtualClock()

    async def main() -> None:
        for ros in (
            graph(clock, "patrol"),
            graph(clock, "house", world="patrol"),
            graph(clock, show_world=True),
        ):
            await ros.start()
            assert ros.world is not None
            assert ros.world.description.name in ("patrol", "empty")
            await ros.close()

    run(main, clock)


def test_the_seed_of_the_run_is_that_of_the_world() -> None:
    clock = VirtualClock()

    async def main() -> None:
        ros = graph(clock, seed=42)
        ros.backend()
        assert ros.world is not None
        assert ros.world.description.seed == 42
        await ros.close()

    run(main, clock)


def test_an_invalid_world_is_reported_at_the_start() -> None:
    clock = VirtualClock()

    async def main() -> None:
        with pytest.raises(WorldError, match="world not found: `nowhere`"):
            await graph(clock, "nowhere").start()

    run(main, clock)


def test_a_missing_library_is_reported_at_the_start(monkeypatch: pytest.MonkeyPatch) -> None:
    def missing(*_: object, **__: object) -> None:
        raise BackendUnavailable("no rclpy")

    monkeypatch.setattr("jacaros.robots.ros.open.open_backend", missing)
    clock = VirtualClock()

    async def main() -> None:
        with pytest.raises(BackendUnavailable):
            await graph(clock, ros="ros2").start()

    run(main, clock)


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


def test_a_simulator_that_is_not_followed_is_reported_once(monkeypatch: pytest.MonkeyPatch) -> None:
    backend, lines = Elsewhere(), list[str]()
    monkeypatch.setattr("jacaros.robots.ros.open.open_backend", lambda *_, **__: backend)

    async def main() -> None:
        ros = RosGraph(RunOptions(ros="ros2"), WallClock(), "my system", None, lines.append)
        await ros.start()
        hear = backend.listening
        assert hear is not None
        hear("a time")
        hear("another that was on its way")
        assert backend.listening is None
        await ros.close()

    run(main, VirtualClock())
    assert len(lines) == 1
    assert "run with --clock ros" in lines[0]


def test_on_a_real_graph_the_projects_own_world_is_not_created(monkeypatch: pytest.MonkeyPatch) -> None:
    backend = Elsewhere()
    monkeypatch.setattr("jacaros.robots.ros.open.open_backend", lambda *_, **__: backend)
    clock = VirtualClock()

    async def main() -> None:
        ros = graph(clock, "patrol", ros="ros2")
        await ros.start()
        assert backend.started
        assert ros.world is None
        assert ros.backend() is backend
        await ros.close()
        assert backend.closed

    run(main, clock)


@pytest.mark.parametrize(("asked", "kept"), [(False, 2000), (True, 3000)])
def test_the_ground_truth_is_kept_only_on_request(asked: bool, kept: int) -> None:
    clock = VirtualClock()

    async def main() -> None:
        ros = graph(clock, keep_ground_truth=asked)
        ros.backend()
        assert ros.world is not None
        truth = ros.world.ground_truth
        for number in range(3000):
            truth.record_event(RobotEvent(number, "", "door_opened", 0.0, 0.0, 0.0, {"door": "gate"}))
        assert (len(truth.events) >= 3000) == asked
        assert len(truth.events) <= kept
        await ros.close()

    run(main, clock)


def test_a_real_graph_ignores_the_world_of_the_project(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = VirtualClock()
    monkeypatch.setattr(
        "jacaros.robots.ros.open.open_backend", lambda _, *args, **kw: _open("memory", *args, **kw)
    )

    async def main() -> None:
        ros = graph(clock, "nowhere", ros="ros1")
        await ros.start()
        assert ros.world is None
        await ros.close()

    run(main, clock)
