"""The world as a ROS node: topics, rates, commands, several robots, and the separate process."""

import json
import math
import signal
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from navigation_lab import Lab, in_world
from sensor_lab import heard

from jacaros.robots.ros.message import to_seconds
from jacaros.robots.ros.open import open_backend
from jacaros.robots.world import GroundTruth, SimNode, World, serve
from jacaros.robots.world.graph import robot_node
from jacaros.robots.world.graph.on_graph import RobotOnGraph
from jacaros.robots.world.graph.publishing import sensor
from jacaros.robots.world.process import GroundTruthFile
from jacaros.runtime.clock import VirtualClock, WallClock, run

ODOMETRY = ("/odom", "nav_msgs/msg/Odometry")


def timed(lab: Lab, topic: str, type_name: str) -> list[tuple[float, Any]]:
    """The messages of a topic from now on, with the time of the run."""
    heard: list[tuple[float, Any]] = []
    lab.backend.subscription(
        topic, type_name, lambda sample: heard.append((round(lab.clock.elapsed, 6), sample.message))
    )
    return heard


@pytest.mark.world("robots:\n  - name: turtlebot\n")
async def test_odometry_is_published_at_20_hz_with_pose_and_twist(lab: Lab) -> None:
    heard = timed(lab, *ODOMETRY)
    await lab.drive(2.0, 0.3, 0.5)
    lab.node.close()
    assert len(heard) == pytest.approx(40, abs=1)
    assert [time for time, _ in heard[:3]] == [0.05, 0.1, 0.15]
    last, robot = heard[-1][1], lab.world.robot()
    assert (last.header.frame_id, last.child_frame_id) == ("odom", "base_footprint")
    assert last.twist.twist.linear.x == pytest.approx(0.3)
    assert last.twist.twist.angular.z == pytest.approx(0.5)
    yaw = 2 * math.atan2(last.pose.pose.orientation.z, last.pose.pose.orientation.w)
    behind = lab.clock.now() - to_seconds(last.header.stamp)
    assert yaw == pytest.approx(robot.yaw - 0.5 * behind, abs=0.02)
    assert last.pose.pose.position.x == pytest.approx(robot.x, abs=0.02)


@pytest.mark.world("empty")
async def test_stamps_are_the_time_of_the_state(lab: Lab) -> None:
    heard = lab.hear(*ODOMETRY)
    await lab.clock.sleep(0.2)
    stamps = [to_seconds(message.header.stamp) - lab.clock.start for message in heard]
    assert stamps == pytest.approx([0.04, 0.1, 0.14, 0.2][: len(stamps)], abs=1e-5)


@pytest.mark.parametrize("topic", ["/cmd_vel", "/cmd_vel_mux/input/navi", "/mobile_base/commands/velocity"])
@pytest.mark.world("empty")
async def test_the_robot_obeys_all_command_topics_and_the_last_command_wins(lab: Lab, topic: str) -> None:
    await lab.drive(3.0, 0.2, topic=topic)
    assert lab.world.ground_truth.pose().x == pytest.approx(0.2 * 3.0, abs=0.04)
    await lab.drive(1.0, -0.3, topic="/cmd_vel_mux/input/navi")
    assert lab.world.robot().speed == pytest.approx(-0.3)


@pytest.mark.world("empty")
async def test_a_command_takes_effect_at_its_time_although_the_world_is_stepped_later(lab: Lab) -> None:
    await lab.clock.sleep(0.071)
    lab.say("/cmd_vel", "geometry_msgs/msg/Twist", linear={"x": 0.3})
    await lab.clock.sleep(1.0)
    [event] = lab.world.ground_truth.events_of("command_timeout")
    assert event.time == pytest.approx(0.06 + 0.52)


def test_late_steps_give_the_same_run() -> None:
    done = in_world(lambda lab: lab.drive(4.0, 0.3, 0.4), "patrol")
    direct = World.load("patrol")
    for _ in range(40):
        direct.command("turtlebot", 0.3, 0.4)
        direct.run(0.1)
    assert done.world.ground_truth.digest() == direct.ground_truth.digest()


