"""Message types without a ROS installation: a `Schema` built from definition files.

The types of ROS 2 Jazzy are in one file, ``interfaces/jazzy.msg``. A type is parsed, and its class created, on first
use; all runs of a process share the classes.
"""

import dataclasses
import keyword
from collections.abc import Callable, Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any

from jacaros.robots.ros.errors import UnknownInterface
from jacaros.robots.ros.fields import FieldType, MessageDefinition, parse_definition
from jacaros.robots.ros.interfaces import BUILT_IN, KINDS, PARTS, definition, how_to_define, split
from jacaros.robots.ros.message import DEFAULTS, Memo, Schema, zeros

_ZEROS: Mapping[str, object] = {"string": "", "bool": False, "float32": 0.0, "float64": 0.0}


class _Store:
    """The types known in this process."""

    def __init__(self) -> None:
        file = (BUILT_IN / "jazzy.msg").read_text(encoding="utf-8")
        parts = (part.partition("\n") for part in file.split(f"{'=' * 80}\nMSG: ")[1:])
        self._texts = {name: text for name, _, text in parts}
        self._definitions: dict[str, MessageDefinition] = {}
        self.classes: Memo[str, type] = Memo(lambda name: _message_class(name, self.definition(name)))

    def names(self) -> set[str]:
        return {*self._texts, *self._definitions}

    def __contains__(self, type_name: str) -> bool:
        return type_name in self._definitions or type_name in self._texts

    def definition(self, type_name: str) -> MessageDefinition:
        found = self._definitions.get(type_name)
        if found is None:
            text, package = self._texts[type_name], type_name.split("/")[0]
            found = self._definitions[type_name] = parse_definition(text, package)
        return found

    def add(self, type_name: str, added: MessageDefinition) -> None:
        self._definitions[type_name] = added


@cache
def _store() -> _Store:
    return _Store()


def _message_class(type_name: str, described: MessageDefinition) -> type:
    names = [_python_name(name) for name in described.fields]
    constants = {_python_name(name): value for name, value in described.constants.items()}
    namespace = {**constants, "__msgtype__": type_name}
    return dataclasses.make_dataclass(type_name.replace("/", "__"), names, namespace=namespace)


def _python_name(field: str) -> str:
    """Return the attribute name of a field; a Python keyword gets an underscore appended."""
    return f"{field}_" if keyword.iskeyword(field) else field


def stored_types() -> list[str]:
    """Return the full names of all stored message types, sorted."""
    return sorted(_store().names())


def is_stored(type_name: str) -> bool:
    """Return whether the type with this full name is stored already."""
    return type_name in _store()


class DefinitionSchema(Schema):
    """Message classes of ROS 2 Jazzy, plus those defined in folders.

    Args:
        roots: the user's own definition folders; see `jacaros.robots.ros.interfaces`.
    """

    def __init__(self, roots: Sequence[Path] = ()) -> None:
        super().__init__(roots)
        self._makers = Memo(self._compile)

    def new(self, type_name: str) -> Any:
        """Create a message with zeros, empty strings and empty sequences; raises `UnknownInterface`."""
        return self._makers[type_name]()

    def maker(self, type_name: str) -> Callable[[], Any]:
        return self._makers[type_name]

    def load(self, type_name: str) -> None:
        """Load the message types of a service or an action; raises `UnknownInterface`."""
        kind = type_name.split("/")[1]
        if not all(f"{type_name}_{part}" in _store() for part in PARTS[kind]):
            text = self._definition(type_name)
            try:
                parts = split(type_name, text)
            except ValueError as problem:
                raise UnknownInterface(f"the definition of {type_name} is wrong: {problem}") from None
            for part, its_text in parts.items():
                self._register(part, its_text)

    def offered(self, type_name: str) -> None:
        """Raise `UnknownInterface` for a service or an action without a definition.

        The definition is parsed on the first request or goal: parsing takes milliseconds, and a robot serves many types.
        """
        if f"{type_name}_{PARTS[type_name.split('/')[1]][0]}" not in _store():
            self._definition(type_name)

    def _read_fields(self, type_name: str) -> Mapping[str, FieldType]:
        self._require(type_name)
        return _store().definition(type_name).fields

    def _find_class(self, type_name: str) -> Any:
        self._require(type_name)
        return _store().classes[type_name]

    def _require(self, type_name: str) -> None:
        if type_name in _store():
            return
        whole, _, part = type_name.rpartition("_")
        kind = type_name.split("/")[1]
        if part in PARTS.get(kind, ()):
            self.load(whole)
        elif kind in PARTS:
            what = "a service" if kind == "srv" else "an action"
            raise UnknownInterface(
                f"{type_name} is the type of {what}, not of messages; write package/msg/Name"
            )
        else:
            self._register(type_name, self._definition(type_name))

    def _definition(self, type_name: str) -> str:
        text = definition(type_name, self._roots)
        if text is None:
            kind = KINDS[type_name.split("/")[1]]
            raise UnknownInterface(f"{kind} type {type_name} is not known here; {how_to_define(type_name)}")
        return text

    def _register(self, type_name: str, text: str) -> None:
        try:
            parsed = parse_definition(text, type_name.split("/")[0])
        except ValueError as problem:
            raise UnknownInterface(f"the definition of {type_name} is wrong: {problem}") from None
        for field in parsed.fields.values():
            if field.is_message:
                self._require(field.base)
        _store().add(type_name, parsed)

    def _compile(self, type_name: str) -> Callable[[], Any]:
        """Return a function that creates a message in one expression, so nested messages need no further calls."""
        names: dict[str, Any] = {}
        maker: Callable[[], Any] = eval(f"lambda: {self._message(type_name, names)}", names)
        return maker

    def _message(self, type_name: str, names: dict[str, Any]) -> str:
        """Return an expression that creates a message; add the objects it refers to to *names*."""
        defaults = DEFAULTS.get(type_name, {})
        values = [
            repr(defaults[name]) if name in defaults else self._default(field, names)
            for name, field in self.fields(type_name).items()
        ]
        return f"{_named(_store().classes[type_name], names)}({', '.join(values)})"

    def _default(self, field: FieldType, names: dict[str, Any]) -> str:
        if not field.array:
            return self._single_default(field, names)
        length = field.length if field.fixed else 0
        if field.is_numeric:
            return f"{_named(zeros(field, length), names)}[:]"
        return f"[{self._single_default(field, names)} for _ in range({length})]" if length else "[]"

    def _single_default(self, field: FieldType, names: dict[str, Any]) -> str:
        return self._message(field.base, names) if field.is_message else repr(_ZEROS.get(field.base, 0))


def _named(value: object, names: dict[str, Any]) -> str:
    """Add a value to *names*, and return its name for use in an expression."""
    name = f"v{len(names)}"
    names[name] = value
    return name
