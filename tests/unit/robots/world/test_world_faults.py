"""Faults of the world: their effects, their times, and the ground truth about them."""

import hashlib
import json
import math
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any

import pytest

from jacaros.robots.ros.backend import Backend
from jacaros.robots.ros.open import open_backend
from jacaros.robots.world import GroundTruth, SimNode, World
from jacaros.robots.world.process import GroundTruthFile
from jacaros.runtime.clock import VirtualClock, run
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
    assert states(world) == [(1.0, "begins"), (3.0, "ends")]
    [first, _] = world.ground_truth.events_of("fault")
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
    drive(world, 1.0)
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
    world = World.load(
        WORLD,
        faults="""
faults:
  tired: {kind: battery_drop, to: 15, at: 1}
  cold: {kind: dead_dock, dock: dock, at: 1, for: 5}
""",
    )
    world.run(0.5)
    assert world.robot().battery.charging
    world.run(5.0)
    assert 14.5 < world.robot().battery.level < 15
    assert not world.robot().battery.charging
    world.run(2.0)
    assert world.robot().battery.charging


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
        text = "faults:\n  f: {kind: wheel_slip, share: 0.5, at: 0.5}\n"
        world = World.load(WORLD, seed, text)
        drive(world, 5.0, 0.3, 0.2)
        return hashlib.sha256(json.dumps(world.robot().pose).encode()).hexdigest()

    assert digest(1) == digest(1)
    assert digest(1) != digest(2)


# Messages.


def heard(faults: str, topic: str, type_name: str, seconds: float = 3.0) -> list[tuple[float, Any]]:
    """Return the messages of a topic, with their times."""
    found: list[tuple[float, Any]] = []

    async def body(backend: Backend, clock: VirtualClock) -> None:
        backend.subscription(
            topic, type_name, lambda sample: found.append((round(clock.elapsed, 3), sample.message))
        )
        await clock.sleep(seconds)

    in_graph(faults, body)
    return found


def in_graph(faults: str, body: Callable[[Backend, VirtualClock], Awaitable[None]]) -> World:
    world, clock = world_with(faults), VirtualClock()

    async def main() -> None:
        backend = open_backend("memory", clock, "test", log=lambda text: None)
        await backend.start()
        node = SimNode(world, backend, clock)
        node.start()
        await body(backend, clock)
        node.close()
        await backend.close()

    run(main, clock)
    return world


SCAN = ("/scan", "sensor_msgs/msg/LaserScan")
ODOMETRY = ("/odom", "nav_msgs/msg/Odometry")


def test_a_dead_sensor_is_silent() -> None:
    times = [time for time, _ in heard("{kind: dead, topic: /scan, at: 1, for: 1}", *SCAN)]
    assert [time for time in times if 1.0 < time <= 2.0] == []
    assert len([time for time in times if time <= 1.0]) == 5
    assert len([time for time in times if time > 2.0]) >= 4


def test_a_frozen_sensor_repeats_itself_with_new_stamps() -> None:
    async def body(backend: Backend, clock: VirtualClock) -> None:
        backend.subscription(*ODOMETRY, lambda sample: found.append(sample.message))
        wheels = backend.publisher("/cmd_vel", "geometry_msgs/msg/Twist")
        for _ in range(20):
            wheels.publish(wheels.message(linear={"x": 0.3}))
            await clock.sleep(0.1)

    found: list[Any] = []
    world = in_graph("{kind: frozen, topic: odom, at: 1}", body)
    places = [message.pose.pose.position.x for message in found]
    assert places[-1] == places[-15] < world.robot().x - 0.1
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


def test_commands_are_lost_too() -> None:
    async def body(backend: Backend, clock: VirtualClock) -> None:
        wheels = backend.publisher("/cmd_vel", "geometry_msgs/msg/Twist")
        for _ in range(20):
            wheels.publish(wheels.message(linear={"x": 0.3}))
            await clock.sleep(0.1)

    assert in_graph("{kind: dead, topic: /cmd_vel, at: 0}", body).robot().x == 0.0


def test_every_fault_has_a_service() -> None:
    async def body(backend: Backend, clock: VirtualClock) -> None:
        client = backend.client("/faults/f", "std_srvs/srv/SetBool")
        await clock.sleep(1.0)
        assert (await client.call({"data": True}, 1.0)).success
        await clock.sleep(1.0)
        assert (await client.call({"data": False}, 1.0)).success

    assert [state for _, state in states(in_graph("{kind: blocked_wheel}", body))] == ["begins", "ends"]


