"""Robots that drive by themselves: through the actions of the graph, judged by what truly happens."""

import asyncio
import math
import os
import random
import subprocess
import sys
from collections.abc import Awaitable, Callable
from dataclasses import replace
from typing import Any

import pytest

from jacaros.clock import VirtualClock, run
from jacaros.ros.action import GoalStatus, Outcome
from jacaros.ros.errors import GoalRejected, UnknownInterface
from jacaros.ros.open import open_backend
from jacaros.ros.qos import QoS
from jacaros.sim import SimNode, World
from jacaros.sim.navigation.driver import Driver, Pace
from jacaros.sim.navigation.failure import NavigationFailure
from jacaros.sim.navigation.grid import Grid
from jacaros.sim.navigation.placement import Placement, distance
from jacaros.sim.navigation.planner import Planner
from jacaros.sim.navigation.route import Route
from jacaros.sim.trigonometry import PI

NAVIGATE = "nav2_msgs/action/NavigateToPose"
TWIST = "geometry_msgs/msg/Twist"


def pose(x: float, y: float, yaw: float = 0.0, frame: str = "map") -> dict[str, Any]:
    turn = {"z": math.sin(yaw / 2), "w": math.cos(yaw / 2)}
    return {"header": {"frame_id": frame}, "pose": {"position": {"x": x, "y": y}, "orientation": turn}}


class Lab:
    """A world on the memory graph, and a client of its robots."""

    def __init__(self, world: World, clock: VirtualClock, backend: Any, node: SimNode) -> None:
        self.world, self.clock, self.backend, self.node = world, clock, backend, node
        self.feedback: list[Any] = []

    async def send(self, name: str, type_name: str, **goal: Any) -> Any:
        client = self.backend.action_client(name, type_name)
        return await client.send(goal, self.feedback.append, timeout=5.0)

    async def do(self, name: str, type_name: str, **goal: Any) -> Outcome:
        handle = await self.send(name, type_name, **goal)
        outcome: Outcome = await handle.outcome(timeout=300.0)
        return outcome

    async def go(self, x: float, y: float, yaw: float = 0.0, frame: str = "map", robot: str = "") -> Outcome:
        return await self.do(f"{robot}/navigate_to_pose", NAVIGATE, pose=pose(x, y, yaw, frame))

    async def stands(self, robot: str | None = None) -> None:
        """Half a second later nothing moves any more."""
        await self.clock.sleep(0.6)
        before = self.world.robot(robot).pose
        await self.clock.sleep(0.5)
        assert self.world.robot(robot).pose == before


def in_world(source: str, body: Callable[[Lab], Awaitable[None]], seed: int | None = None) -> Lab:
    clock = VirtualClock()
    labs = []

    async def main() -> None:
        backend = open_backend("memory", clock, "test")
        await backend.start()
        beside = open_backend("memory", clock, "world", graph=backend.graph)  # type: ignore[attr-defined]
        await beside.start()
        world = World.load(source, seed)
        node = SimNode(world, beside, clock)
        node.start()
        labs.append(Lab(world, clock, backend, node))
        await body(labs[0])
        node.close()
        await beside.close()
        await backend.close()

    run(main, clock)
    return labs[0]


def near(world: World, x: float, y: float, yaw: float, robot: str | None = None) -> None:
    there = world.robot(robot)
    assert math.hypot(there.x - x, there.y - y) < 0.08
    assert abs(math.sin(there.yaw - yaw)) < 0.08
    assert math.cos(there.yaw - yaw) > 0.0


def bumps(world: World) -> list[Any]:
    return [event for event in world.log if event.kind in ("bump", "collision")]


@pytest.mark.slow
@pytest.mark.parametrize("name", ["house", "patrol", "two_robots", "three_robots", "empty"])
def test_two_hundred_random_goals_and_never_a_wall(name: str) -> None:
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


def test_a_goal_is_reached_with_its_heading() -> None:
    async def body(lab: Lab) -> None:
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

    assert bumps(in_world("house", body).world) == []


