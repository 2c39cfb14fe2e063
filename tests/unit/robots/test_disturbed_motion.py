"""Motion over a graph that delays, repeats, loses and overtakes odometry: the robot arrives, or stops with a reason."""

from typing import Any

import pytest
from robot_lab import STANDSTILL, Lab, assert_at, made

from jacaros.artifacts import ArtifactId
from jacaros.robots.artifacts.odometry import ArtOdometry
from jacaros.robots.artifacts.velocity import ArtCmdVel
from jacaros.robots.ros.drivers.memory.graph import Disturbance, both, delayed, dropped, duplicated

pytestmark = pytest.mark.world("empty")


def disturb(lab: Lab, topic: str, disturbance: Disturbance) -> None:
    backend: Any = lab.backend
    backend.graph.disturb(topic, disturbance)


@pytest.mark.parametrize(
    "disturbance",
    [
        delayed(0.02),
        delayed(0.0, jitter=0.1, seed=3),
        duplicated(3, apart=0.03),
        dropped(0.5, seed=1),
        both(dropped(0.2, seed=2), both(duplicated(2, apart=0.05), delayed(0.01, jitter=0.05, seed=4))),
    ],
    ids=["delayed", "overtaking", "repeated", "lost", "all of it"],
)
async def test_a_square_is_driven_with_bad_odometry(lab: Lab, disturbance: Disturbance) -> None:
    disturb(lab, "/odom", disturbance)
    artifact = await lab.make(ArtCmdVel)
    for _ in range(4):
        await lab.do(artifact, "moveForward", 1)
        await lab.do(artifact, "rotate", 90)
    assert_at(lab, 0, 0, 0, metres=0.06, degrees=3)


async def test_positions_that_overtake_each_other_are_never_shown_backwards(lab: Lab) -> None:
    disturb(lab, "/odom", delayed(0.0, jitter=0.2, seed=5))
    watcher = lab.watch(await lab.make(ArtOdometry))
    artifact = await lab.make(ArtCmdVel)
    await lab.do(artifact, "moveForward", 2)
    shown = [float(str(x)) for x, _, _ in watcher.values("odom")]
    there = shown.index(max(shown))  # from there on it makes up for what it has driven too far
    assert there > 20
    assert shown[: there + 1] == sorted(shown[: there + 1])


@made(ArtCmdVel, recorded=True)
async def test_odometry_that_is_lost_for_good_stops_the_robot(lab: Lab, artifact: ArtifactId) -> None:
    moving = await lab.begun(2, artifact, "moveForward", 5)
    disturb(lab, "/odom", dropped())
    await moving.done
    assert moving.reason == "no_odometry(5)"
    assert lab.last_command == STANDSTILL
    assert lab.speed() == (0.0, 0.0)
