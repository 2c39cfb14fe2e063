"""Fault files: YAML text to `Fault` objects, which declare their entries, checked against their world."""

import re
from dataclasses import replace
from pathlib import Path

from jacaros.files.entries import values
from jacaros.files.yaml import Node, Problem, read_document, read_text, top_keys
from jacaros.plane.pose import Pose
from jacaros.sim.data.faults import ACTIONS, AT_ONCE, KEYS, MESSAGES, WHEELS, Fault
from jacaros.sim.data.world import PersonDescription, WorldDescription, WorldError
from jacaros.sim.files.floor import place_problem, read_path
from jacaros.sim.files.robot import read_pose

_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
_COMMON = ("kind", "at", "for", "robot")


def read_faults(source: str | Path, world: WorldDescription) -> tuple[Fault, ...]:
    """Read a fault file, or the text of one.

    Raises:
        WorldError: the file does not exist, has mistakes, or does not match the *world*; the text lists all mistakes.
    """
    if isinstance(source, str) and "\n" in source:
        name, text, (problems, faults) = "faults", source, _faults(source, world)
    else:
        name = str(source)
        text, problems, faults = _read(Path(source), world)
    if problems:
        raise WorldError(name, text, problems)
    return faults


def is_fault_file(path: Path) -> bool:
    """Return whether a YAML file is a fault file: it has the key ``faults``, and none of a world."""
    keys = top_keys(path)
    return "faults" in keys and "robots" not in keys and "artifacts" not in keys


def fault_file_problems(path: Path) -> tuple[str, list[Problem]]:
    """Return the text of a fault file, and all mistakes that do not depend on a world."""
    text, problems, _ = _read(path, None)
    return text, problems


def _read(path: Path, world: WorldDescription | None) -> tuple[str, list[Problem], tuple[Fault, ...]]:
    try:
        text, wrong = read_text(path)
    except OSError as error:
        help = "give the path of a file that begins with `faults:`"
        return "", [Problem(1, 1, f"cannot read the file: {error.strerror}", help)], ()
    return (text, [wrong], ()) if wrong is not None else (text, *_faults(text, world))


def _faults(text: str, world: WorldDescription | None) -> tuple[list[Problem], tuple[Fault, ...]]:
    problems: list[Problem] = []
    document = read_document(text, problems, "a fault file")
    found: list[Fault] = []
    if not problems:
        entries = document.mapping("faults", required=("faults",))
        if "faults" in entries:
            found = [_fault(key, item, world) for key, item in entries["faults"].entries()]
    return problems, tuple(found)


def _fault(key: Node, node: Node, world: WorldDescription | None) -> Fault:
    name = key.text()
    if not _NAME.fullmatch(name):
        key.wrong(f"invalid fault name '{name}'", "begin with a letter, and use letters, digits and _ only")
    kinds = node.value.get("kind") if isinstance(node.value, dict) else None
    keys = KEYS.get(kinds, ()) if isinstance(kinds, str) else ()
    every = tuple(dict.fromkeys(key for keys in KEYS.values() for key in keys))
    entries = node.mapping(*_COMMON, *(keys or every), required=("kind",))
    if "kind" not in entries:
        return Fault(name, "dead")
    kind = entries["kind"].choice(*KEYS)
    usual = Fault(name, kind, share=0.3 if kind == "wheel_slip" else 1.0)
    fault = replace(usual, **values(entries, usual))
    if kind in AT_ONCE and "for" in entries:
        entries["for"].wrong(f"'{kind}' has no duration", "remove 'for'")
    return _placed(fault, node, entries, world)