@pytest.mark.world("patrol")
async def test_the_battery_is_published_every_second_and_when_charging_changes(lab: Lab) -> None:
    lab.world.robot().battery.level = 50.0
    heard = timed(lab, "/battery_state", "sensor_msgs/msg/BatteryState")
    await lab.clock.sleep(2.5)
    lab.world.robot().x, lab.world.robot().y = 1.0, 1.0  # into the dock by hand
    await lab.clock.sleep(15.0)
    states = [message.power_supply_status for _, message in heard]
    assert states[:4] == [2, 2, 2, 1], "discharging, then charging"
    assert [time for time, _ in heard[:4]] == [0.05, 1.05, 2.05, 2.55]
    assert states[-1] == 4, "full, in the dock"
    assert heard[0][1].percentage == pytest.approx(0.5, abs=0.001)
    assert heard[-1][1].percentage == 1.0


@pytest.mark.world("patrol")
async def test_the_laser_is_computed_only_with_subscribers(lab: Lab, monkeypatch: pytest.MonkeyPatch) -> None:
    with monkeypatch.context() as patch:
        patch.setattr(World, "scan", lambda *_: pytest.fail("computed"))
        await lab.clock.sleep(1.0)
    heard = lab.hear("/scan", "sensor_msgs/msg/LaserScan")
    await lab.clock.sleep(2.0)
    assert len(heard) == pytest.approx(10, abs=1)
    scan = heard[0]
    assert len(scan.ranges) == 360
    assert scan.ranges[180] == pytest.approx(2.8), "the wall ahead"
    assert scan.angle_min + 180 * scan.angle_increment == pytest.approx(0.0)


@pytest.mark.world("empty")
async def test_transforms_are_published_only_with_subscribers(lab: Lab) -> None:
    heard = lab.hear("/tf", "tf2_msgs/msg/TFMessage")
    await lab.clock.sleep(1.0)
    assert len(heard) == pytest.approx(20, abs=1)
    frames = [(each.header.frame_id, each.child_frame_id) for each in heard[0].transforms]
    assert frames == [("odom", "base_footprint"), ("map", "odom")]


@pytest.mark.world("two_robots")
async def test_two_robots_differ_by_their_namespaces(lab: Lab) -> None:
    heard = lab.hear("/robot_1/odom", "nav_msgs/msg/Odometry")
    await lab.drive(2.0, 0.2, topic="/robot_1/cmd_vel")
    truth = lab.world.ground_truth
    assert truth.pose("robot_0") == (-1, -1, 0)
    assert truth.pose("robot_1").x == pytest.approx(1 - 0.4, abs=0.04)
    assert heard[0].child_frame_id == "robot_1/base_footprint"


@pytest.mark.world("house")
async def test_a_cleaning_task_on_the_topic_is_recorded_with_the_true_pose(lab: Lab) -> None:
    await lab.drive(2.0, 0.3)
    lab.say("/cleaning/task", "std_msgs/msg/String", data="mop floor")
    await lab.clock.sleep(0.1)
    [event] = lab.world.ground_truth.events_of("task")
    assert event.data == {"task": "mop floor", "room": "hallway"}
    assert event.x == pytest.approx(0.6, abs=0.1)


@pytest.mark.world("empty")
async def test_a_closed_node_stops_the_world(lab: Lab) -> None:
    await lab.drive(1.0, 0.2)
    lab.node.close()
    await lab.clock.sleep(5.0)
    assert lab.world.time == pytest.approx(1.0)


class HeldUpClock:
    """A wall clock whose timers fire when the test says so."""

    virtual = False

    def __init__(self) -> None:
        self.time = 1000.0
        self.timers: list[tuple[float, Callable[[], None]]] = []

    @property
    def elapsed(self) -> float:
        return self.time

    def now(self) -> float:
        return self.time

    def call_later(self, delay: float, callback: Callable[[], None]) -> Any:
        self.timers.append((self.time + delay, callback))

    async def sleep(self, delay: float) -> None:
        raise AssertionError

    def busy(self, cycles: int) -> None:
        raise AssertionError

    def fire(self, late: float = 0.0) -> float:
        """Call the next timer, *late* seconds after its time; return that time."""
        when, callback = self.timers.pop(0)
        self.time = max(self.time, when + late)
        callback()
        return when


