"""The visible part of a run: the embedded world or a real graph, its robots, and what of it changes."""

from collections.abc import Callable, Mapping
from math import isfinite
from typing import Any, NamedTuple, Self

from jacaros.robots.world import World
from jacaros.robots.world.data.ground_truth import RobotState

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
        """Return the world, which does not change, as `WorldDescription.drawing` describes it; None without one."""
        if self._drawing is None and (world := self._find()) is not None:
            self._drawing = world.description.drawing()
        return self._drawing

    def robots(self) -> list[RobotView]:
        """Return the robots at their true poses."""
        world = self._find()
        return views_of(world) if world is not None else []

    def follow(self, moved: Callable[[], None]) -> bool:
        """Call *moved* ten times per second while robots move; return False while there is no world."""
        world = self._find()
        if world is not None and self._stop_following is None:
            self._stop_following = world.when_moved(moved)
        return world is not None

    def close(self) -> None:
        """Stop following."""
        if self._stop_following is not None:
            self._stop_following()
            self._stop_following = None


# ---- what changes


class PersonView(NamedTuple):
    """A person at a time: position and radius in metres, the points of the path, and a colour ("" for any)."""

    name: str
    x: float
    y: float
    radius: float
    color: str
    path: tuple[tuple[float, float], ...]


class SceneState:
    """What of a world changes, by its events.

    Args:
        drawing: data of the world, from `jacaros.robots.world.WorldDescription.drawing`.

    Attributes:
        open: whether each door is open.
        places: where each object lies; robots carry the others.
        dirt: grams of dirt that are left, by room and kind.
    """

    def __init__(self, drawing: Mapping[str, Any]) -> None:
        self.open: dict[str, bool] = {door["name"]: door["open"] for door in drawing.get("doors", ())}
        self.places: dict[str, Any] = {each["name"]: each["place"] for each in drawing.get("objects", ())}
        self.dirt: dict[tuple[str, str], float] = {
            (room["name"], dirt["kind"]): dirt["grams"]
            for room in drawing.get("rooms", ())
            for dirt in room.get("dirt", ())
        }
        self._people: dict[str, PersonView] = {}
        self._moves: dict[str, tuple[float, float, float]] = {}
        for person in drawing.get("people", ()):
            self._come(person)

    def _come(self, person: Mapping[str, Any]) -> None:
        path = tuple((x, y) for x, y in person["path"])
        shown = (*path, path[0]) if person["loop"] else path
        self._people[person["name"]] = PersonView(
            person["name"], *path[0], person["radius"], person["color"], shown
        )

    def event(self, t: float, kind: str, data: Mapping[str, Any]) -> None:
        """Process an event, *t* seconds after the start of the run; those that change nothing shown are ignored."""
        match kind:
            case "door_opened" | "door_closed":
                self.open[data["door"]] = kind == "door_opened"
            case "placed":
                self.places[data["object"]] = data["x"], data["y"]
            case "picked":
                self.places.pop(data["object"], None)
            case "cleaned":
                self.dirt[data["room"], data["dirt"]] = data["grams"]
            case "person_goes":
                self._people.pop(data["person"], None)
                self._moves.pop(data["person"], None)
            case "person_comes" | "person_walks" | "person_stands":
                if kind == "person_comes":
                    self._come(data)
                name = data["person"]
                if name in self._people:
                    self._people[name] = self._people[name]._replace(x=data["x"], y=data["y"])
                    self._moves[name] = t, data.get("vx", 0.0), data.get("vy", 0.0)

    def people(self, t: float) -> list[PersonView]:
        """Return the people who are present at a time after the last event, straight on since their last one."""
        found = []
        for name, view in self._people.items():
            since, vx, vy = self._moves.get(name, (t, 0.0, 0.0))
            found.append(view._replace(x=view.x + vx * (t - since), y=view.y + vy * (t - since)))
        return found
