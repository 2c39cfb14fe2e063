"""The large shipped worlds: robots reach every place in them, and touch nothing."""

import asyncio
import math

import pytest
from navigation_lab import Lab, bumps, in_world

from jacaros.robots.ros.action import GoalStatus
from jacaros.robots.world import World
from jacaros.robots.world.data.grid import Grid
from jacaros.robots.world.navigation.planner import Planner

WORLDS = {"flat": 8, "office": 12, "warehouse": 27, "maze": 3}
"""The worlds, with the number of their rooms and docks."""


@pytest.mark.parametrize(("name", "places"), WORLDS.items())
def test_each_room_and_dock_can_be_reached(name: str, places: int) -> None:
    world = World.load(name).description
    robot = world.robots[0]
    planner = Planner(Grid(world), robot.radius)
    found = 0
    for room in world.rooms:
        x_min, y_min, x_max, y_max = room.area
        tried = [
            (x_min + (x_max - x_min) * across / 8, y_min + (y_max - y_min) * up / 8)
            for across in range(1, 8)
            for up in range(1, 8)
        ]
        free = [place for place in tried if planner.grid.clearance_at(*place) > 0.4]
        assert free, f"{room.name} has no free place"
        assert planner.plan(robot.pose[:2], free[0])
        found += 1
    for dock in world.docks:
        assert planner.plan(robot.pose[:2], dock.pose[:2])
        found += 1
    assert found == places


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "goals"),
    [
        ("flat", [(6.2, 2.2), (8.6, 2.4), (8.4, 6.2), (3, 6.4), (4, 2.4)]),
        ("office", [(-11, 2), (9, -2.5), (5.2, 2.2), (-7, -3)]),
        ("maze", [(7.5, 7.5)]),
    ],
)
def test_a_robot_drives_through_the_rooms_and_docks(name: str, goals: list[tuple[float, float]]) -> None:
    async def body(lab: Lab) -> None:
        for goal in goals:
            assert (await lab.go(*goal)).status == GoalStatus.SUCCEEDED
        docked = await lab.do("/dock_robot", "nav2_msgs/action/DockRobot", dock_id="dock")
        assert docked.result.success
        robot, (dock,) = lab.world.robot(), lab.world.description.docks
        assert math.hypot(robot.x - dock.pose.x, robot.y - dock.pose.y) < dock.radius

    assert bumps(in_world(body, name).world) == []


@pytest.mark.slow
def test_robots_of_the_warehouse_work_side_by_side() -> None:
    async def body(lab: Lab) -> None:
        assert [f"/{robot}" for robot in lab.world.robots] == [f"/robot_{k}" for k in range(1, 21)]
        goals = {"robot_1": (-12, 6), "robot_8": (-5, -0.4), "robot_13": (4, 3.2), "robot_20": (12, 6)}
        ends = await asyncio.gather(*(lab.go(*goal, robot=f"/{robot}") for robot, goal in goals.items()))
        assert [end.status for end in ends] == [GoalStatus.SUCCEEDED] * 4

    assert bumps(in_world(body, "warehouse").world) == []