@pytest.mark.parametrize(
    ("goal", "code", "words"),
    [
        (pose(9, 2), 204, "outside of the map"),
        (pose(3, 2), 206, "too near to a wall"),
        (pose(1, 2, frame="moon"), 9002, "frame 'moon' is not known"),
        (pose(1, 2, frame=""), 9002, "names no frame"),
    ],
)
def test_a_goal_that_cannot_be_reached_is_aborted_with_nav2s_code(
    goal: dict[str, Any], code: int, words: str
) -> None:
    async def body(lab: Lab) -> None:
        outcome = await lab.do("/navigate_to_pose", NAVIGATE, pose=goal)
        assert outcome.status == GoalStatus.ABORTED
        assert outcome.result.error_code == code
        assert words in outcome.result.error_msg
        through = await lab.do(
            "/navigate_through_poses", "nav2_msgs/action/NavigateThroughPoses", poses=[goal]
        )
        assert through.result.error_code == code + 100

    assert in_world("house", body).world.robot().odometer == 0.0


@pytest.mark.parametrize("wrong", [{"x": math.nan}, {"y": math.inf}, {"w": 0.0}])
def test_nonsense_is_refused_and_move_base_aborts_it(wrong: dict[str, float]) -> None:
    async def body(lab: Lab) -> None:
        goal = pose(1, 1)
        for part in goal["pose"].values():
            part.update({key: value for key, value in wrong.items() if key in part})
        with pytest.raises(GoalRejected):
            await lab.send("/navigate_to_pose", NAVIGATE, pose=goal)
        with pytest.raises(GoalRejected, match="pose 1"):
            await lab.send("/follow_waypoints", "nav2_msgs/action/FollowWaypoints", poses=[pose(0, 1), goal])
        outcome = await lab.do("/move_base", "move_base_msgs/action/MoveBase", target_pose=goal)
        assert outcome.status == GoalStatus.ABORTED
        assert "not finite" in outcome.text or "no rotation" in outcome.text

    in_world("house", body)


FROM_START = """
name: from start
bounds: {from: [-3, -3], to: [3, 3]}
border: walls
robots:
  - namespace: robot_1
    pose: {x: 1, y: 0, yaw_degrees: 90}
    odometry: {origin: start}
"""


@pytest.mark.parametrize(
    ("frame", "x", "y"),
    [("robot_1/odom", -1, 1), ("odom", -1, 1), ("robot_1/base_link", -1, 1), ("map", 0, -1)],
)
def test_goals_may_be_in_any_frame_of_the_robot(frame: str, x: float, y: float) -> None:
    """At the start odometry and base are the same frame: one metre to the right of the map's middle, looking up."""

    async def body(lab: Lab) -> None:
        goal = (x, y, 0.0) if frame != "map" else (0.0, -1.0, PI / 2)
        outcome = await lab.go(*goal, frame, "/robot_1")
        assert outcome.status == GoalStatus.SUCCEEDED
        near(lab.world, 0, -1, PI / 2)

    in_world(FROM_START, body)


def test_the_tf_tree_joins_map_odometry_and_base() -> None:
    async def body(lab: Lab) -> None:
        lab.backend.tf_listen()
        assert (await lab.go(-1, 1, 0, "robot_1/odom", "/robot_1")).status == GoalStatus.SUCCEEDED
        await lab.stands()
        found = lab.backend.tf_lookup("map", "robot_1/base_scan")
        robot = lab.world.robot()
        assert found.translation == pytest.approx((robot.x, robot.y, 0.0), abs=1e-6)
        assert found.yaw == pytest.approx(robot.yaw, abs=1e-6)
        start = lab.backend.tf_lookup("map", "robot_1/odom")
        assert start.translation == pytest.approx((1.0, 0.0, 0.0), abs=1e-6)
        assert lab.backend.tf_lookup("robot_1/map", "map").translation == pytest.approx((0, 0, 0))

    in_world(FROM_START, body)


def test_goals_in_foreign_frames_go_through_tf() -> None:
    async def body(lab: Lab) -> None:
        table = {
            "header": {"frame_id": "map"},
            "child_frame_id": "table",
            "transform": {"translation": {"x": 1.0, "y": 1.0}, "rotation": {"z": 1.0, "w": 0.0}},
        }
        lab.backend.tf_broadcast(table, static=True)
        outcome = await lab.go(1, 0, 0.0, "table")
        assert outcome.status == GoalStatus.SUCCEEDED
        near(lab.world, 0, 1, PI)

    in_world("empty", body)


