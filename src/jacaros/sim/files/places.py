"""Whether a robot fits at a place given in a world file or a fault file."""

import math
from collections.abc import Iterable

from jacaros.plane.pose import Pose
from jacaros.sim.contact import WallIndex, push_out_rectangle
from jacaros.sim.description import RobotDescription, Segment, WorldDescription

_TOUCHING = 0.001
"""Metres that a robot may overlap a wall: the error of a rounded coordinate."""


def place_problem(
    robot: RobotDescription, pose: Pose, world: WorldDescription, solid: Iterable[Segment]
) -> tuple[str, str]:
    """Return what is wrong with putting a *robot* at *pose*, and a help; both are empty if it fits.

    Args:
        robot: its radius or footprint is used, not its own pose.
        pose: place, in metres and radians.
        world: its boxes, and its bounds if it has border walls.
        solid: walls to consider.
    """
    x, y, _ = pose
    walls = tuple(solid)
    if _has_border(world) and not world.bounds.contains(x, y):
        left, bottom, right, top = world.bounds
        return "outside the world", f"the world is from [{left:g}, {bottom:g}] to [{right:g}, {top:g}]"
    if any(box.contains(x, y) for box in world.boxes):
        return "inside a box", ""
    if robot.footprint is not None:
        length, width = robot.footprint
        fits = _push(robot, pose, walls) <= _TOUCHING
        return ("", "") if fits else (f"in a wall, with a footprint of {length:g} x {width:g} m", "")
    near = min((wall.distance(x, y) for wall in walls), default=math.inf)
    if near < robot.radius - _TOUCHING:
        return f"in a wall: {near:.2f} m from it, with a radius of {robot.radius:g} m", ""
    return "", ""


def _has_border(world: WorldDescription) -> bool:
    return set(world.bounds.edges()) <= set(world.segments)


def _push(robot: RobotDescription, pose: Pose, walls: Iterable[Segment]) -> float:
    """Return how far walls push a rectangular robot away, in metres."""
    assert robot.footprint is not None
    length, width = robot.footprint
    near = WallIndex(walls, robot.radius).near(pose.x, pose.y)
    x, y, _ = push_out_rectangle(pose, 0.5 * length, 0.5 * width, near)
    return math.dist((x, y), pose[:2])
