"""A pause on a real graph first stops the robots that our artifacts drive."""

import asyncio
from types import SimpleNamespace
from typing import Any

import pytest

from jacaros.artifacts import Environment, OperationRequest
from jacaros.robots.artifacts.velocity import ArtCmdVel
from jacaros.robots.ros.guarded import guarded_by
from jacaros.robots.ros.open import open_backend
from jacaros.robots.world import SimNode, World
from jacaros.runtime.clock import WallClock
from jacaros.runtime.mas.debugging.debugger import command_standstill, not_paused
from jacaros.runtime.mas.options import RunOptions

REAL = RunOptions(ros="ros2")


@pytest.mark.real_time
async def test_the_robot_stops_during_a_pause_and_continues_afterwards() -> None:
    """The world has a clock of its own, as a real robot has; only that of the run is paused."""
    ours, theirs = WallClock(), WallClock()
    backend = open_backend("memory", theirs, "test")
    await backend.start()
    world = World.load("empty", 1)
    sim = SimNode(world, backend, theirs)
    sim.start()
    environment = Environment(ours, {"ros": backend})
    workspace = environment.workspace("/main")
    artifact = await workspace.make_artifact("wheels", ArtCmdVel)
    robot = world.robot(None)
    outcomes: list[Any] = []
    workspace.execute(OperationRequest(artifact, "moveForward", (2.0,), "bob", None, outcomes.append))
    await asyncio.sleep(2.0)
    graph: Any = SimpleNamespace(joined=backend)
    command_standstill(graph, REAL)
    ours.pause_timers()
    await asyncio.sleep(2.0)
    stopped = robot.pose[0]
    assert 0.1 < stopped < 1.9
    await asyncio.sleep(30.0)
    assert robot.pose[0] == pytest.approx(stopped, abs=0.001)
    assert not outcomes
    ours.resume()
    await asyncio.sleep(30.0)
    assert [(outcome.ok, outcome.message) for outcome in outcomes] == [(True, None)]
    assert robot.pose[0] == pytest.approx(2.0, abs=0.05)
    await environment.close()
    sim.close()
    await backend.close()


def test_the_embedded_world_is_paused_itself_and_no_command_is_sent() -> None:
    sent: list[str] = []
    backend: Any = open_backend("memory", WallClock(), "test")
    guarded_by(backend).on_standstill(lambda: sent.append("zero"))
    graph: Any = SimpleNamespace(joined=backend)
    command_standstill(graph, RunOptions())
    assert sent == []
    command_standstill(graph, REAL)
    assert sent == ["zero"]
    command_standstill(SimpleNamespace(joined=None), REAL)  # type: ignore[arg-type]
    assert sent == ["zero"]


def test_what_continues_on_a_real_graph_is_named() -> None:
    backend: Any = open_backend("memory", WallClock(), "test")
    remove = guarded_by(backend).add_action("/navigate_to_pose", "nav2_msgs/action/NavigateToPose")
    graph: Any = SimpleNamespace(joined=backend)
    nobody: Any = ()
    options = RunOptions(ros="ros2", ros_clock=True)
    assert not_paused(nobody, graph, options, WallClock()) == (
        "the ROS graph (ros2): other nodes and real robots continue",
        "action /navigate_to_pose: a goal that its server has accepted continues",
        "/clock: the simulator continues",
    )
    remove()
    assert not_paused(nobody, graph, RunOptions(), WallClock()) == ()
