"""What there is to see of a run, and of its robots: the embedded world, or whatever a real graph tells."""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple, Protocol

from jacaros.sim import World

UNKNOWN = -1.0
"""Battery level that is shown if none is published."""


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
    # Not by RobotView(...), which takes twice as long: a recording calls this several times a second.
    return [
        tuple.__new__(
            RobotView,
            (
                robot.name,
                robot.x,
                robot.y,
                robot.yaw,
                robot.battery.level,
                robot.battery.charging,
                bool(robot.touching),
            ),
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

    def follow(self, moved: Callable[[], None]) -> bool:
        """Have *moved* called ten times a second while robots move; False if that is not known, or not yet."""

    def close(self) -> None:
        """Stop looking."""


class EmbeddedScene:
    """The embedded world, whose truth is known.

    Args:
        find: gives the world; None until an agent needs a robot. A project without robots never has one.
    """

    def __init__(self, find: Callable[[], World | None]) -> None:
        self._find = find
        self._drawing: Mapping[str, Any] | None = None
        self._stop_following: Callable[[], None] | None = None

    def drawing(self) -> Mapping[str, Any] | None:
        """The world, which does not change; None without a world."""
        if self._drawing is None and (world := self._find()) is not None:
            self._drawing = world.description.drawing()
        return self._drawing

    def robots(self) -> list[RobotView]:
        """The robots where they truly are."""
        world = self._find()
        return views_of(world) if world is not None else []

    def follow(self, moved: Callable[[], None]) -> bool:
        """Have *moved* called when the world has noted where its robots are; False while there is no world."""
        world = self._find()
        if world is not None and self._stop_following is None:
            self._stop_following = world.when_moved(moved)
        return world is not None

    def close(self) -> None:
        """Follow no longer."""
        if self._stop_following is not None:
            self._stop_following()
            self._stop_following = None
