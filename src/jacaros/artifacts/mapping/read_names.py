"""Read names: of beliefs, of ROS topics and nodes, of types."""

import re

from jacaros.artifacts.mapping.declared import Written
from jacaros.artifacts.mapping.read_fields import place_of, shown
from jacaros.files.yaml import Node
from jacaros.ros.errors import NameInvalid
from jacaros.ros.names import action_type, message_type, service_type

UNNAMED = "unnamed"
"""Replaces an invalid name."""

RESERVED = ("true", "false", "not", "div", "mod", "if", "else", "elif", "for", "while")
"""Words with another meaning in agent programs."""

_BELIEF = re.compile(r"[a-z][A-Za-z0-9_]*")
_ROS = re.compile(r"[~/]?[A-Za-z_][A-Za-z0-9_]*(/[A-Za-z_][A-Za-z0-9_]*)*")
_GLUED = re.compile(r"([a-z_]+):(\S+)")
_TYPE = re.compile(r"[a-z]\w*/(msg/)?[A-Z]\w*")
_NAMESPACE = re.compile(r"/?[A-Za-z_][A-Za-z0-9_]*(/[A-Za-z_][A-Za-z0-9_]*)*/?")
_READERS = {"msg": message_type, "srv": service_type, "action": action_type}
_EXAMPLES = {
    "msg": "nav_msgs/msg/Odometry",
    "srv": "std_srvs/srv/Trigger",
    "action": "nav2_msgs/action/NavigateToPose",
}


def belief_name(node: Node) -> str:
    """Read the name of a property, signal or operation."""
    if not isinstance(node.value, str) or not _BELIEF.fullmatch(node.value):
        if isinstance(node.value, bool):
            node.wrong(
                f"{str(node.value).lower()} is not a valid name in agent programs", "write another name"
            )
            return UNNAMED
        near = re.sub(r"\W", "_", str(node.value)).lstrip("_0123456789")
        help = f"write {near[0].lower()}{near[1:]}" if near else "begin with a lower-case letter"
        node.wrong(f"{shown(node.value)} is not a valid name in agent programs", help)
        return UNNAMED
    if node.value in RESERVED:
        node.wrong(
            f"`{node.value}` is a reserved word in agent programs",
            f"write {node.value}_value or another name",
        )
        return UNNAMED
    return str(node.value)


def ros_name(node: Node) -> Written:
    """Read the name of a topic, service, action or node."""
    value = node.value
    if not isinstance(value, str) or not _ROS.fullmatch(value):
        glued = _GLUED.fullmatch(value) if isinstance(value, str) else None
        help = f"write a space after the colon: {glued[1]}: {glued[2]}" if glued else ""
        node.wrong(f"{shown(value)} is not a ROS name", help or "write it like cmd_vel or /robot/cmd_vel")
        return Written("unnamed", place_of(node))
    return Written(str(value), place_of(node))


def namespace(node: Node) -> str:
    """Read a namespace; empty if none exists."""
    value = node.value
    if value in (None, "", "/"):
        return ""
    if not isinstance(value, str) or not _NAMESPACE.fullmatch(value):
        node.wrong(f"{shown(value)} is not a ROS namespace", "write it like r1 or fleet/r1")
        return ""
    return str(value).strip("/")


def type_written(node: Node, kind: str) -> Written | None:
    """Read a type in full form; *kind* is ``msg``, ``srv`` or ``action``. None after a mistake."""
    full = _full_type(node.value, kind)
    if full is None:
        node.wrong(*_wrong_type(node.value, kind))
        return None
    return Written(full, place_of(node))


def _full_type(value: object, kind: str) -> str | None:
    try:
        full = _READERS[kind](value) if isinstance(value, str) else None
    except NameInvalid:
        return None
    return full if full is not None and full.split("/")[1] == kind else None


_OF = {"msg": "messages", "srv": "a service", "action": "an action"}


def _wrong_type(value: object, kind: str) -> tuple[str, str]:
    """Return the problem with a type, and what to write."""
    for other, of in _OF.items():
        if other != kind and isinstance(value, str) and value.count("/") == 2 and _full_type(value, other):
            return (
                f"{value} is the type of {of}, not of {_OF[kind]}",
                f"write a type such as {_EXAMPLES[kind]}",
            )
    slashed = value.replace(".", "/").replace("::", "/") if isinstance(value, str) else ""
    near = slashed if slashed and _full_type(slashed, kind) else f"it like {_EXAMPLES[kind]}"
    return f"{shown(value)} is not a type of {_OF[kind]}", f"write {near}"


def is_type(value: object) -> bool:
    """Return whether a value has the form of a message type, and not that of a usual topic."""
    return isinstance(value, str) and _TYPE.fullmatch(value) is not None
