"""Interrupted goals: cancelled, preempted, without power, and with robots in the way."""

import asyncio
from typing import Any

import pytest
from navigation_lab import NAVIGATE, Lab, bumps, in_world, near, pose

from jacaros.robots.ros.action import GoalStatus
from jacaros.robots.ros.open import open_backend

pytestmark = pytest.mark.world("house")


async def test_cancelling_stops_the_robot(lab: Lab) -> None:
    handle = await lab.send("/navigate_to_pose", NAVIGATE, pose=pose(2, 2))
    await lab.clock.sleep(3.0)
    assert lab.world.robot().speed > 0.2
    assert await handle.cancel()
    assert (await handle.outcome()).status == GoalStatus.CANCELED
    await lab.stands()


async def test_a_newer_goal_preempts_goals_of_other_actions_too(lab: Lab) -> None:
    first = await lab.send("/navigate_to_pose", NAVIGATE, pose=pose(2, 2))
    await lab.clock.sleep(2.0)
    second = await lab.send("/navigate_to_pose", NAVIGATE, pose=pose(2, 0))
    assert (await first.outcome()).status == GoalStatus.ABORTED
    await lab.clock.sleep(2.0)
    third = await lab.do("/move_base", "move_base_msgs/action/MoveBase", target_pose=pose(0, 2))
    outcome = await second.outcome()
    assert outcome.status == GoalStatus.ABORTED
    assert "newer goal" in outcome.text
    assert third.status == GoalStatus.SUCCEEDED
    await lab.stands()
    near(lab.world, 0, 2, 0)


async def occupied(lab: Lab, name: str, type_name: str, **fields: Any) -> None:
    """Send a goal that is accepted and aborted, because another navigator is running."""
    outcome = await lab.do(name, type_name, **fields)
    assert outcome.status == GoalStatus.ABORTED
    assert "is running; cancel that goal first" in outcome.text


async def test_a_goal_cancelled_just_before_the_next_one_ends_as_aborted(lab: Lab) -> None:
    first = await lab.send("/navigate_to_pose", NAVIGATE, pose=pose(2, 2))
    await lab.clock.sleep(1.0)
    assert await first.cancel()
    # From another node: our own would wait.
    other = open_backend("memory", lab.clock, "other", graph=lab.backend.graph)
    await other.start()
    second = await other.action_client("/navigate_to_pose", NAVIGATE).send({"pose": pose(2, 0)})
    assert (await first.outcome()).status == GoalStatus.ABORTED
    assert (await second.outcome()).status == GoalStatus.SUCCEEDED


async def test_nav2s_two_navigators_do_not_preempt_each_other(lab: Lab) -> None:
    through = "nav2_msgs/action/NavigateThroughPoses"
    first = await lab.send("/navigate_to_pose", NAVIGATE, pose=pose(2, 2))
    await lab.clock.sleep(1.0)
    await occupied(lab, "/navigate_through_poses", through, poses=[pose(0, 1)])
    second = await lab.send("/navigate_to_pose", NAVIGATE, pose=pose(2, 0))
    assert (await first.outcome()).status == GoalStatus.ABORTED
    await occupied(lab, "/navigate_through_poses", through, poses=[pose(0, 1)])
    await second.cancel()
    assert (await second.outcome()).status == GoalStatus.CANCELED
    third = await lab.send("/navigate_through_poses", through, poses=[pose(0, 1)])
    await occupied(lab, "/navigate_to_pose", NAVIGATE, pose=pose(2, 2))
    assert (await third.outcome()).status == GoalStatus.SUCCEEDED
    assert (await lab.go(0, 0)).status == GoalStatus.SUCCEEDED
    empty = await lab.do("/navigate_through_poses", through)
    assert (empty.status, empty.result.error_code) == (GoalStatus.ABORTED, 309)


async def test_a_goal_preempts_docking(lab: Lab) -> None:
    for wait in (1.0, 5.5):  # on the way to the dock, and close before it
        docking = await lab.send("/dock_robot", "nav2_msgs/action/DockRobot", dock_id="dock")
        await lab.clock.sleep(wait)
        assert (await lab.go(0, 0)).status == GoalStatus.SUCCEEDED
        outcome = await docking.outcome()
        assert (outcome.status, outcome.result.success) == (GoalStatus.ABORTED, False)
        assert "newer goal" in outcome.text
        await lab.stands()


