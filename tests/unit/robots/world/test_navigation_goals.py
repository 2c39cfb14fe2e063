"""Robots that drive to goals of the graph's actions, checked against the ground truth."""

import math
import os
import random
import subprocess
import sys
from dataclasses import replace
from typing import Any

import pytest
from navigation_lab import NAVIGATE, Lab, bumps, near, pose

from jacaros.robots.plane.pose import Placement, distance
from jacaros.robots.plane.trigonometry import PI
from jacaros.robots.ros.action import GoalStatus
from jacaros.robots.ros.errors import GoalRejected
from jacaros.robots.world import World
from jacaros.robots.world.data.grid import Grid
from jacaros.robots.world.navigation.driver import Driver, Pace, Route
from jacaros.robots.world.navigation.planner import NavigationFailure, Planner

THROUGH, FOLLOW = "nav2_msgs/action/NavigateThroughPoses", "nav2_msgs/action/FollowWaypoints"


@pytest.mark.slow
@pytest.mark.parametrize("name", ["house", "patrol", "two_robots", "three_robots", "empty", "flat"])
def test_two_hundred_random_goals_are_reached_without_a_bump(name: str) -> None:
    described = World.load(name).description
    world = World(replace(described, robots=described.robots[:1]))
    robot, draw, bounds = world.robot(), random.Random(name), world.description.bounds
    planner = Planner(Grid(world.description), robot.description.radius)
    reached = 0
    while reached < 200:
        goal = (draw.uniform(bounds.x_min, bounds.x_max), draw.uniform(bounds.y_min, bounds.y_max))
        try:
            route = Route(planner.plan((robot.x, robot.y), goal))
        except NavigationFailure:
            continue
        driver = Driver(planner, Pace.within(robot.description.limits, 0.4))
        robot.battery.level = 100.0
        for _ in range(600):
            if distance((robot.x, robot.y), goal) < 0.05:
                break
            route.advance((robot.x, robot.y))
            robot.command(*driver.command(Placement.at(robot.x, robot.y, robot.yaw), route))
            world.run(0.1)
        else:
            pytest.fail(f"not at {goal} but at {robot.pose}")
        reached += 1
    assert [event for event in world.log if event.kind == "bump"] == []


pytestmark = pytest.mark.world("house")


async def test_a_goal_is_reached_with_its_heading(lab: Lab) -> None:
    outcome = await lab.go(2, 2, PI / 2)
    assert outcome.status == GoalStatus.SUCCEEDED
    assert outcome.result.error_code == 0
    await lab.stands()
    near(lab.world, 2, 2, PI / 2)
    first, last = lab.feedback[0], lab.feedback[-1]
    assert first.distance_remaining > 2.0 > 0.1 > last.distance_remaining
    assert last.navigation_time.sec > first.navigation_time.sec
    assert first.estimated_time_remaining.sec > 3
    assert first.current_pose.header.frame_id == "map"
    assert last.number_of_recoveries == 0
    assert bumps(lab.world) == []


@pytest.mark.parametrize(
    ("goal", "code", "words"),
    [
        (pose(9, 2), 204, "outside of the map"),
        (pose(3, 2), 206, "too near a wall"),
        (pose(1, 2, frame="moon"), 9002, "unknown frame 'moon'"),
        (pose(1, 2, frame=""), 9002, "has no frame"),
    ],
)
async def test_a_goal_that_cannot_be_reached_is_aborted_with_nav2s_code(
    lab: Lab, goal: dict[str, Any], code: int, words: str
) -> None:
    outcome = await lab.do("/navigate_to_pose", NAVIGATE, pose=goal)
    assert outcome.status == GoalStatus.ABORTED
    assert outcome.result.error_code == code
    assert words in outcome.result.error_msg
    through = await lab.do("/navigate_through_poses", THROUGH, poses=[goal])
    assert through.result.error_code == code + 100
    assert lab.world.robot().odometer == 0.0


