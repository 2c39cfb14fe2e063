"""The fingerprint of a world: a hash of a run without agents, equal on every machine."""

import hashlib
import random
import sys
from array import array

from jacaros.robots.world.physics.robot import Robot
from jacaros.robots.world.physics.world import STEP, World

_SCAN_PERIOD = 0.1
_TURN_PERIOD = 2.0


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
