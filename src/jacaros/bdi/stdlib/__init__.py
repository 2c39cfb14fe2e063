"""The internal actions of the language; importing them fills `jacaros.bdi.internal_action.STANDARD`."""

from jacaros.bdi.stdlib import (
    agents,
    beliefs,
    collections,
    goals,
    list_sets,
    lists,
    messages,
    output,
    plans,
    random,
    strings,
    sublists,
    terms,
    time,
    types,
    waiting,
)

__all__ = [
    "agents",
    "beliefs",
    "collections",
    "goals",
    "list_sets",
    "lists",
    "messages",
    "output",
    "plans",
    "random",
    "strings",
    "sublists",
    "terms",
    "time",
    "types",
    "waiting",
]
