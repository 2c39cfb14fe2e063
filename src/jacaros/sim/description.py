"""A world as plain data, in metres, radians, seconds and percent.

World files (`jacaros.sim.files.world`) are read into these classes; `jacaros.sim.world.World` runs them, and viewers draw
them.
"""

import math
from dataclasses import dataclass, replace
from typing import Annotated, Any, NamedTuple

from jacaros.files.entries import Entry, either, flag, number, section, text, whole
from jacaros.files.texts import help_line, printable
from jacaros.files.yaml import Problem, YamlFileError
from jacaros.plane.pose import ORIGIN, Pose
from jacaros.plane.trigonometry import PI, TWO_PI, radians
from jacaros.sim.interface import EVERYTHING, Interface


class Segment(NamedTuple):
    """A straight piece of wall, in metres, without thickness."""

    ax: float
    ay: float
    bx: float
    by: float

    def distance(self, x: float, y: float) -> float:
        """Return the distance in metres from a point to the segment."""
        dx, dy = self.bx - self.ax, self.by - self.ay
        place = ((x - self.ax) * dx + (y - self.ay) * dy) / (dx * dx + dy * dy)
        place = 0.0 if place < 0.0 else 1.0 if place > 1.0 else place
        ex, ey = x - (self.ax + place * dx), y - (self.ay + place * dy)
        return math.sqrt(ex * ex + ey * ey)

    def gap(self, other: "Segment") -> float:
        """Return the smallest distance in metres between two segments; 0 if they cross."""
        if self.crosses(other):
            return 0.0
        return min(
            self.distance(other.ax, other.ay),
            self.distance(other.bx, other.by),
            other.distance(self.ax, self.ay),
            other.distance(self.bx, self.by),
        )

    def crosses(self, other: "Segment") -> bool:
        """Return whether two segments cross."""
        return self._parts(other) and other._parts(self)

    def _parts(self, other: "Segment") -> bool:
        """Return whether the ends of *other* are on different sides of the line through this segment."""
        dx, dy = self.bx - self.ax, self.by - self.ay
        of_a = dx * (other.ay - self.ay) - dy * (other.ax - self.ax)
        of_b = dx * (other.by - self.ay) - dy * (other.bx - self.ax)
        return (of_a > 0.0) != (of_b > 0.0)


class Rectangle(NamedTuple):
    """An axis-aligned rectangle, in metres."""

    x_min: float
    y_min: float
    x_max: float
    y_max: float

    def contains(self, x: float, y: float) -> bool:
        """Return whether a point is inside or on the edge."""
        return self.x_min <= x <= self.x_max and self.y_min <= y <= self.y_max

    def edges(self) -> tuple[Segment, Segment, Segment, Segment]:
        """Return the four sides, counter-clockwise."""
        a, b, c, d = self
        return Segment(a, b, c, b), Segment(c, b, c, d), Segment(c, d, a, d), Segment(a, d, a, b)


DEFAULT_BOUNDS = Rectangle(-3.0, -3.0, 3.0, 3.0)


_COLOR = Entry('`"#rrggbb"` or a name', "in drawings")


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
            {"kind": dirt.kind, "grams": dirt.grams, "area": list(dirt.area or self.area)}
            for dirt in self.dirt
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

    name: str
    segment: Segment
    open: bool = False


def _angle(unit: str, help: str, key: str, least: float = 0.0, most: float = 1e9) -> Entry:
    """Return the entry of an angle: degrees in the file, radians in Python."""
    return number(least, most, unit, help, key, radians)


_PER_TURN = number(0.0, 1e9, "%", "discharge by a turn", "drain_per_turn", lambda drain: drain / TWO_PI)


@dataclass(frozen=True, slots=True)
class BatterySettings:
    """Discharge and charge rates of a battery; levels are in percent, 0 to 100.

    The defaults last about two hours of driving, as for a TurtleBot.
    """

    level: Annotated[float, number(0.0, 100.0, "%", "charge at the start")] = 100.0
    drain_per_second: Annotated[float, number(unit="%", help="discharge, also at rest")] = 0.01
    drain_per_metre: Annotated[float, number(unit="%", help="discharge by driving")] = 0.02
    drain_per_radian: Annotated[float, _PER_TURN] = 0.0
    charge_per_second: Annotated[float, number(unit="%", help="charge at a dock")] = 5.0


