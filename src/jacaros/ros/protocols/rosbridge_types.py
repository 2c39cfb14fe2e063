"""Interface definitions: those of the package and of files, and otherwise those of the server's rosapi."""

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from jacaros.ros.errors import UnknownInterface
from jacaros.ros.names import message_type
from jacaros.ros.typestore import DefinitionSchema, is_stored

Ask = Callable[[str, dict[str, Any]], dict[str, Any] | None]
"""Calls a service of rosapi and waits for the fields of its response; None if it fails, `TimeoutError` if there is no
answer."""

_DETAILS = {
    "msg": ("message_details",),
    "srv": ("service_request_details", "service_response_details"),
    "action": ("action_goal_details", "action_result_details", "action_feedback_details"),
}
"""Services of rosapi that return the parts of a definition, in the order of the file."""
_BASES = {"double": "float64", "float": "float32", "boolean": "bool", "octet": "byte"}
_ROS1_BASES = {
    "char": "uint8",
    "byte": "int8",
    "time": "builtin_interfaces/Time",
    "duration": "builtin_interfaces/Duration",
}
_ROS1_ONLY = {
    "rosgraph_msgs/msg/Log": "std_msgs/Header header\nbyte level\nstring name\nstring msg\nstring file\n"
    "string function\nuint32 line\nstring[] topics\n"
}
"""Definitions of ROS 1 that the backend itself needs."""
_PARAMETER_SERVICES = {
    "rcl_interfaces/srv/GetParameters": "string[] names\n---\nParameterValue[] values\n",
    "rcl_interfaces/srv/GetParameterTypes": "string[] names\n---\nuint8[] types\n",
    "rcl_interfaces/srv/SetParameters": "Parameter[] parameters\n---\nSetParametersResult[] results\n",
    "rcl_interfaces/srv/ListParameters": "string[] prefixes\nuint64 depth\n---\nListParametersResult result\n",
}
"""Services of ROS 2's nodes that the backend itself calls."""
_ACTIONLIB = {
    "ActionGoal": "std_msgs/Header header\nactionlib_msgs/GoalID goal_id\n{action}_Goal goal\n",
    "ActionResult": "std_msgs/Header header\nactionlib_msgs/GoalStatus status\n{action}_Result result\n",
    "ActionFeedback": "std_msgs/Header header\nactionlib_msgs/GoalStatus status\n{action}_Feedback feedback\n",
}
"""The wrappers that actionlib adds to the three parts of an action."""
_NO_FIELD = "structure_needs_at_least_one_member"
_SEQUENCE = re.compile(r"sequence<(?P<base>.+?)(?:,\s*\d+)?>")
_INTEGER = re.compile(r"-?\d+")
_CONSTANT = re.compile(r"[A-Z][A-Z0-9_]*")


class BridgeSchema(DefinitionSchema):
    """Message classes of `DefinitionSchema`, plus those whose definitions the server knows.

    Args:
        roots: the user's own definition folders.
        ask: asks the server; it blocks the calling thread, but once per otherwise unknown type.
        describe: returns why the server cannot be asked, None if it can.
    """

    def __init__(self, roots: Sequence[Path], ask: Ask, describe: Callable[[], str | None]) -> None:
        super().__init__(roots)
        self._ask = ask
        self._describe = describe
        self._reported: dict[str, str] = {}

    def _require(self, type_name: str) -> None:
        action, _, part = type_name.rpartition("_")
        if part not in _ACTIONLIB or "/action/" not in action:
            super()._require(type_name)
        elif not is_stored(type_name):
            self._register(type_name, _ACTIONLIB[part].format(action=action))

    def _definition(self, type_name: str, what: str, ending: str) -> str:
        try:
            return super()._definition(type_name, what, ending)
        except UnknownInterface as unknown:
            for ours in (_ROS1_ONLY, _PARAMETER_SERVICES):
                if type_name in ours:
                    return ours[type_name]
            if type_name in self._reported:  # part of a type that the server has described
                return self._reported[type_name]
            reason = self._describe()
            if reason is not None:
                raise UnknownInterface(f"{unknown} ({reason})") from None
            try:
                text = self._fetch(type_name, ending)
            except TimeoutError:
                raise UnknownInterface(
                    f"{unknown} (the rosbridge server was asked for it, but has not answered yet)"
                ) from None
            if text is None:
                raise UnknownInterface(f"{unknown} (the rosbridge server does not know it either)") from None
            return text

    def _fetch(self, type_name: str, ending: str) -> str | None:
        """Return the definition of a type in the form of a file, and store those of its parts."""
        parts = []
        for service in _DETAILS[ending]:
            answer = self._ask(f"/rosapi/{service}", {"type": type_name})
            typedefs = None if answer is None else answer.get("typedefs")
            if not typedefs:
                return None
            whole, *others = typedefs
            parts.append(definition_text(whole))
            for other in others:
                self._reported.setdefault(message_type(other["type"]), definition_text(other))
        return "---\n".join(parts)


def written_on_ros1(type_name: str) -> str:
    """Return a type in ROS 1's form: ``std_msgs/String``, ``nav2_msgs/NavigateToPoseActionGoal``."""
    package, kind, name = type_name.split("/")
    if kind == "action":  # one of the messages of an action
        name = "".join(name.rsplit("_", 1))
    return f"{package}/{name}"


def definition_text(typedef: Mapping[str, Any]) -> str:
    """Convert a ``rosapi_msgs/msg/TypeDef`` to the text of a definition.

    Args:
        typedef: its fields; the length of an array is -1 for a single value and 0 for no limit.
    """
    ros1 = "/msg/" not in "".join(typedef["fieldtypes"]) and not _BASES.keys() & set(typedef["fieldtypes"])
    lines = list(_constants(typedef))
    lengths = typedef.get("fieldarraylen") or [-1] * len(typedef["fieldnames"])
    for name, kind, length in zip(typedef["fieldnames"], typedef["fieldtypes"], lengths, strict=True):
        if name != _NO_FIELD:
            sequence = _SEQUENCE.fullmatch(kind)
            if sequence is not None:  # this is how bounded sequences of bounded strings are described
                kind, length = sequence["base"], 0
            array = "" if length < 0 else f"[{length or ''}]"
            lines.append(f"{_base(kind, ros1)}{array} {name}")
    return "".join(f"{line}\n" for line in lines)


def _base(kind: str, ros1: bool) -> str:
    kind = re.sub(r",\s*\d+$", "", kind)  # this is how bounded sequences are described
    kind = re.sub(r"^(w?string)<\d+>$", "string", kind).replace("/msg/", "/")
    if ros1 and kind in _ROS1_BASES:
        return _ROS1_BASES[kind]
    return _BASES.get(kind, kind)


def _constants(typedef: Mapping[str, Any]) -> Iterator[str]:
    # rosapi reports their values as texts, together with class attributes that are not constants.
    pairs = zip(typedef.get("constnames") or (), typedef.get("constvalues") or (), strict=False)
    for name, value in pairs:
        if _CONSTANT.fullmatch(name) and name != "SLOT_TYPES" and _INTEGER.fullmatch(str(value)):
            yield f"int64 {name}={value}"
