"""Entries of users' YAML files, declared at the fields of the dataclasses that they are read into.

A field such as ``speed: Annotated[float, number(0.01, 5.0, "m/s", "highest speed")] = 0.65`` is the key ``speed`` of a
mapping; a field without a default is required.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import MISSING, dataclass, fields, replace
from typing import Any, TypeVar

from jacaros.runtime.files.yaml import YamlNode

_T = TypeVar("_T")
ReadValue = Callable[[YamlNode, Any], Any]
"""Returns the value of a node, given the default."""


@dataclass(frozen=True, slots=True)
class FieldSpec:
    """How the value of a field is written in a file.

    Attributes:
        words: the values, for documentation, such as ``0.01 to 5 m/s``.
        help: one line of documentation.
        key: name in the file; that of the field if empty.
        read: the reader; None if the code that reads the mapping gives it.
    """

    words: str
    help: str = ""
    key: str = ""
    read: ReadValue | None = None


def declared_entries(described: Any) -> dict[str, tuple[str, FieldSpec, bool]]:
    """Return the entries of a dataclass by key: the name of the field, the entry, and whether it is required."""
    return {
        entry.key or field.name: (field.name, entry, field.default is MISSING)
        for field in fields(described)
        for entry in getattr(field.type, "__metadata__", ())
    }


def values(given: Mapping[str, YamlNode], usual: Any, **readers: ReadValue) -> dict[str, Any]:
    """Return the values of the nodes *given* by key for fields of a dataclass.

    Args:
        given: further keys are ignored.
        usual: an instance with the defaults.
        readers: for the fields whose entries have none.
    """
    return {
        name: (entry.read or readers[name])(given[key], getattr(usual, name))
        for key, (name, entry, _) in declared_entries(usual).items()
        if key in given
    }


def read(node: YamlNode, usual: _T, **readers: ReadValue) -> _T:
    """Return *usual* with the values of the mapping at a node, and report all mistakes; see `values`."""
    known = declared_entries(usual)
    given = node.mapping(*known, required=tuple(key for key, (_, _, required) in known.items() if required))
    return replace(usual, **values(given, usual, **readers))  # type: ignore[type-var]


def section(help: str) -> FieldSpec:
    """Return the entry of a mapping that is read into the fields of its default."""
    return FieldSpec("mapping", help, "", read)


def number(
    least: float = 0.0,
    most: float = 1e9,
    unit: str = "",
    help: str = "",
    key: str = "",
    change: Callable[[float], float] = float,
) -> FieldSpec:
    """Return the entry of a finite number within limits (both included); *change* converts it to the field's unit."""
    words = (
        f"{least:g} to {most:g}" if most < 1e9 else f"at least {least:g}" if least > -math.inf else "number"
    )
    return FieldSpec(f"{words} {unit}".strip(), help, key, lambda node, _: change(node.number(least, most)))


def whole(least: int, help: str) -> FieldSpec:
    """Return the entry of an integer, *least* or more."""
    return FieldSpec(f"integer, at least {least}", help, "", lambda node, _: node.whole(least, least))


def choice(*choices: str, help: str) -> FieldSpec:
    """Return the entry of one of several words."""
    words = ", ".join(f"`{each}`" for each in choices)
    return FieldSpec(words, help, "", lambda node, _: node.choice(*choices))


def either(help: str, key: str, off: str, on: str) -> FieldSpec:
    """Return the entry of a word for False, or one for True."""
    return FieldSpec(f"`{off}`, `{on}`", help, key, lambda node, _: node.choice(off, on) == on)


def flag(help: str) -> FieldSpec:
    """Return the entry of ``false`` or ``true``."""
    return FieldSpec("`false`, `true`", help, "", lambda node, _: node.truth())


def text(help: str) -> FieldSpec:
    """Return the entry of a string."""
    return FieldSpec("text", help, "", lambda node, _: node.text())