_ROOT = math.sqrt(TWO_PI)
# The error of a whole turn is that of 2 pi radians, and the squares of errors add up.
_TURN = number(
    0.0, 1e9, "°", "error of the angle", "noise_degrees_per_turn", lambda turn: radians(turn) / _ROOT
)


@dataclass(frozen=True, slots=True)
class OdometrySettings:
    """The origin of odometry and its errors.

    ``per_metre`` and ``per_radian`` are the standard deviations of the distance after one metre and of the angle after one
    radian (both grow with the square root of the distance); 0 is a perfect encoder. ``turn_per_metre`` is the heading error
    (radians) per metre driven.
    """

    from_start: Annotated[bool, either("where it counts from", "origin", "world", "start")] = False
    per_metre: Annotated[float, number(unit="m", help="error of the distance", key="noise_per_metre")] = 0.0
    per_radian: Annotated[float, _TURN] = 0.0
    turn_per_metre: Annotated[float, _angle("°", "error of the heading", "noise_degrees_per_metre")] = 0.0

    @property
    def noisy(self) -> bool:
        """Whether any error is not zero."""
        return self.per_metre > 0.0 or self.per_radian > 0.0 or self.turn_per_metre > 0.0

    def with_noise(self, factor: float) -> "OdometrySettings":
        """Return the same odometry with its errors times *factor*, or with those of `SLIPPING` if it has none."""
        known = self if self.noisy else SLIPPING
        errors = known.per_metre, known.per_radian, known.turn_per_metre
        return OdometrySettings(self.from_start, *(factor * each for each in errors))


SLIPPING = OdometrySettings(False, 0.02, radians(2.0) / math.sqrt(2.0 * PI), radians(1.0))
"""Odometry of wheels that slip as a TurtleBot's: 2 % in a metre, 2 degrees in a turn, 1 degree per metre."""


@dataclass(frozen=True, slots=True)
class LaserSettings:
    """The laser range finder, at the centre of the robot, facing ahead.

    ``beams_per_turn`` sets the step between beams, ``field`` (radians) the field of view, and ``noise`` the half width
    (metres) of the uniform error of a range. With ``always`` it publishes even without subscriptions.
    """

    enabled: Annotated[bool, flag("whether the robot has a laser")] = True
    beams_per_turn: Annotated[int, whole(4, "beams in 360°")] = 360
    field: Annotated[float, _angle("°", "field of view", "field_degrees", 1.0, 360.0)] = 2.0 * PI
    range_min: Annotated[float, number(unit="m", help="shortest range")] = 0.1
    range_max: Annotated[float, number(0.1, unit="m", help="longest range")] = 10.0
    noise: Annotated[float, number(0.0, 1.0, "m", "largest error of a range")] = 0.0
    always: Annotated[bool, either("when it publishes", "publish", "on demand", "always")] = False


@dataclass(frozen=True, slots=True)
class RobotLimits:
    """Limits of the base: metres and radians, per second and per second squared (TurtleBot)."""

    speed: Annotated[float, number(0.01, 5.0, "m/s", "highest speed")] = 0.65
    turn_rate: Annotated[float, _angle("°/s", "highest turn rate", "turn_rate_degrees", 0.1, 3600.0)] = PI
    acceleration: Annotated[float, number(0.01, unit="m/s²", help="highest acceleration")] = 0.8
    turn_acceleration: Annotated[float, _angle("°/s²", "of turning", "turn_acceleration_degrees", 0.1)] = 5.0
    command_timeout: Annotated[float, number(0.05, unit="s", help="time to a stop without commands")] = 0.5


@dataclass(frozen=True, slots=True)
class NavigationSettings:
    """Whether the robot offers navigation and docking, and its speed in m/s."""

    enabled: Annotated[bool, flag("whether the robot navigates")] = True
    speed: Annotated[float, number(0.05, 5.0, "m/s", "highest speed of navigation")] = 0.4


@dataclass(frozen=True, slots=True)
class CleaningTool:
    """A tool that removes dirt of some kinds (``removes``) within ``reach`` metres of the robot's centre.

    It removes ``rate`` grams per second, the nearest dirt first, as a brush guided by hand or by an arm.
    """

    name: str
    removes: Annotated[tuple[str, ...], Entry("list of texts", "kinds of dirt")]
    rate: Annotated[float, number(0.0, 1e6, "g/s", "dirt removed")] = 5.0
    reach: Annotated[float, number(0.01, 10.0, "m", "from the robot's centre")] = 0.3