@pytest.mark.parametrize("wrong", [{"x": math.nan}, {"y": math.inf}, {"w": 0.0}])
async def test_invalid_goals_are_rejected_or_aborted_by_move_base(lab: Lab, wrong: dict[str, float]) -> None:
    goal = pose(1, 1)
    for part in goal["pose"].values():
        part.update({key: value for key, value in wrong.items() if key in part})
    with pytest.raises(GoalRejected):
        await lab.send("/navigate_to_pose", NAVIGATE, pose=goal)
    with pytest.raises(GoalRejected, match="pose 1"):
        await lab.send("/follow_waypoints", FOLLOW, poses=[pose(0, 1), goal])
    outcome = await lab.do("/move_base", "move_base_msgs/action/MoveBase", target_pose=goal)
    assert outcome.status == GoalStatus.ABORTED
    assert "NaN" in outcome.text or "not a rotation" in outcome.text


NOISY = """
name: noisy
bounds: {from: [-3, -3], to: [3, 3]}
border: walls
robots:
  - odometry: {noise_per_metre: 0.05, noise_degrees_per_turn: 8, noise_degrees_per_metre: 3}
"""


@pytest.mark.world(NOISY, 4)
async def test_a_goal_is_reached_despite_bad_odometry(lab: Lab) -> None:
    for x, y in ((2, 2), (-2, 2), (-2, -2), (2, -2), (0, 0)):
        assert (await lab.go(x, y)).status == GoalStatus.SUCCEEDED
        assert math.hypot(lab.world.robot().x - x, lab.world.robot().y - y) < 0.15
    odometry = lab.world.robot().odometry
    assert math.hypot(odometry.x, odometry.y) > 0.15, "the wheels alone would have been wrong"
    assert bumps(lab.world) == []


async def test_the_robot_passes_through_poses_without_stopping(lab: Lab) -> None:
    speeds = []
    poses = [pose(1, 0.1), pose(2, 0.4, PI / 2)]
    handle = await lab.send("/navigate_through_poses", THROUGH, poses=poses)
    for _ in range(40):
        await lab.clock.sleep(0.1)
        speeds.append(lab.world.robot().speed)
    assert (await handle.outcome()).status == GoalStatus.SUCCEEDED
    near(lab.world, 2, 0.4, PI / 2)
    assert min(speeds[12:]) > 0.25
    left = [feedback.number_of_poses_remaining for feedback in lab.feedback]
    assert sorted(set(left), reverse=True) == [2, 1]


async def test_unreachable_waypoints_are_reported_as_missed(lab: Lab) -> None:
    poses = [pose(0, 1), pose(9, 0), pose(0, 2, PI)]
    outcome = await lab.do("/follow_waypoints", FOLLOW, poses=poses, number_of_loops=1)
    assert outcome.status == GoalStatus.SUCCEEDED
    missed = outcome.result.missed_waypoints
    assert [(each.index, each.error_code) for each in missed] == [(1, 204), (1, 204)]
    assert [feedback.current_waypoint for feedback in lab.feedback] == [0, 1, 2, 0, 1, 2]
    near(lab.world, 0, 2, PI)
    empty = await lab.do("/follow_waypoints", FOLLOW)
    assert (empty.status, empty.result.error_code) == (GoalStatus.ABORTED, 602)


async def test_a_goal_pose_on_a_topic_is_enough(lab: Lab) -> None:
    for topic, goal in (("/goal_pose", pose(1, 0)), ("/move_base_simple/goal", pose(0, 1))):
        lab.say(topic, "geometry_msgs/msg/PoseStamped", **goal)
        await lab.clock.sleep(15.0)
        near(lab.world, goal["pose"]["position"]["x"], goal["pose"]["position"]["y"], 0)


PROGRAM = """
from navigation_lab import NAVIGATE, in_world, pose
async def body(lab):
    lab.backend.subscription("/robot_1/scan", "sensor_msgs/msg/LaserScan", lambda sample: None)
    first = await lab.send("/robot_1/navigate_to_pose", NAVIGATE, pose=pose(-2, -2, 1))
    await lab.go(2, 1.5, 2, robot="/robot_0")
    await first.outcome()
print(in_world(body, "two_robots", 7).world.ground_truth.digest())
"""


def digest(**environment: str) -> str:
    return subprocess.check_output(
        [sys.executable, "-c", PROGRAM],
        cwd=os.path.dirname(__file__),
        env={**os.environ, **environment},
        text=True,
    ).strip()


def test_the_same_goals_give_the_same_run_to_the_last_bit() -> None:
    assert digest() == digest(PYTHONHASHSEED="5") == digest(NPY_DISABLE_CPU_FEATURES="AVX2 FMA3")
