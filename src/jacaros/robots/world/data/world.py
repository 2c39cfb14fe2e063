"""A world as plain data, in metres, radians, seconds and percent.

World files (`files.world`) are read into these classes; the `World` of `physics` runs them, and
viewers draw them.
"""

import math
from dataclasses import dataclass, replace
from typing import Annotated, Any

from jacaros.robots.plane.pose import Pose
from jacaros.robots.plane.shapes import Rectangle, Segment
from jacaros.robots.world.data.robot import RobotDescription
from jacaros.runtime.files.entries import FieldSpec, flag, number, text, whole
from jacaros.runtime.files.texts import help_line, printable
from jacaros.runtime.files.yaml import YamlFileError

DEFAULT_BOUNDS = Rectangle(-3.0, -3.0, 3.0, 3.0)
_COLOR = FieldSpec('`"#rrggbb"` or a name', "in drawings")


def _drawn(thing: Any, *names: str) -> dict[str, Any]:
    """Return fields as JSON data."""
    given = {name: getattr(thing, name) for name in names}
    return {name: list(value) if isinstance(value, tuple) else value for name, value in given.items()}


@dataclass(frozen=True, slots=True)
class Furniture:
    """A box with a kind ("" if unknown) and a colour as ``#rrggbb`` ("" for the colour of boxes)."""

    area: Rectangle
    kind: Annotated[str, text("any text, such as `table`")] = ""
    color: Annotated[str, _COLOR] = ""


@dataclass(frozen=True, slots=True)
class Dirt:
    """Dirt of one kind in a room, in grams, evenly spread over *area* (None: the floor of the room without furniture)."""

    kind: str
    grams: float
    area: Rectangle | None = None


@dataclass(frozen=True, slots=True)
class Room:
    """A named part of the floor; it need not have walls."""

    name: str
    area: Rectangle
    dirt: tuple[Dirt, ...] = ()

    def drawing(self) -> dict[str, Any]:
        """Return the room as JSON data, with dirt only if there is some."""
        shown = [
            {**_drawn(dirt, "kind", "grams"), "area": list(dirt.area or self.area)} for dirt in self.dirt
        ]
        return {"name": self.name, "area": list(self.area), **({"dirt": shown} if shown else {})}


@dataclass(frozen=True, slots=True)
class Dock:
    """A charging station: it charges a robot whose centre rests within ``radius`` metres of it."""

    name: Annotated[str, text("unique name")]
    pose: Pose
    radius: Annotated[float, number(0.01, math.inf, "m", "in which robots are charged")] = 0.25


@dataclass(frozen=True, slots=True)
class Door:
    """A piece of wall that exists while the door is closed; ``open`` is the initial state."""

    name: Annotated[str, FieldSpec("text", "unique name, of letters, digits and _")]
    segment: Annotated[Segment, FieldSpec("`[[x, y], [x, y]]` m", "where it closes")]
    open: Annotated[bool, flag("open at the start")] = False


@dataclass(frozen=True, slots=True)
class ObjectDescription:
    """A round object on the floor that can be carried; ``color`` is ``#rrggbb``, or "" if unknown."""

    name: Annotated[str, text("unique name")]
    x: Annotated[float, number(-math.inf, math.inf, help="position, in m")]
    y: Annotated[float, number(-math.inf, math.inf, help="position, in m")]
    radius: Annotated[float, number(0.005, 0.5, "m", "of the round object")] = 0.03
    color: Annotated[str, _COLOR] = ""


