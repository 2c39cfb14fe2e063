"""World files: YAML text to a `WorldDescription`, which declares most of their keys.

Lengths are in metres, times in seconds, levels in percent and angles in degrees (radians internally). All keys except
``robots`` are optional.
"""

import itertools
import re
from collections.abc import Callable, Iterable
from dataclasses import replace
from pathlib import Path
from typing import Any

from jacaros.robots.plane.pose import Pose
from jacaros.robots.plane.shapes import Rectangle, Segment
from jacaros.robots.world.data.robot import RobotDescription
from jacaros.robots.world.data.world import Dock, Door, Furniture, UnknownWorld, WorldDescription, WorldError
from jacaros.robots.world.files.floor import (
    check_people,
    named,
    place_problem,
    read_box,
    read_object,
    read_person,
    read_rectangle,
    read_rooms,
)
from jacaros.robots.world.files.map import (
    OccupancyMap,
    free_place,
    is_map,
    near_file,
    open_document,
    read_map,
)
from jacaros.robots.world.files.robot import read_pose, read_robot
from jacaros.runtime.files.entries import ReadValue, declared_entries, read, values
from jacaros.runtime.files.texts import is_file, suggestion
from jacaros.runtime.files.yaml import Problem, YamlNode, read_document, top_keys

_WORLDS = Path(__file__).parents[1] / "worlds"
_KEYS = ("map", "size", "bounds", "border", "walls", *declared_entries(WorldDescription))
_TELLING = frozenset(_KEYS) - {"name", "seed"}
"""Keys that are rare in other YAML files."""
_DOOR_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*")


def shipped_worlds() -> list[str]:
    """Return the names of the worlds shipped with the package."""
    return sorted(path.stem for path in _WORLDS.glob("*.yaml"))


def find_world(name: str) -> Path:
    """Return the path of a world file, given its path or the name of a shipped world.

    Raises:
        UnknownWorld: there is neither.
    """
    for path in (Path(name), _WORLDS / f"{name}.yaml"):
        if is_file(path):
            return path
    raise UnknownWorld(name, _meant(name))


def _meant(name: str) -> str:
    """Return a "did you mean", or the names of the shipped worlds."""
    try:
        beside = [str(path) for path in Path(name).parent.glob("*.y*ml")]
    except (OSError, ValueError):
        beside = []
    shipped = shipped_worlds()
    listed = f"give the path of a world file, or one of the shipped worlds: {', '.join(shipped)}"
    return suggestion(name, [*shipped, *beside], listed)


def load_world(name: str) -> WorldDescription:
    """Read a world file, given its path or the name of a shipped world.

    Raises:
        WorldError: the file does not exist or has mistakes; the error lists all of them.
    """
    path = find_world(name)
    text, problems, description = _read(path)
    if description is None:
        raise WorldError(str(path), text, problems)
    return description


def is_world(path: Path) -> bool:
    """Return whether a YAML file is a map or a world file (robots or two other keys of a world), even with mistakes."""
    keys = top_keys(path)
    return is_map(path) or ("artifacts" not in keys and ("robots" in keys or len(keys & _TELLING) > 1))


def world_problems(path: Path) -> tuple[str, list[Problem]]:
    """Return the text of a world file, and all its mistakes."""
    text, problems, _ = _read(path)
    return text, problems


def read_world(text: str, name: str = "world") -> WorldDescription:
    """Read the text of a world file; paths in it are relative to the current folder.

    Args:
        text: YAML.
        name: name of the file in errors.

    Raises:
        WorldError: the text has mistakes; the error lists all of them.
    """
    problems: list[Problem] = []
    document = read_document(text, problems, "a world")
    description = None if problems else _world(document, Path())
    if description is None or problems:
        raise WorldError(name, text, problems)
    return description


def _read(path: Path) -> tuple[str, list[Problem], WorldDescription | None]:
    if is_map(path):
        return _read_as_world(path)
    text, problems, document = open_document(path, "a world")
    description = None if document is None else _world(document, path.parent)
    return text, problems, None if problems else description


def _read_as_world(path: Path) -> tuple[str, list[Problem], WorldDescription | None]:
    """Return a world with the walls of a map, and a TurtleBot at the free place nearest to (0, 0)."""
    text, problems, found = read_map(path)
    place = free_place(found, problems)
    if found is None or place is None:
        return text, problems, None
    robot = RobotDescription(pose=Pose(*place, 0.0))
    walls, boxes = tuple(found.walls()), tuple(found.boxes())
    return text, [], WorldDescription(path.stem, found.bounds, walls, boxes, robots=(robot,))


def _world(document: YamlNode, folder: Path) -> WorldDescription:
    entries = document.mapping(*_KEYS, required=("robots",))
    found = _map(entries["map"], folder) if "map" in entries else None
    bounds = (
        found.bounds if found is not None and not entries.keys() & {"size", "bounds"} else _bounds(entries)
    )
    segments: list[Segment] = []
    boxes: list[Furniture] = []
    if found is not None:
        segments.extend(found.walls())
        boxes.extend(map(Furniture, found.boxes()))
    if "border" in entries and entries["border"].choice("open", "walls") == "walls":
        segments.extend(bounds.edges())
    if "walls" in entries:
        for wall in entries["walls"].sequence():
            _wall(wall, segments, boxes)
    usual = WorldDescription("world", robots=())
    world = replace(
        usual,
        bounds=bounds,
        segments=tuple(segments),
        boxes=tuple(box.area for box in boxes),
        furniture=tuple(box for box in boxes if box.kind or box.color),
        **values(
            entries,
            usual,
            rooms=read_rooms,
            docks=_docks,
            doors=named("door", _door),
            cliffs=_each(read_rectangle),
            objects=named("object", read_object),
            robots=_robots,
            people=_each(read_person),
        ),
    )
    if not document.problems:  # otherwise places may be placeholders
        walled = "border" in entries and entries["border"].value == "walls"
        _check_places(entries["robots"].sequence(), world)
        if "people" in entries:
            check_people(entries["people"].sequence(), world, walled)
    return world


