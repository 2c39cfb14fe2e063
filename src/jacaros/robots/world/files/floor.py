"""What is on the floor in a world file: rooms with their dirt, boxes, objects and people, and whether a robot fits.

Lengths are metres, dirt is in grams::

    kitchen: {from: [1, 1], to: [3, 3]}
    office:
      from: [3, 1]
      to: [9, 3]
      dirt:
        dust: 40                                              # on the whole floor except below furniture
        stains: {grams: 5, from: [4, 1], to: [5, 2]}          # only in this area
"""

import itertools
import math
import re
from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import Any

from jacaros.robots.plane.pose import Pose
from jacaros.robots.plane.shapes import Rectangle, Segment
from jacaros.robots.world.data.robot import RobotDescription
from jacaros.robots.world.data.world import (
    Dirt,
    Furniture,
    ObjectDescription,
    PersonDescription,
    Room,
    WorldDescription,
)
from jacaros.runtime.files.entries import ReadValue, read, values
from jacaros.runtime.files.yaml import YamlNode

LARGEST = 10_000.0
"""Largest area of one field of dirt, in square metres: a million cells of 10 cm."""
_MOST = 1e9


def read_rooms(node: YamlNode, _: object) -> tuple[Room, ...]:
    """Read all rooms, in the order of the file."""
    return tuple(_room(name, room) for name, room in node.mapping().items())


def _room(name: str, node: YamlNode) -> Room:
    entries = node.mapping("from", "to", "dirt", required=("from", "to"))
    area = corners_of(node, entries)
    if "dirt" not in entries:
        return Room(name, area)
    return Room(name, area, tuple(_dirt(kind, dirt, area) for kind, dirt in entries["dirt"].entries()))


def _dirt(kind: YamlNode, node: YamlNode, room: Rectangle) -> Dirt:
    if isinstance(node.value, dict):
        entries = node.mapping("grams", "from", "to", required=("grams", "from", "to"))
        grams = entries["grams"].number(0.0, _MOST) if "grams" in entries else 0.0
        area: Rectangle | None = corners_of(node, entries)
    else:
        grams, area = node.number(0.0, _MOST), None
    x_min, y_min, x_max, y_max = area or room
    if (x_max - x_min) * (y_max - y_min) > LARGEST:
        node.wrong(
            f"{node.what} covers more than {LARGEST:g} square metres",
            "give it a smaller area with 'from' and 'to'",
        )
    return Dirt(kind.text(), grams, area)


def read_rectangle(node: YamlNode) -> Rectangle:
    """Read the opposite corners ``from`` and ``to``, in metres."""
    return corners_of(node, node.mapping("from", "to", required=("from", "to")))


def corners_of(node: YamlNode, entries: dict[str, YamlNode]) -> Rectangle:
    """Return the rectangle between the opposite corners ``from`` and ``to`` among the *entries* of a node."""
    if not {"from", "to"} <= entries.keys():
        return Rectangle(0.0, 0.0, 1.0, 1.0)
    ax, ay = entries["from"].pair()
    bx, by = entries["to"].pair()
    if ax == bx or ay == by:
        node.wrong(f"{node.what} has no area", "'from' and 'to' are opposite corners")
    return Rectangle(min(ax, bx), min(ay, by), max(ax, bx), max(ay, by))


COLORS = {
    "black": "#202020",
    "blue": "#2f6fb5",
    "brown": "#8b5a2b",
    "gray": "#8c8c8c",
    "green": "#3f8f4f",
    "orange": "#e08a2c",
    "pink": "#e48fb0",
    "purple": "#7a4fa3",
    "red": "#c0392b",
    "white": "#f4f4f4",
    "yellow": "#f2c14e",
}
"""Colour names as ``#rrggbb``."""
_RGB = re.compile(r"#[0-9a-f]{6}")


def read_box(node: YamlNode) -> Furniture:
    """Read a box; its colour becomes ``#rrggbb``."""
    entries = node.mapping("from", "to", "kind", "color", required=("from", "to"))
    box = Furniture(corners_of(node, entries))
    return replace(box, **values(entries, box, color=read_color))


def read_color(node: YamlNode, _: object) -> str:
    """Read a colour, a name or ``#rrggbb``; return it as ``#rrggbb``."""
    text = node.text().lower()
    if text in COLORS or not text:
        return COLORS.get(text, "")
    if not _RGB.fullmatch(text):
        node.wrong(f"'{node.value}' is not a colour", f'write "#rrggbb" or one of: {", ".join(COLORS)}')
    return text