def test_a_fault_of_an_unknown_topic_is_reported() -> None:
    with pytest.raises(UsageError, match=r"fault f: unknown topic /skan; did you mean `/scan`\?"):
        heard("{kind: dead, topic: /skan}", *SCAN)


def outcomes(fault: str, begins: list[float]) -> list[tuple[float, str, str]]:
    """Return when goals started at given times end, how, and why."""
    ended: list[tuple[float, str, str]] = []

    async def body(backend: Backend, clock: VirtualClock) -> None:
        client = backend.action_client("/navigate_to_pose", "nav2_msgs/action/NavigateToPose")
        for begin in begins:
            await clock.sleep(begin - clock.elapsed)
            pose = {
                "header": {"frame_id": "map"},
                "pose": {"position": {"x": 1.0}, "orientation": {"w": 1.0}},
            }
            goal = await client.send({"pose": pose})
            result = await goal.outcome()
            ended.append((round(clock.elapsed, 1), result.status.name, result.result.error_msg))

    in_graph(fault, body)
    return ended


def test_goals_of_an_action_are_aborted_while_the_fault_lasts() -> None:
    ended = outcomes("{kind: aborted_action, action: navigate_to_pose, at: 1, for: 2}", [0.1, 2.0, 3.5])
    assert ended[0] == (1.0, "ABORTED", "aborted by the fault f")
    assert ended[1] == (2.0, "ABORTED", "aborted by the fault f")
    assert ended[2][1] == "SUCCEEDED"


def test_a_share_of_the_goals_is_aborted() -> None:
    begins = [5.0 * n for n in range(1, 41)]
    ended = outcomes("{kind: aborted_action, action: /navigate_to_pose, share: 0.25, at: 0}", begins)
    aborted = [status for _, status, _ in ended].count("ABORTED")
    assert 4 <= aborted <= 16
    assert [status for _, status, _ in ended].count("SUCCEEDED") == 40 - aborted


def door_replies(fault: str, requests: list[bool]) -> list[tuple[bool, str]]:
    """Return the replies of the service of an open door to requests to open (True) or close it."""
    replies: list[tuple[bool, str]] = []

    async def body(backend: Backend, clock: VirtualClock) -> None:
        await clock.sleep(1.0)
        client = backend.client("/doors/kitchen/open", "std_srvs/srv/SetBool")
        for opened in requests:
            reply = await client.call({"data": opened}, 5.0)
            replies.append((reply.success, reply.message))

    in_graph(fault, body)
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


def test_a_fault_of_an_unknown_action_is_reported() -> None:
    with pytest.raises(
        UsageError, match=r"fault f: unknown action /navigate_to; did you mean `/navigate_to_pose`\?"
    ):
        heard("{kind: aborted_action, action: /navigate_to}", *SCAN)


def test_a_kidnapped_robot_is_lost_until_it_receives_its_pose() -> None:
    async def body(backend: Backend, clock: VirtualClock) -> None:
        backend.tf_listen()
        await clock.sleep(2.0)
        lost = backend.tf_lookup("map", "base_link").translation
        assert lost[:2] == pytest.approx((0, 0), abs=0.01)
        told = backend.publisher("/initialpose", "geometry_msgs/msg/PoseWithCovarianceStamped")
        place = {"position": {"x": 1.0, "y": -2.0}, "orientation": {"w": 1.0}}
        told.publish(
            told.message(header={"frame_id": "map"}, pose={"pose": place, "covariance": [0.25] * 36})
        )
        await clock.sleep(2.0)
        assert backend.tf_lookup("map", "base_link").translation[:2] == pytest.approx((1, -2), abs=0.01)

    in_graph("{kind: kidnapped_robot, to: {x: 1, y: -2}, at: 1}", body)


def test_a_fault_that_starts_with_the_world_is_in_the_file(tmp_path: Path) -> None:
    world, path = world_with("{kind: blocked_wheel, at: 0}"), tmp_path / "truth.jsonl"
    with GroundTruthFile(path, world, 0.0):
        world.run(1.0)
    [event] = GroundTruth.read(path).events_of("fault")
    assert (event.time, event.data["state"]) == (0.0, "begins")