def _placed(fault: Fault, node: Node, entries: dict[str, Node], world: WorldDescription | None) -> Fault:
    """Complete a fault with its robot, topic or place."""
    if fault.kind in (*WHEELS, *AT_ONCE, *MESSAGES, *ACTIONS):
        fault = replace(fault, robot=_robot(node, entries.get("robot"), fault.kind, world))
    elif "robot" in entries:
        entries["robot"].wrong(f"'{fault.kind}' does not concern a robot", "remove 'robot'")
    if fault.kind in MESSAGES:
        return replace(fault, topic=_name(node, entries.get("topic"), "topic", fault.robot, world))
    if fault.kind in ACTIONS:
        return replace(fault, action=_name(node, entries.get("action"), "action", fault.robot, world))
    docks = None if world is None else [dock.name for dock in world.docks]
    doors = None if world is None else [door.name for door in world.doors]
    if fault.kind in ("closed_door", "stuck_door"):
        return replace(fault, place=_one_of(node, entries, "door", doors))
    if fault.kind == "dead_dock":
        return replace(fault, place=_one_of(node, entries, "dock", docks))
    if fault.kind == "person":
        return replace(fault, person=_person(fault.name, node, entries))
    if fault.kind in AT_ONCE and "to" not in entries:
        node.wrong(f"{node.what} lacks the key 'to'", _TO[fault.kind])
    elif fault.kind == "battery_drop":
        return replace(fault, level=entries["to"].number(0.0, 100.0))
    elif fault.kind == "kidnapped_robot":
        return replace(fault, pose=_landing(entries["to"], fault.robot, world))
    return fault


def _landing(node: Node, name: str, world: WorldDescription | None) -> Pose:
    """Read where a robot is put down; closed doors are ignored, because they may be open by then."""
    mistakes = len(node.problems)
    pose = read_pose(node.mapping("x", "y", "yaw_degrees"))
    robots = () if world is None or len(node.problems) > mistakes else world.robots
    for robot in robots:
        if world is not None and robot.name == name:
            problem, help = place_problem(robot, pose, world, world.segments)
            if problem:
                where = f"it puts the robot '{name}' at [{pose.x:g}, {pose.y:g}], {problem}"
                node.wrong(where, help or "write another place under 'to'")
    return pose


_TO = {
    "battery_drop": "add the remaining percent: to: 15",
    "kidnapped_robot": "add the new place: to: {x: 1, y: 2, yaw_degrees: 90}",
}


_NAMES = {
    "topic": "add a topic of the world, such as 'topic: /scan'",
    "action": "add an action of the world, such as 'action: /navigate_to_pose'",
}


def _robot(node: Node, given: Node | None, kind: str, world: WorldDescription | None) -> str:
    if world is None:
        return ""
    names = [robot.name for robot in world.robots]
    if given is None:
        if len(names) > 1 and kind not in (*MESSAGES, *ACTIONS):
            node.wrong(f"{node.what} lacks the key 'robot'", f"add a robot of the world: 'robot: {names[0]}'")
        return names[0] if len(names) == 1 else ""
    name = given.text()
    if name not in names:
        given.wrong(f"unknown robot '{name}'", f"robots of the world: {', '.join(names) or 'none'}")
    return name


def _name(node: Node, given: Node | None, key: str, robot: str, world: WorldDescription | None) -> str:
    """Return the absolute name of a topic or an action; relative ones are in the robot's namespace."""
    if given is None:
        node.wrong(f"{node.what} lacks the key '{key}'", _NAMES[key])
        return ""
    written = given.text()
    if written.startswith("/"):
        return written
    robots = () if world is None else world.robots
    namespace = next((each.namespace for each in robots if each.name == robot), "")
    return f"/{namespace}/{written}" if namespace else f"/{written}"


def _one_of(node: Node, entries: dict[str, Node], what: str, names: list[str] | None) -> str:
    if what not in entries:
        node.wrong(f"{node.what} lacks the key '{what}'", f"add '{what}: NAME'")
        return ""
    name = entries[what].text()
    if names is not None and name not in names:
        known = f"{what}s of the world: {', '.join(names) or 'none'}"
        entries[what].wrong(f"unknown {what} '{name}'", known)
    return name


def _person(name: str, node: Node, entries: dict[str, Node]) -> PersonDescription:
    if "path" not in entries:
        node.wrong(f"{node.what} lacks the key 'path'", "add 'path: [[1, 0]]', in metres")
    usual = PersonDescription(name, ((0.0, 0.0),))
    return replace(usual, **values(entries, usual, path=read_path))
