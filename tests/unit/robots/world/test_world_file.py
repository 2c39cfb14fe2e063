"""World files: their content, and all mistakes in one pass, with lines."""

import math
from pathlib import Path

import pytest

from jacaros.robots.plane.trigonometry import PI
from jacaros.robots.world import World, WorldError, read_world, shipped_worlds
from jacaros.robots.world.data.robot import KINDS

FULL = """\
name: flat
bounds: {from: [0, 0], to: [4, 3]}
border: walls
seed: 5
walls:
  - segment: [[1, 0], [1, 1]]
  - polyline: [[2, 0], [2, 1], [3, 1]]
    closed: true
  - box: {from: [3, 2], to: [3.5, 2.5]}
rooms:
  kitchen: {from: [2, 2], to: [0, 3]}
docks:
  - {x: 1, y: 2, yaw_degrees: 90}
robots:
  - name: robot_1
    namespace: /robot_1
    pose: {x: 0.5, y: 0.5, yaw_degrees: 180}
    radius: 0.2
    limits: {speed: 0.5, turn_rate_degrees: 90}
    battery: {level: 80, drain_per_second: 0.5, drain_per_turn: 1}
    odometry: {origin: start, noise_per_metre: 0.02}
    laser: {beams_per_turn: 180, field_degrees: 270, range_max: 8, publish: always}
"""


def test_a_full_world_file_is_read() -> None:
    world = read_world(FULL)
    assert (world.name, world.seed, world.bounds) == ("flat", 5, (0, 0, 4, 3))
    assert len(world.segments) == 4 + 1 + 3 + 4
    assert world.rooms[0].area == (0, 2, 2, 3)
    assert world.docks[0].name == "dock"
    assert world.docks[0].pose == (1, 2, PI / 2)
    [robot] = world.robots
    assert robot.namespace == "robot_1"
    assert robot.pose == (0.5, 0.5, PI)
    assert robot.limits.speed == 0.5
    assert robot.limits.turn_rate == PI / 2
    assert robot.limits.turn_acceleration == 5.0
    assert robot.battery.level == 80
    assert robot.battery.drain_per_radian == pytest.approx(1 / (2 * PI))
    assert robot.odometry.from_start
    assert robot.laser.field == pytest.approx(math.radians(270))
    assert robot.laser.always


def test_a_kind_gives_defaults_that_can_be_overridden() -> None:
    text = "robots:\n  - {kind: KIND, limits: {acceleration: 0.5}, laser: {range_max: 5}}\n"
    burger = read_world(text.replace("KIND", "turtlebot3")).robots[0]
    assert (burger.radius, burger.limits.speed, burger.limits.acceleration) == (0.105, 0.22, 0.5)
    assert (burger.laser.range_min, burger.laser.range_max) == (0.12, 5)
    assert burger.laser.field == 2 * PI
    kobuki = read_world(text.replace("KIND", "turtlebot2")).robots[0]
    assert kobuki.laser.field == pytest.approx(math.radians(57))
    with pytest.raises(WorldError, match="turtlebot5"):
        read_world(text.replace("KIND", "turtlebot5"))
    plain, usual = (read_world(text.replace("kind: KIND, ", kind)) for kind in ("", "kind: turtlebot, "))
    assert plain == usual


@pytest.mark.parametrize("kind", KINDS)
def test_a_robot_of_each_kind_drives_as_fast_as_it_can(kind: str) -> None:
    world = World.load(f"robots:\n  - {{name: robot, kind: {kind}}}\n")
    for _ in range(40):
        world.command("robot", 5.0, 0.0)
        world.run(0.1)
    assert world.robot().speed == KINDS[kind].limits.speed


BAD = """\
name: 7
wals: []
walls:
  - segment: [[0, 0], [1]]
docks: [{x: 0}]
robots:
  - {name: a, pose: {x: left}}
  - {name: a, namespace: 2bad}
"""


def test_all_mistakes_are_reported_with_excerpt_and_help() -> None:
    with pytest.raises(WorldError) as caught:
        read_world(BAD, "bad.yaml")
    assert [problem.line for problem in caught.value.problems] == [1, 2, 4, 5, 7, 8, 8]
    told = str(caught.value)
    assert "bad.yaml:2:1: error: a world has no key 'wals'" in told
    assert "    2 | wals: []" in told
    assert "  = help: did you mean `walls`?" in told
    assert "'x' must be a number, not 'left'" in told
    assert "the robot of line 7 has the same name 'a'" in told
    assert "'2bad' is not a ROS namespace" in told


