"""Message types, from the middleware of a run or from the definitions that come with the package."""

import re
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any, Protocol

from jacaros.ros.fields import FLOATS, INTEGER_RANGES, FieldType
from jacaros.ros.interfaces import BUILT_IN, installed
from jacaros.ros.typestore import DefinitionSchema, stored_types

_CONSTANT = re.compile(r"[A-Z][A-Z0-9_]*")


class Interfaces(Protocol):
    """Describes and makes messages; every backend can."""

    def fields(self, type_name: str) -> Mapping[str, FieldType]:
        """Return the fields of a type, also of parts such as ``pkg/srv/Name_Request``. Raises `UnknownInterface`."""

    def message(self, type_name: str, /, **fields: Any) -> Any:
        """Make a message. Raises `UnknownInterface`, `MessageMismatch`."""


class StoredInterfaces:
    """The definitions of the package and of this machine, for checks without a middleware."""

    def __init__(self, folders: tuple[Path, ...] = ()) -> None:
        self._factory = DefinitionSchema((*folders, *installed()))

    def fields(self, type_name: str) -> Mapping[str, FieldType]:
        """Fields of a type."""
        return self._factory.fields(type_name)

    def message(self, type_name: str, /, **fields: Any) -> Any:
        """Make a message."""
        return self._factory.make(type_name, fields)


@lru_cache(maxsize=8)
def stored_interfaces(folders: tuple[Path, ...] = ()) -> StoredInterfaces:
    """Return the shared instance for *folders* of further definitions; it caches what it has read."""
    return StoredInterfaces(folders)


def constants(interfaces: Interfaces, type_name: str) -> dict[str, object]:
    """Return the constants of a message type by name, also those of the parts of services and actions."""
    kind = type(interfaces.message(type_name))
    return {
        name: value
        for name, value in vars(kind).items()
        if _CONSTANT.fullmatch(name)
        and "__" not in name
        and isinstance(value, bool | int | float | str | bytes)
    }


_SMALL = ("byte", "char", "int8", "uint8")
"""Types of fields that hold one of a few constants."""


def constants_by_field(interfaces: Interfaces, type_name: str) -> dict[str, dict[str, object]]:
    """Return the constants of a message type by the field whose values they name; those without a field under ``""``.

    A constant belongs to the field whose name is its prefix. If the type has a single integer field, and that has 8
    bits, all other constants belong to it, provided that no two have the same value.
    """
    fields = interfaces.fields(type_name)
    longest = sorted(fields, key=len, reverse=True)
    found: dict[str, dict[str, object]] = {}
    for name, value in constants(interfaces, type_name).items():
        owners = (field for field in longest if name.startswith(f"{field.upper()}_"))
        owner = next((field for field in owners if _can_have(fields[field], value)), "")
        found.setdefault(owner, {})[name] = value
    others = found.get("", {})
    numbers = [name for name, kind in fields.items() if kind.base in INTEGER_RANGES]
    alone = len(numbers) == 1 and numbers[0] not in found and fields[numbers[0]].base in _SMALL
    if alone and len(set(others.values())) == len(others) > 1:
        found[numbers[0]] = found.pop("")
    return found


def _can_have(field: FieldType, constant: object) -> bool:
    if field.base in INTEGER_RANGES:
        return isinstance(constant, int | bytes)
    return field.base == "string" if isinstance(constant, str) else field.base in FLOATS


def chosen(known: Mapping[str, object], field: str, prefix: str) -> dict[str, object]:
    """Return the constants for a field, without their common prefix, in lower case.

    These are the constants that begin with *prefix*, or else with the field's name, or else all.
    """
    for start in (prefix,) if prefix else (f"{field.upper()}_", ""):
        found = {
            name.removeprefix(start).lstrip("_").lower(): value
            for name, value in known.items()
            if name.startswith(start)
        }
        if found:
            return found
    return {}


PARTS = ("_Request", "_Response", "_Goal", "_Result", "_Feedback")
"""Suffixes of messages that are parts of services and actions."""


def known_types(kind: str) -> list[str]:
    """Types of a kind, ``msg``, ``srv`` or ``action``."""
    own = [
        f"{path.parent.parent.name}/{kind}/{path.stem}"
        for path in sorted(BUILT_IN.glob(f"*/{kind}/*.{kind}"))
    ]
    whole = [name for name in stored_types() if not name.endswith(PARTS)]
    return [*own, *(name for name in whole if f"/{kind}/" in name)]
