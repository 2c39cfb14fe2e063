"""Names of nodes, topics, services and types: checked, resolved and remapped in the same way for every backend.

Every backend passes absolute names to its middleware, so namespaces and remapping need no support there.
"""

import re
from collections.abc import Collection, Iterable, Mapping
from functools import cache

from jacaros.robots.ros.errors import NameInvalid
from jacaros.runtime.files.texts import close_matches

_SEGMENT = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
_PACKAGE = re.compile(r"[A-Za-z][A-Za-z0-9_]*")


GLOBAL_FRAMES = ("map", "earth", "world")
"""Frames that robots share (REP 105)."""


def frame_name(frame: str, prefix: str) -> str:
    """Return the name of a frame in the graph; those with a leading slash, and those that robots share, stay
    unchanged."""
    if frame.startswith("/") or frame in GLOBAL_FRAMES or not frame or not prefix:
        return frame.lstrip("/")
    return f"{prefix}/{frame}"


@cache
def message_type(name: str) -> str:
    """Return the full form ``nav_msgs/msg/Odometry`` of a message type.

    Args:
        name: full form, or ``nav_msgs/Odometry`` as written in ROS 1.

    Raises:
        NameInvalid: the name has neither form.
    """
    return _interface_type(name, "msg")


@cache
def service_type(name: str) -> str:
    """Return the full form ``std_srvs/srv/Trigger`` of a service type; see `message_type`."""
    return _interface_type(name, "srv")


@cache
def action_type(name: str) -> str:
    """Return the full form ``nav2_msgs/action/NavigateToPose`` of an action type; see `message_type`."""
    return _interface_type(name, "action")


def _interface_type(name: str, kind: str) -> str:
    parts = name.split("/")
    if len(parts) == 2:
        parts.insert(1, kind)
    if len(parts) != 3 or parts[1] not in ("msg", "srv", "action"):
        raise NameInvalid(f"{name!r} is not a type name; write it like package/{kind}/Type")
    if not all(_PACKAGE.fullmatch(part) for part in parts):
        raise NameInvalid(
            f"{name!r} is not a type name: only letters, digits and _ are allowed between the slashes"
        )
    return "/".join(parts)


def request_type(service: str) -> str:
    """Return the request message of a service type given in full form."""
    return f"{service}_Request"


def response_type(service: str) -> str:
    """Return the response message of a service type given in full form."""
    return f"{service}_Response"


def goal_type(action: str) -> str:
    """Return the goal message of an action type given in full form."""
    return f"{action}_Goal"


def result_type(action: str) -> str:
    """Return the result message of an action type given in full form."""
    return f"{action}_Result"


def feedback_type(action: str) -> str:
    """Return the feedback message of an action type given in full form."""
    return f"{action}_Feedback"


def near_names(name: str, names: Iterable[str], alike: Collection[str] = ()) -> list[str]:
    """Return up to three names that *name* may mean: with the same last part, or a similar spelling.

    Args:
        name: the unknown name.
        names: the known names.
        alike: those of the same type; if there are any, only they are returned, and any of them if none is similar.
    """
    known = list(alike or names)
    last = name.rpartition("/")[2]
    same = [each for each in known if each.rpartition("/")[2] == last]
    return (list(dict.fromkeys([*same, *close_matches(name, known, 3)])) or list(alike))[:3]


class NodeNames:
    """A node's name, its namespace and its remapping rules.

    Args:
        node_name: plain name without slashes.
        namespace: prefix of relative names; ``""`` is the root.
        remap: replacements of names; both sides may be relative, private (``~x``) or absolute.

    Raises:
        NameInvalid: a name is invalid.
    """

    def __init__(self, node_name: str, namespace: str = "", remap: Mapping[str, str] | None = None) -> None:
        if not _SEGMENT.fullmatch(node_name):
            raise NameInvalid(
                f"{node_name!r} is not a node name: letters, digits and _ only, no leading digit"
            )
        self.node_name = node_name
        self.namespace = "/" + namespace.strip("/") if namespace.strip("/") else ""
        _check(self.namespace or "/root", namespace)
        self.full_name = f"{self.namespace}/{node_name}"
        self._remap = {self._expand(old): self._expand(new) for old, new in (remap or {}).items()}

    def resolve(self, name: str) -> str:
        """Return the absolute, remapped form of a topic or service name.

        Raises:
            NameInvalid: the name is invalid; the text shows it as written.
        """
        absolute = self._expand(name)
        return self._remap.get(absolute, absolute)

    def _expand(self, name: str) -> str:
        if name.startswith("/"):
            absolute = name
        elif name.startswith("~"):
            absolute = f"{self.full_name}/{name[1:].lstrip('/')}"
        else:
            absolute = f"{self.namespace}/{name}"
        _check(absolute, name)
        return absolute


def _check(absolute: str, written: str) -> None:
    for segment in absolute[1:].split("/"):
        if not _SEGMENT.fullmatch(segment):
            raise NameInvalid(
                f"{written!r} is not a ROS name: {segment!r}: only letters, digits and _ are allowed "
                "between the slashes, with no leading digit"
            )
