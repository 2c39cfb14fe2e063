"""The fingerprint of a world: equal on every Python, and different for another seed."""

import hashlib
import random
import sys
from array import array

from jacaros.robots.world.physics.robot import Robot
from jacaros.robots.world.physics.world import STEP, World

_SCAN_PERIOD = 0.1
_TURN_PERIOD = 2.0

WORLD = """
name: two rooms
size: [6, 4]
border: walls
seed: 3
walls:
  - segment: [[0, -2], [0, -0.5]]
  - segment: [[0, 0.5], [0, 2]]
  - box: {from: [1, 1], to: [1.5, 2]}
robots:
  - {name: a, namespace: a, pose: {x: -1, y: 0}, odometry: {noise_per_metre: 0.02, noise_degrees_per_turn: 2}}
  - {name: b, namespace: b, pose: {x: 2, y: 0, yaw_degrees: 180}, laser: {noise: 0.02}}
  - {name: c, namespace: c, pose: {x: -2, y: 1}}
  - {name: d, namespace: d, pose: {x: -2, y: -1}}
"""
EXPECTED = "98cacf317fa5810d1b04d55c9b45ad583edaf9d48168b8da8bb5d5998c7cb3df"


def fingerprint(world: World, seconds: float) -> str:
    """Drive all robots at random, seeded by the world, and hash their poses and measurements.

    Args:
        world: world at its start.
        seconds: duration in seconds of the world, with ten scans per second.

    Returns:
        SHA-256 of all poses, odometry and laser ranges, as hexadecimal digits.
    """
    draw = random.Random(f"{world.description.seed}/fingerprint").random
    content, rates = hashlib.sha256(), dict.fromkeys(world.robots, 0.0)
    per_scan, per_turn = round(_SCAN_PERIOD / STEP), round(_TURN_PERIOD / STEP)
    for step in range(round(seconds / STEP)):
        if step % per_scan == 0:
            for robot in world.robots.values():
                _drive(robot, rates, draw() - 0.5, turns=step % per_turn == 0)
        world.step()
        if step % per_scan == 0:
            for robot in world.robots.values():
                odometry = robot.odometry
                ranges = world.scan(robot.name) if robot.description.laser.enabled else []
                figures = array("d", (*robot.pose, odometry.x, odometry.y, odometry.yaw, *ranges))
                if sys.byteorder == "big":
                    figures.byteswap()
                content.update(figures)
    return content.hexdigest()


def _drive(robot: Robot, rates: dict[str, float], chance: float, turns: bool) -> None:
    """Command a robot: back off and turn on contact, otherwise drive ahead in a curve that changes from time to time."""
    if robot.touching:
        rates[robot.name] = 1.0 if chance > 0.0 else -1.0
    elif turns:
        rates[robot.name] = chance
    robot.command(-0.1 if robot.touching else 0.3, rates[robot.name])


def test_it_is_the_same_on_every_machine() -> None:
    assert fingerprint(World.load(WORLD), 10.0) == EXPECTED


def test_another_seed_gives_another_one() -> None:
    assert fingerprint(World.load(WORLD, 4), 10.0) != EXPECTED
