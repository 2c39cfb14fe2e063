"""The visible part of a run and its robots: the embedded world, or the robots of a real graph."""

from collections.abc import Callable, Mapping
from math import isfinite
from typing import Any, Protocol, Self

from jacaros.sim import World
from jacaros.sim.data.ground_truth import RobotState

UNKNOWN = -1.0
"""Battery level that is shown if none is published."""


class RobotView(RobotState):
    """The state of a robot, with its name; its battery may be `UNKNOWN`.

    In the embedded world the true pose, on a real graph the estimated one.
    """

    name: str

    def __new__(cls, name: str, *state: Any, **fields: Any) -> Self:
        """Create the view from the fields of a `RobotState`."""
        view = super().__new__(cls, *state, **fields)
        view.name = name
        return view


def views_of(world: World) -> list[RobotView]:
    """Return all robots of *world* in their current state."""
    return [RobotView(robot.name, *robot.state()) for robot in world.robots.values()]


def row_of(robot: RobotState) -> RobotState:
    """Return the row of a robot in a frame: millimetres are enough for a picture, and take a third of the bytes."""
    exact = robot.x, robot.y, robot.yaw, robot.battery
    return RobotState._make((*map(_short, exact), int(robot.charging), int(robot.touching)))


def _short(value: float) -> float:
    """Return a number with three decimals."""
    # `round` with digits takes five times as long.
    return round(value * 1e3) / 1e3 if isfinite(value) else value


class Scene(Protocol):
    """An observed world with robots."""

    def drawing(self) -> Mapping[str, Any] | None:
        """The world, as `jacaros.sim.WorldDescription.drawing` describes it: the same object until something changes, None
        while nothing is known."""

    def robots(self) -> list[RobotView]:
        """Return all robots in their current state; new robots are appended."""

    def follow(self, moved: Callable[[], None]) -> bool:
        """Call *moved* ten times per second while robots move; return False if their motion is not (yet) known."""

    def close(self) -> None:
        """Stop looking."""


class EmbeddedScene:
    """The embedded world, with true poses.

    Args:
        find: returns the world; None until an agent needs a robot. A project without robots never has one.
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
        """Return the robots at their true poses."""
        world = self._find()
        return views_of(world) if world is not None else []

    def follow(self, moved: Callable[[], None]) -> bool:
        """Call *moved* when the world has recorded the poses of its robots; return False while there is no world."""
        world = self._find()
        if world is not None and self._stop_following is None:
            self._stop_following = world.when_moved(moved)
        return world is not None

    def close(self) -> None:
        """Stop following."""
        if self._stop_following is not None:
            self._stop_following()
            self._stop_following = None
