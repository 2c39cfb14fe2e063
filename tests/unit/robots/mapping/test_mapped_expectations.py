"""What operations of a mapping expect: of the artifact itself, and of the robot's other artifacts."""

import asyncio

import pytest
from mapped_lab import mapped, settle
from robot_lab import Lab, in_lab

from jacaros.artifacts import ArtifactId
from jacaros.artifacts.env.values import text
from jacaros.robots.mapping.artifact import mapped_type
from jacaros.robots.mapping.file import find_mapping, load_mapping
from jacaros.robots.ros.action import ServerGoal
from jacaros.robots.ros.qos import LATCHED
from played import played

CHARGING, DISCHARGING, NOT_CHARGING, FULL = 1, 2, 3, 4


async def shipped(lab: Lab, file: str) -> ArtifactId:
    path = find_mapping(file)
    assert path is not None
    return await lab.make(mapped_type(load_mapping(path), file.removesuffix(".yaml")))


def offer(lab: Lab, action: str, kind: str, seconds: float, **result: object) -> list[str]:
    """A server that says after some seconds that it has succeeded, whatever is true."""
    events: list[str] = []

    async def execute(goal: ServerGoal) -> dict[str, object]:
        events.append(f"goal {lab.clock.elapsed:g}")
        try:
            await lab.sleep(seconds)
        except asyncio.CancelledError:
            events.append(f"cancelled {lab.clock.elapsed:g}")
            raise
        return result

    lab.backend.action_server(action, kind, execute)
    return events


async def battery(lab: Lab, status: int, percentage: float = 0.4) -> None:
    fields = {"percentage": percentage, "power_supply_status": status}
    lab.say("battery_state", "sensor_msgs/msg/BatteryState", **fields)
    await settle()


async def docked(lab: Lab, there: bool) -> None:
    lab.say("dock_status", "irobot_create_msgs/msg/DockStatus", is_docked=there)
    await settle()


async def bump(lab: Lab) -> None:
    kind = "irobot_create_msgs/msg/HazardDetection"
    detection = {"header": {"frame_id": "bump_front_left"}, "type": 1}
    lab.say("hazard_detection", f"{kind}Vector", detections=[detection])
    await settle()


@pytest.mark.parametrize(
    ("status", "in_dock", "percentage", "reason", "at"),
    [
        (DISCHARGING, True, 0.4, "not_charging", 13),
        (DISCHARGING, False, 0.4, "not_docked", 8),
        (CHARGING, True, 0.4, "None", 3),
        (FULL, True, 1.0, "None", 3),
        (NOT_CHARGING, True, 1.0, "None", 3),
    ],
)
def test_a_dock_without_current_and_a_wrong_dock_status(
    status: int, in_dock: bool, percentage: float, reason: str, at: float
) -> None:
    async def body(lab: Lab) -> None:
        base = await shipped(lab, "turtlebot4.yaml")
        offer(lab, "dock", "irobot_create_msgs/action/Dock", 3, is_docked=True)
        await docked(lab, in_dock)
        await battery(lab, status, percentage)
        run = await lab.call(base, "dock")
        assert (run.reason, round(lab.clock.elapsed, 3)) == (reason, at)
        if not run.ok:
            assert "expected" in run.message
            assert "found" in run.message

    in_lab(body, None)


@played(in_lab, world=None)
async def test_a_current_that_comes_late_is_waited_for(lab: Lab) -> None:
    base = await shipped(lab, "turtlebot4.yaml")
    offer(lab, "dock", "irobot_create_msgs/action/Dock", 3, is_docked=True)
    await docked(lab, True)
    await battery(lab, DISCHARGING)
    run = await lab.begun(9, base, "dock")
    await battery(lab, CHARGING)
    await run.done
    assert (run.ok, round(lab.clock.elapsed, 3)) == (True, 9)


@played(in_lab, world=None)
async def test_the_dock_was_not_left(lab: Lab) -> None:
    base, nav = await shipped(lab, "turtlebot4.yaml"), await shipped(lab, "nav2.yaml")
    offer(lab, "undock", "irobot_create_msgs/action/Undock", 1, is_docked=False)
    offer(lab, "undock_robot", "nav2_msgs/action/UndockRobot", 1, success=True)
    await docked(lab, True)
    await battery(lab, CHARGING)
    assert (await lab.call(base, "undock")).reason == "still_docked"
    assert (await lab.call(nav, "leave_dock")).reason == "still_docked"


@pytest.mark.parametrize(
    ("goal", "reason"), [((2, 0, 175), "None"), ((2.7, 0, 175), "not_there"), ((2, 0, 90), "not_there")]
)
def test_a_robot_that_is_elsewhere_has_not_arrived(goal: tuple[float, float, float], reason: str) -> None:
    async def body(lab: Lab) -> None:
        nav = await shipped(lab, "nav2.yaml")
        offer(lab, "navigate_to_pose", "nav2_msgs/action/NavigateToPose", 1)
        placed = {
            "header": {"frame_id": "map"},
            "child_frame_id": "base_link",
            "transform": {"translation": {"x": 2.1}, "rotation": {"z": -1.0, "w": 0.02}},
        }
        lab.say("/tf_static", "tf2_msgs/msg/TFMessage", LATCHED, transforms=[placed])
        await lab.sleep(0.5)
        run = await lab.call(nav, "navigate_to", *goal)
        assert run.reason == reason
        if not run.ok:
            assert "found pose(2.1,0," in run.message

    in_lab(body, None)


@played(in_lab, world=None)
async def test_a_bump_on_a_planned_way_cancels_the_goal(lab: Lab) -> None:
    await shipped(lab, "turtlebot4.yaml")
    nav = await shipped(lab, "nav2.yaml")
    events = offer(lab, "navigate_to_pose", "nav2_msgs/action/NavigateToPose", 30)
    run = await lab.begun(2, nav, "navigate_to", 5, 0, 0)
    await bump(lab)
    await lab.sleep(0.1)
    assert (run.reason, events) == ("bumped", ["goal 0", "cancelled 2"])
    assert 'stopped by hazard(bump,"bump_front_left")' in run.message


@played(in_lab, world=None)
async def test_a_robot_without_such_a_topic_keeps_its_operation_and_warns_once(lab: Lab) -> None:
    base = await shipped(lab, "turtlebot4.yaml")
    offer(lab, "dock", "irobot_create_msgs/action/Dock", 1, is_docked=True)
    await docked(lab, True)
    await lab.do(base, "dock")
    await lab.do(base, "dock")
    assert [line for line in lab.logged if "cannot check" in line] == [
        "[a5] warning: cannot check the effect of dock/0: no artifact of this robot shows battery/2"
    ]


@played(in_lab)
async def test_a_driving_robot_stands_when_a_condition_is_violated(lab: Lab) -> None:
    kind = """
properties: {load: {topic: load, type: std_msgs/msg/Float64, fields: [data]}}
operations:
  drive:
    parameters: [speed]
    publish: cmd_vel
    type: geometry_msgs/msg/Twist
    fields: {linear.x: $speed}
    rate: 10
    duration: 10
    meanwhile: {load: [{near: 1, by: 0.5}]}
"""
    run = await lab.begun(2, await lab.make(mapped(kind)), "drive", 0.2)
    assert lab.speed()[0] > 0.1
    lab.say("load", "std_msgs/msg/Float64", data=3.0)
    await lab.sleep(0.6)
    assert lab.speed() == (0, 0)
    assert run.outcome is not None
    assert text(run.outcome.reason) == "expected(load(near(1,0.5)),found(load(3)))"
