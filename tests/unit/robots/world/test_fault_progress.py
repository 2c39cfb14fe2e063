"""Faults that begin by progress, and the first effect of each fault."""

import math

import pytest
from navigation_lab import Lab, in_world

from jacaros.robots.plane.pose import distance
from jacaros.robots.world import World
from jacaros.robots.world.data.ground_truth import RobotEvent
from jacaros.robots.world.data.world import WorldError
from jacaros.robots.world.files.faults import read_faults
from jacaros.robots.world.files.world import read_world

WORLD = """
name: progress
bounds: {from: [-3, -3], to: [3, 3]}
border: walls
doors:
  - {name: kitchen, segment: [[2, -1], [2, 1]], open: true}
docks:
  - {name: dock, x: 1, y: 0}
robots:
  - {name: one, battery: {level: 50, drain_per_metre: 10}, gripper: true}
"""
SCAN = "sensor_msgs/msg/LaserScan"


def world_with(fault: str, seed: int = 0) -> World:
    return World.load(WORLD, seed, f"faults:\n  f: {fault}\n")


def drive(world: World, metres: float) -> None:
    """Drive straight on; negative to drive backwards."""
    while abs(metres) - world.robot().odometer > 0.0 and world.time < 60.0:
        world.command("one", math.copysign(0.3, metres), 0.0)
        world.step()


def event(world: World, state: str) -> RobotEvent | None:
    """The event of the fault with a state; fails when there are several."""
    found = [each for each in world.log if each.kind == "fault" and each.data["state"] == state]
    assert len(found) <= 1
    return found[0] if found else None


def acts(world: World) -> float:
    """The time of the first effect, -1 without one."""
    found = event(world, "acts")
    return -1.0 if found is None else found.time


def test_a_fault_begins_after_metres_truly_driven() -> None:
    world = world_with("{kind: wheel_slip, after: {metres: 0.5}, for: 1}")
    world.run(5.0)
    drive(world, 1.0)
    begins = event(world, "begins")
    assert begins is not None
    assert begins.x == pytest.approx(0.5, abs=0.01)
    ends = event(world, "ends")
    assert ends is not None
    assert ends.time == pytest.approx(begins.time + 1.0)


def test_a_fault_begins_at_a_level_of_the_battery() -> None:
    world = world_with("{kind: blocked_wheel, after: {battery: 45}}")
    drive(world, 0.4)
    assert event(world, "begins") is None
    drive(world, 0.6)
    begins = event(world, "begins")
    assert begins is not None
    assert begins.x == pytest.approx(0.5, abs=0.02)


def test_a_fault_begins_after_tasks() -> None:
    world = world_with("{kind: closed_door, door: kitchen, after: {tasks: 2}}")
    for expected in (True, False):
        world.log_task("one", "mop floor")
        world.run(1.0)
        assert world.doors["kitchen"] is expected


def test_the_robot_of_a_fault_is_the_one_that_makes_progress() -> None:
    two = WORLD + "  - {name: two, namespace: two, pose: {x: -1, y: 1}}\n"
    world = World.load(
        two, 0, "faults:\n  f: {kind: closed_door, door: kitchen, robot: two, after: {metres: 0.2}}\n"
    )
    drive(world, 0.5)
    assert world.doors["kitchen"]
    for _ in range(60):
        world.command("two", 0.3, 0.0)
        world.step()
    assert not world.doors["kitchen"]
    begins = event(world, "begins")
    assert begins is not None
    assert begins.robot == "", "a door is not a robot"


def test_wheels_that_stand_do_not_slip() -> None:
    world = world_with("{kind: wheel_slip, at: 1}")
    world.run(5.0)
    assert acts(world) == -1.0
    drive(world, 0.1)
    assert acts(world) == pytest.approx(5.04)
    none = world_with("{kind: wheel_slip, share: 0, at: 1}")
    drive(none, 1.0)
    assert acts(none) == -1.0


def test_an_effect_is_logged_once_for_each_start() -> None:
    world = world_with("{kind: blocked_wheel, wheel: left}")
    for _ in range(2):
        world.faults.begin("f")
        drive(world, world.robot().odometer + 0.1)
        world.faults.end("f")
    states = [each.data["state"] for each in world.log if each.kind == "fault"]
    assert states == ["begins", "acts", "ends"] * 2
    assert math.isinf(world.faults.next)
    assert world.faults.next > 0.0, "no step of the world looks for effects"


@pytest.mark.parametrize(("fault", "has_effect"), [("to: {x: 0.04}", False), ("to: {x: 0.06}", True)])
def test_a_kidnapped_robot_has_moved_five_centimetres(fault: str, has_effect: bool) -> None:
    world = world_with(f"{{kind: kidnapped_robot, {fault}, at: 1}}")
    world.run(2.0)
    assert acts(world) == (1.0 if has_effect else -1.0)


def test_a_robot_is_carried_by_a_distance_to_a_free_place() -> None:
    places = set()
    for seed in range(20):
        world = world_with("{kind: kidnapped_robot, by: 2.5, at: 1}", seed)
        world.run(1.0)
        robot = world.robot()
        assert distance((0.0, 0.0), (robot.x, robot.y)) == pytest.approx(2.5)
        assert all(wall.distance(robot.x, robot.y) >= robot.description.radius for wall in world.segments)
        begins = event(world, "begins")
        assert begins is not None
        assert begins.data == {
            "fault": "f",
            "kind": "kidnapped_robot",
            "state": "begins",
            "x": robot.x,
            "y": robot.y,
            "metres": pytest.approx(2.5),
        }
        places.add(robot.pose)
    assert len(places) == 20
    assert len({round(yaw, 3) for _, _, yaw in places}) == 20


