"""``jacaros ros show``: the fields of an entry of a graph, its endpoints and its next message."""

import json
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from typing import Any

from jacaros.robots.mapping.interfaces import Interfaces, constants_by_field
from jacaros.robots.ros.backend import Endpoint
from jacaros.robots.ros.errors import RosError, UnknownInterface
from jacaros.robots.ros.message import to_seconds
from jacaros.robots.ros.node import Capability
from jacaros.runtime.cli.graph.first_mapping import lines_for
from jacaros.runtime.cli.graph.joining import Joined, one_message
from jacaros.runtime.cli.graph.listing import GraphEntry, GraphKind
from jacaros.runtime.cli.graph.values import Leaf, is_time, leaves, messages, parts, value_at

FEW = 6
"""Number of list elements shown."""
LONG = 60
"""Number of characters of a string shown."""


async def described_all(joined: Joined, things: Sequence[GraphEntry]) -> list[dict[str, Any]]:
    """Describe entries; for a type named without its kind, describe the kinds that exist.

    Raises:
        UnknownInterface: no definition is available.
    """
    found, missing = [], None
    for thing in things:
        try:
            found.append(await described(joined, thing))
        except UnknownInterface as unknown:
            missing = unknown
    if not found and missing is not None:
        raise missing
    return found


async def described(joined: Joined, thing: GraphEntry) -> dict[str, Any]:
    """Describe an entry, as data for `as_text` and for JSON.

    Raises:
        UnknownInterface: the definition of its type is not available.
    """
    data: dict[str, Any] = {"kind": str(thing.kind), "name": thing.name}
    if thing.type_name:
        data["type"] = thing.type_name
    if thing.kind is GraphKind.NODE:
        return {**data, **await _node(joined, thing.name)}
    message = None
    if thing.kind is GraphKind.TOPIC:
        info = joined.contents.topics[thing.name]
        data["types"] = list(info.types)
        data["publishers"] = [_endpoint(each) for each in info.publishers]
        data["subscriptions"] = [_endpoint(each) for each in info.subscriptions]
    if not thing.type_name:
        return data
    if thing.kind is GraphKind.TOPIC and data["publishers"]:
        message = await one_message(joined, joined.contents.topics[thing.name], joined.timeout)
        data["heard"] = message is not None
    data["parts"] = {
        name: [_row(joined, leaf, message) for leaf in leaves(joined.backend.fields, type_name)]
        for name, type_name in parts(thing.type_name).items()
    }
    if others := _other_constants(joined.backend, parts(thing.type_name).values()):
        data["constants"] = others
    if thing.kind is not GraphKind.TYPE:
        data["mapping"] = lines_for(joined, thing)
    return data


async def _node(joined: Joined, name: str) -> dict[str, Any]:
    topics = sorted(joined.contents.topics.items())
    data: dict[str, Any] = {
        "publishes": [topic for topic, info in topics if any(e.node == name for e in info.publishers)],
        "subscribes": [topic for topic, info in topics if any(e.node == name for e in info.subscriptions)],
    }
    if Capability.PARAMETERS in joined.backend.capabilities:
        parameters = joined.backend.parameters(name)
        # Not every node replies: some ROS 2 nodes have no parameter services.
        with suppress(RosError):
            names = await parameters.names(joined.timeout)
            data["parameters"] = {each: await parameters.get(each, joined.timeout) for each in names}
    return data


def _endpoint(endpoint: Endpoint) -> dict[str, Any]:
    data: dict[str, Any] = {"node": endpoint.node or None}
    if endpoint.qos is not None:
        qos = endpoint.qos
        # The depth is left out: ROS 2 does not transmit it.
        quality: dict[str, Any] = {"reliability": qos.reliability, "durability": qos.durability}
        if qos.deadline is not None:
            quality["deadline"] = qos.deadline
        data["qos"] = quality
    return data


def _row(joined: Joined, leaf: Leaf, message: Any) -> dict[str, Any]:
    row: dict[str, Any] = {"path": leaf.path, "type": str(leaf.type)}
    if is_time(leaf.type):
        row["type"] = row["type"].rpartition("/")[2].lower()
    if leaf.unit:
        row["unit"] = leaf.unit
    if named := leaf.owner and constants_by_field(joined.backend, leaf.owner).get(leaf.name):
        row["constants"] = _plain_constants(named)
    if message is not None:
        row["value"] = _plain(value_at(message, leaf.path), leaf)
    return row


def _other_constants(types: Interfaces, type_names: Iterable[str]) -> dict[str, dict[str, Any]]:
    """Return the constants that belong to no single field, by message type."""
    owners = dict.fromkeys(owner for name in type_names for owner in messages(types.fields, name))
    others = {owner: constants_by_field(types, owner).get("", {}) for owner in owners}
    return {owner: _plain_constants(named) for owner, named in others.items() if named}


