"""The running world: motion, contact, commands, battery, docks, odometry, determinism."""

import math
import random

import pytest

from jacaros.robots.plane.pose import Pose
from jacaros.robots.plane.shapes import Segment
from jacaros.robots.plane.trigonometry import PI
from jacaros.robots.world import World
from jacaros.robots.world.data.robot import BatterySettings, OdometrySettings, RobotDescription
from jacaros.robots.world.data.world import Dock, WorldDescription
from jacaros.robots.world.physics.world import STEP
from jacaros.runtime.errors import UsageError


def drive(
    world: World, seconds: float, speed: float, turn_rate: float = 0.0, robot: str = "turtlebot"
) -> None:
    """Command a robot at 10 Hz for a while."""
    for step in range(round(seconds / STEP)):
        if step % 5 == 0:
            world.command(robot, speed, turn_rate)
        world.step()


@pytest.fixture
def world() -> World:
    """The empty world."""
    return World.load("empty")


def test_a_robot_drives_straight_with_its_acceleration(world: World) -> None:
    drive(world, 5.0, 0.2)
    drive(world, 1.0, 0.0)
    robot = world.robot()
    # The ramp up loses what the ramp down adds, but for half a step each.
    assert robot.x == pytest.approx(1.0, abs=0.005)
    assert robot.y == 0.0
    assert robot.odometer == pytest.approx(robot.x)


def test_speed_and_acceleration_obey_the_limits(world: World) -> None:
    drive(world, 0.5, 3.0)
    assert world.robot().speed == pytest.approx(0.4)
    drive(world, 1.5, 3.0)
    assert world.robot().speed == 0.65
    drive(world, 2.0, 0.0, 100.0)
    assert world.robot().turn_rate == PI


def test_a_turn_on_the_spot_keeps_the_place_and_a_circle_closes(world: World) -> None:
    robot = world.robot()
    drive(world, 1.0, 0.0, PI / 2)
    drive(world, 1.0, 0.0)
    assert (robot.x, robot.y) == (0.0, 0.0)
    assert robot.yaw == pytest.approx(PI / 2, abs=0.05)
    robot.speed, robot.turn_rate = 0.2, 0.5
    drive(world, 4 * PI, 0.2, 0.5)
    assert math.hypot(robot.x, robot.y) < 0.01
    assert robot.odometer == pytest.approx(0.2 * 4 * PI, rel=0.01)


def test_a_robot_stops_without_a_ramp_when_commands_cease(world: World) -> None:
    robot = world.robot()
    world.command("turtlebot", 0.3, 0.0)
    world.run(0.5)
    assert robot.speed == pytest.approx(0.3)
    world.step()
    assert robot.speed == 0.0
    [event] = world.ground_truth.events_of("command_timeout")
    assert event.time == pytest.approx(0.52)
    assert event.data["speed"] == pytest.approx(0.3)
    where = robot.x
    world.run(1.0)
    assert robot.x == where


def test_an_invalid_command_stops_the_robot(world: World) -> None:
    drive(world, 1.0, 0.3)
    world.command("turtlebot", math.nan, 0.0)
    world.run(0.5)
    assert world.robot().speed == 0.0
    assert len(world.ground_truth.events_of("bad_command")) == 1


def room(**robot: object) -> World:
    walls = (Segment(1.0, -2.0, 1.0, 2.0), Segment(-1.0, 1.0, 3.0, 1.0))
    return World(WorldDescription(segments=walls, robots=(RobotDescription(**robot),)))  # type: ignore[arg-type]


def test_a_wall_stops_the_robot_and_bumps_once() -> None:
    world = room()
    drive(world, 6.0, 0.3)
    robot = world.robot()
    assert robot.x == pytest.approx(1.0 - 0.17, abs=1e-6)
    assert robot.touching == {"wall"}
    [bump] = world.ground_truth.events_of("bump")
    assert bump.data == {"side": "front"}
    assert robot.speed < 0.02, "stalled wheels do not turn"
    assert robot.odometry.x == pytest.approx(robot.x, abs=1e-6)
    drive(world, 1.0, -0.3)
    assert robot.touching == frozenset()


