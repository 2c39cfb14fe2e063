"""Parameters that are dataclasses or named tuples: agents give a structure, such as ``pose(1,2)`` for a ``Pose``."""

import dataclasses
import typing
from collections.abc import Callable
from typing import Any, NamedTuple

from jacaros.env.kernel.kinds import Kind, Unsuitable, got
from jacaros.env.values import Atom, Structure, functor_of


class Field(NamedTuple):
    """A field of a record.

    Attributes:
        name: as in Python.
        annotation: what it takes.
        optional: True when it has a default value.
    """

    name: str
    annotation: Any
    optional: bool


def fields_of(kind: type) -> list[Field] | None:
    """The fields that the constructor of a dataclass or named tuple takes; None for other classes.

    A class with ``__record__ = False`` says that it is more than its fields: no structure stands for it.
    """
    if getattr(kind, "__record__", True) is False:
        return None
    if dataclasses.is_dataclass(kind):
        hints = _hints(kind)
        missing = dataclasses.MISSING
        return [
            Field(
                f.name,
                hints.get(f.name, object),
                f.default is not missing or f.default_factory is not missing,
            )
            for f in dataclasses.fields(kind)
            if f.init
        ]
    names: tuple[str, ...] | None = getattr(kind, "_fields", None)
    if names is not None and issubclass(kind, tuple):
        hints, defaults = _hints(kind), getattr(kind, "_field_defaults", {})
        return [Field(name, hints.get(name, object), name in defaults) for name in names]
    return None


def _hints(kind: type) -> dict[str, Any]:
    try:
        return typing.get_type_hints(kind)
    except Exception:  # an annotation that cannot be resolved takes anything
        return {}


def record(kind: type, fields: list[Field], kind_of: Callable[[Any], Kind]) -> Kind:
    """The kind of structures that become a *kind*."""
    functor = functor_of(kind)
    kinds = [(field, kind_of(field.annotation)) for field in fields]
    fewest = sum(not field.optional for field in fields)

    def accept(argument: object) -> object:
        if isinstance(argument, kind):
            return argument
        given = _arguments(argument, functor)
        if not fewest <= len(given) <= len(kinds):
            raise Unsuitable(f"it has {len(given)} of them")
        values = {
            field.name: _field(field, wanted, item)
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


def _field(field: Field, kind: Kind, item: object) -> object:
    try:
        return kind.accept(item)
    except Unsuitable as unsuitable:
        raise Unsuitable(f"{field.name} {got(item, unsuitable)}") from None
