"""Positions of the people of an observed world, extrapolated from the last event of each."""

from collections.abc import Mapping
from typing import Any, NamedTuple

PERSON = "person_"
"""Prefix of the kinds of their events."""


class PersonView(NamedTuple):
    """A person at a time: position and radius in metres, the points of the path, and a colour ("" for any)."""

    name: str
    x: float
    y: float
    radius: float
    color: str
    path: tuple[tuple[float, float], ...]


class PeopleSeen:
    """Tracks the people of a world by their events.

    Args:
        drawing: data of the world, from `jacaros.sim.WorldDescription.drawing`.
    """

    def __init__(self, drawing: Mapping[str, Any]) -> None:
        self._views: dict[str, PersonView] = {}
        self._moves: dict[str, tuple[float, float, float]] = {}
        for person in drawing.get("people", ()):
            self._come(person)

    def _come(self, person: Mapping[str, Any]) -> None:
        path = tuple((x, y) for x, y in person["path"])
        shown = (*path, path[0]) if person["loop"] else path
        self._views[person["name"]] = PersonView(
            person["name"], *path[0], person["radius"], person["color"], shown
        )

    def event(self, t: float, kind: str, data: Mapping[str, Any]) -> None:
        """Process an event of the world, *t* seconds after the start of the run; other events are ignored."""
        if not kind.startswith(PERSON):
            return
        name = data["person"]
        if kind == "person_comes":
            self._come(data)
        self._moves.pop(name, None)
        if kind == "person_goes":
            self._views.pop(name, None)
        elif name in self._views:
            self._views[name] = self._views[name]._replace(x=data["x"], y=data["y"])
            self._moves[name] = (t, data.get("vx", 0.0), data.get("vy", 0.0))

    def at(self, t: float) -> list[PersonView]:
        """Return the people who are present at a time after the last event."""
        found = []
        for name, view in self._views.items():
            since, vx, vy = self._moves.get(name, (t, 0.0, 0.0))
            found.append(view._replace(x=view.x + vx * (t - since), y=view.y + vy * (t - since)))
        return found
