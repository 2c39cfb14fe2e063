"""Fault files: YAML text to `Fault` objects, which declare their entries, checked against their world."""

import re
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from jacaros.robots.plane.pose import Pose
from jacaros.robots.world.data.faults import KINDS, Fault, FaultKind
from jacaros.robots.world.data.robot import RobotDescription, absolute
from jacaros.robots.world.data.world import PersonDescription, WorldDescription, WorldError
from jacaros.robots.world.files.floor import place_problem, read_path
from jacaros.robots.world.files.map import open_document
from jacaros.robots.world.files.robot import read_pose
from jacaros.runtime.files.entries import ReadValue, values
from jacaros.runtime.files.yaml import Problem, YamlNode, read_document, top_keys

_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
_REQUIRED = {
    "topic": "add a topic of the world, such as 'topic: /scan'",
    "action": "add an action of the world, such as 'action: /navigate_to_pose'",
    "door": "add 'door: NAME'",
    "dock": "add 'dock: NAME'",
    "path": "add 'path: [[1, 0]]', in metres",
    "to": "add the remaining percent, 'to: 15', or a place, 'to: {x: 1, y: 2, yaw_degrees: 90}'",
}
"""Keys without a default, and how to add them."""
_SHARES = {"wheel_slip": 0.3, "dirty_contact": 0.5}
"""Defaults of ``share`` other than 1."""


def read_faults(source: str | Path, world: WorldDescription) -> tuple[Fault, ...]:
    """Read a fault file, or the text of one.

    Raises:
        WorldError: the file does not exist, has mistakes, or does not match the *world*; the text lists all mistakes.
    """
    document: YamlNode | None
    text, problems = str(source), list[Problem]()
    if isinstance(source, str) and "\n" in source:
        name, document = "faults", read_document(text, problems, "a fault file")
    else:
        name = text
        text, problems, document = _open(Path(source))
    faults = _faults(document, world)
    if problems:
        raise WorldError(name, text, problems)
    return faults


def is_fault_file(path: Path) -> bool:
    """Return whether a YAML file is a fault file: it has the key ``faults``, and none of a world."""
    keys = top_keys(path)
    return "faults" in keys and "robots" not in keys and "artifacts" not in keys


def fault_file_problems(path: Path) -> tuple[str, list[Problem]]:
    """Return the text of a fault file, and all mistakes that do not depend on a world."""
    text, problems, document = _open(path)
    _faults(document, None)
    return text, problems


def _open(path: Path) -> tuple[str, list[Problem], YamlNode | None]:
    return open_document(path, "a fault file", "give the path of a file that begins with `faults:`")


def _faults(document: YamlNode | None, world: WorldDescription | None) -> tuple[Fault, ...]:
    entries = document.mapping("faults", required=("faults",)) if document is not None else {}
    given = entries["faults"].entries() if "faults" in entries else ()
    return tuple(_fault(key, item, world) for key, item in given)