def tell_pose(
    lab: Lab, x: float, y: float, yaw: float = 0.0, frame: str = "map", spread: float = 0.0
) -> None:
    """As rviz's "2D Pose Estimate", whose spread is 0.25."""
    publisher = lab.backend.publisher("/initialpose", "geometry_msgs/msg/PoseWithCovarianceStamped")
    told = pose(x, y, yaw, frame)
    covariance = [0.0] * 36
    covariance[0] = covariance[7] = spread
    publisher.publish({"header": told["header"], "pose": {"pose": told["pose"], "covariance": covariance}})


@pytest.mark.parametrize(
    ("x", "y", "yaw", "frame", "spread", "lost"),
    [
        (0.1, 0.1, 0.1, "map", 0.0, False),
        (0.6, 0.5, 0.0, "map", 0.25, False),
        (0.6, 0.5, 0.0, "map", 0.0, True),
        (0.0, 0.0, 2.0, "map", 0.25, True),
        (2.0, 0.0, 0.0, "", 0.25, True),
        (2.0, 0.0, 0.0, "odom", 0.25, False),
        (math.nan, 0.0, 0.0, "map", 0.25, False),
        (2.0, 0.0, 0.0, "map", -1.0, False),
    ],
)
def test_a_pose_that_the_robot_is_told_is_believed(
    x: float, y: float, yaw: float, frame: str, spread: float, lost: bool
) -> None:
    async def body(lab: Lab) -> None:
        lab.backend.tf_listen()
        tell_pose(lab, x, y, yaw, frame, spread)
        await lab.clock.sleep(2.0)
        believed = lab.backend.tf_lookup("map", "base_link")
        expected = (x, y, yaw) if lost else (0.0, 0.0, 0.0)
        assert (*believed.translation[:2], believed.yaw) == pytest.approx(expected, abs=1e-6)

    in_world("empty", body)


def test_a_robot_that_is_lost_goes_wrong_until_it_is_told_better() -> None:
    async def body(lab: Lab) -> None:
        tell_pose(lab, 1, 0)
        assert (await lab.go(2, 0)).status == GoalStatus.SUCCEEDED
        near(lab.world, 1, 0, 0)
        tell_pose(lab, 1.1, 0.1, spread=0.25)
        await lab.clock.sleep(1.0)
        assert (await lab.go(2, 0)).status == GoalStatus.SUCCEEDED
        near(lab.world, 2, 0, 0)

    in_world("empty", body)


NOISY = """
name: noisy
bounds: {from: [-3, -3], to: [3, 3]}
border: walls
robots:
  - odometry: {noise_per_metre: 0.05, noise_degrees_per_turn: 8, noise_degrees_per_metre: 3}
"""


def test_with_bad_odometry_the_goal_is_reached_all_the_same() -> None:
    async def body(lab: Lab) -> None:
        for x, y in ((2, 2), (-2, 2), (-2, -2), (2, -2), (0, 0)):
            assert (await lab.go(x, y)).status == GoalStatus.SUCCEEDED
            assert math.hypot(lab.world.robot().x - x, lab.world.robot().y - y) < 0.15
        odometry = lab.world.robot().odometry
        assert math.hypot(odometry.x, odometry.y) > 0.15, "the wheels alone would have been wrong"

    assert bumps(in_world(NOISY, body, seed=4).world) == []


def test_cancelling_stops_the_robot() -> None:
    async def body(lab: Lab) -> None:
        handle = await lab.send("/navigate_to_pose", NAVIGATE, pose=pose(2, 2))
        await lab.clock.sleep(3.0)
        assert lab.world.robot().speed > 0.2
        assert await handle.cancel()
        assert (await handle.outcome()).status == GoalStatus.CANCELED
        await lab.stands()

    in_world("house", body)


def test_a_newer_goal_takes_over_also_from_another_action() -> None:
    async def body(lab: Lab) -> None:
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

    in_world("house", body)


