"""Robots dock and undock with the actions of Nav2 and of the TurtleBots, and publish bumps."""

import math

import pytest
from navigation_lab import Lab, pose

from jacaros.robots.ros.action import GoalStatus
from jacaros.robots.ros.errors import GoalRejected

DOCK, UNDOCK = (
    ("/dock_robot", "nav2_msgs/action/DockRobot"),
    ("/undock_robot", "nav2_msgs/action/UndockRobot"),
)
CREATE_DOCK, CREATE_UNDOCK = (
    (f"/{name.lower()}", f"irobot_create_msgs/action/{name}") for name in ("Dock", "Undock")
)
DRIVE_DISTANCE = ("/drive_distance", "irobot_create_msgs/action/DriveDistance")

pytestmark = pytest.mark.world("house")


async def test_docking_and_undocking_as_in_nav2(lab: Lab) -> None:
    outcome = await lab.do(*DOCK, dock_id="dock")
    assert outcome.status == GoalStatus.SUCCEEDED
    assert outcome.result.success
    assert [feedback.state for feedback in lab.feedback] == [1, 2, 3, 4]
    assert lab.world.robot().dock is not None
    again = await lab.do(*DOCK, dock_id="dock")
    assert again.status == GoalStatus.SUCCEEDED
    assert (await lab.do(*UNDOCK)).result.success
    await lab.stands()
    assert lab.world.robot().dock is None
    outside = await lab.do(*UNDOCK)
    assert (outside.status, outside.result.success) == (GoalStatus.ABORTED, False)
    unknown = await lab.do(*DOCK, dock_id="dok")
    assert (unknown.status, unknown.result.error_code) == (GoalStatus.ABORTED, 901)
    assert unknown.result.error_msg == "unknown dock 'dok'; docks: dock"
    assert not unknown.result.success
    by_pose = await lab.do(*DOCK, use_dock_id=False, dock_pose=pose(1, 1.2))
    assert by_pose.status == GoalStatus.SUCCEEDED
    wrong = await lab.do(*DOCK, use_dock_id=False, dock_pose=pose(2, 2))
    assert wrong.result.error_code == 902


async def test_staging_that_takes_too_long_fails(lab: Lab) -> None:
    outcome = await lab.do(*DOCK, dock_id="dock", max_staging_time=1.0)
    assert (outcome.status, outcome.result.error_code) == (GoalStatus.ABORTED, 903)
    await lab.stands()


async def test_the_actions_of_a_turtlebot_4(lab: Lab) -> None:
    states = lab.hear("/dock_status", "irobot_create_msgs/msg/DockStatus")
    with pytest.raises(GoalRejected, match="not docked"):
        await lab.do(*CREATE_UNDOCK)
    docking = await lab.send(*CREATE_DOCK)
    await lab.clock.sleep(1.0)
    with pytest.raises(GoalRejected, match="/dock is running"):
        await lab.do(*CREATE_DOCK)
    assert (await docking.outcome()).result.is_docked
    with pytest.raises(GoalRejected, match="already docked"):
        await lab.do(*CREATE_DOCK)
    await lab.clock.sleep(1.0)
    assert (True, True) in [(each.dock_visible, each.is_docked) for each in states]
    robot = lab.world.robot()
    before = robot.yaw
    assert not (await lab.do(*CREATE_UNDOCK)).result.is_docked
    assert math.cos(robot.yaw - before) < -0.9, "it has turned round"
    start = robot.pose
    await lab.do(*DRIVE_DISTANCE, distance=-0.3)
    assert math.dist(robot.pose[:2], start[:2]) == pytest.approx(0.3, abs=0.02)
    turned = robot.odometry.turned
    await lab.do("/rotate_angle", "irobot_create_msgs/action/RotateAngle", angle=-7.0)
    assert robot.odometry.turned - turned == pytest.approx(-7.0, abs=0.05)
    assert (await lab.do("/dock_drive_action", "kobuki_msgs/action/AutoDocking")).text == ""
    assert robot.dock is not None


@pytest.mark.world("empty")
async def test_a_dock_out_of_sight_is_not_found(lab: Lab) -> None:
    assert (await lab.go(2, 2)).status == GoalStatus.SUCCEEDED
    with pytest.raises(GoalRejected, match="no dock in sight"):
        await lab.do(*CREATE_DOCK)
    blocked = await lab.do(*DRIVE_DISTANCE, distance=9.0)
    assert blocked.status == GoalStatus.ABORTED
    assert "blocked" in blocked.text
    await lab.stands()
    assert 2.5 < lab.world.robot().x < 3.1, "the edge of the map"


@pytest.mark.world("name: cell\nbounds: {from: [-1, -1], to: [1, 1]}\nborder: walls\nrobots: [{name: r}]\n")
async def test_the_bumper_is_published_for_all_three_turtlebots(lab: Lab) -> None:
    vectors = lab.hear("/hazard_detection", "irobot_create_msgs/msg/HazardDetectionVector")
    sensors = lab.hear("/sensor_state", "turtlebot3_msgs/msg/SensorState")
    events = lab.hear("/mobile_base/events/bumper", "kobuki_msgs/msg/BumperEvent")
    await lab.drive(4.0, 0.3)
    await lab.drive(1.0, -0.3)
    hazards = [[(each.type, each.header.frame_id) for each in message.detections] for message in vectors]
    assert hazards[0] == hazards[-1] == []
    assert [(1, "bump_front_center")] in hazards
    states = [message.bumper for message in sensors]
    assert (states[0], max(states), states[-1]) == (0, 1, 0)
    assert sensors[30].left_encoder == sensors[30].right_encoder > 100
    assert [(each.bumper, each.state) for each in events] == [(1, 1), (1, 0)]
