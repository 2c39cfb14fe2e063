"""Which variables a piece of syntax mentions."""

from collections.abc import Iterator
from typing import TypeVar

from jacaros.asl import nodes


def variables_in(node: object) -> Iterator[nodes.Variable]:
    """All occurrences of variables, in order, those of nested plans and bodies included."""
    if isinstance(node, nodes.Variable):
        yield node
        if isinstance(node.namespace, nodes.Variable):
            yield node.namespace
        if node.annotations is not None:
            yield from variables_in(node.annotations)
    elif isinstance(node, nodes.Node):
        for part in node.parts():
            yield from variables_in(part)
    elif isinstance(node, tuple):
        for item in node:
            yield from variables_in(item)


def names_in(*parts: object) -> list[str]:
    """Names of the variables, each once, in order of appearance; unnamed ones left out."""
    names: dict[str, None] = {}
    for part in parts:
        for variable in variables_in(part):
            if not variable.unnamed:
                names[variable.name] = None
    return list(names)


def occurrences(*parts: object) -> dict[str, int]:
    """How often each named variable is mentioned."""
    counts: dict[str, int] = {}
    for part in parts:
        for variable in variables_in(part):
            if not variable.unnamed:
                counts[variable.name] = counts.get(variable.name, 0) + 1
    return counts


Kind = TypeVar("Kind", bound=nodes.Node)


def nodes_in(kind: type[Kind], node: object) -> Iterator[Kind]:
    """All nodes of a kind in a piece of syntax."""
    if isinstance(node, kind):
        yield node
    if isinstance(node, nodes.Node):
        for part in node.parts():
            yield from nodes_in(kind, part)
    elif isinstance(node, tuple):
        for item in node:
            yield from nodes_in(kind, item)
