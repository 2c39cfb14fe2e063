"""ArtMap: the map of a robot's laser, of ``/map``, and the robot on it."""

import math
import subprocess
import sys
from pathlib import Path

import pytest
from robot_lab import Lab, Watcher, made

from jacaros.artifacts import ArtifactId, Out, Structure
from jacaros.robots.artifacts.velocity import ArtCmdVelAndOdometry
from jacaros.robots.map.robot_map import ArtMap
from jacaros.robots.ros.message import stamp
from jacaros.robots.ros.qos import LATCHED

WALLED = """
name: walled
bounds: {from: [-1, -1], to: [3, 1]}
border: walls
walls:
  - segment: [[2, -1], [2, 0.2]]
robots:
  - {name: turtlebot, pose: {x: 0, y: 0}, odometry: {origin: start}, laser: {noise: 0.01}}
"""

pytestmark = [pytest.mark.world(WALLED), made(ArtMap)]


def option(name: str, value: object) -> Structure:
    return Structure(name, (value,))


async def labels(lab: Lab, artifact: ArtifactId, *cells: tuple[int, int]) -> list[object]:
    found: list[object] = []
    for cell in cells:
        out = Out()
        await lab.do(artifact, "getSlamData", *cell, out)
        found.append(out.value)
    return found


async def test_a_scan_makes_cells_free_and_obstacles(lab: Lab, artifact: ArtifactId) -> None:
    assert await labels(lab, artifact, (0, 0)) == ["unknown"]
    await lab.sleep(0.5)
    near, wall, hidden = (10, 0), (20, -5), (25, -5)
    assert await labels(lab, artifact, near, wall, hidden) == ["free", "obstacle", "unknown"]


async def test_the_robot_is_followed(lab: Lab) -> None:
    artifact = await lab.make(ArtMap, option("cell_size", 0.2))
    wheels = await lab.make(ArtCmdVelAndOdometry)
    watcher = lab.watch(artifact)
    await lab.sleep(0.5)
    assert placed(watcher, "me") == {(0, 0)}
    await lab.do(wheels, "moveForward", 1.6)
    await lab.sleep(0.5)
    assert placed(watcher, "me") == {(8, 0)}
    out = Out()
    await lab.do(artifact, "getDistance", out)
    assert out.value == pytest.approx(1.6, abs=0.02)


def placed(watcher: Watcher, thing: str) -> set[tuple[object, object]]:
    return {(v[1], v[2]) for v in watcher.holds("pos2d") if len(v) == 3 and v[0] == thing}


async def test_routes_keep_clear_of_walls_and_legs_lead_along_them(lab: Lab, artifact: ArtifactId) -> None:
    wheels = await lab.make(ArtCmdVelAndOdometry)
    turn, metres = Out(), Out()
    assert (await lab.call(artifact, "getLeg", turn, metres)).reason == "no_odometry"
    await lab.sleep(0.5)
    assert (await lab.call(artifact, "getLeg", turn, metres)).reason == "no_route"
    assert (await lab.call(artifact, "getRoute", 18, 0)).reason == "no_route(18,0)"  # beside the wall
    out = Out()
    await lab.do(artifact, "getRoute", 22, 6, out)
    assert isinstance(out.value, list)
    for each in out.value:
        x, y = each.arguments
        assert math.dist((x, y), (20, 2)) > 2.5
    for _ in range(9):
        await lab.do(artifact, "getLeg", turn, metres)
        await lab.do(wheels, "rotate", turn.value)
        await lab.do(wheels, "moveForward", metres.value)
    assert metres.value == 0
    x, y, _ = lab.pose()
    assert math.dist((x, y), (2.2, 0.6)) < 0.08


async def test_the_first_frontier_waits_for_the_first_scan(lab: Lab, artifact: ArtifactId) -> None:
    x, y = Out(), Out()
    await lab.do(artifact, "getFrontier", x, y)
    assert lab.clock.elapsed < 1.0
    other = await lab.make(ArtMap, "robot_2")
    assert (await lab.call(other, "getFrontier", x, y)).reason == "no_scan(5)"
    other = await lab.make(ArtMap, "robot_2", option("source", "map"))
    assert (await lab.call(other, "getFrontier", x, y)).reason == "no_map(5)"


async def test_the_next_frontier_is_given_until_all_is_explored(lab: Lab, artifact: ArtifactId) -> None:
    wheels = await lab.make(ArtCmdVelAndOdometry)
    await lab.sleep(0.5)
    x, y, turn, metres = (Out() for _ in range(4))
    for _ in range(20):
        asked = await lab.call(artifact, "getFrontier", x, y)
        if asked.outcome is not None and not asked.outcome.ok:
            break
        await lab.do(artifact, "getRoute", x.value, y.value)
        await lab.do(artifact, "getLeg", turn, metres)
        await lab.do(wheels, "rotate", turn.value)
        await lab.do(wheels, "moveForward", metres.value)
    assert asked.reason == "explored"
    assert await labels(lab, artifact, (25, -5), (30, 0)) == ["free", "obstacle"]


