"""Cliffs: robots that drive over one fall, and their sensors detect it before."""

from collections.abc import Awaitable, Callable
from typing import Any

import pytest

from jacaros.robots.ros.backend import Backend
from jacaros.robots.ros.open import open_backend
from jacaros.robots.world import SimNode, World, WorldError, read_world
from jacaros.robots.world.data.grid import Grid
from jacaros.runtime.clock import VirtualClock, run

STAIRS = """\
size: [6, 6]
cliffs:
  - {from: [1, -1], to: [2, 1]}
robots:
  - {name: robot, pose: {x: 0, y: 0}}
"""


def in_graph(body: Callable[[World, Backend, VirtualClock], Awaitable[None]], text: str = STAIRS) -> World:
    """Run *body* beside a world."""
    clock, world = VirtualClock(), World.load(text)

    async def main() -> None:
        backend = open_backend("memory", clock, "test")
        await backend.start()
        node = SimNode(world, backend, clock)
        node.start()
        await body(world, backend, clock)
        node.close()
        await backend.close()

    run(main, clock)
    return world


async def drive(backend: Backend, clock: VirtualClock, seconds: float, speed: float = 0.3) -> None:
    publisher = backend.publisher("/cmd_vel", "geometry_msgs/msg/Twist")
    for _ in range(round(seconds * 10)):
        publisher.publish(publisher.message(linear={"x": speed}))
        await clock.sleep(0.1)


def test_a_robot_with_its_centre_over_a_cliff_falls_and_stays_there() -> None:
    world = World.load(STAIRS)
    for _ in range(60):
        world.command("robot", 0.5, 0.0)
        world.run(0.1)
    [event] = world.ground_truth.events_of("fell")
    assert event.x == pytest.approx(1.0, abs=0.02)
    assert world.ground_truth.pose().x == event.x
    world.command("robot", -0.5, 1.0)
    world.run(1.0)
    assert world.ground_truth.pose() == (event.x, event.y, event.yaw)


def test_a_robot_that_stops_at_the_edge_has_not_fallen() -> None:
    world = World.load(STAIRS)
    while world.robot().x < 0.9:
        world.command("robot", 0.2, 0.0)
        world.run(0.1)
    world.run(2.0)
    assert world.ground_truth.events_of("fell") == []


def test_a_fallen_robot_is_not_pushed() -> None:
    world = World.load(STAIRS + "  - {name: other, namespace: other, pose: {x: -1, y: 0}}\n")
    for _ in range(40):
        world.command("robot", 0.5, 0.0)
        world.run(0.1)
    fallen = world.ground_truth.pose("robot")
    for _ in range(60):
        world.command("other", 0.5, 0.0)
        world.run(0.1)
    assert world.ground_truth.events_of("collision", robot="other")
    assert world.ground_truth.pose("robot") == fallen


def test_the_sensors_of_a_kobuki_see_the_cliff_and_then_the_wheels_drop() -> None:
    cliffs: list[Any] = []
    drops: list[Any] = []

    async def body(world: World, backend: Backend, clock: VirtualClock) -> None:
        backend.subscription(
            "/mobile_base/events/cliff",
            "kobuki_msgs/msg/CliffEvent",
            lambda each: cliffs.append(each.message),
        )
        backend.subscription(
            "/mobile_base/events/wheel_drop",
            "kobuki_msgs/msg/WheelDropEvent",
            lambda each: drops.append(each.message),
        )
        await drive(backend, clock, 3.0)
        assert [(each.sensor, each.state) for each in cliffs] == [(1, 1)], "only the one in the middle"
        assert world.robot().x < 1.0
        await drive(backend, clock, 1.0, -0.3)
        assert [(each.sensor, each.state) for each in cliffs] == [(1, 1), (1, 0)], "and it is behind"
        assert drops == []
        await drive(backend, clock, 3.0)

    in_graph(body)
    assert {(each.sensor, each.state) for each in cliffs[2:]} == {(0, 1), (1, 1), (2, 1)}
    assert [(each.wheel, each.state) for each in drops] == [(0, 1), (1, 1)]


def test_a_create_publishes_cliffs_and_wheel_drops_as_hazards() -> None:
    hazards: list[set[str]] = []

    async def body(world: World, backend: Backend, clock: VirtualClock) -> None:
        backend.subscription(
            "/hazard_detection",
            "irobot_create_msgs/msg/HazardDetectionVector",
            lambda each: hazards.append(
                {f"{hazard.type} {hazard.header.frame_id}" for hazard in each.message.detections}
            ),
        )
        await drive(backend, clock, 5.0)

    in_graph(body)
    told = [each for before, each in zip([set(), *hazards], hazards, strict=False) if each != before]
    assert told[0] == {"2 cliff_front_left", "2 cliff_front_right"}
    assert {"4 wheel_drop_left", "4 wheel_drop_right", "2 cliff_side_left"} < told[-1]


def test_the_map_keeps_robots_away_from_cliffs() -> None:
    grid = Grid(read_world(STAIRS))
    assert grid.clearance_at(1.5, 0.0) == 0.0
    assert grid.clearance_at(0.8, 0.0) == pytest.approx(0.2, abs=0.03)


def test_a_robot_must_not_start_over_a_cliff() -> None:
    with pytest.raises(WorldError, match=r"the robot 'robot' is at \[1.5, 0\], over a cliff"):
        read_world(STAIRS.replace("x: 0", "x: 1.5"))