def test_nav2s_two_navigators_do_not_take_over_from_each_other() -> None:
    async def body(lab: Lab) -> None:
        through = "nav2_msgs/action/NavigateThroughPoses"
        first = await lab.send("/navigate_to_pose", NAVIGATE, pose=pose(2, 2))
        await lab.clock.sleep(1.0)
        with pytest.raises(GoalRejected, match="navigate_to_pose is at work"):
            await lab.send("/navigate_through_poses", through, poses=[pose(0, 1)])
        second = await lab.send("/navigate_to_pose", NAVIGATE, pose=pose(2, 0))
        assert (await first.outcome()).status == GoalStatus.ABORTED
        with pytest.raises(GoalRejected, match="navigate_to_pose is at work"):
            await lab.send("/navigate_through_poses", through, poses=[pose(0, 1)])
        await second.cancel()
        assert (await second.outcome()).status == GoalStatus.CANCELED
        third = await lab.send("/navigate_through_poses", through, poses=[pose(0, 1)])
        with pytest.raises(GoalRejected, match="navigate_through_poses is at work"):
            await lab.send("/navigate_to_pose", NAVIGATE, pose=pose(2, 2))
        assert (await third.outcome()).status == GoalStatus.SUCCEEDED
        assert (await lab.go(0, 0)).status == GoalStatus.SUCCEEDED
        empty = await lab.do("/navigate_through_poses", through)
        assert (empty.status, empty.result.error_code) == (GoalStatus.ABORTED, 309)

    in_world("house", body)


def test_a_goal_that_comes_while_the_robot_docks_takes_over() -> None:
    async def body(lab: Lab) -> None:
        for wait in (1.0, 5.5):  # on the way to the dock, and close before it
            docking = await lab.send("/dock_robot", "nav2_msgs/action/DockRobot", dock_id="dock")
            await lab.clock.sleep(wait)
            assert (await lab.go(0, 0)).status == GoalStatus.SUCCEEDED
            outcome = await docking.outcome()
            assert (outcome.status, outcome.result.success) == (GoalStatus.ABORTED, False)
            assert "newer goal" in outcome.text
            await lab.stands()

    in_world("house", body)


def test_closing_the_servers_stops_the_robot() -> None:
    async def body(lab: Lab) -> None:
        handle = await lab.send("/navigate_to_pose", NAVIGATE, pose=pose(2, 2))
        await lab.clock.sleep(3.0)
        for navigation in lab.node.navigation:
            navigation.close()
        assert (await handle.outcome()).status == GoalStatus.ABORTED
        await lab.stands()

    in_world("house", body)


def test_a_battery_that_runs_empty_ends_the_goal() -> None:
    async def body(lab: Lab) -> None:
        lab.world.robot().battery.level = 2.0
        outcome = await lab.go(2, 2)
        assert outcome.status == GoalStatus.ABORTED
        assert (outcome.result.error_code, outcome.result.error_msg) == (105, "the battery is empty")

    in_world("house", body)


PARKED = """
name: corridor
bounds: {from: [-3, -0.4], to: [3, 0.4]}
border: walls
robots:
  - {name: one, namespace: one, pose: {x: -2, y: 0, yaw_degrees: 0}}
  - {name: two, namespace: two, pose: {x: 0.5, y: 0, yaw_degrees: 0}}
"""


def test_a_robot_that_never_moves_blocks_a_corridor() -> None:
    async def body(lab: Lab) -> None:
        outcome = await lab.go(2, 0, robot="/one")
        assert outcome.status == GoalStatus.ABORTED
        assert outcome.result.error_code == 208
        assert "another robot stands in the way" in outcome.result.error_msg
        assert lab.feedback[-1].number_of_recoveries == 3
        assert 15.0 < lab.clock.elapsed < 45.0
        await lab.stands("one")

    assert bumps(in_world(PARKED, body).world) == []


def test_a_robot_that_goes_away_in_time_is_waited_for() -> None:
    async def body(lab: Lab) -> None:
        first = await lab.send("/one/navigate_to_pose", NAVIGATE, pose=pose(1.4, 0))
        await lab.clock.sleep(8.0)
        assert (await lab.go(2.5, 0, robot="/two")).status == GoalStatus.SUCCEEDED
        assert (await first.outcome()).status == GoalStatus.SUCCEEDED

    assert bumps(in_world(PARKED, body).world) == []


