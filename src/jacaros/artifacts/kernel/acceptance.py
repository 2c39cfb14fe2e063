"""From a parameter's Python annotation to a check that converts plain values and describes what it expects."""

import collections.abc
import dataclasses
import enum
import inspect
import types
import typing
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

from jacaros.artifacts.env.values import Atom, Out, Structure, equal, functor_of, text

# Kinds of values that parameters accept.
#
# For a parameter that is a dataclass or a named tuple, agents pass a structure, such as ``pose(1,2)``.


AcceptValue = Callable[[Any], object]
"""Converts an argument for the operation. Raises `Unsuitable`."""

LONGEST = 120
"""Maximum number of characters of an argument in a message."""


class Unsuitable(Exception):
    """An argument is not of the kind that a parameter accepts. The text, if any, says which part of it is not."""


class ValueKind(NamedTuple):
    """A kind of values.

    Attributes:
        expected: its description, for messages.
        accept: checks and converts an argument.
    """

    expected: str
    accept: AcceptValue


def _input(argument: object) -> object:
    if isinstance(argument, Out):
        raise Unsuitable
    return argument


ANYTHING = ValueKind("any value", _input)


def instance_of(kind: type, expected: str) -> ValueKind:
    """Accept instances of a class, unconverted."""

    def accept(argument: object) -> object:
        if isinstance(argument, kind):
            return argument
        raise Unsuitable

    return ValueKind(expected, accept)


def alternatives(kinds: Sequence[ValueKind]) -> ValueKind:
    """Accept any of several kinds. One that needs no conversion has precedence."""

    def accept(argument: object) -> object:
        converted: list[object] = []
        reasons = []
        for each in kinds:
            try:
                result = each.accept(argument)
            except Unsuitable as unsuitable:
                reasons.append(str(unsuitable))
                continue
            if result is argument:
                return argument
            converted.append(result)
        if not converted:
            raise Unsuitable(next(filter(None, reasons), ""))
        return converted[0]

    return ValueKind(" or ".join(kind.expected for kind in kinds), accept)


def shown(argument: object) -> str:
    """Return an argument as agents write it, shortened."""
    written = "an unbound variable" if isinstance(argument, Out) else text(argument, quoted=True)
    return written if len(written) <= LONGEST else f"{written[:LONGEST]}..."


def accept_part(kind: ValueKind, item: object, part: str, which: object = None) -> Any:
    """Accept a part of an argument, such as its ``element`` 3.

    Raises:
        Unsuitable: it is not of its kind; the text says which part it is, and which part of it is wrong.
    """
    try:
        return kind.accept(item)
    except Unsuitable as unsuitable:
        where = part if which is None else f"{part} {text(which, quoted=True)}"
        deeper = f": {unsuitable}" if str(unsuitable) else ""
        raise Unsuitable(f"{where} is {shown(item)}{deeper}") from None


class Field(NamedTuple):
    """A field of a record.

    Attributes:
        name: its Python name.
        annotation: its annotation.
        optional: whether it has a default value.
    """

    name: str
    annotation: Any
    optional: bool


def fields_of(kind: type) -> list[Field] | None:
    """Return the fields that the constructor of a dataclass or named tuple takes; None for other classes.

    A class with ``__record__ = False`` has more state than its fields, so no structure can represent it.
    """
    is_named_tuple = issubclass(kind, tuple) and hasattr(kind, "_fields")
    if getattr(kind, "__record__", True) is False or not (dataclasses.is_dataclass(kind) or is_named_tuple):
        return None
    hints = _hints(kind)
    parameters = inspect.signature(kind).parameters.values()
    return [
        Field(each.name, hints.get(each.name, object), each.default is not each.empty) for each in parameters
    ]


def _hints(kind: type) -> dict[str, Any]:
    try:
        return typing.get_type_hints(kind)
    except Exception:  # an annotation that cannot be resolved accepts any value
        return {}


def record(kind: type, fields: list[Field], kind_of: Callable[[Any], ValueKind]) -> ValueKind:
    """Accept structures that become a *kind*."""
    functor = functor_of(kind)
    kinds = [(field, kind_of(field.annotation)) for field in fields]
    fewest = sum(not field.optional for field in fields)

    def accept(argument: object) -> object:
        if isinstance(argument, kind):
            return argument
        given = _arguments(argument, functor)
        if not fewest <= len(given) <= len(kinds):
            raise Unsuitable(f"it has {len(given)} arguments")
        values = {
            field.name: accept_part(wanted, item, field.name)
            for (field, wanted), item in zip(kinds, given, strict=False)
        }
        try:
            return kind(**values)
        except (ValueError, TypeError) as error:
            raise Unsuitable(str(error)) from None

    written = ", ".join(f"{f.name}: {k.expected}" + (" (optional)" if f.optional else "") for f, k in kinds)
    return ValueKind(f"{functor}({written})" if written else functor, accept)


def _arguments(argument: object, functor: str) -> tuple[object, ...]:
    if isinstance(argument, Structure) and argument.functor == functor:
        return argument.arguments
    if isinstance(argument, Atom) and argument == functor:
        return ()
    raise Unsuitable


