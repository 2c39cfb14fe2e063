"""Bad messages: told, not shown, and never acted on; and the connection of topics."""

import math
from typing import Any

import pytest
from robot_lab import STANDSTILL, TWIST, Lab, Watcher, made

from jacaros.artifacts import ArtifactId, Atom, Structure
from jacaros.robots.artifacts.battery import ArtSimBattery
from jacaros.robots.artifacts.odometry import ArtOdometry
from jacaros.robots.artifacts.sensors import ArtBaseScan
from jacaros.robots.artifacts.thesis import ArtTutorial
from jacaros.robots.artifacts.velocity import ArtCmdVel
from jacaros.robots.kit.reading import FAR, SILENCE, BadMessages, Stamps
from jacaros.runtime.clock import VirtualClock

ODOMETRY = "nav_msgs/msg/Odometry"


async def say(lab: Lab, x: float, stamp: float | None = 0.0, frame: str = "odom", **turn: float) -> None:
    """Publish a position; the stamp is in seconds from now, None for none."""
    header = {"frame_id": frame, "stamp": 0 if stamp is None else lab.clock.now() + stamp}
    lab.say("/odom", ODOMETRY, header=header, pose={"pose": {"position": {"x": x}, "orientation": turn}})
    await lab.sleep(0.02)


def whys(watcher: Watcher) -> list[str]:
    """The reasons of all signals about bad messages."""
    assert {name for name, _ in watcher.signals} <= {"bad_message"}
    assert {arguments[0] for _, arguments in watcher.signals} <= {"/odom"}
    return [str(arguments[1]).replace('"', "") for _, arguments in watcher.signals]


def test_bad_messages_are_reported_on_the_1st_10th_and_100th_occurrence() -> None:
    told: list[tuple[Structure, str]] = []
    faults = BadMessages("/odom", lambda why, text: told.append((why, text)))
    for number in range(250):
        faults.not_finite("x", math.nan)
        if number == 30:
            faults.add(Structure("wrong_frame", ("map",)), "the frame is map")
    x = 'not_finite("x")'
    assert [str(why) for why, _ in told] == [x, x, 'wrong_frame("map")', x]
    assert told[0][1] == "/odom: x is nan; message dropped"
    assert told[1][1] == "/odom: x is nan; message dropped (10 times so far)"
    assert faults.total == 251
    assert faults.counts == {"not_finite": 250, "wrong_frame": 1}


pytestmark = made(ArtOdometry)


@pytest.mark.parametrize("number", [math.nan, math.inf, -math.inf])
async def test_a_number_that_is_not_finite_is_reported_and_not_shown(
    lab: Lab, artifact: ArtifactId, watcher: Watcher, number: float
) -> None:
    await say(lab, 1)
    await say(lab, number)
    await say(lab, 2, w=number)
    await say(lab, 3)
    assert watcher.values("odom") == [(0, 0, 0), (1, 0, 0), (3, 0, 0)]
    assert all(math.isfinite(each) for values in watcher.values("pose") for each in values)
    assert whys(watcher) == ["not_finite(pose.pose.position.x)"]
    assert lab.logged == [f"[{artifact.name}] /odom: pose.pose.position.x is {number}; message dropped"]


@pytest.mark.parametrize(
    ("messages", "shown", "told"),
    [
        ([(1, 0), (2, 0), (1, -0.5), (2, -0.04), (3, 0)], [1, 2, 3], ["out_of_order(0.48)"]),
        (
            [(1, 0), (2, -5), (3, -5), (4, -5), (5, -5)],
            [1, 4, 5],
            ["out_of_order(4.98)", "clock_jumped(4.94)"],
        ),
        ([(1, None), (2, -1000), (3, FAR - 1)], [1, 2, 3], ["stamp_off(-1000)"]),
    ],
    ids=["older or repeated", "a clock that jumped back is believed", "far off our clock"],
)
async def test_stamps_decide_what_is_shown_and_reported(
    lab: Lab,
    watcher: Watcher,
    messages: list[tuple[float, float | None]],
    shown: list[float],
    told: list[str],
) -> None:
    for x, stamp in messages:
        await say(lab, x, stamp)
    assert watcher.values("odom") == [(x, 0, 0) for x in (0, *shown)]
    assert whys(watcher) == told
    assert ("use_sim_time" in lab.logged[0]) == told[0].startswith("stamp_off")


async def test_late_messages_between_good_ones_are_not_a_jump(lab: Lab, watcher: Watcher) -> None:
    for x in range(1, 9):
        await say(lab, x)
        await say(lab, -x, stamp=-1)
    assert watcher.values("odom") == [(x, 0, 0) for x in range(9)]


