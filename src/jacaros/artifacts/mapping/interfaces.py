"""What is known of message types: by the middleware of a run, or by the definitions that come with the package."""

import re
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any, Protocol

from jacaros.ros.fields import FieldType
from jacaros.ros.interfaces import installed
from jacaros.ros.message import MessageFactory
from jacaros.ros.typestore import RosbagsSchema

_CONSTANT = re.compile(r"[A-Z][A-Z0-9_]*")


class Interfaces(Protocol):
    """Tells and makes messages; every backend can."""

    def fields(self, type_name: str) -> Mapping[str, FieldType]:
        """Fields of a type, also of parts such as ``pkg/srv/Name_Request``; raises `UnknownInterface`."""

    def message(self, type_name: str, /, **fields: Any) -> Any:
        """Make a message; raises `UnknownInterface`, `MessageMismatch`."""


class StoredInterfaces:
    """The definitions that come with the package or are installed here: what is checked where there is no middleware."""

    def __init__(self, folders: tuple[Path, ...] = ()) -> None:
        self._factory = MessageFactory(RosbagsSchema((*folders, *installed())))

    def fields(self, type_name: str) -> Mapping[str, FieldType]:
        """Fields of a type."""
        return self._factory.fields(type_name)

    def message(self, type_name: str, /, **fields: Any) -> Any:
        """Make a message."""
        return self._factory.make(type_name, fields)


@lru_cache(maxsize=8)
def stored_interfaces(folders: tuple[Path, ...] = ()) -> StoredInterfaces:
    """One for all who have the same *folders* of further definitions: it remembers what it has read."""
    return StoredInterfaces(folders)


def constants(interfaces: Interfaces, type_name: str) -> dict[str, object]:
    """The constants of a message type by name; those of a service's or an action's parts too."""
    kind = type(interfaces.message(type_name))
    return {
        name: value
        for name, value in vars(kind).items()
        if _CONSTANT.fullmatch(name)
        and "__" not in name
        and isinstance(value, bool | int | float | str | bytes)
    }


def chosen(known: Mapping[str, object], field: str, prefix: str) -> dict[str, object]:
    """The constants that are meant for a field, with what their names have in common cut off, in lower case.

    Those that begin with *prefix*, or else with the field's name, or else all.
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
