"""The ``people`` of a world file::

people:
  - name: ann
    path: [[0, 0], [2, 0], [2, 2]]    # points; ann starts at the first one
    speed: 1                          # m/s
    pause: 0                          # seconds at each point
    loop: true                        # continues from the last point to the first; false: stops at the last
    radius: 0.25
    careless: false                   # true: does not stop in front of robots
    color: red
"""

import itertools

from jacaros.files.yaml import Node
from jacaros.sim.description import PersonDescription, Segment, WorldDescription
from jacaros.sim.files.box import read_color

_TOUCHING = 0.001


def read_person(node: Node) -> PersonDescription:
    """Read one person."""
    entries = node.mapping(
        "name", "path", "speed", "pause", "loop", "radius", "careless", "color", required=("name", "path")
    )
    usual = PersonDescription("", ((0.0, 0.0),))
    return PersonDescription(
        name=entries["name"].text() if "name" in entries else "",
        path=read_path(entries["path"]) if "path" in entries else usual.path,
        speed=entries["speed"].number(0.01, 5.0, usual.speed) if "speed" in entries else usual.speed,
        pause=entries["pause"].number(0.0, 1e6) if "pause" in entries else usual.pause,
        loop="loop" in entries and entries["loop"].truth(),
        radius=entries["radius"].number(0.05, 2.0, usual.radius) if "radius" in entries else usual.radius,
        careless="careless" in entries and entries["careless"].truth(),
        color=read_color(entries["color"]) if "color" in entries else "",
    )


def read_path(node: Node) -> tuple[tuple[float, float], ...]:
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


def check_people(items: list[Node], world: WorldDescription, walled: bool) -> None:
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