def judged(*messages: tuple[float, float]) -> tuple[list[str], list[float]]:
    """Check the stamps of messages that arrive at some times; return the reports and the delays."""
    told: list[str] = []
    late: list[float] = []
    clock = VirtualClock()
    stamps = Stamps(BadMessages("/odom", lambda why, text: told.append(str(why))), clock)
    for arrival, stamp in messages:
        clock._move_to(arrival)
        stamps.accept(stamp, clock.now())
        late.append(round(stamps.late, 3))
    return [each for each in told if not each.startswith("stamp_off")], late


def test_messages_that_come_later_after_their_stamps_than_others_are_late() -> None:
    other_clock = 5000.0
    good = [(n * 0.1, other_clock + n * 0.1) for n in range(10)]
    held_up = [(2.0 + n * 0.1, other_clock + 1.0 + n * 0.1) for n in range(3)]
    good_again = [(2.5, other_clock + 2.5)]
    told, late = judged(*good, *held_up, *good_again)
    assert told == ["late(0.999)"]
    assert late == [0.0] * 10 + [pytest.approx(1.0, abs=0.01)] * 3 + [0.0]


def test_the_first_message_may_be_an_old_one() -> None:
    assert judged((0, 100), (0.1, 105), (0.2, 105.1)) == ([], [0.0, 0.0, 0.0])


def test_a_clock_that_was_set_back_makes_nothing_late() -> None:
    before = [(n * 0.1, 100 + n * 0.1) for n in range(20)]
    for back in (0.7, 30.0):
        after = [(n * 0.1, 100 - back + n * 0.1) for n in range(20, 60)]
        told, late = judged(*before, *after)
        assert not any(each.startswith("late") for each in told)
        assert set(late) == {0.0}


def test_clocks_that_part_slowly_make_nothing_late() -> None:
    hours = [(n * 1.0, 100 + n * 0.9995) for n in range(7200)]
    told, late = judged(*hours)
    assert told == []
    assert max(late) == 0.0


def test_a_constant_stamp_is_ignored() -> None:
    assert judged(*[(float(n), 100.0) for n in range(10)]) == ([], [0.0] * 10)


def test_a_stamp_is_not_compared_with_a_clock_that_has_no_time_yet() -> None:
    """A clock that follows ``/clock`` stands at 0 until its first message."""
    told: list[str] = []
    stamps = Stamps(BadMessages("/odom", lambda why, text: told.append(str(why))), VirtualClock())
    assert stamps.accept(1.7e9, now=0.0)
    assert told == []
    assert stamps.accept(1.7e9 + 1.0, now=1.0)
    assert told == ["stamp_off(1700000000)"]


async def test_odometry_in_another_frame_is_dropped_until_the_first_source_is_silent(
    lab: Lab, watcher: Watcher
) -> None:
    for x, frame in ((1, "odom"), (50, "map"), (2, "/odom"), (3, "")):
        await say(lab, x, frame=frame)
    assert watcher.values("odom") == [(x, 0, 0) for x in range(4)]
    assert whys(watcher) == ["wrong_frame(map)"]
    await lab.sleep(SILENCE)
    await say(lab, 50, frame="map")
    assert watcher.holds("odom") == [(50, 0, 0)]


@made(ArtOdometry, Structure("frame", (Atom("odom"),)))
async def test_a_frame_that_is_asked_for_is_the_only_one(lab: Lab, watcher: Watcher) -> None:
    await say(lab, 50, frame="map")
    await lab.sleep(SILENCE)
    await say(lab, 50, frame="map")
    await say(lab, 1)
    assert watcher.values("odom") == [(0, 0, 0), (1, 0, 0)]


BATTERY = "sensor_msgs/msg/BatteryState"


async def test_a_scan_without_a_range_and_a_battery_without_a_number_are_reported(lab: Lab) -> None:
    scanner = lab.watch(await lab.make(ArtBaseScan))
    battery = lab.watch(await lab.make(ArtSimBattery, Structure("source", (Atom("robot"),))))
    lab.say("/scan", "sensor_msgs/msg/LaserScan", ranges=[1.0, math.inf, 1.0], range_max=math.inf)
    lab.say("/battery_state", BATTERY, percentage=math.nan)
    await lab.sleep(0.1)
    assert scanner.values("laserrange") == [(0, 0, 0, 0, 0)]
    assert battery.holds("battery") == []
    told = [[(name, *map(str, why)) for name, why in each.signals] for each in (scanner, battery)]
    assert told == [
        [("bad_message", "/scan", 'not_finite("laserrange")')],
        [("bad_message", "/battery_state", 'not_finite("percentage")')],
    ]


# Motion.


def feed(lab: Lab, until: float, fault: Any) -> None:
    """Publish odometry of a robot that drives as it is commanded, whose messages *fault* may spoil."""
    publisher, commands = lab.backend.publisher("/odom", ODOMETRY), lab.hear("/cmd_vel", TWIST)
    x = 0.0

    def tick() -> None:
        nonlocal x
        speed = commands[-1].linear.x if commands else 0.0
        x += 0.02 * speed
        message = publisher.message(
            header={"frame_id": "odom", "stamp": lab.clock.now()},
            pose={"pose": {"position": {"x": x}}},
            twist={"twist": {"linear": {"x": speed}}},
        )
        fault(message, lab.clock.elapsed)
        publisher.publish(message)
        if lab.clock.elapsed < until:
            lab.clock.call_later(0.02, tick)

    tick()