def test_a_robot_does_not_leave_a_corner_through_the_walls() -> None:
    world = room(pose=Pose(0.0, 0.0, PI / 4))
    drive(world, 10.0, 0.65)
    robot = world.robot()
    assert robot.x <= 1.0 - 0.17 + 1e-9
    assert robot.y <= 1.0 - 0.17 + 1e-9


def test_a_robot_behind_touches_with_its_back() -> None:
    world = room(pose=Pose(0.0, 0.0, PI))
    drive(world, 4.0, -0.3)
    assert [event.data["side"] for event in world.ground_truth.events_of("bump")] == ["back"]
    robot = world.robot()
    assert robot.odometry.x == pytest.approx(robot.x, abs=0.01), "stalled wheels are not counted"
    assert robot.odometer == pytest.approx(robot.x, abs=0.01)


def test_two_robots_push_each_other_apart_and_both_have_an_event() -> None:
    other = RobotDescription(name="b", namespace="b", pose=Pose(1.0, 0.0, PI))
    world = World(WorldDescription(robots=(RobotDescription(name="a"), other)))
    drive(world, 4.0, 0.3, robot="a")
    assert world.robot("b").x - world.robot("a").x >= 0.34 - 0.01
    collisions = world.ground_truth.events_of("collision")
    assert [(event.robot, event.data) for event in collisions] == [
        ("a", {"with": "b", "side": "front"}),
        ("b", {"with": "a", "side": "front"}),
    ]


DRAINING = BatterySettings(level=50.0, drain_per_second=1.0, drain_per_metre=10.0, charge_per_second=5.0)


def test_the_battery_drains_with_time_and_with_motion() -> None:
    world = World(WorldDescription(robots=(RobotDescription(battery=DRAINING),)))
    world.run(10.0)
    assert world.ground_truth.battery() == pytest.approx(40.0)
    drive(world, 5.0, 0.2)
    assert world.ground_truth.battery() == pytest.approx(35.0 - 10.0 * world.robot().odometer)


def docking_world(x: float) -> World:
    robot = RobotDescription(pose=Pose(x, 0.0, 0.0), battery=DRAINING)
    return World(WorldDescription(docks=(Dock("home", Pose(0.0, 0.0, 0.0), 0.25),), robots=(robot,)))


def kinds(world: World) -> list[str]:
    return [event.kind for event in world.log if event.kind != "battery"]


def test_a_battery_charges_in_the_dock_from_the_start_until_it_is_full_and_stays_full() -> None:
    """In between it reported a full battery at 20 %."""
    world = docking_world(0.2)
    robot = world.robot()
    for _ in range(50):
        world.step()
        assert robot.battery.charging == (robot.dock is not None)
    world.run(29.0)
    assert world.ground_truth.battery() == 100.0
    assert kinds(world) == ["docked", "charging", "charged"]
    assert not robot.battery.charging


def test_a_battery_does_not_charge_just_outside_the_dock_nor_on_the_way_through_it() -> None:
    outside = docking_world(0.26)
    outside.run(10.0)
    assert outside.ground_truth.battery() == pytest.approx(40.0)
    through = docking_world(-1.0)
    drive(through, 10.0, 0.2)
    assert through.robot().x > 0.9
    for world in (outside, through):
        assert world.ground_truth.events_of("docked", "charging") == []


def test_leaving_the_dock_ends_charging() -> None:
    world = docking_world(0.0)
    world.run(2.0)
    drive(world, 3.0, 0.2)
    assert kinds(world) == ["docked", "charging", "undocked"]
    assert not world.robot().battery.charging


