"""Faults of the world: their effects, their times, and the ground truth about them."""

import hashlib
import json
import math
from pathlib import Path
from typing import Any

import pytest
from navigation_lab import Lab, in_world, pose

from jacaros.robots.plane.pose import Placement
from jacaros.robots.world import GroundTruth, World
from jacaros.robots.world.process import GroundTruthFile
from jacaros.runtime.errors import UsageError

WORLD = """
name: faulty
seed: 5
bounds: {from: [-3, -3], to: [3, 3]}
border: walls
doors:
  - {name: kitchen, segment: [[2, -1], [2, 1]], open: true}
docks:
  - {name: dock, x: 0, y: 0}
robots:
  - name: turtlebot
    battery: {level: 50, charge_per_second: 5}
"""


def world_with(faults: str) -> World:
    return World.load(WORLD, faults="faults:\n  f: " + faults + "\n")


def drive(world: World, seconds: float, speed: float = 0.3, turn_rate: float = 0.0) -> None:
    for _ in range(round(seconds * 10)):
        world.command("turtlebot", speed, turn_rate)
        world.run(0.1)


def states(world: World) -> list[tuple[float, str]]:
    return [(event.time, event.data["state"]) for event in world.ground_truth.events_of("fault")]


def test_a_fault_starts_and_ends_on_schedule() -> None:
    world = world_with("{kind: wheel_slip, share: 0.5, at: 1, for: 2}")
    drive(world, 4.0)
    assert states(world) == [(1.0, "begins"), (1.0, "acts"), (3.0, "ends")]
    [first, _, _] = world.ground_truth.events_of("fault")
    assert (first.robot, first.data["fault"], first.data["kind"]) == ("turtlebot", "f", "wheel_slip")


def test_slipping_wheels_turn_farther_than_the_robot_drives() -> None:
    world = world_with("{kind: wheel_slip, share: 0.4, at: 0}")
    drive(world, 5.0)
    robot = world.robot()
    assert robot.odometry.x == pytest.approx(1.45, abs=0.06)
    assert robot.x == pytest.approx(0.6 * robot.odometry.x, rel=0.1)


@pytest.mark.parametrize(("wheel", "turns"), [("left", 1), ("right", -1)])
def test_a_robot_with_a_blocked_wheel_turns_round_it(wheel: str, turns: int) -> None:
    world = world_with(f"{{kind: blocked_wheel, wheel: {wheel}, at: 0}}")
    drive(world, 1.0)
    robot = world.robot()
    assert robot.yaw * turns > 0.5
    assert robot.odometry.yaw == pytest.approx(robot.yaw), "the wheels are what odometry counts"


def test_a_robot_with_two_blocked_wheels_does_not_move() -> None:
    world = world_with("{kind: blocked_wheel, at: 0, for: 1.1}")
    drive(world, 0.5)
    drive(world, 0.5, turn_rate=1.0)
    assert world.robot().pose == (0, 0, 0)
    drive(world, 2.0)
    assert world.robot().x > 0.1


def test_a_kidnapped_robot_does_not_notice() -> None:
    world = world_with("{kind: kidnapped_robot, to: {x: 1, y: -2, yaw_degrees: 90}, at: 1}")
    world.run(2.0)
    robot = world.robot()
    assert robot.pose == pytest.approx((1, -2, math.pi / 2))
    assert (robot.odometry.x, robot.odometry.y) == (0, 0)


def test_a_battery_drops_and_a_dead_dock_does_not_charge() -> None:
    world = world_with(
        "{kind: battery_drop, to: 15, at: 1}\n  cold: {kind: dead_dock, dock: dock, at: 1, for: 5}"
    )
    world.run(0.5)
    assert world.robot().battery.charging
    world.run(5.0)
    assert 14.5 < world.robot().battery.level < 15
    assert not world.robot().battery.charging
    world.run(2.0)
    assert world.robot().battery.charging


