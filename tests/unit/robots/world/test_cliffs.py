"""Cliffs: robots that drive over one fall, and their sensors detect it before."""

import pytest
from navigation_lab import Lab

from jacaros.robots.plane.pose import Pose
from jacaros.robots.world import World, WorldError, read_world
from jacaros.robots.world.data.grid import Grid

STAIRS = """\
size: [6, 6]
cliffs:
  - {from: [1, -1], to: [2, 1]}
robots:
  - {name: robot, pose: {x: 0, y: 0}}
"""


def test_a_robot_with_its_centre_over_a_cliff_falls_and_stays_there() -> None:
    world = World.load(STAIRS)
    for _ in range(60):
        world.command("robot", 0.5, 0.0)
        world.run(0.1)
    [event] = world.ground_truth.events_of("fell")
    assert event.x == pytest.approx(1.0, abs=0.02)
    assert world.ground_truth.pose().x == event.x
    world.command("robot", -0.5, 1.0)
    world.run(1.0)
    assert world.ground_truth.pose() == (event.x, event.y, event.yaw)


def test_a_robot_that_stops_at_the_edge_has_not_fallen() -> None:
    world = World.load(STAIRS)
    while world.robot().x < 0.9:
        world.command("robot", 0.2, 0.0)
        world.run(0.1)
    world.run(2.0)
    assert world.ground_truth.events_of("fell") == []


def test_a_fallen_robot_is_not_pushed() -> None:
    world = World.load(STAIRS + "  - {name: other, namespace: other, pose: {x: -1, y: 0}}\n")
    for _ in range(40):
        world.command("robot", 0.5, 0.0)
        world.run(0.1)
    fallen = world.ground_truth.pose("robot")
    for _ in range(60):
        world.command("other", 0.5, 0.0)
        world.run(0.1)
    assert world.ground_truth.events_of("collision", robot="other")
    assert world.ground_truth.pose("robot") == fallen


@pytest.mark.world(STAIRS)
async def test_the_sensors_of_a_kobuki_see_the_cliff_and_then_the_wheels_drop(lab: Lab) -> None:
    cliffs = lab.hear("/mobile_base/events/cliff", "kobuki_msgs/msg/CliffEvent")
    drops = lab.hear("/mobile_base/events/wheel_drop", "kobuki_msgs/msg/WheelDropEvent")
    await lab.drive(3.0, 0.3)
    assert [(each.sensor, each.state) for each in cliffs] == [(1, 1)], "only the one in the middle"
    assert lab.world.robot().x < 1.0
    await lab.drive(1.0, -0.3)
    assert [(each.sensor, each.state) for each in cliffs] == [(1, 1), (1, 0)], "and it is behind"
    assert drops == []
    await lab.drive(3.0, 0.3)
    assert {(each.sensor, each.state) for each in cliffs[2:]} == {(0, 1), (1, 1), (2, 1)}
    assert [(each.wheel, each.state) for each in drops] == [(0, 1), (1, 1)]


@pytest.mark.world(STAIRS)
async def test_a_create_publishes_cliffs_and_wheel_drops_as_hazards(lab: Lab) -> None:
    messages = lab.hear("/hazard_detection", "irobot_create_msgs/msg/HazardDetectionVector")
    await lab.drive(5.0, 0.3)
    hazards = [{f"{each.type} {each.header.frame_id}" for each in message.detections} for message in messages]
    told = [each for before, each in zip([set(), *hazards], hazards, strict=False) if each != before]
    assert told[0] == {"2 cliff_front_left", "2 cliff_front_right"}
    assert {"4 wheel_drop_left", "4 wheel_drop_right", "2 cliff_side_left"} < told[-1]


def test_the_map_keeps_robots_away_from_cliffs() -> None:
    grid = Grid(read_world(STAIRS))
    assert grid.clearance_at(1.5, 0.0) == 0.0
    assert grid.clearance_at(0.8, 0.0) == pytest.approx(0.2, abs=0.03)


def test_a_robot_must_not_start_over_a_cliff() -> None:
    with pytest.raises(WorldError, match=r"the robot 'robot' is at \[1.5, 0\], over a cliff"):
        read_world(STAIRS.replace("x: 0", "x: 1.5"))


@pytest.mark.world(STAIRS)
async def test_the_wheels_of_a_carried_robot_drop_for_a_moment(lab: Lab) -> None:
    drops = lab.hear("/mobile_base/events/wheel_drop", "kobuki_msgs/msg/WheelDropEvent")
    hazards = lab.hear("/hazard_detection", "irobot_create_msgs/msg/HazardDetectionVector")
    await lab.drive(1.0, 0.0)
    lab.world.robot().put_down(Pose(1.5, 1.5, 0.0))
    await lab.drive(1.0, 0.0)
    assert [(drop.wheel, drop.state) for drop in drops] == [(0, 1), (1, 1), (0, 0), (1, 0)]
    assert {len(vector.detections) for vector in hazards} == {0, 2}
    assert hazards[-1].detections == []
