"""Plain values: the values that agents and artifacts exchange.

Numbers, Booleans, strings, `Atom`, `Structure`, lists and dictionaries are passed by content. Output parameters are `Out`
objects. Anything else is passed as an opaque reference. This module does not depend on the terms of the language: the body
converts between the two.
"""

import dataclasses
from collections import deque
from enum import Enum
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Generic

if TYPE_CHECKING:
    from typing_extensions import TypeVar

    T = TypeVar("T", default=Any)
else:
    from typing import TypeVar

    T = TypeVar("T")


class Atom(str):
    """An atom of AgentSpeak, such as ``kitchen``. A plain ``str`` is an AgentSpeak *string*.

    It compares and hashes like its text, so an artifact need not distinguish ``clean(kitchen)`` from ``clean("kitchen")``.
    """

    __slots__ = ()

    def __repr__(self) -> str:
        return f"Atom({str.__repr__(self)})"


@dataclasses.dataclass(frozen=True, slots=True)
class Structure:
    """A compound term such as ``aborted(3)``.

    Two structures are equal if functors and arguments are equal, whatever their annotations.

    Attributes:
        functor: the name before the brackets.
        arguments: plain values, at least one. Without arguments, use an `Atom`.
        annotations: atoms and structures in square brackets after it.
    """

    functor: str
    arguments: tuple[object, ...]
    annotations: tuple[object, ...] = dataclasses.field(default=(), compare=False, repr=False)

    def __str__(self) -> str:
        return text(self, quoted=True)


class Unset:
    """The type of `UNSET`, the value of an output parameter that no operation has set."""

    __slots__ = ()

    def __repr__(self) -> str:
        return "UNSET"


UNSET = Unset()
"""The value of an output parameter before an operation sets it. The agent's variable remains unbound."""


class Out(Generic[T]):
    """An output parameter, in which an operation stores a result for its caller.

    ``Out[int]`` declares the type of the result for type checkers and readers; ``Out`` accepts any value.

    Attributes:
        variable: the caller's variable. If the caller passes the same one twice, both results must be equal.
    """

    __slots__ = ("_value", "variable")

    def __init__(self, variable: object = None) -> None:
        self._value: object = UNSET
        self.variable = variable

    @property
    def value(self) -> T:
        """The stored plain value, or `UNSET`."""
        return self._value  # type: ignore[return-value]

    @property
    def is_set(self) -> bool:
        """Whether a value has been stored."""
        return self._value is not UNSET

    def set(self, value: T) -> None:
        """Store *value*, converted to a plain value (see `plain`). A later call replaces it."""
        self._value = plain(value)

    def __repr__(self) -> str:
        return f"Out({self._value!r})"


SCALARS: frozenset[type] = frozenset({int, float, bool, str, Atom, type(None)})
"""Classes whose values are plain."""


_DEPTH = 200
"""Maximum nesting depth of a value."""


def plain(value: Any) -> object:
    """Convert *value* to a plain value that shares no mutable part with it.

    Lists, tuples, ranges and deques become new lists; dictionaries are copied; sets become frozen sets. A dataclass or
    named tuple becomes a `Structure` with the class name, first letter in lower case. Numpy scalars and arrays
    (recognised by their ``tolist``) become numbers and lists. Members of an ``Enum`` become
    atoms (their names in lower case), those of ``StrEnum`` and ``IntEnum`` strings and numbers. Anything else is
    returned as it is: an opaque reference.

    Raises:
        ValueError: the value contains itself, or is nested deeper than 200 levels.
    """
    if type(value) in SCALARS:
        return value
    try:
        return _plain(value, _DEPTH)
    except _TooDeep:
        raise ValueError(f"the value contains itself, or is nested deeper than {_DEPTH} levels") from None


class _TooDeep(Exception):
    """The value is nested too deeply."""


def _plain(value: Any, room: int) -> object:
    kind = type(value)
    if kind in SCALARS:
        return value
    if room == 0:
        raise _TooDeep
    room -= 1
    if kind is list:
        return [_plain(item, room) for item in value]
    if kind is Structure:
        return _plain_structure(value, room)
    if isinstance(value, str):
        return _plain_text(value)
    if isinstance(value, (int, float)):
        return int(value) if isinstance(value, int) else float(value)
    if isinstance(value, tuple) and hasattr(value, "_fields"):
        return _structure(kind, value, room)
    if isinstance(value, (list, tuple, range, deque)):
        return [_plain(item, room) for item in value]
    if isinstance(value, (dict, MappingProxyType)):
        return {_plain_key(key, room): _plain(item, room) for key, item in value.items()}
    if isinstance(value, (set, frozenset)):
        return frozenset(_plain_key(item, room) for item in value)
    if hasattr(kind, "tolist") and hasattr(kind, "dtype"):
        return _plain(value.tolist(), room)
    if isinstance(value, Enum):
        return Atom(str(value.name).lower())
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        return _structure(kind, (getattr(value, field.name) for field in dataclasses.fields(value)), room)
    return value


def _plain_text(value: str) -> str:
    text = str.__str__(value)
    return Atom(text) if isinstance(value, Atom) else text


def _plain_structure(value: Structure, room: int) -> Structure:
    if not isinstance(value.functor, str) or not value.functor:
        raise TypeError(f"expected a string as functor of a structure, found {value.functor!r}")
    arguments = tuple(_plain(argument, room) for argument in value.arguments)
    if not value.annotations:
        return Structure(value.functor, arguments)
    return Structure(value.functor, arguments, tuple(_plain(each, room) for each in value.annotations))


def _plain_key(key: Any, room: int) -> Any:
    converted = _plain(key, room)
    try:
        hash(converted)
    except TypeError:
        return key
    return converted


def functor_of(kind: type) -> str:
    """Return the functor of the structure for a dataclass or named tuple: ``pose`` for ``Pose``."""
    return kind.__name__[:1].lower() + kind.__name__[1:]


def _structure(kind: type, values: Any, room: int) -> object:
    functor = functor_of(kind)
    arguments = tuple(_plain(value, room) for value in values)
    return Structure(functor, arguments) if arguments else Atom(functor)


def equal(left: object, right: object) -> bool:
    """Return whether two plain values are equal for an agent: 3 and 3.0 are, 1 and ``true`` are not."""
    if isinstance(left, bool) or isinstance(right, bool):
        return left is right
    if isinstance(left, list) and isinstance(right, list):
        return len(left) == len(right) and all(map(equal, left, right))
    if isinstance(left, Structure) and isinstance(right, Structure):
        return left.functor == right.functor and equal(list(left.arguments), list(right.arguments))
    return bool(left == right)


def text(value: object, quoted: bool = False) -> str:
    """Return *value* as agents print it. With *quoted*, strings are in double quotes."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float) and value.is_integer() and abs(value) < 1e15:
        return str(int(value))
    if isinstance(value, Structure):
        annotations = f"[{_joined(value.annotations)}]" if value.annotations else ""
        return f"{value.functor}({_joined(value.arguments)}){annotations}"
    if isinstance(value, (list, tuple)):
        return f"[{_joined(value)}]"
    if isinstance(value, str) and quoted and not isinstance(value, Atom):
        return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
    return str(value)


def _joined(values: list[object] | tuple[object, ...]) -> str:
    return ",".join(text(value, quoted=True) for value in values)