def test_an_empty_battery_stops_the_robot() -> None:
    battery = BatterySettings(level=1.0, drain_per_second=1.0)
    world = World(WorldDescription(robots=(RobotDescription(battery=battery),)))
    drive(world, 4.0, 0.3)
    assert world.robot().x < 0.3
    assert world.robot().speed == 0.0
    [event] = world.ground_truth.events_of("battery_empty")
    assert event.data == {"level": 0}


def test_odometry_without_errors_is_the_true_pose_to_the_last_bit() -> None:
    world = World.load("robots:\n  - name: turtlebot\n")
    drive(world, 7.0, 0.25, 0.4)
    robot = world.robot()
    assert (robot.odometry.x, robot.odometry.y, robot.odometry.yaw) == robot.pose


def test_odometry_may_count_from_the_start() -> None:
    robot = RobotDescription(pose=Pose(1.0, 1.0, PI / 2), odometry=OdometrySettings(from_start=True))
    world = World(WorldDescription(robots=(robot,)))
    drive(world, 5.0, 0.2)
    drive(world, 1.0, 0.0)
    odometry = world.robot().odometry
    assert odometry.x == pytest.approx(world.robot().y - 1.0)
    assert (odometry.y, odometry.yaw) == (0.0, 0.0)


def end_of_a_metre(seed: int, step: float) -> float:
    robot = RobotDescription(odometry=OdometrySettings(per_metre=0.05))
    world = World(WorldDescription(robots=(robot,), seed=seed))
    world.robot().speed = 0.5
    for _ in range(round(2.0 / step)):
        world.command("turtlebot", 0.5, 0.0)
        world.step(step)
    return world.robot().odometry.x - world.robot().x


@pytest.mark.parametrize("step", [0.01, 0.02, 0.05])
def test_the_error_of_odometry_does_not_depend_on_the_length_of_the_steps(step: float) -> None:
    errors = [end_of_a_metre(seed, step) for seed in range(150)]
    deviation = math.sqrt(sum(error * error for error in errors) / len(errors))
    assert deviation == pytest.approx(0.05, rel=0.2)


NOISY = """
name: noisy
bounds: {from: [-2, -2], to: [2, 2]}
border: walls
walls: [{box: {from: [0.5, 0.5], to: [1, 1]}}]
robots:
  - name: a
    odometry: {noise_per_metre: 0.05, noise_degrees_per_turn: 3}
    laser: {noise: 0.01}
  - {name: b, namespace: b, pose: {x: -1, y: 1, yaw_degrees: 45}}
"""


def wander(seed: int) -> World:
    """A seeded drive with noise everywhere."""
    world, draw = World.load(NOISY, seed), random.Random("driver")
    for _ in range(150):
        for name in world.robots:
            world.command(name, draw.uniform(-0.2, 0.6), draw.uniform(-2.0, 2.0))
        world.run(0.2)
        world.scan("a")
    return world


def test_the_same_seed_gives_the_same_run_twice_and_on_every_machine() -> None:
    one, two = wander(1), wander(1)
    digest = "d4309c6bf0ef8bf4b343849d4225f4ba8cd78d21027acf1a3c1b8e7cf867e092"
    assert one.ground_truth.digest() == two.ground_truth.digest() == digest
    assert one.scan("a") == two.scan("a")
    assert one.robot("a").odometry.x == two.robot("a").odometry.x
    assert wander(2).robot("a").odometry.x != one.robot("a").odometry.x


def test_the_path_is_sampled_ten_times_a_second_in_motion_and_seldom_at_rest(world: World) -> None:
    drive(world, 2.0, 0.2)
    moving = len(world.ground_truth.path())
    assert 19 <= moving <= 22
    world.run(20.0)
    assert len(world.ground_truth.path()) - moving <= 30


def test_an_unknown_robot_is_reported() -> None:
    with pytest.raises(UsageError, match=r"unknown robot 'dalek' in world .*; robots: turtlebot"):
        World.load("empty").robot("dalek")
