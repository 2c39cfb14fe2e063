"""Driving in the frame of the map, where wheels slip: `frame(map)` of the artifacts that drive."""

import pytest
from robot_lab import STANDSTILL, Lab, apart, assert_at

from jacaros.artifacts import Out, Structure
from jacaros.robots.artifacts.velocity import ArtCmdVel
from jacaros.robots.plane.pose import Pose

ON_MAP = Structure("frame", ("map",))
NOISE = "{noise_per_metre: 0.05, noise_degrees_per_turn: 5, noise_degrees_per_metre: 3}"
SLIPPERY = f"""
name: slippery
seed: 3
robots:
  - name: turtlebot
    odometry: {NOISE}
"""

pytestmark = pytest.mark.world(SLIPPERY)
TWO = f"""
name: two
seed: 3
robots:
  - name: one
    namespace: one
    pose: {{x: 0, y: 1}}
    odometry: {NOISE}
  - name: two
    namespace: two
    odometry: {NOISE}
"""


async def drive_rounds(lab: Lab, *arguments: object) -> None:
    wheels = await lab.make(ArtCmdVel, *arguments)
    for _ in range(3):
        for x, y in ((1, 0), (1, 1), (0, 1), (0, 0)):
            await lab.do(wheels, "driveTo", x, y)


async def test_what_slipping_wheels_pile_up_is_put_right(lab: Lab) -> None:
    await drive_rounds(lab, ON_MAP)
    assert_at(lab, 0, 0, lab.pose()[2], metres=0.05)


async def test_in_odometrys_own_frame_it_adds_up(lab: Lab) -> None:
    await drive_rounds(lab)
    assert apart(lab.pose(), (0, 0, 0))[0] > 0.1


async def test_turns_and_poses_are_those_of_the_map(lab: Lab) -> None:
    wheels = await lab.make(ArtCmdVel, ON_MAP)
    for _ in range(8):
        await lab.do(wheels, "rotate", 90)
    await lab.do(wheels, "goTo", 1, 1, 90)
    assert_at(lab, 1, 1, 90, metres=0.05, degrees=4)
    x, y, heading = Out(), Out(), Out()
    await lab.sleep(1)
    await lab.do(wheels, "getCurrentPose", x, y, heading)
    told = (float(str(x.value)), float(str(y.value)), float(str(heading.value)))
    metres, degrees = apart(told, lab.pose())
    assert metres < 0.005
    assert degrees < 0.5


@pytest.mark.parametrize("frame", ["map", "/two/map"])
@pytest.mark.world(TWO)
async def test_robots_share_the_map(lab: Lab, frame: str) -> None:
    wheels = await lab.make(ArtCmdVel, "two", Structure("frame", (frame,)))
    await lab.do(wheels, "driveTo", 2, 0)
    robot = lab.world.robot("two")
    assert abs(robot.x - 2) < 0.05
    assert abs(robot.y) < 0.05


async def test_without_localisation_the_robot_stands_and_the_motion_fails(lab: Lab) -> None:
    wheels = await lab.make(ArtCmdVel, Structure("frame", ("garden",)))
    failed = await lab.call(wheels, "moveForward", 1)
    assert failed.reason == "no_transform(5)"
    assert 5 <= lab.clock.elapsed < 6
    assert lab.pose() == (0, 0, 0)


async def test_localisation_that_dies_on_the_way_stops_the_robot(lab: Lab) -> None:
    wheels = await lab.make(ArtCmdVel, ON_MAP)
    driving = await lab.begun(3, wheels, "moveForward", 5)
    backend = lab.backend
    backend.graph.disturb("/tf", lambda message: ())  # type: ignore[attr-defined]
    await lab.sleep(3)
    assert lab.speed() == STANDSTILL
    await driving.done
    assert driving.reason == "no_transform(5)"
    assert lab.pose()[0] < 4.5


async def test_a_relative_motion_fails_when_localisation_finds_the_robot_elsewhere(lab: Lab) -> None:
    wheels = await lab.make(ArtCmdVel, ON_MAP)
    turning = await lab.begun(2, wheels, "rotate", 180)
    lab.world.robot("turtlebot").misled = Pose(-1, 0, 0)
    await turning.done
    assert turning.reason.startswith("interrupted(")
    assert turning.message == "localisation has found the robot elsewhere"


async def test_a_drive_to_a_point_continues_from_there(lab: Lab) -> None:
    wheels = await lab.make(ArtCmdVel, ON_MAP)
    driving = await lab.begun(2, wheels, "driveTo", 2, 0)
    lab.world.robot("turtlebot").misled = Pose(0, 0, 0)
    await driving.done
    assert driving.ok