ROBOT = "robots: [{name: a}]\n"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("name: [unclosed", "this bracket is never closed"),
        ("a: 1\na: 2", "duplicate key 'a', first in line 1"),
        ("", "a world is empty"),
        ("name: a", "lacks the key 'robots'"),
        ("just a text", "must be a mapping"),
        ("robots: []", "needs a robot"),
        (ROBOT + "size: [0, 3]", "must be positive"),
        (ROBOT + "size: [1, 3]\nbounds: {from: [0, 0], to: [1, 1]}", "are alternatives"),
        (ROBOT + "walls: [{box: {from: [0, 0], to: [0, 1]}}]", "has no area"),
        (ROBOT + "walls: [{polyline: [[0, 0]]}]", "has 1 points"),
        (ROBOT + "walls: [{segment: [[0, 0], [0, 0]]}]", "twice in a row"),
        (ROBOT + "walls: [{box: {from: [1, 1], to: [2, 2], color: sky}}]", "'sky' is not a colour"),
        (ROBOT + "walls: [{box: {from: [1, 1], to: [2, 2], kind: 3}}]", "must be a text"),
        (ROBOT + "walls: [{closed: true}]", "must be one segment, polyline or box"),
        ("robots: [{name: a, laser: {enabled: 1}}]", "must be true or false"),
        ("robots: [{name: a, laser: {beams_per_turn: 2}}]", "whole number of at least 4"),
        ("robots: [{name: a, battery: {level: 101}}]", "must lie between 0 and 100"),
        ("robots: [{name: a, odometry: {origin: moon}}]", "'origin' is 'moon'"),
        ("robots: {name: a}", "must be a list"),
        (ROBOT + "border: glass", "'border' is 'glass'"),
        ("robots: [{name: a, radius: .inf}]", "must be a number"),
        ("robots:\n  - <<: {nam: a}\n    name: r\n", "no key 'nam'"),
    ],
)
def test_mistakes_in_a_world_are_reported_once(text: str, message: str) -> None:
    with pytest.raises(WorldError, match=message) as caught:
        read_world(text)
    assert len(caught.value.problems) == 1


def test_boxes_may_have_a_kind_and_a_colour() -> None:
    world = read_world(
        """
robots: [{}]
walls:
  - box: {from: [1, 1], to: [2, 2]}
  - box: {from: [2, 2], to: [1, 3], kind: table, color: Brown}
  - box: {from: [2, 0], to: [3, 1], color: "#00FF7f"}
"""
    )
    assert world.boxes == ((1, 1, 2, 2), (1, 2, 2, 3), (2, 0, 3, 1))
    assert [(each.kind, each.color) for each in world.furniture] == [("table", "#8b5a2b"), ("", "#00ff7f")]
    assert [each.area for each in world.furniture] == list(world.boxes[1:])


def test_a_binary_file_is_reported(tmp_path: Path) -> None:
    path = tmp_path / "picture.yaml"
    path.write_bytes(b"\x89PNG\xff\xfe")
    with pytest.raises(WorldError, match="the byte 0x89 is not UTF-8"):
        World.load(path)


def test_robots_may_share_settings_by_a_yaml_merge() -> None:
    text = "robots:\n  - &one {name: a, radius: 0.2}\n  - {<<: *one, name: b, namespace: b}\n"
    assert [robot.radius for robot in read_world(text).robots] == [0.2, 0.2]


SHIPPED = "empty, flat, house, maze, office, patrol, three_robots, two_robots, warehouse"


@pytest.mark.parametrize(("name", "told"), [("nowhere", SHIPPED), ("x" * 300, "world not found")])
def test_an_unknown_world_lists_the_shipped_ones(name: str, told: str) -> None:
    with pytest.raises(WorldError, match=told):
        World.load(name)


