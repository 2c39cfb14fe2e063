"""What there is to see of a run: the embedded world, or whatever a real graph tells."""

from collections.abc import Mapping
from typing import Any, Protocol

from jacaros.inspector.robot_view import RobotView, views_of
from jacaros.sim import World


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