def test_a_dirty_contact_comes_and_goes_alike_in_each_run() -> None:
    def charging() -> list[bool]:
        world = world_with("{kind: dirty_contact, dock: dock, at: 0, for: 10}")
        found = []
        for _ in range(12):
            world.run(0.98)  # before the end of each second
            found.append(world.robot().fed)
            world.run(0.02)
        return found

    found = charging()
    assert set(found[:9]) == {True, False}
    assert found[11], "clean again"
    assert found == charging()


def test_a_wrong_dock_takes_the_robot_without_charging_it() -> None:
    world = world_with("{kind: wrong_dock, to: {x: 0.1}, at: 1, for: 2}")
    world.run(2.0)
    robot = world.robot()
    assert [dock.name for dock in (robot.dock, world.visible_dock(robot)) if dock] == ["f", "dock"]
    assert not robot.battery.charging
    world.run(2.0)
    assert robot.battery.charging
    docked = [
        (event.kind, event.data["dock"]) for event in world.ground_truth.events_of("docked", "undocked")
    ]
    assert docked == [
        ("docked", "dock"),
        ("undocked", "dock"),
        ("docked", "f"),
        ("undocked", "f"),
        ("docked", "dock"),
    ]


def test_a_person_stands_in_the_way_of_the_robot_wherever_it_is() -> None:
    world = world_with("{kind: person_in_the_way, gap: 0.4, at: 1, for: 60}")
    drive(world, 1.5, turn_rate=1.0)
    person, robot = world.people["f"], world.robot()
    ahead = Placement.at(*robot.pose).local(person.x, person.y)
    assert math.hypot(*ahead) == pytest.approx(0.4 + 0.17 + 0.25, abs=0.2)
    drive(world, 62.0, speed=0.0)
    assert world.people == {}


def test_people_do_not_stand_in_walls() -> None:
    world = world_with("{kind: person_in_the_way}")
    world.robot().x = 2.0
    assert "a wall is in the way" in str(world.faults.begin("f"))


def test_a_door_closes_and_opens_unless_it_is_blocked() -> None:
    world = world_with("{kind: closed_door, door: kitchen, at: 1, for: 2}")
    world.run(2.0)
    assert world.doors == {"kitchen": False}
    world.run(2.0)
    assert world.doors == {"kitchen": True}
    world.robot().x = 2.0
    assert world.faults.begin("f") == "turtlebot is in the way"
    assert states(world)[-1][1] == "refused"
    assert world.faults.at_work == []


def test_a_person_comes_and_goes() -> None:
    world = world_with("{kind: person, path: [[1, 0]], at: 1, for: 3}")
    world.run(2.0)
    assert list(world.people) == ["f"]
    drive(world, 1.9, 0.6)
    assert world.ground_truth.events_of("collision") != []
    world.run(1.0)
    assert world.people == {}


def test_faults_can_be_started_and_ended() -> None:
    world = world_with("{kind: blocked_wheel}")
    world.run(1.0)
    assert world.faults.at_work == []
    assert world.faults.begin("f") is None
    assert world.faults.begin("f") is None, "it goes on"
    assert world.faults.at_work == ["f"]
    world.faults.end("f")
    world.faults.end("f")
    assert states(world) == [(1.0, "begins"), (1.0, "ends")]
    with pytest.raises(UsageError, match="unknown fault 'g'; faults: f"):
        world.faults.begin("g")


def test_the_same_seed_gives_the_same_faults() -> None:
    def digest(seed: int) -> str:
        world = World.load(WORLD, seed, "faults:\n  f: {kind: wheel_slip, share: 0.5, at: 0.5}\n")
        drive(world, 5.0, 0.3, 0.2)
        return hashlib.sha256(json.dumps(world.robot().pose).encode()).hexdigest()

    assert digest(1) == digest(1)
    assert digest(1) != digest(2)


# Messages.


def heard(fault: str, topic: str, type_name: str, seconds: float = 3.0) -> list[tuple[float, Any]]:
    """Return the messages of a topic, with their times."""
    found: list[tuple[float, Any]] = []

    async def body(lab: Lab) -> None:
        lab.backend.subscription(
            topic, type_name, lambda sample: found.append((round(lab.clock.elapsed, 3), sample.message))
        )
        await lab.clock.sleep(seconds)

    in_world(body, world_with(fault))
    return found