def _check_places(items: Iterable[YamlNode], world: WorldDescription) -> None:
    """Report robots that are outside the world, in furniture, over a cliff, or in a wall or a closed door."""
    solid = (*world.segments, *(door.segment for door in world.doors if not door.open))
    for item, robot in zip(items, world.robots, strict=True):
        x, y, _ = robot.pose
        problem, help = place_problem(robot, robot.pose, world, solid)
        if not problem and any(cliff.contains(x, y) for cliff in world.cliffs):
            problem = "over a cliff"
        if problem:
            item.wrong(
                f"the robot '{robot.name}' is at [{x:g}, {y:g}], {problem}",
                help or "write another place under 'pose'",
            )


def _map(node: YamlNode, folder: Path) -> OccupancyMap | None:
    name = node.text()
    if not name:
        return None
    path = folder / name
    if not is_file(path):
        node.wrong(
            f"map not found: `{path}`", near_file(path, "*.y*ml") or "its path is relative to the world file"
        )
        return None
    _, problems, found = read_map(path)
    for each in problems:
        node.wrong(f"{path}:{each.line}:{each.column}: {each.message}", each.help)
    return found


def _bounds(entries: dict[str, YamlNode]) -> Rectangle:
    if "bounds" in entries:
        if "size" in entries:
            entries["size"].wrong("'size' and 'bounds' are alternatives", "remove one of them")
        return read_rectangle(entries["bounds"])
    if "size" not in entries:
        return Rectangle(-3.0, -3.0, 3.0, 3.0)
    width, height = entries["size"].pair()
    if width <= 0 or height <= 0:
        entries["size"].wrong("a size must be positive", "write [width, height], in metres")
    return Rectangle(-width / 2, -height / 2, width / 2, height / 2)


def _wall(node: YamlNode, segments: list[Segment], boxes: list[Furniture]) -> None:
    entries = node.mapping("segment", "polyline", "box", "closed")
    kinds = [kind for kind in ("segment", "polyline", "box") if kind in entries]
    if len(kinds) != 1:
        node.wrong(
            f"{node.what} must be one segment, polyline or box", "for example 'segment: [[0, 0], [1, 0]]'"
        )
        return
    shape = entries[kinds[0]]
    if kinds[0] == "box":
        box = read_box(shape)
        boxes.append(box)
        segments.extend(box.area.edges())
        return
    closed = "closed" in entries and entries["closed"].truth()
    _straight(shape, segments, kinds[0] == "polyline", closed)


def _straight(shape: YamlNode, segments: list[Segment], several: bool = False, closed: bool = False) -> None:
    """Read the points of a segment, or of *several* connected segments, and add them to *segments*."""
    mistakes = len(shape.problems)
    points = [point.pair() for point in shape.sequence()]
    if len(shape.problems) > mistakes:
        return
    if len(points) < 2 or (not several and len(points) > 2):
        shape.wrong(
            f"{shape.what} has {len(points)} points", "a segment has two points, a polyline two or more"
        )
        return
    if closed:
        points.append(points[0])
    for (ax, ay), (bx, by) in itertools.pairwise(points):
        if (ax, ay) == (bx, by):
            shape.wrong(f"{shape.what} has the point [{ax:g}, {ay:g}] twice in a row", "remove one of them")
        else:
            segments.append(Segment(ax, ay, bx, by))


def _each(item: Callable[[YamlNode], Any]) -> ReadValue:
    return lambda node, _: tuple(map(item, node.sequence()))


def _docks(node: YamlNode, _: object) -> tuple[Dock, ...]:
    docks = []
    for index, item in enumerate(node.sequence()):
        entries = item.mapping("name", "x", "y", "yaw_degrees", "radius", required=("x", "y"))
        usual = Dock(f"dock{index + 1}" if index else "dock", read_pose(entries))
        docks.append(replace(usual, **values(entries, usual)))
    return tuple(docks)


def _door(node: YamlNode) -> Door:
    return read(node, Door("", Segment(0.0, 0.0, 1.0, 0.0)), name=_door_name, segment=_segment)


def _door_name(node: YamlNode, _: object) -> str:
    name = node.text()
    if not _DOOR_NAME.fullmatch(name):
        node.wrong(f"'{name}' cannot be part of a ROS name", "use letters, digits and _ for a door's name")
    return name


def _segment(node: YamlNode, usual: Segment) -> Segment:
    pieces: list[Segment] = []
    _straight(node, pieces)
    return pieces[0] if pieces else usual


def _robots(node: YamlNode, _: object) -> tuple[RobotDescription, ...]:
    """Read all robots; report those with the same name or the same topics, and a world without robots."""
    seen: dict[tuple[str, str], int] = {}
    items = list(node.sequence())
    if not items and isinstance(node.value, list):
        node.wrong("a world needs a robot", "add '- name: turtlebot' under 'robots'")
    for item in items:
        if not isinstance(item.value, dict):
            continue
        name = str(item.value.get("name", "turtlebot"))
        for key, value in (("name", name), ("namespace", str(item.value.get("namespace", "")).strip("/"))):
            if (key, value) in seen:
                first = seen[key, value]
                item.wrong(
                    f"the robot of line {first} has the same {key} '{value}'", f"give it another {key}"
                )
            seen.setdefault((key, value), item.line)
    return tuple(map(read_robot, items))
