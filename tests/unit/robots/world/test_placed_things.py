"""Changes of a running world: moved robots, obstacles, batteries."""

import math

import pytest

from jacaros.robots.world import World
from jacaros.runtime.errors import UsageError

LAB = """
name: lab
bounds: {from: [-3, -3], to: [3, 3]}
border: walls
walls:
  - box: {from: [1, 1], to: [2, 2]}
robots:
  - {name: one, namespace: one, pose: {x: -1, y: 0, yaw_degrees: 0}}
  - {name: two, namespace: two, pose: {x: -1, y: -2, yaw_degrees: 0}}
"""


@pytest.fixture
def world() -> World:
    """A room with a box and two robots."""
    return World.load(LAB, seed=1)


def test_a_robot_is_put_down_elsewhere_and_the_ground_truth_records_it(world: World) -> None:
    world.command("one", 0.5, 0.0)
    world.run(0.2)
    world.place("one", 2.0, 0.0, math.pi)
    robot = world.robot("one")
    assert (robot.x, robot.y, robot.yaw, robot.speed) == (2.0, 0.0, math.pi, 0.0)
    assert world.ground_truth.events_of("robot_placed", robot="one")[0].data == {
        "x": 2.0,
        "y": 0.0,
        "yaw": math.pi,
    }
    assert world.ground_truth.path("one")[-1].x == 2.0


def test_a_robot_keeps_its_heading_unless_another_is_given(world: World) -> None:
    world.place("one", 2.0, 0.0)
    assert world.robot("one").yaw == 0.0


@pytest.mark.parametrize(
    ("place", "why"),
    [
        ((2.95, 0.0), "a wall is in the way"),
        ((1.5, 1.5), "a wall is in the way"),
        ((0.9, 1.5), "a wall is in the way"),
        ((4.0, 0.0), "outside of the world"),
        ((-1.0, -1.8), "two is in the way"),
    ],
)
def test_places_without_room_are_rejected(world: World, place: tuple[float, float], why: str) -> None:
    with pytest.raises(UsageError, match=why):
        world.place("one", *place)
    assert (world.robot("one").x, world.robot("one").y) == (-1.0, 0.0)
    assert not world.ground_truth.events_of("robot_placed")


def test_a_robot_may_be_put_at_its_own_place(world: World) -> None:
    world.place("one", -1.0, 0.05)
    assert world.robot("one").y == 0.05


def test_an_obstacle_stops_a_robot_and_is_seen_by_its_laser(world: World) -> None:
    robot = world.robot("one")
    free = world.scan("one")[180]
    obstacle = world.add_obstacle(0.5, 0.0, 0.2)
    seen = world.scan("one")[180]
    assert seen == pytest.approx(1.3, abs=0.02)
    assert free > seen
    for _ in range(300):
        world.command("one", 0.5, 0.0)
        world.step()
    assert robot.x == pytest.approx(0.5 - 0.2 - robot.description.radius, abs=0.01)
    assert obstacle in robot.touching
    assert world.ground_truth.events_of("collision", robot="one")[0].data["with"] == obstacle


def test_a_removed_obstacle_does_not_block(world: World) -> None:
    obstacle = world.add_obstacle(0.5, 0.0, 0.2)
    world.remove_obstacle(obstacle)
    for _ in range(300):
        world.command("one", 0.5, 0.0)
        world.step()
    assert world.robot("one").x > 1.0
    assert [event.data["obstacle"] for event in world.ground_truth.events_of("obstacle_removed")] == [
        obstacle
    ]
    with pytest.raises(UsageError, match="unknown obstacle: `obstacle_1`"):
        world.remove_obstacle(obstacle)


def test_obstacles_have_unique_names(world: World) -> None:
    names = [world.add_obstacle(x, 0.0, 0.1) for x in (0.0, 1.0, 2.0)]
    assert names == ["obstacle_1", "obstacle_2", "obstacle_3"]


@pytest.mark.parametrize("radius", [0.0, -1.0, 2.5, math.nan])
def test_the_size_of_an_obstacle_is_limited(world: World, radius: float) -> None:
    with pytest.raises(UsageError, match=r"between 0\.02 and 2 metres"):
        world.add_obstacle(0.0, 0.0, radius)


def test_a_battery_level_can_be_set(world: World) -> None:
    world.set_battery("one", 7.5)
    assert world.robot("one").battery.level == 7.5
    assert world.ground_truth.events_of("battery_set", robot="one")[0].data == {"level": 7.5}
    world.step()
    assert world.ground_truth.events_of("battery", robot="one")[-1].data == {"level": 8}
    with pytest.raises(UsageError, match="between 0 and 100 percent"):
        world.set_battery("one", 101.0)


def test_an_unchanged_world_behaves_as_before(world: World) -> None:
    """The same description, seed and commands give the same run, whether or not obstacles came and went."""
    other = World.load(LAB, seed=1)
    gone = other.add_obstacle(2.0, -2.0, 0.1)
    other.remove_obstacle(gone)
    for each in (world, other):
        for _ in range(100):
            each.command("one", 0.5, 0.3)
            each.step()
    assert world.ground_truth.path("one") == other.ground_truth.path("one")
