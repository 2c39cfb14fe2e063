"""What a robot perceives: the robots, people and doors that its laser sees."""

import math
from collections.abc import Iterable

from jacaros.robots.plane.pose import Placement, Point, distance
from jacaros.robots.plane.shapes import Circle, Segment
from jacaros.robots.world.data.world import Door
from jacaros.robots.world.physics.robot import Robot
from jacaros.robots.world.physics.world import World

RANGE = 3.0
"""Distance in metres up to which other robots and doors are considered."""
_LEAF = -0.03
"""Radius of the circles that stand for a closed door: navigation treats it as a wall, not as a robot."""
_BETWEEN = 0.1
"""Maximum distance in metres between the centres of those circles."""


class LaserPerception:
    """What a robot perceives, on the map at its estimated pose. A robot without a laser perceives nothing.

    Args:
        world: the world.
        robot: robot with the laser.
    """

    def __init__(self, world: World, robot: Robot) -> None:
        self._world, self._robot = world, robot
        laser = robot.description.laser
        self._reach = min(RANGE, laser.range_max) if laser.enabled else 0.0
        self._closed: set[str] = set()

    def robots(self, believed: Placement) -> list[Circle]:
        """Return the robots, people and obstacles that no wall hides."""
        world = self._world
        if self._reach <= 0.0 or not (len(world.robots) > 1 or world.people or world.obstacles):
            return []
        true, seen = self._robot.placement, []
        for x, y, radius in self._world.others(self._robot):
            if self._sees(x, y, self._world.segments):
                seen.append((*believed.point(*true.local(x, y)), radius))
        return seen

    def closed_doors(self, believed: Placement) -> dict[str, list[Circle]]:
        """Return the doors that were closed when last seen, each as a row of circles."""
        doors = self._world.description.doors
        if not doors:
            return {}
        for door in doors:
            others = [wall for wall in self._world.segments if wall is not door.segment]
            if any(self._sees(*point, others) for point in _points(door)[1:-1]):
                (self._closed.discard if self._world.doors[door.name] else self._closed.add)(door.name)
        true = self._robot.placement
        return {
            door.name: [(*believed.point(*true.local(*point)), _LEAF) for point in _points(door)]
            for door in doors
            if door.name in self._closed
        }

    def covers(self, place: Point, believed: Placement) -> bool:
        """Return whether the robot sees a place on its map, or what occupies it."""
        return self._sees(*self._robot.placement.point(*believed.local(*place)), self._world.segments)

    def forget(self) -> None:
        """Forget the doors that were closed."""
        self._closed.clear()

    def _sees(self, x: float, y: float, walls: Iterable[Segment]) -> bool:
        dx, dy = x - self._robot.x, y - self._robot.y
        near = dx * dx + dy * dy <= self._reach * self._reach
        return near and not Segment(self._robot.x, self._robot.y, x, y).crosses(*walls)


def _points(door: Door) -> list[Point]:
    ax, ay, bx, by = door.segment
    pieces = max(2, math.ceil(distance((ax, ay), (bx, by)) / _BETWEEN))
    return [(ax + (bx - ax) * n / pieces, ay + (by - ay) * n / pieces) for n in range(pieces + 1)]
