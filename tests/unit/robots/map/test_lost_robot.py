"""ArtMap and a robot that is carried away: it notices, and finds its place, judged by its true pose."""

import math
from pathlib import Path

import pytest
from robot_lab import Lab, Watcher, made

from jacaros.artifacts import ArtifactId, Out, Structure
from jacaros.robots.artifacts.velocity import ArtCmdVelAndOdometry
from jacaros.robots.map.robot_map import ArtMap

SQUARE = """
name: square
bounds: {from: [-2, -2], to: [2, 2]}
border: walls
robots: [{name: turtlebot, pose: {x: 0.5, y: 0.2}}]
"""
TWO_ROOMS = """
name: two rooms
bounds: {from: [-1, -1], to: [7, 3]}
border: walls
walls: [{segment: [[2, -1], [2, 3]]}, {box: {from: [1, 2], to: [2, 3]}}, {box: {from: [4, 0.5], to: [5, 1]}}]
robots: [{name: turtlebot, pose: {x: 0, y: 0}}]
"""
HALL = """
name: hall
bounds: {from: [-9, -9], to: [9, 9]}
border: walls
robots: [{name: turtlebot, pose: {x: -8, y: -8}}]
"""

pytestmark = [pytest.mark.world("house"), made(ArtMap)]


async def tour(lab: Lab) -> ArtifactId:
    """Drive along the square of the house, which makes a map of it."""
    wheels = await lab.make(ArtCmdVelAndOdometry)
    for _ in range(4):
        await lab.do(wheels, "moveForward", 2)
        await lab.do(wheels, "rotate", 90)
    return wheels


def carry(lab: Lab, x: float, y: float, degrees: float = 60.0) -> None:
    lab.world.place(lab.world.robot().name, x, y, math.radians(degrees))


async def error(lab: Lab, artifact: ArtifactId) -> float:
    """Metres between the pose on the map and the true pose."""
    x, y, yaw = Out(), Out(), Out()
    await lab.do(artifact, "getPose", x, y, yaw)
    truth = lab.pose()
    assert abs(math.remainder(yaw.value - truth[2], 360.0)) < 2.0
    return math.dist((x.value, y.value), truth[:2])


def is_lost(watcher: Watcher) -> bool:
    return watcher.holds("lost") == [()]


async def test_an_undisturbed_robot_has_no_doubt(lab: Lab, artifact: ArtifactId, watcher: Watcher) -> None:
    await tour(lab)
    await lab.sleep(3.0)
    assert watcher.values("localised") == [(100,)]
    assert watcher.values("lost") == []
    assert await error(lab, artifact) < 0.02


async def test_a_carried_robot_is_lost_and_finds_its_place_by_turning(
    lab: Lab, artifact: ArtifactId, watcher: Watcher
) -> None:
    wheels = await tour(lab)
    carry(lab, 2.1, 1.7)
    await lab.sleep(3.0)
    assert is_lost(watcher)
    assert (await lab.call(artifact, "getPose", Out(), Out(), Out())).reason == "lost"
    assert (await lab.call(artifact, "relocalise")).reason == "ambiguous(2)"
    await lab.do(wheels, "rotate", 90)
    assert not is_lost(watcher)
    assert await error(lab, artifact) < 0.02
    await lab.sleep(3.0)
    assert await error(lab, artifact) < 0.02


async def test_a_lost_robot_does_not_change_its_map(lab: Lab, artifact: ArtifactId, watcher: Watcher) -> None:
    wheels = await tour(lab)
    carry(lab, 2.1, 1.7)
    await lab.do(wheels, "rotate", 360)
    assert is_lost(watcher)
    carry(lab, 0.0, 0.0, 0.0)
    await lab.do(wheels, "rotate", 360)
    assert (watcher.holds("localised"), is_lost(watcher)) == ([(100,)], False)


@pytest.mark.world(SQUARE)
async def test_corners_that_look_the_same_are_ambiguous(
    lab: Lab, artifact: ArtifactId, watcher: Watcher
) -> None:
    wheels = await lab.make(ArtCmdVelAndOdometry)
    await lab.do(wheels, "rotate", 360)
    assert (await lab.call(artifact, "relocalise")).reason == "ambiguous(4)"
    await lab.do(wheels, "rotate", 360)
    await lab.do(wheels, "moveForward", 0.5)
    assert is_lost(watcher)


