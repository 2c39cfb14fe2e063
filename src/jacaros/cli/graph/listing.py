"""``jacaros ros list``: the contents of a graph as a table, as lines or as JSON."""

import json
import sys
from collections.abc import Iterator
from typing import Any

from jacaros.ros.backend import GraphContents, TopicInfo
from jacaros.runtime.output import beneath

UNKNOWN = "(unknown)"
"""Shown instead of a type that the middleware does not report."""


def as_json(contents: GraphContents, rates: dict[str, float]) -> str:
    """Return one JSON object with the lists ``topics``, ``actions``, ``services`` and ``nodes``."""
    return json.dumps(
        {
            "topics": [_topic(info, rates) for _, info in sorted(contents.topics.items())],
            "actions": _typed(contents.actions),
            "services": _typed(contents.services),
            "nodes": list(contents.nodes),
        },
        indent=2,
    )


def _topic(info: TopicInfo, rates: dict[str, float]) -> dict[str, Any]:
    return {
        "name": info.name,
        "types": list(info.types),
        "publishers": [each.node for each in info.publishers],
        "subscriptions": [each.node for each in info.subscriptions],
        "rate": rates.get(info.name),
    }


def _typed(things: dict[str, str]) -> list[dict[str, str | None]]:
    return [{"name": name, "type": type_name or None} for name, type_name in sorted(things.items())]


def as_lines(contents: GraphContents, rates: dict[str, float]) -> Iterator[str]:
    """Yield one line for each entry, for other programs: kind, name, type and, for topics, the number of endpoints."""
    for name, info in sorted(contents.topics.items()):
        rate = f" rate={rates[name]:g}" if name in rates else ""
        ends = f"publishers={len(info.publishers)} subscriptions={len(info.subscriptions)}"
        yield f"topic {name} {_types(info)} {ends}{rate}"
    for kind, things in (("action", contents.actions), ("service", contents.services)):
        for name, type_name in sorted(things.items()):
            yield f"{kind} {name} {type_name or UNKNOWN}"
    for node in contents.nodes:
        yield f"node {node}"


def show_tables(contents: GraphContents, rates: dict[str, float]) -> None:
    """Print tables on the terminal."""
    from rich.table import Table

    from jacaros.inspector.terminal_console import TerminalConsole

    console = TerminalConsole(file=beneath(sys.stdout))

    def table(title: str, *columns: str) -> Table:
        made = Table(title=title, title_justify="left", title_style="bold", box=None, pad_edge=False)
        for column in columns:
            number = column in ("pub", "sub", "Hz")
            made.add_column(column, justify="right" if number else "left", overflow="fold")
        return made

    topics = table("Topics", "name", "type", "pub", "sub", *(["Hz"] if rates else []))
    for name, info in sorted(contents.topics.items()):
        rate = [f"{rates[name]:g}" if name in rates else ""] if rates else []
        topics.add_row(name, _types(info), str(len(info.publishers)), str(len(info.subscriptions)), *rate)
    shown = [topics]
    for title, things in (("Actions", contents.actions), ("Services", contents.services)):
        made = table(title, "name", "type")
        for name, type_name in sorted(things.items()):
            made.add_row(name, type_name or UNKNOWN)
        shown.append(made)
    nodes = table("Nodes", "name")
    for node in contents.nodes:
        nodes.add_row(node)
    for made in [*shown, nodes]:
        if made.row_count:
            console.print(made)
            console.print()


def notes(contents: GraphContents) -> Iterator[str]:
    """Yield notes that explain what the list lacks."""
    if not all(contents.actions.values()):
        yield (
            f"note: the types of some actions are {UNKNOWN}: rosapi on the robot cannot report them "
            "(it has no service /rosapi/action_type)"
        )


def _types(info: TopicInfo) -> str:
    return ",".join(info.types) or UNKNOWN
