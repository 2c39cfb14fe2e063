"""What a robot sees of the other robots with its laser."""

from collections.abc import Iterable

from jacaros.sim.description import Segment
from jacaros.sim.navigation.placement import Placement
from jacaros.sim.navigation.planner import Circle
from jacaros.sim.robot import Robot
from jacaros.sim.world import World

RANGE = 3.0
"""Metres up to which a robot cares for others."""


def others_in_sight(world: World, robot: Robot, believed: Placement) -> list[Circle]:
    """The robots that no wall hides, on the map of a robot that believes to be at *believed*.

    A robot without a laser sees nothing.
    """
    if len(world.robots) < 2 or not robot.description.laser.enabled:
        return []
    reach = min(RANGE, robot.description.laser.range_max)
    true = Placement.at(robot.x, robot.y, robot.yaw)
    seen = []
    for other in world.robots.values():
        dx, dy = other.x - robot.x, other.y - robot.y
        if other is robot or dx * dx + dy * dy > reach * reach:
            continue
        if not hidden(world.description.segments, robot.x, robot.y, other.x, other.y):
            seen.append((*believed.point(*true.local(other.x, other.y)), other.description.radius))
    return seen


def hidden(walls: Iterable[Segment], ax: float, ay: float, bx: float, by: float) -> bool:
    """Whether a wall crosses the straight line between two points."""
    dx, dy = bx - ax, by - ay
    for cx, cy, ex, ey in walls:
        of_c, of_e = dx * (cy - ay) - dy * (cx - ax), dx * (ey - ay) - dy * (ex - ax)
        if (of_c > 0.0) == (of_e > 0.0):
            continue
        wx, wy = ex - cx, ey - cy
        if (wx * (ay - cy) - wy * (ax - cx) > 0.0) != (wx * (by - cy) - wy * (bx - cx) > 0.0):
            return True
    return False
