"""The ``people`` of a world file; `PersonDescription` declares their entries."""

import itertools
from collections.abc import Iterable

from jacaros.files.entries import read
from jacaros.files.yaml import Node
from jacaros.sim.description import PersonDescription, Segment, WorldDescription
from jacaros.sim.files.objects import read_color

_TOUCHING = 0.001


def read_person(node: Node) -> PersonDescription:
    """Read one person."""
    return read(node, PersonDescription("", ((0.0, 0.0),)), path=read_path, color=read_color)


def read_path(node: Node, _: object) -> tuple[tuple[float, float], ...]:
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


def check_people(items: Iterable[Node], world: WorldDescription, walled: bool) -> None:
    """Report duplicate names of people and robots, and paths that touch a wall or a robot's initial pose.

    Closed doors are allowed: people wait in front of them.
    """
    names = {robot.name for robot in world.robots}
    for item, person in zip(items, world.people, strict=True):
        if person.name in names:
            item.wrong(f"duplicate name '{person.name}'", "give each person and robot a different name")
        names.add(person.name)
        _check_path(item, person, world, walled)


def _check_path(item: Node, person: PersonDescription, world: WorldDescription, walled: bool) -> None:
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