def _fault(key: YamlNode, node: YamlNode, world: WorldDescription | None) -> Fault:
    name = key.text()
    if not _NAME.fullmatch(name):
        key.wrong(f"invalid fault name '{name}'", "begin with a letter, and use letters, digits and _ only")
    word = node.value.get("kind") if isinstance(node.value, dict) else None
    every = tuple(dict.fromkeys(key for kind in KINDS.values() for key in kind.keys))
    kind = KINDS.get(word) if isinstance(word, str) else None
    entries = node.mapping(
        "kind", "at", "after", "for", "robot", *(kind.keys if kind else every), required=("kind",)
    )
    if kind is None:
        if "kind" in entries:
            entries["kind"].choice(*KINDS)
        return Fault(name, "dead")
    for key_name in kind.keys:
        if key_name in _REQUIRED and key_name not in entries and "by" not in entries:
            other = ", or a distance, 'by: 1.5'" if "by" in kind.keys else ""
            node.wrong(f"{node.what} lacks the key '{key_name}'", _REQUIRED[key_name] + other)
    if not kind.lasts and "for" in entries:
        entries["for"].wrong(f"'{word}' has no duration", "remove 'for'")
    _check_one_of(entries, "at", "after")
    _check_one_of(entries, "to", "by")
    whose = _robot(node, entries, str(word), kind, world)
    usual = Fault(
        name,
        str(word),
        robot=whose if kind.robot else "",
        share=_SHARES.get(str(word), 1.0),
    )
    robot = next((each for each in (world.robots if world else ()) if each.name == usual.robot), None)
    prefix = f"/{robot.namespace}" if robot and robot.namespace else ""
    fault = replace(
        usual,
        **values(
            entries,
            usual,
            topic=lambda node, _: absolute(node.text(), prefix),
            action=lambda node, _: absolute(node.text(), prefix),
            door=_one_of("door", world and world.doors),
            dock=_one_of("dock", world and world.docks),
        ),
    )
    if "after" in entries:
        _check_progress(entries["after"])
        fault = replace(fault, after=replace(fault.after, robot=whose))
    if word == "missed_grasp" and robot and not robot.gripper_reach:
        node.wrong(
            f"the robot '{robot.name}' has no gripper", "add 'gripper: true' to it, or remove the fault"
        )
    if word in ("person", "person_in_the_way"):
        person = PersonDescription(name, ((0.0, 0.0),))
        return replace(fault, person=replace(person, **values(entries, person, path=read_path)))
    if word == "battery_drop" and "to" in entries:
        return replace(fault, level=entries["to"].number(0.0, 100.0))
    if "to" in entries:
        put_down = robot if word == "kidnapped_robot" else None
        return replace(fault, pose=_place(entries["to"], put_down, world))
    return fault


def _check_one_of(entries: Mapping[str, YamlNode], one: str, other: str) -> None:
    if one in entries and other in entries:
        entries[other].wrong(f"'{one}' and '{other}' exclude each other", f"remove '{one}' or '{other}'")


def _check_progress(node: YamlNode) -> None:
    keys = node.value if isinstance(node.value, dict) else {"": None}
    if len(keys) != 1:
        help = "write one of 'metres', 'battery' and 'tasks'"
        node.wrong(f"'after' has {len(keys)} keys, but must have one", help)


def _robot(
    node: YamlNode,
    entries: Mapping[str, YamlNode],
    word: str,
    kind: FaultKind,
    world: WorldDescription | None,
) -> str:
    """Read the affected robot, or the one whose progress counts; by default, the only one."""
    given, counts = entries.get("robot"), "after" in entries
    if not kind.robot and not counts:
        if given is not None:
            given.wrong(f"'{word}' does not concern a robot", "remove 'robot', or add 'after'")
        return ""
    if world is None:
        return ""
    names = [robot.name for robot in world.robots]
    if given is None:
        if len(names) > 1 and (counts or not {"topic", "action"} & set(kind.keys)):
            node.wrong(f"{node.what} lacks the key 'robot'", f"add a robot of the world: 'robot: {names[0]}'")
        return names[0] if len(names) == 1 else ""
    name = given.text()
    if name not in names:
        given.wrong(f"unknown robot '{name}'", f"robots of the world: {', '.join(names) or 'none'}")
    return name


def _one_of(what: str, things: Any) -> ReadValue:
    """Read the name of one of the *things* of a world; None for any name."""

    def read(node: YamlNode, _: object) -> str:
        name = node.text()
        names = None if things is None else [each.name for each in things]
        if names == []:
            node.wrong(f"the world has no {what}", f"add '{what}s:' to the world, or remove the fault")
        elif names is not None and name not in names:
            node.wrong(f"unknown {what} '{name}'", f"{what}s of the world: {', '.join(names)}")
        return name

    return read


def _place(node: YamlNode, robot: RobotDescription | None, world: WorldDescription | None) -> Pose:
    """Read a pose in the world; one where a *robot* is put down must have room for it.

    Closed doors are ignored, because they may be open by then.
    """
    mistakes = len(node.problems)
    pose = read_pose(node.mapping("x", "y", "yaw_degrees"))
    if world is None or len(node.problems) > mistakes:
        return pose
    problem, help, whom = "outside the world", "", "it is about"
    if robot is not None:
        problem, help = place_problem(robot, pose, world, world.segments)
        whom = f"it puts the robot '{robot.name}' at"
    elif world.bounds.contains(pose.x, pose.y):
        return pose
    if problem:
        node.wrong(f"{whom} [{pose.x:g}, {pose.y:g}], {problem}", help or "write another place under 'to'")
    return pose
