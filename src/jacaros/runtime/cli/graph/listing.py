"""The entries of a graph: find what a name means, and ``jacaros ros list``, as a table, as lines or as JSON."""

import json
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

from jacaros.robots.ros.backend import GraphContents
from jacaros.robots.ros.errors import NameInvalid
from jacaros.robots.ros.names import near_names
from jacaros.runtime.cli.graph.joining import Joined
from jacaros.runtime.cli.usage import usage_error
from jacaros.runtime.errors import UsageError
from jacaros.runtime.files.texts import did_you_mean
from jacaros.runtime.output import beneath

UNKNOWN = "(unknown)"
"""Shown instead of a type that the middleware does not report."""
_LABELS = ("", "publishers=", "subscriptions=", "rate=")
_COLUMNS = ("type", "pub", "sub", "Hz")
"""What follows the name of an entry: in lines for other programs, and as columns of a table."""


class GraphKind(StrEnum):
    """Kinds of entries of a graph."""

    TOPIC = "topic"
    SERVICE = "service"
    ACTION = "action"
    NODE = "node"
    TYPE = "type"


@dataclass(frozen=True, slots=True)
class GraphEntry:
    """An entry of a graph.

    Attributes:
        name: absolute name; for a type, its full name.
        type_name: full name of the type; empty if the graph does not report it, and for nodes.
    """

    kind: GraphKind
    name: str
    type_name: str = ""


def all_things(contents: GraphContents) -> list[GraphEntry]:
    """Return topics, actions, services and nodes, each sorted by name."""
    topics = [
        GraphEntry(GraphKind.TOPIC, name, next(iter(info.types), ""))
        for name, info in sorted(contents.topics.items())
    ]
    actions = [
        GraphEntry(GraphKind.ACTION, name, type_name) for name, type_name in sorted(contents.actions.items())
    ]
    services = [
        GraphEntry(GraphKind.SERVICE, name, type_name)
        for name, type_name in sorted(contents.services.items())
    ]
    return [*topics, *actions, *services, *(GraphEntry(GraphKind.NODE, name) for name in contents.nodes)]


def find(joined: Joined, written: str) -> list[GraphEntry]:
    """Return the entries named *written*: an absolute name, a name relative to the namespace, or a type.

    Raises:
        UsageError: the name is unknown; the error suggests similar ones.
    """
    types = _type_names(written)
    if types:
        return [GraphEntry(GraphKind.TYPE, name, name) for name in types]
    try:
        name = joined.backend.resolve(written)
    except NameInvalid as wrong:
        raise UsageError(str(wrong)) from None
    things = all_things(joined.contents)
    found = [thing for thing in things if thing.name == name]
    if not found:
        raise usage_error(
            f"unknown name: `{name}`",
            did_you_mean(near_names(name, [t.name for t in things]), "`jacaros ros list` shows all names"),
        )
    return found


def find_mappable(joined: Joined, written: str) -> list[GraphEntry]:
    """Return the entries named *written* that a mapping can contain: a node may have the same name as a topic.

    Raises:
        UsageError: the name is unknown, or names only a node or a type.
    """
    things = find(joined, written)
    mappable = [thing for thing in things if thing.kind not in (GraphKind.NODE, GraphKind.TYPE)]
    if not mappable:
        found = things[0]
        raise usage_error(
            f"`{found.name}` is a {found.kind}", "a mapping file contains topics, services and actions"
        )
    return mappable


def _type_names(written: str) -> list[str]:
    """Return the full names of the types that a name without a leading slash may mean."""
    parts = written.split("/")
    if written.startswith(("/", "~")) or not parts[-1][:1].isupper() or len(parts) not in (2, 3):
        return []
    if len(parts) == 3:
        return [written] if parts[1] in ("msg", "srv", "action") else []
    return [f"{parts[0]}/{kind}/{parts[1]}" for kind in ("msg", "srv", "action")]


def as_json(contents: GraphContents, rates: dict[str, float]) -> str:
    """Return one JSON object with the lists ``topics``, ``actions``, ``services`` and ``nodes``."""
    topics = [
        {
            "name": name,
            "types": list(info.types),
            "publishers": [each.node for each in info.publishers],
            "subscriptions": [each.node for each in info.subscriptions],
            "rate": rates.get(name),
        }
        for name, info in sorted(contents.topics.items())
    ]
    typed: dict[str, list[Any]] = {
        f"{kind}s": [
            {"name": thing.name, "type": thing.type_name or None}
            for thing in all_things(contents)
            if thing.kind is kind
        ]
        for kind in (GraphKind.ACTION, GraphKind.SERVICE)
    }
    return json.dumps({"topics": topics, **typed, "nodes": list(contents.nodes)}, indent=2)


def _rows(contents: GraphContents, rates: dict[str, float]) -> Iterator[tuple[GraphKind, list[str]]]:
    """Yield each entry as its name and what `_LABELS` names."""
    for thing in all_things(contents):
        row = [thing.name]
        if thing.kind is GraphKind.TOPIC:
            info = contents.topics[thing.name]
            row += [",".join(info.types) or UNKNOWN, str(len(info.publishers)), str(len(info.subscriptions))]
            row += [f"{rates[thing.name]:g}"] if thing.name in rates else []
        elif thing.kind is not GraphKind.NODE:
            row.append(thing.type_name or UNKNOWN)
        yield thing.kind, row


def as_lines(contents: GraphContents, rates: dict[str, float]) -> Iterator[str]:
    """Yield one line for each entry, for other programs: kind, name, type and, for topics, the number of endpoints."""
    for kind, (name, *values) in _rows(contents, rates):
        told = (f"{label}{value}" for label, value in zip(_LABELS, values, strict=False))
        yield " ".join((kind, name, *told))


def show_tables(contents: GraphContents, rates: dict[str, float]) -> None:
    """Print tables on the terminal."""
    from rich.table import Table

    from jacaros.look.page.terminal_console import TerminalConsole

    console = TerminalConsole(file=beneath(sys.stdout))
    tables: dict[GraphKind, Table] = {}
    for kind, row in _rows(contents, rates):
        if kind not in tables:
            title = f"{kind.capitalize()}s"
            table = Table(title=title, title_justify="left", title_style="bold", box=None, pad_edge=False)
            tables[kind] = table
            table.add_column("name", overflow="fold")
            number = {GraphKind.TOPIC: 4 if rates else 3, GraphKind.NODE: 0}.get(kind, 1)
            for column in _COLUMNS[:number]:
                table.add_column(column, justify="left" if column == "type" else "right", overflow="fold")
        tables[kind].add_row(*row)
    for table in tables.values():
        console.print(table)
        console.print()


def notes(contents: GraphContents) -> Iterator[str]:
    """Yield notes that explain what the list lacks."""
    if not all(contents.actions.values()):
        yield (
            f"note: the types of some actions are {UNKNOWN}: rosapi on the robot cannot report them "
            "(it has no service /rosapi/action_type)"
        )
