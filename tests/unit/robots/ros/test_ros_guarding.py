"""When a guard stops the robot, and when it lets go of it; and the whole of it on the graph inside the process."""

import asyncio
import math
from collections.abc import Awaitable, Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import pytest

from jacaros.robots.ros.backend import Backend
from jacaros.robots.ros.guard import LEAVING, Brakes, Guard, HeartbeatMonitor
from jacaros.robots.ros.guarded import STAMPED, Guarded
from jacaros.robots.ros.heartbeat import LOCAL, Heartbeat
from jacaros.robots.ros.open import GraphAddress, open_backend
from jacaros.runtime.clock import VirtualClock, WallClock, run
from jacaros.runtime.errors import UsageError
from jacaros.runtime.mas.options import RunOptions

TWIST = "geometry_msgs/msg/Twist"


class Watched:
    """A watch with a time-out of 0.3 s, and what it has done."""

    def __init__(self, armed: bool = True) -> None:
        self.done: list[str] = []
        self.watch = HeartbeatMonitor(0.3, self.done.append, lambda: self.done.append("released"))
        self.watch.connect(10.0)
        self.watch.armed = armed

    def look(self, *times: float) -> list[str]:
        for time in times:
            self.watch.look(time)
        return self.done


@pytest.fixture
def watched() -> Watched:
    """An armed watch."""
    return Watched()


def test_heartbeats_in_time_keep_the_guard_quiet(watched: Watched) -> None:
    for tenth in range(100, 200):
        watched.watch.beat(tenth / 10)
        watched.look(tenth / 10 + 0.09)
    assert watched.done == []


def test_a_heartbeat_that_ceases_trips_the_guard_once_unless_the_agents_drive_nothing(
    watched: Watched,
) -> None:
    assert watched.watch.look(10.1) == pytest.approx(0.2), "it knows when to look again"
    assert watched.look(10.29, 10.31, 10.4, 20.0) == ["no heartbeat from the agents for 0.31 s"]
    assert Watched(armed=False).look(11.0) == []


def test_heartbeats_alone_do_not_release_the_robot(watched: Watched) -> None:
    watched.look(11.0)
    watched.watch.beat(12.0)
    watched.look(12.1)
    assert watched.watch.tripped
    watched.watch.permit()
    assert not watched.watch.tripped
    assert watched.done[1:] == ["released"]


def test_a_process_that_dies_trips_the_guard_immediately_until_new_agents_have_a_permission(
    watched: Watched,
) -> None:
    watched.watch.lose()
    assert watched.done == ["the agents' process died"]
    watched.watch.connect(20.0)
    assert watched.watch.tripped
    watched.watch.permit()
    assert watched.look(20.1, 20.5)[2:] == ["no heartbeat from the agents for 0.50 s"]


def test_a_goodbye_does_not_trip_the_guard(watched: Watched) -> None:
    watched.watch.leave()
    assert watched.look(20.0) == []


def test_agents_that_end_may_be_late_but_not_for_ever(watched: Watched) -> None:
    watched.watch.expect_end()
    assert watched.look(10.0 + LEAVING - 0.1) == []
    assert watched.look(10.0 + LEAVING + 0.1) != []


def test_a_guard_needs_a_real_graph() -> None:
    with pytest.raises(UsageError, match="--guard needs a real ROS graph"):
        RunOptions(guard=True).check()