def test_robots_pass_each_other() -> None:
    async def body(lab: Lab) -> None:
        async def shuttle(robot: str, ends: list[tuple[float, float]]) -> None:
            for x, y in ends * 2:
                outcome = await lab.go(x, y, robot=f"/{robot}")
                assert outcome.status == GoalStatus.SUCCEEDED, outcome.text

        await asyncio.gather(
            shuttle("robot_1", [(3, 0.2), (-3, 0)]),
            shuttle("robot_2", [(-3, -0.2), (3, 2.2)]),
            shuttle("robot_3", [(3, -2.2), (0, 2.2)]),
        )

    done = in_world("three_robots", body)
    assert bumps(done.world) == []


def test_the_robot_passes_through_poses_without_a_halt() -> None:
    async def body(lab: Lab) -> None:
        speeds = []
        handle = await lab.send(
            "/navigate_through_poses",
            "nav2_msgs/action/NavigateThroughPoses",
            poses=[pose(1, 0.1), pose(2, 0.4, PI / 2)],
        )
        for _ in range(40):
            await lab.clock.sleep(0.1)
            speeds.append(lab.world.robot().speed)
        assert (await handle.outcome()).status == GoalStatus.SUCCEEDED
        near(lab.world, 2, 0.4, PI / 2)
        assert min(speeds[12:]) > 0.25
        left = [feedback.number_of_poses_remaining for feedback in lab.feedback]
        assert sorted(set(left), reverse=True) == [2, 1]

    in_world("house", body)


def test_waypoints_that_cannot_be_reached_are_missed() -> None:
    async def body(lab: Lab) -> None:
        outcome = await lab.do(
            "/follow_waypoints",
            "nav2_msgs/action/FollowWaypoints",
            poses=[pose(0, 1), pose(9, 0), pose(0, 2, PI)],
            number_of_loops=1,
        )
        assert outcome.status == GoalStatus.SUCCEEDED
        missed = outcome.result.missed_waypoints
        assert [(each.index, each.error_code) for each in missed] == [(1, 204), (1, 204)]
        assert [feedback.current_waypoint for feedback in lab.feedback] == [0, 1, 2, 0, 1, 2]
        near(lab.world, 0, 2, PI)
        empty = await lab.do("/follow_waypoints", "nav2_msgs/action/FollowWaypoints")
        assert (empty.status, empty.result.error_code) == (GoalStatus.ABORTED, 602)

    in_world("house", body)


def test_a_goal_pose_on_a_topic_is_enough() -> None:
    async def body(lab: Lab) -> None:
        for topic, goal in (("/goal_pose", pose(1, 0)), ("/move_base_simple/goal", pose(0, 1))):
            publisher = lab.backend.publisher(topic, "geometry_msgs/msg/PoseStamped")
            publisher.publish(publisher.message(**goal))
            await lab.clock.sleep(15.0)
            near(lab.world, goal["pose"]["position"]["x"], goal["pose"]["position"]["y"], 0)

    in_world("house", body)


def test_docking_and_undocking_as_nav2_has_it() -> None:
    async def body(lab: Lab) -> None:
        outcome = await lab.do("/dock_robot", "nav2_msgs/action/DockRobot", dock_id="dock")
        assert outcome.status == GoalStatus.SUCCEEDED
        assert outcome.result.success
        assert [feedback.state for feedback in lab.feedback] == [1, 2, 3, 4]
        assert lab.world.robot().dock is not None
        again = await lab.do("/dock_robot", "nav2_msgs/action/DockRobot", dock_id="dock")
        assert again.status == GoalStatus.SUCCEEDED
        assert (await lab.do("/undock_robot", "nav2_msgs/action/UndockRobot")).result.success
        await lab.stands()
        assert lab.world.robot().dock is None
        outside = await lab.do("/undock_robot", "nav2_msgs/action/UndockRobot")
        assert (outside.status, outside.result.success) == (GoalStatus.ABORTED, False)
        unknown = await lab.do("/dock_robot", "nav2_msgs/action/DockRobot", dock_id="dok")
        assert (unknown.status, unknown.result.error_code) == (GoalStatus.ABORTED, 901)
        assert unknown.result.error_msg == "there is no dock 'dok'; the docks are: dock"
        assert not unknown.result.success
        by_pose = await lab.do(
            "/dock_robot", "nav2_msgs/action/DockRobot", use_dock_id=False, dock_pose=pose(1, 1.2)
        )
        assert by_pose.status == GoalStatus.SUCCEEDED
        wrong = await lab.do(
            "/dock_robot", "nav2_msgs/action/DockRobot", use_dock_id=False, dock_pose=pose(2, 2)
        )
        assert wrong.result.error_code == 902

    in_world("house", body)