def read_object(node: YamlNode) -> ObjectDescription:
    """Read one object that grippers can carry."""
    return read(node, ObjectDescription("", 0.0, 0.0), color=read_color)


def named(what: str, read_one: Callable[[YamlNode], Any]) -> ReadValue:
    """Return the reader of a list of things, in the order of the file, whose names must differ."""

    def read_all(node: YamlNode, _: object) -> tuple[Any, ...]:
        found: list[Any] = []
        for item in node.sequence():
            each = read_one(item)
            if any(other.name == each.name for other in found):
                item.wrong(f"duplicate {what} '{each.name}'", "give it another name")
            found.append(each)
        return tuple(found)

    return read_all


_TOUCHING = 0.001


def read_person(node: YamlNode) -> PersonDescription:
    """Read one person."""
    return read(node, PersonDescription("", ((0.0, 0.0),)), path=read_path, color=read_color)


def read_path(node: YamlNode, _: object) -> tuple[tuple[float, float], ...]:
    points = tuple(point.pair() for point in node.sequence())
    if not points:
        node.wrong(f"{node.what} has no points", "write [[x, y], ...], in metres")
        return ((0.0, 0.0),)
    for before, after in itertools.pairwise(points):
        if before == after:
            node.wrong(
                f"{node.what} has the point [{after[0]:g}, {after[1]:g}] twice in a row",
                "remove one of them",
            )
    return points


def check_people(items: Iterable[YamlNode], world: WorldDescription, walled: bool) -> None:
    """Report duplicate names of people and robots, and paths that touch a wall or a robot's initial pose.

    Closed doors are allowed: people wait in front of them.
    """
    names = {robot.name for robot in world.robots}
    for item, person in zip(items, world.people, strict=True):
        if person.name in names:
            item.wrong(f"duplicate name '{person.name}'", "give each person and robot a different name")
        names.add(person.name)
        _check_path(item, person, world, walled)


def _check_path(item: YamlNode, person: PersonDescription, world: WorldDescription, walled: bool) -> None:
    x, y = person.path[0]
    for robot in world.robots:
        dx, dy, reach = robot.pose.x - x, robot.pose.y - y, robot.radius + person.radius
        if dx * dx + dy * dy < reach * reach:
            item.wrong(
                f"'{person.name}' starts at the place of the robot '{robot.name}'",
                "start the path at another point",
            )
    for ax, ay, bx, by in person.legs():
        where = f"the path of '{person.name}' from [{ax:g}, {ay:g}] to [{bx:g}, {by:g}]"
        if walled and not (world.bounds.contains(ax, ay) and world.bounds.contains(bx, by)):
            item.wrong(f"{where} leaves the world", "keep the path inside the walls of the border")
        elif any(
            Segment(ax, ay, bx, by).gap(wall) < person.radius - _TOUCHING for wall in world.segments
        ) or any(box.contains(ax, ay) for box in world.boxes):
            item.wrong(
                f"{where} passes a wall at less than the radius of {person.radius:g} m",
                "lead the path around it",
            )


_TOUCHING = 0.001
"""Metres that a robot may overlap a wall: the error of a rounded coordinate."""


def place_problem(
    robot: RobotDescription, pose: Pose, world: WorldDescription, solid: Iterable[Segment]
) -> tuple[str, str]:
    """Return what is wrong with putting a *robot* at *pose*, and a help; both are empty if it fits.

    Args:
        robot: its radius is used, not its own pose.
        pose: place, in metres and radians.
        world: its boxes, and its bounds if it has border walls.
        solid: walls to consider.
    """
    x, y, _ = pose
    walls = tuple(solid)
    if _has_border(world) and not world.bounds.contains(x, y):
        left, bottom, right, top = world.bounds
        return "outside the world", f"the world is from [{left:g}, {bottom:g}] to [{right:g}, {top:g}]"
    if any(box.contains(x, y) for box in world.boxes):
        return "inside a box", ""
    near = min((wall.distance(x, y) for wall in walls), default=math.inf)
    if near < robot.radius - _TOUCHING:
        return f"in a wall: {near:.2f} m from it, with a radius of {robot.radius:g} m", ""
    return "", ""


def _has_border(world: WorldDescription) -> bool:
    return set(world.bounds.edges()) <= set(world.segments)
