"""What a robot of the world does at the edges: walls, docks, doors, gaps, and other robots beside it."""

import math

import pytest
from navigation_lab import Lab

from jacaros.robots.plane.pose import Placement
from jacaros.robots.plane.shapes import Rectangle, Segment
from jacaros.robots.ros.action import GoalStatus
from jacaros.robots.world import World
from jacaros.robots.world.data.grid import Grid
from jacaros.robots.world.data.world import WorldDescription
from jacaros.robots.world.navigation.driver import Driver, Pace, Route
from jacaros.robots.world.navigation.planner import GOAL_OCCUPIED, NavigationFailure, Planner

RADIUS = 0.17


def drive(world: World, seconds: float, speed: float, turn_rate: float = 0.0) -> None:
    for _ in range(round(seconds * 10)):
        world.command(world.robot().name, speed, turn_rate)
        world.run(0.1)


def test_a_robot_that_spins_in_a_dock_is_not_docked_until_it_stands() -> None:
    world = World.load("house")
    world.robot().put_down(world.description.docks[0].pose)
    drive(world, 2.0, 0.0, 2.0)
    assert world.robot().dock is None
    drive(world, 2.0, 0.0)
    assert world.robot().dock is not None


def planner(*walls: Segment) -> Planner:
    bounds = Rectangle(-2.0, -2.0, 2.0, 2.0)
    return Planner(Grid(WorldDescription(bounds=bounds, segments=walls)), RADIUS)


def test_a_goal_that_leaves_less_than_a_margin_to_the_wall_is_refused() -> None:
    across = Segment(-2.0, 0.0, 2.0, 0.0)
    with pytest.raises(NavigationFailure) as failure:
        planner(across).plan((0.0, -1.0), (0.0, -RADIUS - 0.02))
    assert failure.value.code == GOAL_OCCUPIED
    assert planner(across).plan((0.0, -1.0), (0.0, -RADIUS - 0.05))


@pytest.mark.parametrize(("beside", "speed"), [(0.48, 0.2), (0.9, 0.4)])
def test_a_robot_passes_another_slowly_unless_it_is_far(beside: float, speed: float) -> None:
    driver = Driver(planner(), Pace(0.4, 1.5, 0.4))
    route = Route([(-1.5, 0.0), (1.5, 0.0)])
    here = Placement.at(-1.5, 0.0, 0.0)
    for _ in range(20):  # it accelerates with what it sees ahead
        command = driver.command(here, route, [(-1.4, beside, RADIUS)])
    assert command.speed == pytest.approx(speed)


DOCK_AT_WALL = """
size: [6, 6]
walls: [{segment: [[-0.2, -1], [-0.2, 1]]}]
docks: [{name: dock, x: 0, y: 0}]
robots: [{pose: {x: 0, y: 0}}]
"""


@pytest.mark.world(DOCK_AT_WALL)
async def test_a_robot_with_a_wall_behind_it_leaves_its_dock_forwards(lab: Lab) -> None:
    await lab.clock.sleep(1.0)
    assert lab.world.robot().dock is not None
    outcome = await lab.do("/undock_robot", "nav2_msgs/action/UndockRobot")
    assert outcome.status is GoalStatus.SUCCEEDED
    assert lab.world.robot().x > 0.3


def test_a_fault_that_is_begun_on_request_ends_after_its_time() -> None:
    world = World.load("house", faults="faults:\n  oil: {kind: wheel_slip, share: 0.3, for: 2}\n")
    world.run(1.0)
    assert world.faults.begin("oil") is None
    world.run(1.9)
    assert world.faults.at_work == ["oil"]
    world.run(0.2)
    assert world.faults.at_work == []
    assert [round(event.time, 2) for event in world.ground_truth.events_of("fault")] == [1.0, 3.0]
    assert math.isinf(world.faults.next)