def kind_of(annotation: Any) -> ValueKind:
    """Return the kind of values that a parameter with *annotation* accepts. An unknown annotation accepts any input."""
    annotation = _unwrapped(annotation)
    if _hashable(annotation) and annotation in _SIMPLE:
        return _SIMPLE[annotation]
    origin, members = typing.get_origin(annotation), typing.get_args(annotation)
    if origin in (typing.Union, types.UnionType):
        return alternatives([kind_of(member) for member in members])
    if origin is typing.Literal:
        return _choice(members)
    if origin is Out:
        return _SIMPLE[Out]
    container = origin if origin is not None else annotation
    made = _CONTAINERS.get(container) if _hashable(container) else None
    if made is not None:
        return made(members)
    if isinstance(container, type):
        return _kind_of_class(container)
    return ANYTHING


def _hashable(annotation: Any) -> bool:
    return isinstance(annotation, collections.abc.Hashable)


def _unwrapped(annotation: Any) -> Any:
    """Resolve new types, annotated types and aliases."""
    while True:
        if isinstance(annotation, typing.NewType):
            annotation = annotation.__supertype__
        elif typing.get_origin(annotation) is typing.Annotated:
            annotation = typing.get_args(annotation)[0]
        elif type(annotation).__name__ == "TypeAliasType":  # Python 3.11 has only that of typing_extensions
            annotation = annotation.__value__
        else:
            return annotation


def _kind_of_class(kind: type) -> ValueKind:
    if issubclass(kind, enum.Enum):
        return _member(kind)
    fields = fields_of(kind)
    if fields is not None:
        return record(kind, fields, kind_of)
    if getattr(kind, "_is_protocol", False) and not getattr(kind, "_is_runtime_protocol", False):
        return ANYTHING
    return instance_of(kind, kind.__name__)


def _integer(argument: object) -> object:
    if type(argument) is int:
        return argument
    if isinstance(argument, float) and argument.is_integer():
        return int(argument)
    raise Unsuitable


def _real(argument: object) -> object:
    if type(argument) is float:
        return argument
    if type(argument) is int:
        try:
            return float(argument)
        except OverflowError:
            raise Unsuitable from None
    raise Unsuitable


def _text(argument: object) -> object:
    """Accept a string. An atom becomes one, so that output does not depend on how the caller wrote it."""
    if not isinstance(argument, str):
        raise Unsuitable
    return str(argument) if type(argument) is not str else argument


def _choice(choices: tuple[object, ...]) -> ValueKind:
    def accept(argument: object) -> object:
        for choice in choices:
            if argument is choice or equal(argument, choice):
                return argument
        raise Unsuitable

    return ValueKind(" or ".join(text(choice, quoted=True) for choice in choices), accept)


def _member(kind: type[enum.Enum]) -> ValueKind:
    """Accept a member of an enumeration, by its name in any case, or by its value."""
    members = list(kind)
    by_name = {member.name.lower(): member for member in members}

    def accept(argument: object) -> object:
        if isinstance(argument, kind):
            return argument
        found = by_name.get(argument.lower()) if isinstance(argument, str) else None
        if found is None:
            found = next((member for member in members if equal(argument, member.value)), None)
        if found is None:
            raise Unsuitable
        return found

    return ValueKind(f"one of {', '.join(by_name)}", accept)


def _list_like(make: Callable[[list[Any]], object]) -> Callable[[tuple[Any, ...]], ValueKind]:
    def kind(members: tuple[Any, ...]) -> ValueKind:
        each = kind_of(members[0]) if members else None

        def accept(argument: object) -> object:
            if not isinstance(argument, list):
                raise Unsuitable
            return make(
                argument
                if each is None
                else [accept_part(each, item, "element", n) for n, item in enumerate(argument, 1)]
            )

        return ValueKind(
            "a list" if each is None or each is ANYTHING else f"a list, each {each.expected}", accept
        )

    return kind


def _tuple(members: tuple[Any, ...]) -> ValueKind:
    """Accept a list of this length as a tuple of these members; ``tuple[T, ...]`` accepts any length."""
    if not members or members[-1] is Ellipsis:
        return _list_like(tuple)(members[:1])
    kinds = [kind_of(member) for member in members]

    def accept(argument: object) -> object:
        if not isinstance(argument, list):
            raise Unsuitable
        if len(argument) != len(kinds):
            raise Unsuitable(f"it has {len(argument)} elements")
        pairs = zip(kinds, argument, strict=True)
        return tuple(accept_part(kind, item, "element", n) for n, (kind, item) in enumerate(pairs, 1))

    return ValueKind(f"a list of {len(kinds)} ({', '.join(kind.expected for kind in kinds)})", accept)


def _takes_none(argument: object) -> object:
    if argument is None:
        return argument
    raise Unsuitable


_SIMPLE: dict[Any, ValueKind] = {
    object: ANYTHING,
    Any: ANYTHING,
    int: ValueKind("an integer", _integer),
    float: ValueKind("a number", _real),
    str: ValueKind("a text", _text),
    type(None): ValueKind("nothing", _takes_none),
    None: ValueKind("nothing", _takes_none),
    bool: instance_of(bool, "true or false"),
    Atom: instance_of(Atom, "an atom"),
    Structure: instance_of(Structure, "a structure"),
    Out: instance_of(Out, "an unbound variable (it is an output)"),
}

_LIST = _list_like(lambda items: items)
_MAP = instance_of(dict, "a map")
_CONTAINERS: dict[Any, Callable[[tuple[Any, ...]], ValueKind]] = {
    list: _LIST,
    tuple: _tuple,
    dict: lambda members: _MAP,
    collections.abc.Mapping: lambda members: _MAP,
    collections.abc.Sequence: _LIST,
    collections.abc.Iterable: _LIST,
}
