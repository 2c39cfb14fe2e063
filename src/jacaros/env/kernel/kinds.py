"""Kinds of values that parameters take."""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

from jacaros.env.values import Out, text

Accept = Callable[[Any], object]
"""Takes an argument and gives what the operation receives; raises `Unsuitable`."""

LONGEST = 120
"""Characters of an argument that a message shows."""


class Unsuitable(Exception):
    """An argument is not of the kind that a parameter takes; the text, if any, says which part of it is not."""


class Kind(NamedTuple):
    """A kind of values.

    Attributes:
        expected: what it is, for people.
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
    """The instances of a class, which are taken as they are."""

    def accept(argument: object) -> object:
        if isinstance(argument, kind):
            return argument
        raise Unsuitable

    return Kind(expected, accept)


def alternatives(kinds: Sequence[Kind]) -> Kind:
    """Any of several kinds: the first that takes the argument as it is wins over one that would convert it."""

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
    """An argument as agents write it, shortened."""
    written = "an unbound variable" if isinstance(argument, Out) else text(argument, quoted=True)
    return written if len(written) <= LONGEST else f"{written[:LONGEST]}..."


def got(item: object, unsuitable: Unsuitable) -> str:
    """Say of a part what it is, or which part of it is wrong."""
    deeper = str(unsuitable)
    return f"is {shown(item)}" + (f": {deeper}" if deeper else "")
