"""Driving with an eye on what is in the way: the option `stop_for` of artifacts that drive."""

import pytest
from robot_lab import STANDSTILL, Lab

from jacaros.artifacts import Structure
from jacaros.robots.artifacts.velocity import ArtCmdVel

LOOKING = Structure("stop_for", ("scan",))
DOOR = """
name: passage
size: [6, 2]
rooms:
  west: {from: [-3, -1], to: [1, 1]}
  east: {from: [1, -1], to: [3, 1]}
doors:
  - {name: door, segment: [[1, -1], [1, 1]], open: false}
robots:
  - name: turtlebot
"""
BLIND = "name: dark\nrobots: [{name: turtlebot, laser: {enabled: false}}]\n"

pytestmark = pytest.mark.world(DOOR)


def bumps(lab: Lab) -> int:
    return len([event for event in lab.world.ground_truth.events if event.kind in ("bump", "collision")])


async def test_a_robot_stands_before_a_closed_door_and_fails_as_blocked(lab: Lab) -> None:
    wheels = await lab.make(ArtCmdVel, LOOKING)
    failed = await lab.call(wheels, "driveTo", 2, 0)
    assert failed.reason.startswith("blocked(")
    assert failed.message == "the laser sees something in the way"
    assert 0.7 < lab.pose()[0] < 0.8
    assert lab.speed() == STANDSTILL
    assert not bumps(lab)


async def test_without_the_option_it_touches_the_door(lab: Lab) -> None:
    wheels = await lab.make(ArtCmdVel)
    await lab.call(wheels, "driveTo", 2, 0)
    assert bumps(lab)


async def test_it_drives_on_when_the_door_opens(lab: Lab) -> None:
    wheels = await lab.make(ArtCmdVel, LOOKING)
    driving = await lab.begun(2.5, wheels, "driveTo", 2, 0)
    lab.world.move_door("door", True)
    await driving.done
    assert driving.ok
    assert lab.pose()[0] == pytest.approx(2, abs=0.02)


async def test_a_motion_by_time_alone_fails_in_front_of_it(lab: Lab) -> None:
    wheels = await lab.make(ArtCmdVel, LOOKING)
    failed = await lab.call(wheels, "move", 50)
    assert failed.reason.startswith("blocked(")
    assert not bumps(lab)


async def test_it_looks_back_where_it_drives_back(lab: Lab) -> None:
    wheels = await lab.make(ArtCmdVel, LOOKING)
    await lab.do(wheels, "rotate", 180)
    failed = await lab.call(wheels, "moveReverse", 2)
    assert failed.reason.startswith("blocked(")
    assert not bumps(lab)


async def test_walls_beside_the_way_do_not_stop_it(lab: Lab) -> None:
    wheels = await lab.make(ArtCmdVel, LOOKING, Structure("radius", (0.9,)))
    await lab.do(wheels, "moveForward", -1)
    assert lab.pose()[0] == pytest.approx(-1, abs=0.02)


@pytest.mark.world(BLIND)
async def test_it_does_not_start_without_a_scan(lab: Lab) -> None:
    wheels = await lab.make(ArtCmdVel, LOOKING)
    failed = await lab.call(wheels, "moveForward", 1)
    assert failed.reason == "no_scan(5)"
    assert lab.pose() == (0, 0, 0)