@pytest.mark.parametrize(("name", "meant"), [("huose", "house"), ("{}/yrad.yaml", "{}/yard.yaml")])
def test_a_misspelt_world_suggests_a_similar_name(tmp_path: Path, name: str, meant: str) -> None:
    (tmp_path / "yard.yaml").write_text("")
    name, meant = name.format(tmp_path), meant.format(tmp_path)
    with pytest.raises(WorldError) as unknown:
        World.load(name)
    assert str(unknown.value) == f"error: world not found: `{name}`\n  = help: did you mean `{meant}`?"


@pytest.mark.parametrize("name", shipped_worlds())
def test_a_shipped_world_loads_and_its_robots_stand_free(name: str) -> None:
    world = World.load(name)
    for robot in world.robots:
        world.command(robot, 0.0, 0.001)
    world.run(0.2)
    assert world.ground_truth.events_of("bump", "collision") == []
    assert world.description.docks


def test_each_corner_of_the_square_is_in_its_room_of_the_house() -> None:
    rooms = [World.load("house").room_at(*corner) for corner in ((0, 0), (2, 0), (2, 2), (0, 2))]
    assert rooms == ["hallway", "living_room", "kitchen", "bathroom"]


def test_navigation_can_be_disabled_or_given_a_speed() -> None:
    def settings(text: str) -> tuple[bool, float]:
        robot = read_world(f"robots:\n  - name: r\n    {text}\n").robots[0]
        return robot.navigation.enabled, robot.navigation.speed

    assert settings("radius: 0.2") == (True, 0.4)
    assert settings("navigation: false") == (False, 0.4)
    assert settings("navigation: true") == (True, 0.4)
    assert settings("navigation: {speed: 0.2}") == (True, 0.2)
    for wrong, told in (
        ("navigation: {sped: 1}", "3:18: error: 'navigation' has no key 'sped'"),
        ("navigation: fast", "3:17: error: 'navigation' must be true or false, not 'fast'"),
        ("navigation: {speed: 9}", "3:25: error: 'speed' is 9, but must lie between 0.05 and 5"),
    ):
        with pytest.raises(WorldError) as error:
            settings(wrong)
        assert told in str(error.value)


@pytest.mark.parametrize("value", ["2001-99-99", "!!int x", "!!float q", "9" * 5000])
def test_an_invalid_value_has_a_location(value: str) -> None:
    with pytest.raises(WorldError, match="world:2:7: error: not YAML: not a valid"):
        read_world(f"robots: [{{name: r}}]\nname: {value}\n")


WALLED = """\
size: [4, 4]
border: walls
walls:
  - box: {from: [-1, -1], to: [1, 1]}
  - segment: [[1.5, -2], [1.5, 2]]
doors:
  - {name: cellar, segment: [[-2, 1.5], [-1, 1.5]], open: false}
  - {name: garden, segment: [[-1, 1.5], [0, 1.5]], open: true}
robots:
"""


def test_all_misplaced_robots_are_reported_in_one_pass() -> None:
    robots = {"far": "9, y: 0", "boxed": "0, y: 0", "walled": "1.4, y: 0.5", "stuck": "-1.5, y: 1.6"}
    lines = [f"  - {{name: {each}, namespace: {each}, pose: {{x: {at}}}}}" for each, at in robots.items()]
    with pytest.raises(WorldError) as wrong:
        read_world(WALLED + "\n".join(lines))
    assert [(problem.line, problem.message) for problem in wrong.value.problems] == [
        (10, "the robot 'far' is at [9, 0], outside the world"),
        (11, "the robot 'boxed' is at [0, 0], inside a box"),
        (12, "the robot 'walled' is at [1.4, 0.5], in a wall: 0.10 m from it, with a radius of 0.17 m"),
        (13, "the robot 'stuck' is at [-1.5, 1.6], in a wall: 0.10 m from it, with a radius of 0.17 m"),
    ]


@pytest.mark.parametrize(
    ("border", "place"),
    [
        ("walls", "{x: -0.5, y: 1.5}"),  # in a door that is open
        ("walls", "{x: 1.33, y: 0}"),  # at a wall, without touching it
        ("open", "{x: 9, y: 0}"),  # nothing keeps robots in such a world
    ],
)
def test_robots_may_start_wherever_they_can_drive(border: str, place: str) -> None:
    text = WALLED.replace("border: walls", f"border: {border}")
    assert len(read_world(f"{text}  - {{pose: {place}}}").robots) == 1