@pytest.mark.parametrize(
    ("x", "y"),
    [
        pytest.param(5.5, 2.0, marks=pytest.mark.world(TWO_ROOMS), id="a room that is not on the map"),
        pytest.param(0.0, 0.0, marks=pytest.mark.world(HALL), id="no wall in reach"),
    ],
)
async def test_a_robot_in_a_place_without_match_says_so(
    lab: Lab, artifact: ArtifactId, watcher: Watcher, x: float, y: float
) -> None:
    wheels = await lab.make(ArtCmdVelAndOdometry)
    await lab.do(wheels, "rotate", 360)
    carry(lab, x, y)
    assert (await lab.call(artifact, "relocalise")).reason == "no_match"
    await lab.do(wheels, "rotate", 360)
    assert is_lost(watcher)


async def test_slipping_wheels_are_corrected_without_doubt(
    lab: Lab, artifact: ArtifactId, watcher: Watcher
) -> None:
    wheels = await tour(lab)
    lab.world.robot().grip = lambda: 0.6
    await lab.do(wheels, "moveForward", 1.5)
    await lab.do(wheels, "rotate", 90)
    assert math.dist(lab.pose()[:2], (1.5, 0.0)) > 0.4
    assert await error(lab, artifact) < 0.02
    assert watcher.values("lost") == []


async def test_a_pose_that_a_person_gives_is_corrected(
    lab: Lab, artifact: ArtifactId, watcher: Watcher
) -> None:
    await tour(lab)
    carry(lab, 2.1, 1.7)
    await lab.sleep(3.0)
    await lab.do(artifact, "set_pose", 1.7, 1.8, 70)
    assert not is_lost(watcher)
    assert await error(lab, artifact) < 0.02


async def test_a_wrong_pose_is_noticed(lab: Lab, artifact: ArtifactId, watcher: Watcher) -> None:
    await tour(lab)
    await lab.do(artifact, "set_pose", 2, 2, 0)
    await lab.sleep(3.0)
    assert is_lost(watcher)


async def test_a_robot_that_starts_anywhere_finds_itself_on_a_loaded_map(
    lab: Lab, artifact: ArtifactId, watcher: Watcher, tmp_path: Path
) -> None:
    wheels = await tour(lab)
    await lab.do(artifact, "saveMap", str(tmp_path / "house.yaml"))
    carry(lab, 0.2, 2.1)
    other = await lab.make(ArtMap)
    await lab.do(other, "loadMap", str(tmp_path / "house.yaml"))
    await lab.call(other, "relocalise")
    await lab.do(wheels, "rotate", 90)
    assert await error(lab, other) < 0.05


@made(ArtMap, Structure("pose_from", ("odometry",)))
async def test_a_map_without_matching_takes_a_pose_but_does_not_search(
    lab: Lab, artifact: ArtifactId, watcher: Watcher
) -> None:
    await lab.sleep(1.0)
    assert (await lab.call(artifact, "relocalise")).reason == "no_matching"
    carry(lab, 1.0, 2.0, 90.0)
    await lab.do(artifact, "set_pose", 1, 2, 90)
    assert await error(lab, artifact) < 0.01
    assert watcher.values("localised") == []


@pytest.mark.world(None)
async def test_without_sensors_nothing_is_searched_and_no_pose_is_taken(
    lab: Lab, artifact: ArtifactId
) -> None:
    assert (await lab.call(artifact, "relocalise")).reason == "no_scan(5)"
    assert (await lab.call(artifact, "set_pose", 1, 1, 0)).reason == "no_odometry"
    assert (await lab.call(artifact, "getOpenGround", Out(), Out())).reason == "no_scan"


@pytest.mark.world(TWO_ROOMS)
async def test_open_ground_is_where_the_scan_shows_the_longest_way(lab: Lab, artifact: ArtifactId) -> None:
    await lab.sleep(0.5)
    degrees, metres = Out(), Out()
    await lab.do(artifact, "getOpenGround", degrees, metres)
    assert (degrees.value, metres.value) == (0.0, 1.0)
    carry(lab, 1.6, 0.0, 0.0)
    await lab.sleep(0.5)
    await lab.do(artifact, "getOpenGround", degrees, metres)
    assert 90.0 <= abs(degrees.value) <= 180.0
    assert metres.value == 1.0