def test_a_robot_is_not_carried_where_there_is_no_place() -> None:
    world = world_with("{kind: kidnapped_robot, by: 4.5}")
    assert world.faults.begin("f") == "no free place 4.5 m from one"
    assert acts(world) == -1.0


@pytest.mark.parametrize(("level", "has_effect"), [(49.5, False), (48.5, True), (60, False)])
def test_a_battery_has_lost_a_percent(level: float, has_effect: bool) -> None:
    world = world_with(f"{{kind: battery_drop, to: {level}, at: 0}}")
    assert acts(world) == (0.0 if has_effect else -1.0)


@pytest.mark.parametrize(
    "fault", ["{kind: closed_door, door: kitchen, at: 0}", "{kind: person, path: [[2, 0]], at: 0}"]
)
def test_a_robot_comes_near(fault: str) -> None:
    world = world_with(fault)
    drive(world, 0.98)
    assert acts(world) == -1.0
    drive(world, 1.02)
    assert acts(world) == pytest.approx(world.time, abs=0.2)


def test_a_door_that_was_closed_before_has_no_effect() -> None:
    world = world_with("{kind: closed_door, door: kitchen, at: 1}")
    world.move_door("kitchen", opened=False)
    drive(world, 1.5)
    assert (acts(world), event(world, "begins") is None) == (-1.0, False)


@pytest.mark.parametrize("kind", ["dead_dock", "dirty_contact"])
def test_a_robot_in_a_dock_is_without_current(kind: str) -> None:
    world = world_with(f"{{kind: {kind}, dock: dock, at: 0}}")
    world.run(5.0)
    assert acts(world) == -1.0
    drive(world, 1.0)
    world.run(5.0)
    docked = [each.time for each in world.log if each.kind == "docked"]
    assert docked[-1] <= acts(world) <= world.time


@pytest.mark.parametrize(
    ("fault", "first"),
    [
        ("dead", 0.04),
        ("nan", 0.04),
        ("frozen", 0.24),
        ("lost, share: 1", 0.04),
        ("lost, share: 0", -1.0),
        ("delayed, seconds: 0.1", 0.04),
        ("delayed, seconds: 0", -1.0),
        ("duplicated", 0.04),
    ],
)
def test_a_message_is_changed_lost_or_late(fault: str, first: float) -> None:
    world = world_with(f"{{kind: {fault}, topic: /scan, at: 0.1}}")

    async def body(lab: Lab) -> None:
        await lab.clock.sleep(1.0)
        assert acts(world) == -1.0, "the topic has no subscriber"
        lab.backend.subscription("/scan", SCAN, lambda sample: None)
        await lab.clock.sleep(1.0)

    in_world(body, world)
    assert acts(world) == (-1.0 if first < 0.0 else pytest.approx(1.0 + first, abs=0.01))


@pytest.mark.parametrize(("at", "first"), [(0.5, 2.0), (2.5, 2.5)])
def test_a_goal_is_aborted(at: float, first: float) -> None:
    world = world_with(f"{{kind: aborted_action, action: /navigate_to_pose, at: {at}, for: 5}}")

    async def body(lab: Lab) -> None:
        await lab.clock.sleep(2.0)
        assert acts(world) == -1.0
        await lab.go(1, 0)

    in_world(body, world)
    assert acts(world) == pytest.approx(first, abs=0.07), "the world lags by up to a tick"


def test_a_stuck_door_refuses() -> None:
    world = world_with("{kind: stuck_door, door: kitchen, at: 0}")

    async def body(lab: Lab) -> None:
        await lab.clock.sleep(2.0)
        assert not (await lab.call("/doors/kitchen/open", "std_srvs/srv/SetBool", data=False)).success

    in_world(body, world)
    assert acts(world) == pytest.approx(2.0, abs=0.05)


def test_a_lost_robot_believes_it() -> None:
    world = world_with("{kind: lost_localisation, to: {x: 1}, at: 0.5}")

    async def body(lab: Lab) -> None:
        await lab.clock.sleep(2.0)

    in_world(body, world)
    assert acts(world) == pytest.approx(0.5, abs=0.1)


@pytest.mark.parametrize(
    ("fault", "message"),
    [
        ("{kind: dead, topic: /scan, at: 1, after: {metres: 1}}", "'at' and 'after' exclude each other"),
        ("{kind: dead, topic: /scan, after: {}}", "'after' has 0 keys, but must have one"),
        ("{kind: dead, topic: /scan, after: {tasks: 1, metres: 1}}", "'after' has 2 keys, but must have one"),
        ("{kind: dead, topic: /scan, after: {meters: 1}}", "did you mean `metres`?"),
        ("{kind: dead, topic: /scan, after: {battery: 101}}", "'battery' is 101, but must lie between"),
        ("{kind: dead, topic: /scan, after: {tasks: 0.5}}", "'tasks' must be a whole number"),
        ("{kind: kidnapped_robot}", "or a distance, 'by: 1.5'"),
        ("{kind: kidnapped_robot, by: 1, to: {x: 1}}", "'to' and 'by' exclude each other"),
        ("{kind: kidnapped_robot, by: -1}", "'by' is -1, but must lie between 0 and 100"),
        ("{kind: closed_door, door: kitchen, robot: one}", "remove 'robot', or add 'after'"),
    ],
)
def test_a_mistake_is_reported(fault: str, message: str) -> None:
    with pytest.raises(WorldError) as told:
        read_faults(f"faults:\n  f: {fault}\n", read_world(WORLD))
    assert message in str(told.value)
