"""Kinds of values that parameters accept.

For a parameter that is a dataclass or a named tuple, agents pass a structure, such as ``pose(1,2)``.
"""

import dataclasses
import inspect
import typing
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

from jacaros.env.values import Atom, Out, Structure, functor_of, text

Accept = Callable[[Any], object]
"""Converts an argument for the operation. Raises `Unsuitable`."""

LONGEST = 120
"""Maximum number of characters of an argument in a message."""


class Unsuitable(Exception):
    """An argument is not of the kind that a parameter accepts. The text, if any, says which part of it is not."""


class Kind(NamedTuple):
    """A kind of values.

    Attributes:
        expected: its description, for messages.
        accept: checks and converts an argument.
    """

    expected: str
    accept: Accept


def _input(argument: object) -> object:
    if isinstance(argument, Out):
        raise Unsuitable
    return argument


ANYTHING = Kind("any value", _input)


def instance_of(kind: type, expected: str) -> Kind:
    """Accept instances of a class, unconverted."""

    def accept(argument: object) -> object:
        if isinstance(argument, kind):
            return argument
        raise Unsuitable

    return Kind(expected, accept)


def alternatives(kinds: Sequence[Kind]) -> Kind:
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

    return Kind(" or ".join(kind.expected for kind in kinds), accept)


def shown(argument: object) -> str:
    """Return an argument as agents write it, shortened."""
    written = "an unbound variable" if isinstance(argument, Out) else text(argument, quoted=True)
    return written if len(written) <= LONGEST else f"{written[:LONGEST]}..."


def accept_part(kind: Kind, item: object, part: str, which: object = None) -> Any:
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


def record(kind: type, fields: list[Field], kind_of: Callable[[Any], Kind]) -> Kind:
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
    return Kind(f"{functor}({written})" if written else functor, accept)


def _arguments(argument: object, functor: str) -> tuple[object, ...]:
    if isinstance(argument, Structure) and argument.functor == functor:
        return argument.arguments
    if isinstance(argument, Atom) and argument == functor:
        return ()
    raise Unsuitable
