"""The internal actions of the language; importing them fills `jacaros.bdi.internal_action.STANDARD`."""

from jacaros.bdi.stdlib import (
    agents,
    collections,
    list_sets,
    lists,
    output,
    random,
    strings,
    sublists,
    terms,
    time,
    types,
)

__all__ = [
    "agents",
    "collections",
    "list_sets",
    "lists",
    "output",
    "random",
    "strings",
    "sublists",
    "terms",
    "time",
    "types",
]
