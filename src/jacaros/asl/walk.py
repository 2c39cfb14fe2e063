"""All nodes of a tree."""

from collections.abc import Iterator
from dataclasses import fields
from typing import Final

from jacaros.asl import nodes

_fields: Final[dict[type, tuple[str, ...]]] = {}


def walk(*roots: object) -> Iterator[nodes.Node]:
    """The *roots* and everything below them, in the order of the text."""
    stack: list[object] = list(reversed(roots))
    while stack:
        part = stack.pop()
        if isinstance(part, tuple):
            stack.extend(reversed(part))
        elif isinstance(part, nodes.Node):
            yield part
            stack.extend(getattr(part, name) for name in _names_of(type(part)))


def children(node: nodes.Node) -> Iterator[nodes.Node]:
    """The nodes right below *node*, in the order of the text."""
    for name in reversed(_names_of(type(node))):
        part = getattr(node, name)
        if isinstance(part, nodes.Node):
            yield part
        elif isinstance(part, tuple):
            yield from part


def _names_of(node_type: type[nodes.Node]) -> tuple[str, ...]:
    """The fields that hold further nodes, last one first."""
    known = _fields.get(node_type)
    if known is None:
        known = tuple(part.name for part in fields(node_type) if part.name != "span")[::-1]
        _fields[node_type] = known
    return known