def test_guard_and_agents_find_each_other_by_graph_and_name(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", "7")
    assert GraphAddress("ros2").identity == GraphAddress("ros2", 7).identity == "7"
    assert GraphAddress("ros2", 8).identity == "8"
    assert GraphAddress("ros1", master="http://a.example:1").identity == "http://a.example:1"
    arguments = " ".join(GraphAddress("ros2", 8, namespace="a").arguments)
    assert arguments == "--ros ros2 --domain-id 8 --namespace a"


class Lab:
    """A guard, the heartbeat of a robot's agents, and the base that hears it all; in real time."""

    guarding: asyncio.Future[None]

    def __init__(self, backend: Backend, base: Backend, path: Path, once: bool = True) -> None:
        self.lines: list[str] = []
        self.heard: list[float] = []
        self.guarded = Guarded()
        self.guard = Guard(backend, "/robot", path, 0.3, once, self.lines.append)
        self.lost: list[bool] = []
        self.heartbeat = Heartbeat(self.guarded, False, lambda: self.lost.append(True))
        self.path, self.base = path, base
        base.subscription("/cmd_vel", TWIST, lambda sample: self.heard.append(sample.message.linear.x))

    async def end(self) -> None:
        """Let the agents leave, and the guard with them."""
        await self.heartbeat.close()
        await self.guarding

    async def connected(self) -> None:
        while True:
            try:
                return await self.heartbeat.connect(self.path)
            except OSError:
                await asyncio.sleep(0.01)

    async def until(self, condition: Callable[[], object]) -> None:
        async with asyncio.timeout(30):
            while not condition():  # noqa: ASYNC110 - what is waited for is another's
                await asyncio.sleep(0.01)


def play(body: Callable[[Lab], Awaitable[None]]) -> None:
    async def main() -> None:
        base: Any = open_backend("memory", WallClock(), "base", log=lambda text: None)
        await base.start()
        backend = open_backend("memory", WallClock(), "guard", log=lambda text: None, graph=base.graph)
        with TemporaryDirectory() as folder:
            lab = Lab(backend, base, Path(folder) / "s")
            lab.guarding = asyncio.ensure_future(lab.guard.run())
            lab.guarded.add_topic("/cmd_vel", TWIST)
            await lab.connected()
            await lab.heartbeat.wait_until_ready()
            await body(lab)
            await lab.end()
        await base.close()

    run(main, WallClock())


Lab.play = staticmethod(play)


async def test_a_guard_sends_zero_until_the_agents_return_and_ends_with_them(lab: Lab) -> None:
    first = lab.heartbeat
    assert first._writer is not None
    first._writer.transport.abort()  # as the death of a process does
    await lab.until(lambda: len(lab.heard) > 3)
    lab.heartbeat = Heartbeat(lab.guarded, False, lambda: None)
    await lab.connected()
    await lab.until(lambda: "/robot: the guard has released the robot" in lab.lines)
    count = len(lab.heard)
    await lab.end()
    assert len(lab.heard) == count
    assert set(lab.heard) == {0.0}
    assert lab.lost == [True]
    assert lab.lines == [
        "warning: /robot: the agents' process died; the guard sends zero velocity to /cmd_vel until they return",
        "/robot: the guard has released the robot",
    ]
    assert not lab.path.exists()


async def test_a_guard_reports_how_many_receivers_it_has_found(lab: Lab) -> None:
    found = lab.guarded.found
    await lab.until(lambda: found == {LOCAL: {"/cmd_vel": 1}})
    lab.guarded.add_topic("/late", TWIST)
    assert not lab.guarded.covered("/late", 1)
    await lab.until(lambda: found == {LOCAL: {"/cmd_vel": 1, "/late": 0}})
    lab.base.subscription("/late", TWIST, lambda sample: None)
    await lab.until(lambda: lab.guarded.covered("/late", 1))


async def test_a_permit_for_an_earlier_trip_does_not_release_the_robot(lab: Lab) -> None:
    lab.guard._watch.look(math.inf)
    first = lab.guard._trip_id
    lab.guard._take({"permit": first})
    lab.guard._watch.look(math.inf)
    lab.guard._take({"permit": first})
    assert lab.guard._watch.tripped
    lab.guard._take({"permit": lab.guard._trip_id})
    assert not lab.guard._watch.tripped


async def test_a_guard_that_dies_before_it_is_ready_does_not_count_as_lost(tmp_path: Path) -> None:
    lost: list[bool] = []
    async with await asyncio.start_unix_server(lambda _, writer: writer.close(), tmp_path / "s"):
        heartbeat = Heartbeat(Guarded(), False, lambda: lost.append(True))
        await heartbeat.connect(tmp_path / "s")
        with pytest.raises(ConnectionError):
            await heartbeat.wait_until_ready()
    assert lost == []


async def test_a_loop_that_is_stuck_trips_the_guard_and_its_motions_are_interrupted(lab: Lab) -> None:
    interrupted: list[bool] = []
    lab.guarded.on_interruption(lambda: interrupted.append(True))
    assert lab.heartbeat._timer is not None
    lab.heartbeat._timer.cancel()
    await lab.until(lambda: interrupted)
    await lab.until(lambda: len(lab.lines) == 2)
    assert lab.heard
    assert "no heartbeat" in lab.lines[0]
    assert lab.lost == []


def test_a_stamped_velocity_carries_the_time_unless_it_is_a_simulators() -> None:
    stamps: list[int] = []

    async def main() -> None:
        backend = open_backend("memory", clock, "guard", log=lambda text: None)
        await backend.start()
        backend.subscription("/s", STAMPED, lambda sample: stamps.append(sample.message.header.stamp.sec))
        brakes = Brakes(backend, lambda text: None)
        brakes.cover([("/s", STAMPED)], [])
        for simulated in (False, True):
            brakes.simulated_time = simulated
            brakes.stop()
            await clock.sleep(0.1)
        await backend.close()

    clock = VirtualClock()
    run(main, clock)
    assert stamps == [int(clock.start), 0]