DRIFTING = WALLED.replace(
    "{origin: start}",
    "{origin: start, noise_per_metre: 0.2, noise_degrees_per_turn: 20, noise_degrees_per_metre: 10}",
)
"""The same with odometry that goes wrong by ten times what that of the examples does."""


@pytest.mark.parametrize(
    ("pose_from", "least", "most"), [("scans", 0.0, 0.06), ("amcl", 0.0, 0.15), ("odometry", 0.18, 9.0)]
)
@pytest.mark.world(DRIFTING)
async def test_drift_of_odometry_is_corrected(lab: Lab, pose_from: str, least: float, most: float) -> None:
    """`/amcl_pose` comes each 25 cm; between two of them the wheels are trusted."""
    artifact = await lab.make(ArtMap, option("pose_from", pose_from), option("cell_size", 0.05))
    wheels = await lab.make(ArtCmdVelAndOdometry)
    watcher = lab.watch(artifact)
    for _ in range(6):
        await lab.do(wheels, "rotate", 90)
        await lab.do(wheels, "moveForward", 0.3)
    await lab.sleep(1.0)
    x, y, _ = lab.pose()
    cell_x, cell_y = next(iter(placed(watcher, "me")))
    off = math.dist((x, y), (0.05 * float(str(cell_x)), 0.05 * float(str(cell_y))))
    assert least <= off < most


def publish_map(lab: Lab, resolution: float = 0.5) -> None:
    publisher = lab.backend.publisher("/map", "nav_msgs/msg/OccupancyGrid", LATCHED)
    message = publisher.message(data=[0, 100, -1, 0])
    message.info.resolution = resolution
    message.info.width = message.info.height = 2
    message.info.origin.position.x = message.info.origin.position.y = -resolution / 2.0
    publisher.publish(message)


@pytest.mark.world(None)
@made(ArtMap, option("source", "map"), option("robots", ["robot_2"]))
async def test_the_map_may_come_from_another_node(lab: Lab, artifact: ArtifactId, watcher: Watcher) -> None:
    publish_map(lab)
    await lab.sleep(0.1)
    cells = [(0, 0), (1, 0), (0, 1), (1, 1)]
    assert await labels(lab, artifact, *cells) == ["free", "obstacle", "unknown", "free"]
    other = lab.backend.publisher(
        "/robot_2/amcl_pose", "geometry_msgs/msg/PoseWithCovarianceStamped", LATCHED
    )
    for x in (0.0, 0.6):
        message = other.message()
        message.pose.pose.position.x = x
        message.pose.pose.orientation.w = 1.0
        stamp(message.header.stamp, lab.clock.now())
        other.publish(message)
    await lab.sleep(0.1)
    assert placed(watcher, "robot_2") == {(1, 0)}


@pytest.mark.world("house")
async def test_the_map_of_the_world_is_used_with_the_pose_of_its_localisation(lab: Lab) -> None:
    artifact = await lab.make(ArtMap, option("source", "map"))
    wheels = await lab.make(ArtCmdVelAndOdometry)
    watcher = lab.watch(artifact)
    await lab.do(wheels, "moveForward", 1)
    await lab.sleep(1.0)
    assert placed(watcher, "me") == {(10, 0)}
    await lab.do(artifact, "getRoute", 20, 20)
    route = watcher.holds("route")[0][0]
    assert isinstance(route, list)
    assert len(route) > 20


async def test_a_loaded_map_localises_the_robot(lab: Lab, tmp_path: Path) -> None:
    file = str(tmp_path / "saved.yaml")
    artifact = await lab.make(ArtMap)
    await lab.sleep(0.5)
    await lab.do(artifact, "saveMap", file)
    await lab.do(artifact, "clear")
    assert await labels(lab, artifact, (20, -5)) == ["unknown"]
    await lab.do(artifact, "loadMap", file)
    assert await labels(lab, artifact, (20, -5)) == ["obstacle"]
    await lab.sleep(5.0)
    assert await labels(lab, artifact, (20, -5), (10, 0)) == ["obstacle", "free"]


@pytest.mark.parametrize(
    "wrong",
    [("source", "camera"), ("laser", [0, 0]), ("robots", ["a", 1]), ("robots", "a"), ("cell_size", 0)],
)
@pytest.mark.world(None)
async def test_options_that_cannot_be_are_refused(lab: Lab, wrong: tuple[str, object]) -> None:
    with pytest.raises(Exception, match="expected"):
        await lab.make(ArtMap, option(*wrong))


def test_a_run_without_a_map_does_not_load_it() -> None:
    code = (
        "import sys, jacaros.robots.registry as r\n"
        "assert 'ArtMap' in r.BUILT_IN and 'ArtMop' not in r.BUILT_IN and 'ArtSlamData' in list(r.BUILT_IN)\n"
        "assert not [m for m in sys.modules if m.startswith('jacaros.robots.map.')]\n"
        "assert r.find_type('jason.architecture.ArtMap').__name__ == 'ArtMap'\n"
        "assert 'numpy' not in sys.modules\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