async def test_a_robot_that_loses_its_pose_stops_immediately_and_the_motion_fails_with_a_reason(
    lab: Lab,
) -> None:
    def fault(message: Any, now: float) -> None:
        if now >= 2.0:
            message.pose.pose.position.x = math.nan

    lab.record()
    feed(lab, 20, fault)
    artifact = await lab.make(ArtCmdVel)
    watcher = lab.watch(artifact)
    failed = await lab.call(artifact, "moveForward", 5)
    assert failed.reason == "no_odometry(5)"
    assert "messages were bad" in failed.message
    assert any(linear > 0 for _, linear, _ in lab.commands)
    assert all(command[1:] == STANDSTILL for command in lab.commands if command[0] > 2.1)
    assert all(math.isfinite(number) for command in lab.commands for number in command)
    assert "not_finite(pose.pose.position.x)" in whys(watcher)


async def test_a_few_bad_poses_only_slow_a_motion_down(lab: Lab) -> None:
    def fault(message: Any, now: float) -> None:
        if 2.0 <= now < 2.5:
            message.pose.pose.orientation.z = math.nan

    feed(lab, 30, fault)
    artifact = await lab.make(ArtCmdVel)
    await lab.do(artifact, "moveForward", 2)


async def test_a_pose_from_another_frame_does_not_lead_a_motion_astray(lab: Lab) -> None:
    def fault(message: Any, now: float) -> None:
        if 1.5 <= now < 1.9:
            message.header.frame_id = "map"
            message.pose.pose.position.x += 100.0

    lab.record()
    feed(lab, 30, fault)
    artifact = await lab.make(ArtCmdVel)
    await lab.do(artifact, "moveForward", 2)
    assert all(linear >= -0.05 for _, linear, _ in lab.commands)


# Connection.


def watching(value: object) -> Structure:
    return Structure("watch_connection", (value,))


@made(ArtTutorial, "r", watching(True))
async def test_a_topic_is_connected_while_it_has_a_publisher(lab: Lab, watcher: Watcher) -> None:
    assert watcher.holds("connected") == []
    publisher = lab.backend.publisher("/r/chatter", "std_msgs/msg/String")
    await lab.sleep(1)
    assert watcher.holds("connected") == [("/r/chatter",)]
    publisher.close()
    await lab.sleep(1)
    assert watcher.holds("connected") == []
    lab.say("/r/chatter", "std_msgs/msg/String", data="again")
    await lab.sleep(0.01)
    assert watcher.holds("connected") == [("/r/chatter",)]
    assert watcher.holds("r_chatter") == [("again",)]


async def test_a_topic_is_lost_with_the_graph_and_found_again_with_it(lab: Lab) -> None:
    lab.backend.publisher("/odom", ODOMETRY)
    watcher = lab.watch(await lab.make(ArtOdometry, watching(True)))
    assert watcher.holds("connected") == [("/odom",)]
    graph = lab.backend.graph  # type: ignore[attr-defined]
    graph.interrupt()
    assert watcher.holds("connected") == []
    graph.restore()
    assert watcher.holds("connected") == [("/odom",)]


@made(ArtOdometry, watching(2))
async def test_a_topic_stays_connected_when_the_master_dies_and_its_publisher_lives(
    lab: Lab, watcher: Watcher
) -> None:
    await say(lab, 1)
    backend: Any = lab.backend
    backend.set_connected(False)
    await lab.sleep(1)
    await say(lab, 2)
    await lab.sleep(1.5)
    assert watcher.holds("connected") == [("/odom",)]


@made(ArtOdometry, watching(2))
async def test_a_silent_publisher_is_lost_where_messages_are_expected(lab: Lab, watcher: Watcher) -> None:
    lab.backend.publisher("/odom", ODOMETRY)
    await lab.sleep(1)
    assert watcher.holds("connected") == []
    await say(lab, 1)
    assert watcher.holds("connected") == [("/odom",)]
    await lab.sleep(2.6)
    assert watcher.holds("connected") == []
    await say(lab, 1)
    assert watcher.holds("connected") == [("/odom",)]


async def test_connections_are_watched_only_with_the_option_and_until_disposal(
    lab: Lab, watcher: Watcher
) -> None:
    lab.backend.publisher("/odom", ODOMETRY)
    await lab.sleep(1)
    assert watcher.holds("connected") == []
    artifact = await lab.make(ArtOdometry, watching(True))
    await lab.sleep(1)
    lab.workspace.dispose_artifact(artifact)
    backend: Any = lab.backend
    backend.set_connected(False)
    await lab.sleep(2)
    assert [line for line in lab.logged if "connected" in line] == []