def faulty(fault: str) -> pytest.MarkDecorator:
    """The mark of a scene in the world with a fault."""
    return pytest.mark.world(WORLD, None, f"faults:\n  f: {fault}\n")


SCAN = ("/scan", "sensor_msgs/msg/LaserScan")
ODOMETRY = ("/odom", "nav_msgs/msg/Odometry")


def test_a_dead_sensor_is_silent() -> None:
    times = [time for time, _ in heard("{kind: dead, topic: /scan, at: 1, for: 1}", *SCAN)]
    assert [time for time in times if 1.0 < time <= 2.0] == []
    assert len([time for time in times if time <= 1.0]) == 5
    assert len([time for time in times if time > 2.0]) >= 4


@faulty("{kind: frozen, topic: odom, at: 1}")
async def test_a_frozen_sensor_repeats_itself_with_new_stamps(lab: Lab) -> None:
    found = lab.hear(*ODOMETRY)
    await lab.drive(2.0, 0.3)
    places = [message.pose.pose.position.x for message in found]
    assert places[-1] == places[-15] < lab.world.robot().x - 0.1
    stamps = [str(message.header.stamp) for message in found]
    assert len(set(stamps)) == len(stamps)


def test_a_nan_sensor_publishes_nan() -> None:
    scans = heard("{kind: nan, topic: /scan, at: 1, for: 1}", *SCAN)
    wrong = [all(math.isnan(each) for each in scan.ranges) for _, scan in scans]
    assert wrong == [1.0 < time <= 2.0 for time, _ in scans]
    assert all(scan.range_max == 10.0 for _, scan in scans)


def test_messages_are_lost_repeated_and_late() -> None:
    whole = heard("{kind: lost, topic: /odom}", *ODOMETRY)
    some = heard("{kind: lost, topic: /odom, share: 0.5, at: 0}", *ODOMETRY)
    assert 0.25 < len(some) / len(whole) < 0.75
    assert len(heard("{kind: duplicated, topic: /odom, copies: 3, at: 0}", *ODOMETRY)) == 3 * len(whole)
    late = heard("{kind: delayed, topic: /odom, seconds: 0.5, at: 0}", *ODOMETRY)
    assert (whole[0][0], late[0][0]) == (0.05, 0.55)


@faulty("{kind: dead, topic: /cmd_vel, at: 0}")
async def test_commands_are_lost_too(lab: Lab) -> None:
    await lab.drive(2.0, 0.3)
    assert lab.world.robot().x == 0.0


@faulty("{kind: blocked_wheel}")
async def test_every_fault_has_a_service(lab: Lab) -> None:
    for on in (True, False):
        await lab.clock.sleep(1.0)
        assert (await lab.call("/faults/f", "std_srvs/srv/SetBool", data=on)).success
    assert [state for _, state in states(lab.world)] == ["begins", "ends"]


async def outcomes(lab: Lab, begins: list[float]) -> list[tuple[float, str, str]]:
    """Return when goals started at given times end, how, and why."""
    ended = []
    for begin in begins:
        await lab.clock.sleep(begin - lab.clock.elapsed)
        result = await lab.go(1, 0)
        ended.append((round(lab.clock.elapsed, 1), result.status.name, result.result.error_msg))
    return ended


@faulty("{kind: aborted_action, action: navigate_to_pose, at: 1, for: 2}")
async def test_goals_of_an_action_are_aborted_while_the_fault_lasts(lab: Lab) -> None:
    ended = await outcomes(lab, [0.1, 2.0, 3.5])
    assert ended[0] == (1.0, "ABORTED", "aborted by the fault f")
    assert ended[1] == (2.0, "ABORTED", "aborted by the fault f")
    assert ended[2][1] == "SUCCEEDED"


@faulty("{kind: aborted_action, action: /navigate_to_pose, share: 0.25, at: 0}")
async def test_a_share_of_the_goals_is_aborted(lab: Lab) -> None:
    statuses = [status for _, status, _ in await outcomes(lab, [5.0 * n for n in range(1, 41)])]
    aborted = statuses.count("ABORTED")
    assert 4 <= aborted <= 16
    assert statuses.count("SUCCEEDED") == 40 - aborted


