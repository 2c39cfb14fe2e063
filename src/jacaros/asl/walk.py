"""All nodes of a tree, its variables, and its shape."""

from collections.abc import Iterator
from typing import TypeVar

from jacaros.asl import nodes


def walk(*roots: object) -> Iterator[nodes.Node]:
    """The *roots* and everything below them, in the order of the text."""
    stack: list[object] = list(reversed(roots))
    while stack:
        part = stack.pop()
        if isinstance(part, tuple):
            stack.extend(reversed(part))
        elif isinstance(part, nodes.Node):
            yield part
            stack.extend(reversed(part.parts()))


def children(node: nodes.Node) -> Iterator[nodes.Node]:
    """The nodes right below *node*, in the order of the text."""
    for part in node.parts():
        if isinstance(part, nodes.Node):
            yield part
        elif isinstance(part, tuple):
            yield from part


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


def shape(node: object, names: dict[str, int] | None = None) -> object:
    """The tree without places and with variables numbered, to be compared: equal for trees that differ in the names
    of their variables only."""
    names = {} if names is None else names
    if isinstance(node, nodes.Variable):
        number = names.setdefault(node.name, len(names))
        return (number, shape(node.annotations, names), shape(node.namespace, names), node.negated)
    if isinstance(node, tuple):
        return tuple([shape(part, names) for part in node])
    if isinstance(node, nodes.Node):
        return (type(node).__name__, *[shape(part, names) for part in node.parts()])
    return node
