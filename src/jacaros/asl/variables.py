"""Which variables a piece of syntax mentions."""

from collections.abc import Iterator
from typing import TypeVar

from jacaros.asl import nodes
from jacaros.asl.walk import walk


def variables_in(node: object) -> Iterator[nodes.Variable]:
    """All occurrences of variables, in order, those of nested plans and bodies included."""
    return nodes_in(nodes.Variable, node)


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
    """All nodes of a kind in a piece of syntax, in order."""
    return (part for part in walk(node) if isinstance(part, kind))


def operands(node: nodes.And | nodes.Or) -> list[nodes.Node]:
    """The formulae that a chain of the same operator joins, from left to right."""
    kind = type(node)
    found: list[nodes.Node] = []
    stack: list[nodes.Node] = [node]
    while stack:
        node_ = stack.pop()
        if isinstance(node_, kind):
            stack += (node_.right, node_.left)
        else:
            found.append(node_)
    return found