def test_staging_that_takes_too_long_fails() -> None:
    async def body(lab: Lab) -> None:
        outcome = await lab.do(
            "/dock_robot", "nav2_msgs/action/DockRobot", dock_id="dock", max_staging_time=1.0
        )
        assert (outcome.status, outcome.result.error_code) == (GoalStatus.ABORTED, 903)
        await lab.stands()

    in_world("house", body)


def test_the_actions_of_a_turtlebot_4() -> None:
    async def body(lab: Lab) -> None:
        states: list[Any] = []
        lab.backend.subscription(
            "/dock_status",
            "irobot_create_msgs/msg/DockStatus",
            lambda sample: states.append((sample.message.dock_visible, sample.message.is_docked)),
        )
        with pytest.raises(GoalRejected, match="in no dock"):
            await lab.do("/undock", "irobot_create_msgs/action/Undock")
        docking = await lab.send("/dock", "irobot_create_msgs/action/Dock")
        await lab.clock.sleep(1.0)
        with pytest.raises(GoalRejected, match="/dock is at work"):
            await lab.do("/dock", "irobot_create_msgs/action/Dock")
        assert (await docking.outcome()).result.is_docked
        with pytest.raises(GoalRejected, match="docked already"):
            await lab.do("/dock", "irobot_create_msgs/action/Dock")
        await lab.clock.sleep(1.0)
        assert (True, True) in states
        before = lab.world.robot().yaw
        assert not (await lab.do("/undock", "irobot_create_msgs/action/Undock")).result.is_docked
        assert math.cos(lab.world.robot().yaw - before) < -0.9, "it has turned round"
        start = lab.world.robot().pose
        await lab.do("/drive_distance", "irobot_create_msgs/action/DriveDistance", distance=-0.3)
        there = lab.world.robot().pose
        assert math.hypot(there.x - start.x, there.y - start.y) == pytest.approx(0.3, abs=0.02)
        turned = lab.world.robot().odometry.turned
        await lab.do("/rotate_angle", "irobot_create_msgs/action/RotateAngle", angle=-7.0)
        assert lab.world.robot().odometry.turned - turned == pytest.approx(-7.0, abs=0.05)
        assert (await lab.do("/dock_drive_action", "kobuki_msgs/action/AutoDocking")).text == ""
        assert lab.world.robot().dock is not None

    in_world("house", body)


def test_a_dock_out_of_sight_is_not_found() -> None:
    async def body(lab: Lab) -> None:
        assert (await lab.go(2, 2)).status == GoalStatus.SUCCEEDED
        with pytest.raises(GoalRejected, match="no dock in sight"):
            await lab.do("/dock", "irobot_create_msgs/action/Dock")
        blocked = await lab.do("/drive_distance", "irobot_create_msgs/action/DriveDistance", distance=9.0)
        assert blocked.status == GoalStatus.ABORTED
        assert "in the way" in blocked.text
        await lab.stands()
        assert 2.5 < lab.world.robot().x < 3.1, "the edge of the map"

    in_world("empty", body)