@pytest.mark.parametrize(
    ("fault", "message"),
    [
        ("{kind: dead, topic: /skan}", r"unknown topic /skan; did you mean `/scan`\?"),
        (
            "{kind: aborted_action, action: /navigate_to}",
            r"unknown action /navigate_to; did you mean `/navigate_to_pose`\?",
        ),
    ],
)
def test_a_fault_of_an_unknown_name_is_reported(fault: str, message: str) -> None:
    with pytest.raises(UsageError, match=f"fault f: {message}"):
        heard(fault, *SCAN)


def door_replies(fault: str, requests: list[bool]) -> list[tuple[bool, str]]:
    """Return the replies of the service of an open door to requests to open (True) or close it."""
    replies: list[tuple[bool, str]] = []

    async def body(lab: Lab) -> None:
        await lab.clock.sleep(1.0)
        for opened in requests:
            reply = await lab.call("/doors/kitchen/open", "std_srvs/srv/SetBool", data=opened)
            replies.append((reply.success, reply.message))

    in_world(body, world_with(fault))
    return replies


def test_a_stuck_door_does_not_move_and_the_reply_has_the_reason() -> None:
    stuck = (False, "the door 'kitchen' is stuck")
    assert door_replies("{kind: stuck_door, door: kitchen, at: 0}", [False, False, True]) == [
        stuck,
        stuck,
        (True, ""),  # it is open
    ]
    assert door_replies("{kind: stuck_door, door: kitchen, at: 2}", [False, True]) == [(True, "")] * 2


def test_a_stuck_door_fails_a_share_of_the_requests() -> None:
    replies = door_replies("{kind: stuck_door, door: kitchen, share: 0.25, at: 0}", [False, True] * 40)
    failed = [success for success, _ in replies].count(False)
    assert 5 <= failed <= 35
    other = door_replies("{kind: stuck_door, door: kitchen, share: 0.25, at: 0}", [False, True] * 40)
    assert other == replies, "the same seed"


@faulty("{kind: kidnapped_robot, to: {x: 1, y: -2}, at: 1}")
async def test_a_kidnapped_robot_is_lost_until_it_receives_its_pose(lab: Lab) -> None:
    lab.backend.tf_listen()
    await lab.clock.sleep(2.0)
    lost = lab.backend.tf_lookup("map", "base_link").translation
    assert lost[:2] == pytest.approx((0, 0), abs=0.01)
    told = {**pose(1, -2), "pose": {"pose": pose(1, -2)["pose"], "covariance": [0.25] * 36}}
    lab.say("/initialpose", "geometry_msgs/msg/PoseWithCovarianceStamped", **told)
    await lab.clock.sleep(2.0)
    assert lab.backend.tf_lookup("map", "base_link").translation[:2] == pytest.approx((1, -2), abs=0.01)


@faulty("{kind: lost_localisation, to: {x: 2, y: -2, yaw_degrees: 90}, at: 0}")
async def test_a_lost_robot_believes_in_another_pose_and_moves_from_there(lab: Lab) -> None:
    lab.backend.tf_listen()
    await lab.clock.sleep(1.0)
    assert lab.backend.tf_lookup("map", "base_link").translation[:2] == pytest.approx((2, -2), abs=0.01)
    await lab.drive(2.0, 0.3)
    x, y, _ = lab.backend.tf_lookup("map", "base_link").translation
    assert (x, y) == pytest.approx((2, -2 + lab.world.robot().odometry.x), abs=0.05)
    assert lab.world.robot().y == 0.0
    assert not lab.world.ground_truth.events_of("robot_placed")


def test_a_fault_that_starts_with_the_world_is_in_the_file(tmp_path: Path) -> None:
    world, path = world_with("{kind: blocked_wheel, at: 0}"), tmp_path / "truth.jsonl"
    with GroundTruthFile(path, world, 0.0):
        world.run(1.0)
    [event] = GroundTruth.read(path).events_of("fault")
    assert (event.time, event.data["state"]) == (0.0, "begins")
