"""A guard on the robot's computer: the heartbeat over the graph, in real time."""

import asyncio
from collections.abc import Awaitable, Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import pytest

from jacaros.robots.ros import heartbeat
from jacaros.robots.ros.guard import NETWORK_TIMEOUT, Guard, HeartbeatMonitor
from jacaros.robots.ros.guarded import Guarded, guarded_by
from jacaros.robots.ros.heartbeat import TEXT, GraphHeartbeat, Heartbeat, topics_of
from jacaros.robots.ros.node import Publisher
from jacaros.robots.ros.open import open_backend
from jacaros.runtime.clock import WallClock, run

TWIST = "geometry_msgs/msg/Twist"
FORWARD = {"linear": {"x": 0.3}}


class Lab:
    """Agents at one end of a network, a guard and a base at the other.

    Attributes:
        heard: velocities that the base received.
    """

    def __init__(self, agents: Any, guard: Any, path: Path) -> None:
        self.backend, self.path = agents, path
        self._ends: list[Callable[[], None]] = []
        self.lines: list[str] = []
        self.logged: list[str] = []
        self.heard: list[float] = []
        self.interrupted = 0
        self.guard = Guard(guard, "/agents", path, None, False, self.lines.append)
        self.guarded = guarded_by(agents)
        self.guarded.on_interruption(self._interrupt)
        self.wheels: Publisher = agents.publisher("/cmd_vel", TWIST)
        self.guarded.add_topic("/cmd_vel", TWIST)
        self.guarded.watch(self.wheels)
        self.heartbeat = self.new_heartbeat()

    def _interrupt(self) -> None:
        self.interrupted += 1

    def new_heartbeat(self) -> GraphHeartbeat:
        return GraphHeartbeat(self.backend, False, self.logged.append)

    def cut(self) -> None:
        """Lose the network: heartbeat and answers no longer arrive."""
        self._ends = [self.backend.graph.disturb(topic, lambda _: ()) for topic in topics_of("/agents")]

    def mend(self) -> None:
        """End `cut`."""
        for end in self._ends:
            end()

    @property
    def state(self) -> HeartbeatMonitor:
        return self.guard._watch

    async def until(self, condition: Callable[[], object]) -> None:
        async with asyncio.timeout(30):
            while not condition():  # noqa: ASYNC110 - what is waited for is another's
                await asyncio.sleep(0.01)


def play(body: Callable[[Lab], Awaitable[None]]) -> None:
    async def main() -> None:
        base: Any = open_backend("memory", WallClock(), "base", log=lambda text: None)
        await base.start()
        agents = open_backend("memory", WallClock(), "agents", log=lambda text: None, graph=base.graph)
        guard = open_backend("memory", WallClock(), "agents_guard", log=lambda text: None, graph=base.graph)
        await agents.start()
        with TemporaryDirectory() as folder:
            lab = Lab(agents, guard, Path(folder) / "s")
            base.subscription("/cmd_vel", TWIST, lambda sample: lab.heard.append(sample.message.linear.x))
            guarding = asyncio.ensure_future(lab.guard.run())
            await lab.until(lambda: lab.state.agents)
            await body(lab)
            lab.state.leave()
            lab.guard._ending = True
            lab.guard._tripped_at = 0.0
            lab.guard._wake.set()
            await guarding
        lab.heartbeat.close()
        await agents.close()
        await base.close()

    run(main, WallClock())


Lab.play = staticmethod(play)


async def test_a_heartbeat_that_ceases_while_the_robot_drives_stops_it(lab: Lab) -> None:
    lab.wheels.publish(FORWARD)
    await lab.until(lambda: lab.heard)
    lab.cut()
    await lab.until(lambda: len(lab.heard) > 3)
    assert lab.interrupted == 0
    assert lab.heard[:4] == [0.3, 0.0, 0.0, 0.0]
    assert lab.lines[0].startswith("warning: /agents: no heartbeat from the agents for 0.5")


async def test_agents_that_return_are_interrupted_once_before_the_robot_is_released(lab: Lab) -> None:
    lab.wheels.publish(FORWARD)
    lab.cut()
    await lab.until(lambda: lab.state.tripped)
    lab.mend()
    await lab.until(lambda: not lab.state.tripped)
    assert lab.interrupted == 1
    count = len(lab.heard)
    await asyncio.sleep(2 * NETWORK_TIMEOUT)
    assert len(lab.heard) == count, "the guard is quiet when the run is healthy"
    assert lab.interrupted == 1
    assert lab.lines[-1] == "/agents: the guard has released the robot"


@pytest.mark.parametrize("driven", [False, True])
async def test_a_heartbeat_that_ceases_while_the_robot_stands_stops_nothing(lab: Lab, driven: bool) -> None:
    if driven:
        lab.wheels.publish(FORWARD)
        lab.wheels.publish({})
    await asyncio.sleep(0.2)
    lab.cut()
    count = len(lab.heard)
    await lab.until(lambda: not lab.state.agents)
    await asyncio.sleep(0.2)
    assert len(lab.heard) == count
    assert lab.guard._brakes.found == {}, "no publisher is left on the topic"
    lab.mend()
    await lab.until(lambda: lab.state.agents)
    assert lab.lines == []