def _plain_constants(named: Mapping[str, object]) -> dict[str, Any]:
    return {name: _single(value) for name, value in named.items()}


def _plain(value: Any, leaf: Leaf) -> Any:
    """Return a value as data for JSON; for long lists the first elements and the length."""
    if value is None:
        return None
    single = to_seconds if is_time(leaf.type) else _single
    if leaf.type.array:
        elements = [single(each) for each in value[:FEW]]
        return elements if len(value) <= FEW else {"length": len(value), "first": elements}
    return single(value)


def _single(value: Any) -> Any:
    if hasattr(value, "item"):
        value = value.item()
    if isinstance(value, bytes):
        return value[0] if len(value) == 1 else list(value)
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    return value if isinstance(value, bool | int | float | str) else str(value)


def as_json(data: Sequence[dict[str, Any]]) -> str:
    """Return one object, or a list for several entries of the same name."""
    return json.dumps(data[0] if len(data) == 1 else list(data), indent=2, ensure_ascii=False, default=str)


def as_text(data: dict[str, Any]) -> Iterator[str]:
    """Yield the lines of the text output."""
    yield f"{data['kind']} {data['name']}"
    if len(data.get("types", ())) > 1:
        yield f"  types: {', '.join(data['types'])}: conflicting types"
    elif "type" in data and data["kind"] != "type":
        yield f"  type: {data['type']}"
    elif data["kind"] not in ("node", "type"):
        yield "  type: not reported by this middleware"
    for key in ("publishers", "subscriptions"):
        if key in data:
            yield f"  {key}: {'; '.join(map(_endpoint_text, data[key])) or 'none'}"
    yield from _of_node(data)
    for name, rows in data.get("parts", {}).items():
        yield ""
        yield (
            name if len(data["parts"]) > 1 or "value" not in (rows[0] if rows else {}) else "latest message"
        )
        yield from _table(rows)
    for type_name, named in data.get("constants", {}).items():
        yield ""
        yield f"constants of {type_name}"
        yield from _constant_lines(named)
    if data.get("heard") is False:
        yield ""
        yield "no message received; --timeout S waits longer"
    if data.get("mapping"):
        yield ""
        yield "entry for a mapping file (`jacaros ros map` writes one)"
        yield from (f"  {line}".rstrip() for line in data["mapping"])


def _of_node(data: dict[str, Any]) -> Iterator[str]:
    for key in ("publishes", "subscribes"):
        if key in data:
            yield f"  {key}: {', '.join(data[key]) or 'none'}"
    if data.get("parameters"):
        yield ""
        yield "parameters"
        yield from (f"  {name}: {value!r}" for name, value in data["parameters"].items())


def _endpoint_text(endpoint: dict[str, Any]) -> str:
    node = endpoint["node"] or "unknown node"
    qos = endpoint.get("qos")
    if qos is None:
        return str(node)
    deadline = f", deadline {qos['deadline']:g} s" if "deadline" in qos else ""
    return f"{node} ({qos['reliability']}, {qos['durability']}{deadline})"


def _table(rows: list[dict[str, Any]]) -> Iterator[str]:
    if not rows:
        yield "  (empty)"
        return
    cells = [[row["path"], row["type"], row.get("unit", ""), _text(row)] for row in rows]
    widths = [max(len(cell[column]) for cell in cells) for column in range(3)]
    for row, cell in zip(rows, cells, strict=True):
        line = "  ".join(text.ljust(width) for text, width in zip(cell, widths, strict=False))
        yield f"  {line}  {cell[3]}".rstrip()
        yield from _constant_lines(row.get("constants", {}))


def _constant_lines(named: dict[str, Any]) -> Iterator[str]:
    return (f"      {_plain_text(value)} = {name}" for name, value in named.items())


def _text(row: dict[str, Any]) -> str:
    if "value" not in row:
        return ""
    value = row["value"]
    if isinstance(value, dict):
        return f"[{', '.join(map(_plain_text, value['first']))}, ... {value['length']} in all]"
    if isinstance(value, list):
        return f"[{', '.join(map(_plain_text, value))}]"
    return "(none)" if value is None else _plain_text(value)


def _plain_text(value: Any) -> str:
    """Return a plain value in AgentSpeak notation."""
    if isinstance(value, str):
        text = json.dumps(value, ensure_ascii=False)
        return text if len(text) <= LONG else f"{text[:LONG]}..."
    if isinstance(value, bool):
        return str(value).lower()
    return f"{value:.6g}" if isinstance(value, float) and abs(value) < 1e6 else str(value)