def test_a_blocked_world_catches_up_without_a_burst_of_messages() -> None:
    clock, world, received = HeldUpClock(), World.load("empty"), []

    async def main() -> None:
        backend = open_backend("memory", VirtualClock(), "test")
        await backend.start()
        backend.subscription("/odom", "nav_msgs/msg/Odometry", received.append)
        SimNode(world, backend, clock).start()
        times = [clock.fire(0.01), clock.fire(), clock.fire(60.0), clock.fire(), clock.fire()]
        assert times == pytest.approx([1000.05, 1000.1, 1000.15, 1060.2, 1060.25])
        await backend.close()

    run(main, VirtualClock())
    assert world.time == pytest.approx(60.24, abs=0.021)


def test_served_worlds_write_their_ground_truth_and_it_reads_back_the_same(tmp_path: Path) -> None:
    clock, path = VirtualClock(), tmp_path / "truth.jsonl"
    world = World.load("patrol")

    async def main() -> None:
        clock.call_later(1.0, lambda: world.command("turtlebot", 0.3, 0.0))
        await serve(world, open_backend("memory", clock, "world"), clock, 5.0, path)

    run(main, clock)
    read, truth = GroundTruth.read(path), world.ground_truth
    assert read.events == truth.events
    assert read.pose() == truth.pose()
    assert read.odometer() == truth.odometer()
    assert set(read.path()) >= set(truth.path())
    records = [json.loads(line) for line in path.read_text().splitlines()]
    assert records[0]["epoch"] == clock.start
    assert records[-1] == {"kind": "end", "time": 5.0}


def test_the_ground_truth_is_on_disk_during_the_run_and_a_truncated_line_is_skipped(tmp_path: Path) -> None:
    path, world = tmp_path / "truth.jsonl", World.load("empty")
    with GroundTruthFile(path, world, 0.0):
        world.command("turtlebot", 0.3, 0.0)
        world.run(1.0)
        while "command_timeout" not in (running := path.read_text()):
            threading.Event().wait(0.01)
    path.write_text(running + '{"kind": "samp')
    read = GroundTruth.read(path)
    assert [event.kind for event in read.events] == ["command_timeout"]
    assert read.latest().time == pytest.approx(0.5, abs=0.5)


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_a_served_world_stops_cleanly_on_a_signal(tmp_path: Path, number: signal.Signals) -> None:
    clock, path = WallClock(), tmp_path / "truth.jsonl"

    async def main() -> None:
        clock.call_later(0.0, lambda: signal.raise_signal(number))
        await serve(World.load("empty"), open_backend("memory", clock, "world"), clock, None, path)

    run(main, clock)
    assert json.loads(path.read_text().splitlines()[-1])["kind"] == "end"


def test_the_time_of_the_world_is_published_on_clock() -> None:
    times: list[float] = []
    clock = VirtualClock()

    async def main() -> None:
        listener = open_backend("memory", clock, "listener")
        await listener.start()
        listener.subscription(
            "/clock", "rosgraph_msgs/msg/Clock", lambda sample: times.append(to_seconds(sample.message.clock))
        )
        world = open_backend("memory", clock, "world", graph=listener.graph)  # type: ignore[attr-defined]
        await serve(World.load("empty"), world, clock, duration=2.0, publish_clock=True)

    run(main, clock)
    assert len(times) == pytest.approx(200, abs=2)
    assert times == sorted(times)
    assert times[-1] - times[0] == pytest.approx(2.0, abs=0.02)


def test_another_sensor_is_one_entry(monkeypatch: pytest.MonkeyPatch) -> None:
    def fill(at: RobotOnGraph, message: Any) -> None:
        message.range = math.hypot(at.robot.x, at.robot.y)

    far = sensor("/far", "sensor_msgs/msg/Range", fill, every=10, frame="far")
    monkeypatch.setattr(robot_node, "SENSORS", (far,))
    _, received = heard("/far", "sensor_msgs/msg/Range", 1.02, 0.0)
    assert [message.header.frame_id for message in received] == ["far", "far"]
    assert received[0].range >= 0.0
