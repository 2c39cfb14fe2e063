"""What there is to see of a run, and of its robots: the embedded world, or whatever a real graph tells."""

from collections.abc import Mapping
from typing import Any, NamedTuple, Protocol

from jacaros.sim import World

UNKNOWN = -1.0
"""The level of a battery that nobody tells of."""


class RobotView(NamedTuple):
    """A robot at one moment: pose (metres, radians), battery (percent, or `UNKNOWN`) and what happens to it.

    Of the embedded world the true pose, of a robot on a real graph the one that it believes in.
    """

    name: str
    x: float
    y: float
    yaw: float
    battery: float
    charging: bool = False
    touching: bool = False


def views_of(world: World) -> list[RobotView]:
    """All robots of *world* as they are now."""
    return [
        RobotView(
            robot.name,
            robot.x,
            robot.y,
            robot.yaw,
            robot.battery.level,
            robot.battery.charging,
            bool(robot.touching),
        )
        for robot in world.robots.values()
    ]


class Scene(Protocol):
    """A world with robots that is looked at."""

    def drawing(self) -> Mapping[str, Any] | None:
        """The world, as `jacaros.sim.WorldDescription.drawing` gives it: the same object while nothing has changed, None
        while nothing is known."""

    def robots(self) -> list[RobotView]:
        """All robots as they are now, in an order to which new ones are added at the end."""

    def close(self) -> None:
        """Look no more."""


class EmbeddedScene:
    """The embedded world, whose truth is known.

    Args:
        world: the world.
    """

    def __init__(self, world: World) -> None:
        self._world = world
        self._drawing = world.description.drawing()

    def drawing(self) -> Mapping[str, Any]:
        """The world, which does not change."""
        return self._drawing

    def robots(self) -> list[RobotView]:
        """The robots where they truly are."""
        return views_of(self._world)

    def close(self) -> None:
        """Nothing is held."""