async def test_closing_the_servers_stops_the_robot(lab: Lab) -> None:
    handle = await lab.send("/navigate_to_pose", NAVIGATE, pose=pose(2, 2))
    await lab.clock.sleep(3.0)
    for navigation in lab.node.navigation:
        navigation.close()
    assert (await handle.outcome()).status == GoalStatus.ABORTED
    await lab.stands()


async def test_a_battery_that_runs_empty_ends_the_goal(lab: Lab) -> None:
    lab.world.robot().battery.level = 2.0
    outcome = await lab.go(2, 2)
    assert outcome.status == GoalStatus.ABORTED
    assert (outcome.result.error_code, outcome.result.error_msg) == (105, "the battery is empty")


PARKED = """
name: corridor
bounds: {from: [-3, -0.4], to: [3, 0.4]}
border: walls
robots:
  - {name: one, namespace: one, pose: {x: -2, y: 0, yaw_degrees: 0}}
  - {name: two, namespace: two, pose: {x: 0.5, y: 0, yaw_degrees: 0}}
"""


@pytest.mark.world(PARKED)
async def test_a_robot_that_never_moves_blocks_a_corridor(lab: Lab) -> None:
    outcome = await lab.go(2, 0, robot="/one")
    assert outcome.status == GoalStatus.ABORTED
    assert outcome.result.error_code == 208
    assert "another robot blocks the path" in outcome.result.error_msg
    assert lab.feedback[-1].number_of_recoveries == 3
    assert 15.0 < lab.clock.elapsed < 45.0
    await lab.stands("one")
    assert bumps(lab.world) == []


@pytest.mark.world(PARKED)
async def test_the_robot_waits_for_a_robot_that_leaves_in_time(lab: Lab) -> None:
    first = await lab.send("/one/navigate_to_pose", NAVIGATE, pose=pose(1.4, 0))
    await lab.clock.sleep(8.0)
    assert (await lab.go(2.5, 0, robot="/two")).status == GoalStatus.SUCCEEDED
    assert (await first.outcome()).status == GoalStatus.SUCCEEDED
    assert bumps(lab.world) == []


@pytest.mark.world("three_robots")
async def test_robots_pass_each_other(lab: Lab) -> None:
    async def shuttle(robot: str, ends: list[tuple[float, float]]) -> None:
        for x, y in ends * 2:
            outcome = await lab.go(x, y, robot=f"/{robot}")
            assert outcome.status == GoalStatus.SUCCEEDED, outcome.text

    await asyncio.gather(
        shuttle("robot_1", [(3, 0.2), (-3, 0)]),
        shuttle("robot_2", [(-3, -0.2), (3, 2.2)]),
        shuttle("robot_3", [(3, -2.2), (0, 2.2)]),
    )
    assert bumps(lab.world) == []


STOREHOUSE = """
name: storehouse
bounds: {{from: [-4, -3], to: [4, 3]}}
border: walls
walls:
  - box: {{from: [-2.5, 0.9], to: [2.5, 1.3]}}
  - box: {{from: [-2.5, -1.3], to: [2.5, -0.9]}}
robots:
  - {{name: one, namespace: one, pose: {{x: -3.2, y: 0, yaw_degrees: 0}}}}
  - {{name: two, namespace: two, pose: {{x: {x}, y: 0.3, yaw_degrees: 0}}}}
  - {{name: three, namespace: three, pose: {{x: {x}, y: -0.3, yaw_degrees: 0}}}}
"""


@pytest.mark.parametrize("they_go", [True, False])
@pytest.mark.parametrize(
    "x", [pytest.param(-1.6, id="closed from the beginning"), pytest.param(1.5, id="seen on the way")]
)
def test_a_detour_is_abandoned_when_the_obstacles_have_gone(x: float, they_go: bool) -> None:
    """Between the racks it is 6.4 metres to the goal, around them 8.9, or 12 after turning back."""

    async def body(lab: Lab) -> None:
        first = await lab.send("/one/navigate_to_pose", NAVIGATE, pose=pose(3.2, 0))
        while not lab.feedback or lab.feedback[-1].distance_remaining < 8.0:  # until it turns to the detour
            await lab.clock.sleep(0.5)
        await lab.clock.sleep(1.5)
        if they_go:
            for name, away in (("two", -3.0), ("three", -3.6)):
                robot = lab.world.robot(name)
                robot.x, robot.y = away, 2.5
        assert (await first.outcome(timeout=300.0)).status == GoalStatus.SUCCEEDED

    done = in_world(body, STOREHOUSE.format(x=x)).world
    driven = done.robot("one").odometer
    assert driven < 8.0 if they_go else driven > 8.5
    assert bumps(done) == []
