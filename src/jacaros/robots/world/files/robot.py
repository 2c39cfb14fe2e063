"""The ``robots`` part of a world file: one mapping to a `RobotDescription`, which declares its entries.

Among its ``topics``, ``services`` and ``actions``, a name of the simulator with another name renames it, or adds it to a
robot whose kind lacks it::

    topics:
      scan: front/scan                                        # below the namespace; /front/scan: not
    actions:
      navigate_to_pose: go_to
"""

import re
from collections.abc import Mapping
from dataclasses import replace

from jacaros.robots.plane.pose import Pose
from jacaros.robots.plane.trigonometry import radians
from jacaros.robots.world.data.robot import (
    ACTIONS,
    KINDS,
    SERVICES,
    TOPICS,
    USUAL,
    CleaningTool,
    NavigationSettings,
    RobotDescription,
    RobotInterface,
)
from jacaros.runtime.files.entries import declared_entries, read, values
from jacaros.runtime.files.texts import suggestion
from jacaros.runtime.files.yaml import YamlNode

_NAMESPACE = re.compile(r"/?[A-Za-z][A-Za-z0-9_]*(/[A-Za-z][A-Za-z0-9_]*)*")

_REACH = 0.35
"""Default reach of a gripper, in metres."""


def read_robot(node: YamlNode) -> RobotDescription:
    """Read one robot; the defaults are those of its kind, at the origin."""
    given = node.mapping("kind", *declared_entries(RobotDescription), *SECTIONS)
    usual = KINDS[given["kind"].choice(*KINDS)] if "kind" in given else KINDS[USUAL]
    described = values(
        given,
        usual,
        namespace=_namespace,
        pose=_pose,
        navigation=_navigation,
        gripper_reach=_gripper_reach,
        tools=_tools,
    )
    return replace(usual, interface=read_interface(given, usual.interface), **described)


def read_pose(entries: dict[str, YamlNode]) -> Pose:
    """Read a pose from the keys ``x``, ``y`` (metres) and ``yaw_degrees``, each 0 by default."""

    def value(key: str) -> float:
        return entries[key].number() if key in entries else 0.0

    return Pose(value("x"), value("y"), radians(value("yaw_degrees")))


def _pose(node: YamlNode, _: object) -> Pose:
    return read_pose(node.mapping("x", "y", "yaw_degrees"))


def _namespace(node: YamlNode, _: object) -> str:
    text = node.text()
    if text and not _NAMESPACE.fullmatch(text):
        node.wrong(
            f"'{text}' is not a ROS namespace", "use letters, digits and _, with / between parts: robot_1"
        )
    return text.strip("/")


def _gripper_reach(node: YamlNode, _: object) -> float:
    if isinstance(node.value, dict):
        given = node.mapping("reach")
        return given["reach"].number(0.05, 5.0, _REACH) if "reach" in given else _REACH
    return _REACH if node.truth() else 0.0


def _navigation(node: YamlNode, usual: NavigationSettings) -> NavigationSettings:
    if isinstance(node.value, dict):
        return read(node, usual)
    return replace(usual, enabled=node.truth())


def _tools(node: YamlNode, _: object) -> tuple[CleaningTool, ...]:
    return tuple(read(tool, CleaningTool(name.text(), ()), removes=_removes) for name, tool in node.entries())


def _removes(node: YamlNode, _: object) -> tuple[str, ...]:
    if not node.value:
        node.wrong("a tool removes at least one kind of dirt", "write the kinds: [dust, crumbs]")
    return tuple(kind.text() for kind in node.sequence())


SECTIONS = ("topics", "services", "actions")
_KNOWN: Mapping[str, tuple[str, ...]] = {"topics": TOPICS, "services": SERVICES, "actions": ACTIONS}
_NAME = re.compile(r"/?[A-Za-z][A-Za-z0-9_]*(/[A-Za-z][A-Za-z0-9_]*)*")


def read_interface(entries: Mapping[str, YamlNode], usual: RobotInterface) -> RobotInterface:
    """Read the names of one robot; *usual* are those of its kind."""
    renamed: dict[str, str] = {}
    for section in SECTIONS:
        given = list(entries[section].entries()) if section in entries else []
        others = set(_KNOWN[section]) - usual.lacking - {key.value for key, _ in given}
        used = {name: name for name in others}
        for key, value in given:
            if key.value not in _KNOWN[section]:
                listed = f"known names: {', '.join(_KNOWN[section])}"
                help = suggestion(str(key.value), _KNOWN[section], listed)
                key.wrong(f"unknown name in '{section}': `{key.value}`", help)
                continue
            renamed[key.value] = offered = _name(value)
            if offered in used:
                value.wrong(
                    f"`{offered}` is also the name of `{used[offered]}`", "give one of them another name"
                )
            used[offered] = key.value
    return RobotInterface(usual.lacking, renamed)


def _name(node: YamlNode) -> str:
    text = node.text()
    if text and not _NAME.fullmatch(text):
        node.wrong(
            f"'{text}' is not a ROS name", "use letters, digits and _, with / between parts: front/scan"
        )
    return text
