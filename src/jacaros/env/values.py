"""Plain values: what crosses between agents and artifacts.

Numbers, truth values, texts, `Atom`, `Structure`, lists and dictionaries cross by content; output
parameters are `Out` objects; anything else crosses as an opaque reference.  Nothing here knows the terms
of the language: the body joins the two.
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
    """An atom of AgentSpeak, such as ``kitchen``; a plain ``str`` is an AgentSpeak *string*.

    It compares and hashes like its text, so an artifact need not care whether an agent wrote
    ``clean(kitchen)`` or ``clean("kitchen")``.
    """

    __slots__ = ()

    def __repr__(self) -> str:
        return f"Atom({str.__repr__(self)})"


@dataclasses.dataclass(frozen=True, slots=True)
class Structure:
    """A compound term such as ``aborted(3)``.

    Two structures are equal when functors and arguments are, whatever their annotations.

    Attributes:
        functor: the name in front of the brackets.
        arguments: plain values, at least one; without arguments it would be an `Atom`.
        annotations: atoms and structures, those in the square brackets behind it.
    """

    functor: str
    arguments: tuple[object, ...]
    annotations: tuple[object, ...] = dataclasses.field(default=(), compare=False, repr=False)

    def __str__(self) -> str:
        return text(self, quoted=True)


class Unset:
    """The kind of `UNSET`, the value of an output parameter that no operation has set."""

    __slots__ = ()

    def __repr__(self) -> str:
        return "UNSET"


UNSET = Unset()
"""The value of an output parameter before an operation sets it; the agent's variable stays unbound."""


class Out(Generic[T]):
    """An output parameter: the place where an operation leaves a result for its caller.

    ``Out[int]`` tells type checkers, and readers, what it gives; ``Out`` is for anything.

    Attributes:
        variable: what the caller writes there; where it writes the same twice, both results have to be equal.
    """

    __slots__ = ("_value", "variable")

    def __init__(self, variable: object = None) -> None:
        self._value: object = UNSET
        self.variable = variable

    @property
    def value(self) -> T:
        """The plain value left here, or `UNSET`."""
        return self._value  # type: ignore[return-value]

    @property
    def is_set(self) -> bool:
        """True when a value was left here."""
        return self._value is not UNSET

    def set(self, value: T) -> None:
        """Leave *value*, turned into a plain value (see `plain`); a later call replaces it."""
        self._value = plain(value)

    def __repr__(self) -> str:
        return f"Out({self._value!r})"


SCALARS: frozenset[type] = frozenset({int, float, bool, str, Atom, type(None)})
"""Classes of values that are plain as they are."""


_DEPTH = 200
"""How deeply a value may be nested."""
_NUMBERS = ("decimal", "fractions")
"""Modules of further numbers of Python, which need not be loaded to know them."""


def plain(value: Any) -> object:
    """Turn *value* into a plain value that shares no mutable part with it.

    Lists, tuples, ranges and deques become new lists, dictionaries are copied, sets become frozen sets; a
    dataclass or named tuple becomes a `Structure` with the class name, first letter in lower case; numpy
    scalars and arrays (known by their ``tolist``) become numbers and lists; decimals and fractions become
    numbers; members of an ``Enum`` become atoms (their names in lower case), those of ``StrEnum`` and
    ``IntEnum`` texts and numbers.  What is none of these stays as it is: an opaque reference.

    Raises:
        ValueError: it contains itself, or is nested deeper than 200 levels.
    """
    if type(value) in SCALARS:
        return value
    try:
        return _plain(value, _DEPTH)
    except _TooDeep:
        raise ValueError(f"a value contains itself, or is nested deeper than {_DEPTH} levels") from None


class _TooDeep(Exception):
    """There is no room for another level."""


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
    if isinstance(value, Enum):
        return Atom(str(value.name).lower())
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        return _structure(kind, (getattr(value, field.name) for field in dataclasses.fields(value)), room)
    return _plain_number_or_array(value, room)


def _plain_text(value: str) -> str:
    text = str.__str__(value)
    return Atom(text) if isinstance(value, Atom) else text


def _plain_number_or_array(value: Any, room: int) -> object:
    kind = type(value)
    if kind.__module__ in _NUMBERS and kind.__name__ in ("Decimal", "Fraction"):
        whole = value == value and kind.__name__ == "Fraction" and value.denominator == 1
        return int(value) if whole else float(value)
    if hasattr(kind, "tolist") and hasattr(kind, "dtype"):
        return _plain(value.tolist(), room)
    return value


def _plain_structure(value: Structure, room: int) -> Structure:
    if not isinstance(value.functor, str) or not value.functor:
        raise TypeError(f"the functor of a structure is a text, not {value.functor!r}")
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
    """The functor of the structure that stands for a dataclass or named tuple: ``pose`` for ``Pose``."""
    return kind.__name__[:1].lower() + kind.__name__[1:]


def _structure(kind: type, values: Any, room: int) -> object:
    functor = functor_of(kind)
    arguments = tuple(_plain(value, room) for value in values)
    return Structure(functor, arguments) if arguments else Atom(functor)


def equal(left: object, right: object) -> bool:
    """Tell whether two plain values are equal to an agent: 3 and 3.0 are, 1 and ``true`` are not."""
    if isinstance(left, bool) or isinstance(right, bool):
        return left is right
    if isinstance(left, list) and isinstance(right, list):
        return len(left) == len(right) and all(map(equal, left, right))
    if isinstance(left, Structure) and isinstance(right, Structure):
        return left.functor == right.functor and equal(list(left.arguments), list(right.arguments))
    return bool(left == right)


def text(value: object, quoted: bool = False) -> str:
    """Write *value* the way agents print it; *quoted* puts strings in double quotes."""
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
