"""Where robots are and goals lie: the frames of the tf tree, and a pose set from outside."""

import math
from typing import Any

import pytest
from navigation_lab import Lab, near, pose

from jacaros.robots.plane.trigonometry import PI
from jacaros.robots.ros.action import GoalStatus
from jacaros.robots.ros.qos import LATCHED

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
@pytest.mark.world(FROM_START)
async def test_goals_may_be_in_any_frame_of_the_robot(lab: Lab, frame: str, x: float, y: float) -> None:
    """At the start odometry and base are the same frame: one metre to the right of the map's middle, looking up."""
    goal = (x, y, 0.0) if frame != "map" else (0.0, -1.0, PI / 2)
    outcome = await lab.go(*goal, frame, "/robot_1")
    assert outcome.status == GoalStatus.SUCCEEDED
    near(lab.world, 0, -1, PI / 2)


pytestmark = pytest.mark.world("empty")


@pytest.mark.world(FROM_START)
async def test_the_tf_tree_joins_map_odometry_and_base(lab: Lab) -> None:
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


async def test_goals_in_foreign_frames_go_through_tf(lab: Lab) -> None:
    turn = {"translation": {"x": 1.0, "y": 1.0}, "rotation": {"z": 1.0, "w": 0.0}}
    table = {"header": {"frame_id": "map"}, "child_frame_id": "table", "transform": turn}
    lab.backend.tf_broadcast(table, static=True)
    outcome = await lab.go(1, 0, 0.0, "table")
    assert outcome.status == GoalStatus.SUCCEEDED
    near(lab.world, 0, 1, PI)


TYPE = "geometry_msgs/msg/PoseWithCovarianceStamped"


def tell_pose(
    lab: Lab, x: float, y: float, yaw: float = 0.0, frame: str = "map", spread: float = 0.0
) -> None:
    """As rviz's "2D Pose Estimate", whose spread is 0.25."""
    told, covariance = pose(x, y, yaw, frame), [0.0] * 36
    covariance[0] = covariance[7] = spread
    lab.say(
        "/initialpose", TYPE, header=told["header"], pose={"pose": told["pose"], "covariance": covariance}
    )


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
async def test_a_received_pose_sets_the_estimate(
    lab: Lab, x: float, y: float, yaw: float, frame: str, spread: float, lost: bool
) -> None:
    lab.backend.tf_listen()
    tell_pose(lab, x, y, yaw, frame, spread)
    await lab.clock.sleep(2.0)
    believed = lab.backend.tf_lookup("map", "base_link")
    expected = (x, y, yaw) if lost else (0.0, 0.0, 0.0)
    assert (*believed.translation[:2], believed.yaw) == pytest.approx(expected, abs=1e-6)


async def test_a_lost_robot_drives_wrong_until_it_receives_its_pose(lab: Lab) -> None:
    tell_pose(lab, 1, 0)
    assert (await lab.go(2, 0)).status == GoalStatus.SUCCEEDED
    near(lab.world, 1, 0, 0)
    tell_pose(lab, 1.1, 0.1, spread=0.25)
    await lab.clock.sleep(1.0)
    assert (await lab.go(2, 0)).status == GoalStatus.SUCCEEDED
    near(lab.world, 2, 0, 0)


def believed(message: Any) -> tuple[float, float, float, float]:
    """x, y and the variances of x and of the heading."""
    place, covariance = message.pose.pose.position, message.pose.covariance
    assert covariance[7] == covariance[0]
    return (round(place.x, 3), round(place.y, 3), round(covariance[0], 6), round(covariance[35], 6))


async def test_the_estimated_pose_is_latched_and_published_after_25_cm_or_11_degrees(lab: Lab) -> None:
    first = lab.hear("/amcl_pose", TYPE, LATCHED)
    await lab.clock.sleep(3.0)
    assert [believed(each) for each in first] == [(0.0, 0.0, 0.0025, 0.001)]
    assert first[0].header.frame_id == "map"
    assert first[0].pose.pose.orientation.w == 1.0
    robot = lab.world.robot()
    robot.command(0.3, 0.0)
    for _ in range(20):
        robot.command(0.3, 0.0)
        await lab.clock.sleep(0.1)
    driven = [believed(each)[0] for each in first[1:]]
    assert len(driven) == 2
    assert driven[0] == pytest.approx(0.25, abs=0.03)
    assert driven[1] - driven[0] == pytest.approx(0.25, abs=0.03)
    await lab.clock.sleep(2.0)
    count = len(first)
    for _ in range(5):
        robot.command(0.0, 0.6)
        await lab.clock.sleep(0.1)
    assert len(first) == count + 1
    late = lab.hear("/amcl_pose", TYPE, LATCHED)
    await lab.clock.sleep(0.1)
    assert [believed(each) for each in late] == [believed(first[-1])]


async def test_a_received_pose_keeps_its_covariance_until_the_robot_has_moved(lab: Lab) -> None:
    messages = lab.hear("/amcl_pose", TYPE, LATCHED)
    await lab.clock.sleep(0.2)
    tell_pose(lab, 0.3, 0.0, spread=0.25)
    await lab.clock.sleep(2.0)
    assert [believed(each) for each in messages] == [(0.0, 0.0, 0.0025, 0.001), (0.3, 0.0, 0.25, 0.0)]
    await lab.drive(6.0, 0.0, 1.0)
    found = [believed(each) for each in messages[2:]]
    assert {each[:2] for each in found} == {(0.0, 0.0)}
    assert found[-1][2:] == (0.0025, 0.001)
    assert found == sorted(found, reverse=True), "surer each time"


@pytest.mark.world("two_robots")
async def test_the_pose_of_a_robot_is_in_its_namespace(lab: Lab) -> None:
    name = lab.world.description.robots[0].namespace
    messages = lab.hear(f"/{name}/amcl_pose", TYPE, LATCHED)
    await lab.clock.sleep(0.2)
    assert [each.header.frame_id for each in messages] == [f"{name}/map"]