@dataclass(frozen=True, slots=True)
class PersonDescription:
    """A person who walks from point to point of a path (metres), with a pause (seconds) at each.

    With ``loop`` the path continues from the last point to the first; otherwise the person stays at the last point. A
    ``careless`` person does not stop in front of robots. ``color`` is ``#rrggbb``, or "" for any.
    """

    name: Annotated[str, text("unique name")]
    path: Annotated[tuple[tuple[float, float], ...], FieldSpec("list of `[x, y]` in m", "points of the walk")]
    speed: Annotated[float, number(0.01, 5.0, "m/s", "walking speed")] = 1.0
    pause: Annotated[float, number(0.0, 1e6, "s", "rest at each point")] = 0.0
    loop: Annotated[bool, flag("continues from the last point to the first")] = False
    radius: Annotated[float, number(0.05, 2.0, "m", "of the round person")] = 0.25
    careless: Annotated[bool, flag("does not stop in front of robots")] = False
    color: Annotated[str, _COLOR] = ""

    def legs(self) -> tuple[Segment, ...]:
        """Return the segments of the path."""
        ends = (*self.path[1:], self.path[0]) if self.loop else self.path[1:]
        return tuple(Segment(*a, *b) for a, b in zip(self.path, ends, strict=False) if a != b)

    def drawing(self) -> dict[str, Any]:
        """Return the data for a viewer, as JSON data."""
        return {
            **_drawn(self, "name", "radius", "color"),
            "path": [list(point) for point in self.path],
            "loop": self.loop,
        }


@dataclass(frozen=True, slots=True)
class WorldDescription:
    """A whole world.

    ``segments`` are all walls, including those of ``boxes`` (solid furniture), without ``doors``; ``furniture`` are the
    boxes with a kind or a colour. Over ``cliffs`` there is no floor.
    """

    name: Annotated[str, text("of the world")] = "empty"
    bounds: Rectangle = DEFAULT_BOUNDS
    segments: tuple[Segment, ...] = ()
    boxes: tuple[Rectangle, ...] = ()
    furniture: tuple[Furniture, ...] = ()
    rooms: Annotated[tuple[Room, ...], FieldSpec("mapping", "parts of the floor by name")] = ()
    docks: Annotated[tuple[Dock, ...], FieldSpec("list", "charging stations")] = ()
    doors: Annotated[tuple[Door, ...], FieldSpec("list", "open or closed")] = ()
    cliffs: Annotated[tuple[Rectangle, ...], FieldSpec("list", "areas without floor")] = ()
    objects: Annotated[tuple[ObjectDescription, ...], FieldSpec("list", "things to carry")] = ()
    robots: Annotated[tuple[RobotDescription, ...], FieldSpec("list", "at least one")] = (RobotDescription(),)
    people: Annotated[tuple[PersonDescription, ...], FieldSpec("list", "people who walk")] = ()
    seed: Annotated[int, whole(0, "of all noise")] = 0

    def with_noise(self, factor: float) -> "WorldDescription":
        """Return the same world with the noise of its robots' sensors times *factor*; 0 for exact sensors.

        A robot whose odometry has no noise gets that of `SLIPPING`, times *factor*.
        """
        robots = (
            replace(
                robot,
                odometry=robot.odometry.with_noise(factor),
                laser=replace(robot.laser, noise=min(1.0, factor * robot.laser.noise)),
            )
            for robot in self.robots
        )
        return replace(self, robots=tuple(robots))

    def drawing(self) -> dict[str, Any]:
        """Return the data for a viewer to draw the world, as JSON data."""
        return {
            "name": self.name,
            "bounds": list(self.bounds),
            "walls": [list(segment) for segment in self.segments],
            "boxes": [list(box) for box in self.boxes],
            "furniture": [_drawn(each, "kind", "color", "area") for each in self.furniture],
            "rooms": [room.drawing() for room in self.rooms],
            "docks": [_drawn(dock, "name", "pose", "radius") for dock in self.docks],
            "doors": [_drawn(door, "name", "segment", "open") for door in self.doors],
            "cliffs": [list(cliff) for cliff in self.cliffs],
            "robots": [_drawn(robot, "name", "pose", "radius") for robot in self.robots],
            "objects": [
                {"name": each.name, "place": [each.x, each.y], **_drawn(each, "radius", "color")}
                for each in self.objects
            ],
            "people": [person.drawing() for person in self.people],
        }


class WorldError(YamlFileError):
    """Raised for a world file with mistakes."""


class UnknownWorld(WorldError):
    """Raised for a name that is neither a file nor a shipped world.

    Attributes:
        message: the error, without the help.
        help: the similar world, or the list of shipped worlds.
    """

    def __init__(self, name: str, help: str) -> None:
        super().__init__(name, "", [])
        self.message = f"world not found: `{printable(name)}`"
        self.help = help

    def __str__(self) -> str:
        return f"error: {self.message}\n{help_line(self.help)}"
