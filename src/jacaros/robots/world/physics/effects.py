"""What faults do to a robot itself, and when faults of docks, doors and people first affect one."""

from collections.abc import Callable, Iterable, Mapping
from functools import partial
from typing import Final

from jacaros.robots.world.data.faults import Fault
from jacaros.robots.world.physics.faults import Effect, Felt
from jacaros.robots.world.physics.robot import Robot

NEAR = 1.0
"""Metres from the centre of a robot at which a closed door or the centre of a person affects it."""


def _slip(robot: Robot, fault: Fault, seed: int) -> Effect:
    draw = fault.draw(seed, "slip")
    robot.grip = lambda: max(0.0, 1.0 - 2.0 * fault.share * draw())
    return Effect(partial(setattr, robot, "grip", None), lambda: robot.rolling and fault.share > 0.0)


def _block(robot: Robot, fault: Fault, seed: int) -> Effect:
    robot.blocked_wheel = fault.wheel
    return Effect(partial(setattr, robot, "blocked_wheel", ""), lambda: robot.rolling)


def _mislead(robot: Robot, fault: Fault, seed: int) -> Effect:
    robot.misled = fault.pose
    return Effect(felt=lambda: robot.misled is None)


def _drain(robot: Robot, fault: Fault, seed: int) -> Effect:
    before = robot.battery.level
    robot.battery.level = min(before, fault.level)
    return Effect(felt=before - robot.battery.level >= 1.0)


ON_ROBOT: Final[Mapping[str, Callable[[Robot, Fault, int], Effect]]] = {
    "wheel_slip": _slip,
    "blocked_wheel": _block,
    "lost_localisation": _mislead,
    "battery_drop": _drain,
}
"""Kinds that concern nothing but a robot: what they do, given the seed of the world."""


def near(robots: Iterable[Robot], apart: Callable[[float, float], float]) -> Felt:
    """Return a function that returns whether a robot is near something, given its distance from a point."""
    return lambda: any(apart(robot.x, robot.y) <= NEAR for robot in robots)


def without_current(robots: Iterable[Robot], dock: str) -> Felt:
    """Return a function that returns whether a robot is in a dock and has no current."""
    return lambda: any(
        robot.dock is not None and robot.dock.name == dock and not robot.fed for robot in robots
    )