async def test_a_running_goal_counts_as_driving(lab: Lab) -> None:
    with lab.guarded.goal():
        lab.cut()
        await lab.until(lambda: lab.state.tripped)
    assert lab.lines != []


async def test_a_process_that_ends_in_good_order_is_not_missed(lab: Lab) -> None:
    lab.wheels.publish(FORWARD)
    await lab.until(lambda: lab.state.driving)
    lab.heartbeat.goodbye()
    lab.cut()
    await lab.until(lambda: not lab.state.agents)
    await lab.until(lambda: len(lab.heard) > 1)
    assert lab.lines == []
    assert lab.heard == [0.3, 0.0], "the zero velocity of the agents may be lost: the guard sends its own"


async def test_a_guard_without_agents_stops_nothing(lab: Lab) -> None:
    lab.heartbeat.goodbye()
    lab.cut()
    await lab.until(lambda: not lab.state.agents)
    await asyncio.sleep(2 * NETWORK_TIMEOUT)
    assert (lab.lines, lab.heard) == ([], [])


async def test_the_first_motion_is_announced_before_its_command() -> None:
    order: list[str] = []
    guarded = Guarded()
    backend = open_backend("memory", WallClock(), "agents", log=lambda text: None)
    await backend.start()
    backend.subscription("/cmd_vel", TWIST, lambda sample: order.append("sent"))
    wheels = backend.publisher("/cmd_vel", TWIST)
    guarded.watch(wheels)
    assert wheels.watcher is None, "a run without a guard pays nothing"
    guarded.announce(lambda: order.append("announced"))
    for speed in (0.0, 0.3, 0.3, 0.0):
        wheels.publish({"linear": {"x": speed}})
        order.append(f"driving {guarded.driving}")
        await asyncio.sleep(0.01)
    guarded.announce(None)
    assert wheels.watcher is None
    await backend.close()
    assert order == [
        *("driving False", "sent"),
        *("announced", "driving True", "sent"),
        *("driving True", "sent"),
        *("driving False", "sent"),
    ]


async def test_a_run_with_the_same_name_does_not_take_the_guard_over(lab: Lab) -> None:
    first = lab.guard._run
    other = lab.new_heartbeat()
    await asyncio.sleep(0.3)
    assert lab.guard._run == first
    other.close()


async def test_agents_on_the_same_computer_are_heard_directly(lab: Lab) -> None:
    direct = Heartbeat(lab.guarded, False, lambda: None)
    await direct.connect(lab.path)
    await direct.wait_until_ready()
    lab.cut()
    await asyncio.sleep(2 * NETWORK_TIMEOUT)
    assert not lab.state.tripped
    await direct.close()
    await lab.until(lambda: not lab.state.agents)
    assert lab.lines == []


async def test_other_messages_on_the_topics_are_ignored(lab: Lab) -> None:
    for topic in topics_of("/agents"):
        publisher = lab.backend.publisher(topic, TEXT)
        for text in ("hello", "[1]", "{}", '"text"'):
            publisher.publish({"data": text})
    await asyncio.sleep(0.2)
    assert lab.state.agents
    assert list(lab.guarded.found) == ["/agents_guard"]
    assert lab.lines == []


async def test_a_guard_that_is_ending_takes_no_agents(lab: Lab) -> None:
    lab.state.leave()
    lab.guard._ending = True
    lab.heartbeat._publish()
    await asyncio.sleep(0.01)
    assert not lab.state.agents
    assert lab.lines == []


async def test_a_run_reports_a_guard_that_appears_and_one_that_disappears(
    lab: Lab, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(heartbeat, "LOST", 0.3)
    await lab.heartbeat.wait_for_answer()
    assert lab.guarded.found == {"/agents_guard": {"/cmd_vel": 1}}
    lab.guard._answer = lambda message: None
    await lab.until(lambda: len(lab.logged) == 2)
    assert lab.guarded.found == {}
    assert lab.logged == [
        "the guard /agents_guard watches over the graph",
        "warning: the guard /agents_guard no longer answers; it may be unable to stop the robot",
    ]


@pytest.mark.parametrize(("gap", "trips"), [(0.4, False), (0.6, True)])
def test_gaps_that_are_usual_on_a_wireless_network_do_not_trip_the_guard(gap: float, trips: bool) -> None:
    tripped: list[str] = []
    watch = HeartbeatMonitor(0.3, tripped.append, lambda: None)
    watch.connect(10.0, NETWORK_TIMEOUT)
    watch.armed = True
    for beat in range(100):
        watch.beat(10.0 + beat * gap)
        watch.look(10.0 + (beat + 0.99) * gap)
    assert bool(tripped) == trips
