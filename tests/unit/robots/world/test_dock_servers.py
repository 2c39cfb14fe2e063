"""Robots dock and undock with the actions of Nav2 and of the TurtleBots, and publish bumps."""

import math
from typing import Any

import pytest
from navigation_lab import Lab, in_world, pose

from jacaros.robots.ros.action import GoalStatus
from jacaros.robots.ros.errors import GoalRejected
from played import played

TWIST = "geometry_msgs/msg/Twist"


@played(in_world, "house")
async def test_docking_and_undocking_as_in_nav2(lab: Lab) -> None:
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
    assert unknown.result.error_msg == "unknown dock 'dok'; docks: dock"
    assert not unknown.result.success
    by_pose = await lab.do(
        "/dock_robot", "nav2_msgs/action/DockRobot", use_dock_id=False, dock_pose=pose(1, 1.2)
    )
    assert by_pose.status == GoalStatus.SUCCEEDED
    wrong = await lab.do("/dock_robot", "nav2_msgs/action/DockRobot", use_dock_id=False, dock_pose=pose(2, 2))
    assert wrong.result.error_code == 902


@played(in_world, "house")
async def test_staging_that_takes_too_long_fails(lab: Lab) -> None:
    outcome = await lab.do("/dock_robot", "nav2_msgs/action/DockRobot", dock_id="dock", max_staging_time=1.0)
    assert (outcome.status, outcome.result.error_code) == (GoalStatus.ABORTED, 903)
    await lab.stands()


@played(in_world, "house")
async def test_the_actions_of_a_turtlebot_4(lab: Lab) -> None:
    states: list[Any] = []
    lab.backend.subscription(
        "/dock_status",
        "irobot_create_msgs/msg/DockStatus",
        lambda sample: states.append((sample.message.dock_visible, sample.message.is_docked)),
    )
    with pytest.raises(GoalRejected, match="not docked"):
        await lab.do("/undock", "irobot_create_msgs/action/Undock")
    docking = await lab.send("/dock", "irobot_create_msgs/action/Dock")
    await lab.clock.sleep(1.0)
    with pytest.raises(GoalRejected, match="/dock is running"):
        await lab.do("/dock", "irobot_create_msgs/action/Dock")
    assert (await docking.outcome()).result.is_docked
    with pytest.raises(GoalRejected, match="already docked"):
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


@played(in_world, "empty")
async def test_a_dock_out_of_sight_is_not_found(lab: Lab) -> None:
    assert (await lab.go(2, 2)).status == GoalStatus.SUCCEEDED
    with pytest.raises(GoalRejected, match="no dock in sight"):
        await lab.do("/dock", "irobot_create_msgs/action/Dock")
    blocked = await lab.do("/drive_distance", "irobot_create_msgs/action/DriveDistance", distance=9.0)
    assert blocked.status == GoalStatus.ABORTED
    assert "blocked" in blocked.text
    await lab.stands()
    assert 2.5 < lab.world.robot().x < 3.1, "the edge of the map"


def test_the_bumper_is_published_for_all_three_turtlebots() -> None:
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