@dataclass(frozen=True, slots=True)
class ObjectDescription:
    """A round object on the floor that can be carried; ``color`` is ``#rrggbb``, or "" if unknown."""

    name: Annotated[str, text("unique name")]
    x: Annotated[float, number(-math.inf, math.inf, help="position, in m")]
    y: Annotated[float, number(-math.inf, math.inf, help="position, in m")]
    radius: Annotated[float, number(0.005, 0.5, "m", "of the round object")] = 0.03
    color: Annotated[str, _COLOR] = ""


@dataclass(frozen=True, slots=True)
class RobotDescription:
    """A robot: its name, the namespace of its topics ("" for none), its initial pose and its properties.

    ``footprint`` is the length and width of a rectangular robot; ``radius`` is then that of the circumscribed circle, which
    other robots, lasers and navigation use. ``gripper_reach`` is the reach of the gripper, in metres from the robot's
    centre; 0 without a gripper. ``interface`` has the names of its topics, services and actions.
    """

    name: Annotated[str, text("unique name")] = "turtlebot"
    namespace: Annotated[str, Entry("text", "prefix of its topics, services and actions")] = ""
    pose: Annotated[Pose, Entry("`{x, y, yaw_degrees}`", "initial pose")] = ORIGIN
    radius: Annotated[float, number(0.02, 2.0, "m", "of a round robot")] = 0.17
    limits: Annotated[RobotLimits, section("limits of the base")] = RobotLimits()
    battery: Annotated[BatterySettings, section("charge and discharge")] = BatterySettings()
    odometry: Annotated[OdometrySettings, section("origin and errors of odometry")] = OdometrySettings()
    laser: Annotated[LaserSettings, section("laser range finder")] = LaserSettings()
    navigation: Annotated[NavigationSettings, Entry("mapping or flag", "navigation")] = NavigationSettings()
    tools: Annotated[tuple[CleaningTool, ...], Entry("mapping", "cleaning tools by name")] = ()
    gripper_reach: Annotated[float, Entry("mapping or flag", "gripper", "gripper")] = 0.0
    footprint: Annotated[tuple[float, float] | None, Entry("`[length, width]` m", "of a rectangle")] = None
    interface: Interface = EVERYTHING


@dataclass(frozen=True, slots=True)
class PersonDescription:
    """A person who walks from point to point of a path (metres), with a pause (seconds) at each.

    With ``loop`` the path continues from the last point to the first; otherwise the person stays at the last point. A
    ``careless`` person does not stop in front of robots. ``color`` is ``#rrggbb``, or "" for any.
    """

    name: Annotated[str, text("unique name")]
    path: Annotated[tuple[tuple[float, float], ...], Entry("list of `[x, y]` in m", "points of the walk")]
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
            "name": self.name,
            "radius": self.radius,
            "color": self.color,
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
    rooms: Annotated[tuple[Room, ...], Entry("mapping", "parts of the floor by name")] = ()
    docks: Annotated[tuple[Dock, ...], Entry("list", "charging stations")] = ()
    doors: Annotated[tuple[Door, ...], Entry("list", "open or closed")] = ()
    cliffs: Annotated[tuple[Rectangle, ...], Entry("list", "areas without floor")] = ()
    objects: Annotated[tuple[ObjectDescription, ...], Entry("list", "things to carry")] = ()
    robots: Annotated[tuple[RobotDescription, ...], Entry("list", "at least one")] = (RobotDescription(),)
    people: Annotated[tuple[PersonDescription, ...], Entry("list", "people who walk")] = ()
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
            "furniture": [
                {"kind": each.kind, "color": each.color, "area": list(each.area)} for each in self.furniture
            ],
            "rooms": [room.drawing() for room in self.rooms],
            "docks": [
                {"name": dock.name, "pose": list(dock.pose), "radius": dock.radius} for dock in self.docks
            ],
            "doors": [
                {"name": door.name, "segment": list(door.segment), "open": door.open} for door in self.doors
            ],
            "cliffs": [list(cliff) for cliff in self.cliffs],
            "robots": [
                {
                    "name": robot.name,
                    "pose": list(robot.pose),
                    "radius": robot.radius,
                    **({"footprint": list(robot.footprint)} if robot.footprint is not None else {}),
                }
                for robot in self.robots
            ],
            "objects": [
                {"name": each.name, "place": [each.x, each.y], "radius": each.radius, "color": each.color}
                for each in self.objects
            ],
            "people": [person.drawing() for person in self.people],
        }


__all__ = ["Problem", "UnknownWorld", "WorldError"]


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
