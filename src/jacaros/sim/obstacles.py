"""Round obstacles put on the floor during a run, which block robots, people and lasers.

They are not on the robots' map.
"""

import math
from collections.abc import Iterable, Sequence
from typing import NamedTuple

from jacaros.errors import UsageError
from jacaros.sim.contact import WallIndex, push_apart
from jacaros.sim.robot.robot import Robot
from jacaros.sim.robot.sensors.laser import Circle


class Obstacle(NamedTuple):
    """One obstacle, in metres."""

    name: str
    x: float
    y: float
    radius: float


class Obstacles:
    """The obstacles of a world.

    Attributes:
        by_name: obstacles by name.
    """

    def __init__(self) -> None:
        self.by_name: dict[str, Obstacle] = {}
        self._count = 0

    def add(self, x: float, y: float, radius: float) -> Obstacle:
        """Add an obstacle at a point; return it with its new name."""
        self._count += 1
        obstacle = Obstacle(f"obstacle_{self._count}", x, y, radius)
        self.by_name[obstacle.name] = obstacle
        return obstacle

    def remove(self, name: str) -> Obstacle:
        """Remove an obstacle.

        Raises:
            UsageError: the obstacle does not exist.
        """
        if name not in self.by_name:
            raise UsageError(f"unknown obstacle: `{name}`")
        return self.by_name.pop(name)

    def circles(self) -> list[Circle]:
        """Return centres and radii, in metres."""
        return [(each.x, each.y, each.radius) for each in self.by_name.values()]

    def hold_off(self, robots: Sequence[Robot], walls: WallIndex, dt: float) -> None:
        """Push robots out of the obstacles, which do not move."""
        for obstacle in self.by_name.values():
            for robot in robots:
                reach = robot.description.radius + obstacle.radius
                push = push_apart(robot.x, robot.y, obstacle.x, obstacle.y, reach)
                if push is not None:
                    x, y, towards_x, towards_y = push
                    side = robot.side(towards_x, towards_y)
                    robot.touch(obstacle.name, 2.0 * x, 2.0 * y, side, walls, dt)

    def near(self, x: float, y: float, reach: float) -> str:
        """Return the name of an obstacle that overlaps a circle, "" for none."""
        return overlapping(
            ((each.name, each.x, each.y, each.radius) for each in self.by_name.values()), x, y, reach
        )


def overlapping(circles: Iterable[tuple[str, float, float, float]], x: float, y: float, reach: float) -> str:
    """Return the name of the first of some *circles* that overlaps a circle of radius *reach*, "" for none."""
    return next((name for name, cx, cy, radius in circles if math.hypot(cx - x, cy - y) < radius + reach), "")