def test_the_bumper_is_told_in_the_messages_of_all_three_turtlebots() -> None:
    seen: dict[str, list[Any]] = {}

    async def body(lab: Lab) -> None:
        def listen(topic: str, type_name: str) -> None:
            seen[topic] = []
            lab.backend.subscription(topic, type_name, lambda sample: seen[topic].append(sample.message))

        listen("/hazard_detection", "irobot_create_msgs/msg/HazardDetectionVector")
        listen("/sensor_state", "turtlebot3_msgs/msg/SensorState")
        listen("/mobile_base/events/bumper", "kobuki_msgs/msg/BumperEvent")
        publisher = lab.backend.publisher("/cmd_vel", TWIST)
        for speed in [0.3] * 40 + [-0.3] * 10:
            publisher.publish(publisher.message(linear={"x": speed}))
            await lab.clock.sleep(0.1)

    world = "name: cell\nbounds: {from: [-1, -1], to: [1, 1]}\nborder: walls\nrobots: [{name: r}]\n"
    in_world(world, body)
    hazards = [
        [(each.type, each.header.frame_id) for each in message.detections]
        for message in seen["/hazard_detection"]
    ]
    assert hazards[0] == hazards[-1] == []
    assert [(1, "bump_front_center")] in hazards
    states = [message.bumper for message in seen["/sensor_state"]]
    assert (states[0], max(states), states[-1]) == (0, 1, 0)
    assert seen["/sensor_state"][30].left_encoder == seen["/sensor_state"][30].right_encoder > 100
    assert [(each.bumper, each.state) for each in seen["/mobile_base/events/bumper"]] == [(1, 1), (1, 0)]


def test_the_map_comes_latched_and_by_service() -> None:
    async def body(lab: Lab) -> None:
        maps: list[Any] = []
        latched = QoS(durability="transient_local", depth=1)
        for _ in range(2):  # the second one comes late
            lab.backend.subscription(
                "/map", "nav_msgs/msg/OccupancyGrid", lambda sample: maps.append(sample.message), latched
            )
            await lab.clock.sleep(1.0)
        assert len(maps) == 2
        info, data = maps[0].info, maps[0].data
        assert (info.width, info.height) == (88, 88)
        assert info.resolution == pytest.approx(0.05)
        assert (info.origin.position.x, info.origin.position.y) == pytest.approx((-1.2, -1.2))

        def at(x: float, y: float) -> int:
            return int(data[math.floor((y + 1.2) / 0.05) * 88 + math.floor((x + 1.2) / 0.05)])

        assert at(0, 0) == at(2, 2) == 0
        assert at(3, 3) == at(-1.19, 0) == at(1.01, -0.9) == 100
        client = lab.backend.client("/map_server/map", "nav_msgs/srv/GetMap")
        answer = await client.call(timeout=5.0)
        assert list(answer.map.data) == list(data)

    in_world("house", body)


def test_navigation_can_be_switched_off() -> None:
    async def body(lab: Lab) -> None:
        assert lab.node.navigation == []
        await lab.clock.sleep(0.2)
        assert not lab.backend.action_client("/navigate_to_pose", NAVIGATE).ready

    in_world("name: w\nrobots: [{name: r, navigation: false}]\n", body)


def test_types_that_are_not_known_are_left_out_and_told(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = VirtualClock()
    told = []

    async def main() -> None:
        backend = open_backend("memory", clock, "world")
        await backend.start()
        offer = backend.action_server

        def some(name: str, type_name: str, *rest: Any) -> Any:
            if "irobot" in type_name:
                raise UnknownInterface("not here")
            return offer(name, type_name, *rest)

        monkeypatch.setattr(backend, "action_server", some)
        monkeypatch.setattr(backend, "rosout", lambda level, text: told.append((level, text)))
        node = SimNode(World.load("empty"), backend, clock)
        node.start()
        assert backend.action_client("/navigate_to_pose", NAVIGATE).ready
        node.close()
        await backend.close()

    run(main, clock)
    assert told[0] == (
        "warn",
        "action /dock is not offered: irobot_create_msgs/action/Dock is not known here",
    )
    assert len(told) == 4


PROGRAM = """
from test_navigation import NAVIGATE, in_world, pose
async def body(lab):
    lab.backend.subscription("/robot_1/scan", "sensor_msgs/msg/LaserScan", lambda sample: None)
    first = await lab.send("/robot_1/navigate_to_pose", NAVIGATE, pose=pose(-2, -2, 1))
    await lab.go(2, 1.5, 2, robot="/robot_0")
    await first.outcome()
print(in_world("two_robots", body, 7).world.ground_truth.digest())
"""


def digest(**environment: str) -> str:
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM],
        cwd=os.path.dirname(__file__),
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        check=True,
    )
    return done.stdout.strip()


def test_the_same_goals_give_the_same_run_to_the_last_bit() -> None:
    assert digest() == digest(PYTHONHASHSEED="5") == digest(NPY_DISABLE_CPU_FEATURES="AVX2 FMA3")
