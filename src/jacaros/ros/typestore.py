"""Genuine message definitions without a ROS installation: the ``rosbags`` typestore as a `Schema`.

Loading the store takes about 0.15 s, so it is done when the first message type is asked for, once a process.
"""

import re
from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any

from jacaros.ros.errors import UnknownInterface
from jacaros.ros.fields import FieldType, from_rosbags
from jacaros.ros.interfaces import definition, split_action, split_service
from jacaros.ros.message import DEFAULTS
from jacaros.ros.names import feedback_type, goal_type, request_type, response_type, result_type
from jacaros.ros.values import zeros

_FILLER = "structure_needs_at_least_one_member"
"""What ROS 2 puts into empty messages."""
_WSTRING = re.compile(r"^\s*wstring\b", re.MULTILINE)
"""A text with wide characters: ours are all the same."""
_ZEROS: Mapping[str, object] = {"string": "", "bool": False, "float32": 0.0, "float64": 0.0}


@lru_cache(maxsize=1)
def _store() -> Any:
    from rosbags.typesys import Stores, get_typestore  # costs more than the rest of the start together

    return get_typestore(Stores.ROS2_JAZZY)


def stored_types() -> list[str]:
    """Names of all message types of the store, in full form, sorted."""
    return sorted(_store().types)


def is_stored(type_name: str) -> bool:
    """Whether a type in full form is in the store already."""
    return type_name in _store().types


class RosbagsSchema:
    """Message classes of ROS 2 Jazzy from ``rosbags``, plus definitions found in folders.

    Args:
        roots: the user's own definition folders; see `jacaros.ros.interfaces`.
    """

    def __init__(self, roots: Sequence[Path] = ()) -> None:
        self._roots = tuple(roots)
        self._fields: dict[str, Mapping[str, FieldType]] = {}
        self._makers: dict[str, Callable[[], Any]] = {}

    def look_in(self, folder: Path) -> None:
        """Look for definitions in *folder* too, from now on."""
        if folder not in self._roots:
            self._roots = (*self._roots, folder)

    def fields(self, type_name: str) -> Mapping[str, FieldType]:
        """Fields of a type in full form; raises `UnknownInterface`."""
        fields = self._fields.get(type_name)
        if fields is None:
            self._require(type_name)
            described = _store().fielddefs[type_name][1]
            fields = self._fields[type_name] = {
                name: from_rosbags(kind) for name, kind in described if name != _FILLER
            }
        return fields

    def new(self, type_name: str) -> Any:
        """Make a message with zeros, empty texts and empty sequences; raises `UnknownInterface`."""
        maker = self._makers.get(type_name)
        if maker is None:
            maker = self._makers[type_name] = self._compile(type_name)
        return maker()

    def numbers(self, field: FieldType, values: Any) -> Any:
        """Keep numpy arrays as they are."""
        return values

    def single(self, field: FieldType, value: Any) -> Any:
        """Keep plain values as they are."""
        return value

    def service(self, type_name: str) -> None:
        """Make the request and response types of a service known; raises `UnknownInterface`."""
        self._require_parts(type_name, "service", (request_type, response_type), split_service)

    def action(self, type_name: str) -> None:
        """Make the goal, result and feedback types of an action known; raises `UnknownInterface`."""
        self._require_parts(type_name, "action", (goal_type, result_type, feedback_type), split_action)

    def offered(self, type_name: str) -> None:
        """Raise `UnknownInterface` for a service or an action that has no definition.

        The definition is read when the first request or goal comes: that takes milliseconds, and a robot offers many.
        """
        kind = type_name.split("/")[1]
        part = request_type(type_name) if kind == "srv" else goal_type(type_name)
        if part not in _store().types:
            self._definition(type_name, "service" if kind == "srv" else "action", kind)

    def _require(self, type_name: str) -> None:
        if type_name in _store().types:
            return
        whole, _, part = type_name.rpartition("_")
        if "/srv/" in type_name and part in ("Request", "Response"):
            self.service(whole)
        elif "/action/" in type_name and part in ("Goal", "Result", "Feedback"):
            self.action(whole)
        elif (kind := type_name.split("/")[1]) in ("srv", "action"):
            what = "a service" if kind == "srv" else "an action"
            raise UnknownInterface(
                f"{type_name} is the type of {what}, not of messages; write package/msg/Name"
            )
        else:
            self._register(type_name, self._definition(type_name, "message", "msg"))

    def _require_parts(
        self,
        type_name: str,
        what: str,
        names: Sequence[Callable[[str], str]],
        split: Callable[[str], Sequence[str]],
    ) -> None:
        types = [name(type_name) for name in names]
        if all(part in _store().types for part in types):
            return
        text = self._definition(type_name, what, type_name.split("/")[1])
        try:
            parts = split(text)
        except ValueError as problem:
            raise UnknownInterface(f"the definition of {type_name} is wrong: {problem}") from None
        for part, definition_of_part in zip(types, parts, strict=True):
            self._register(part, definition_of_part)

    def _definition(self, type_name: str, what: str, ending: str) -> str:
        text = definition(type_name, self._roots)
        if text is None:
            raise UnknownInterface(
                f"{what} type {type_name} is not known here; put its definition into a folder and name that "
                f"folder in interface_paths (in a mapping file: interfaces): {type_name}.{ending}"
            )
        return text

    def _register(self, type_name: str, text: str) -> None:
        from rosbags.typesys import get_types_from_msg

        # Read as if it were a message: the parser looks for types without a package beside the type itself.
        package, _, name = type_name.split("/")
        [parsed] = get_types_from_msg(_WSTRING.sub("string", text), f"{package}/msg/{name}").values()
        for _, kind in parsed[1]:
            field = from_rosbags(kind)
            if field.is_message:
                self._require(field.base)
        _store().register({type_name: parsed})

    def _compile(self, type_name: str) -> Callable[[], Any]:
        """A function that makes a message, written out as one expression: nested messages need no calls between."""
        names: dict[str, Any] = {}
        maker: Callable[[], Any] = eval(f"lambda: {self._message(type_name, names)}", names)
        return maker

    def _message(self, type_name: str, names: dict[str, Any]) -> str:
        """An expression that makes a message; *names* takes what it refers to."""
        fields = self.fields(type_name)
        defaults = DEFAULTS.get(type_name, {})
        values = [
            repr(defaults[name]) if name in defaults else self._value(field, names)
            for name, field in fields.items()
        ]
        # By place: a field may have a name that Python keeps for itself.
        return f"{_named(_store().types[type_name], names)}({', '.join(values) or '0'})"

    def _value(self, field: FieldType, names: dict[str, Any]) -> str:
        if not field.array:
            return self._single(field, names)
        length = field.length if field.fixed else 0
        if field.is_numeric:
            return f"{_named(zeros(field, length), names)}.copy()"
        return f"[{self._single(field, names)} for _ in range({length})]" if length else "[]"

    def _single(self, field: FieldType, names: dict[str, Any]) -> str:
        return self._message(field.base, names) if field.is_message else repr(_ZEROS.get(field.base, 0))


def _named(value: object, names: dict[str, Any]) -> str:
    """A name for a value in an expression."""
    name = f"v{len(names)}"
    names[name] = value
    return name
