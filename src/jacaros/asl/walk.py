"""Walk syntax trees: their nodes, variables and shape.

>>> from jacaros.asl.loader import parse_term
>>> names_in(parse_term("f(X, g(Y), X)"))
['X', 'Y']
>>> is_ground(parse_term("f(a)"))
True
"""

from collections import defaultdict
from collections.abc import Callable, Iterator
from typing import Any, TypeVar

from jacaros.asl import nodes


def walk(*roots: object) -> Iterator[nodes.Node]:
    """Yield the *roots* and all nodes below them, in source order."""
    stack: list[object] = list(reversed(roots))
    while stack:
        part = stack.pop()
        if isinstance(part, tuple):
            stack.extend(reversed(part))
        elif isinstance(part, nodes.Node):
            yield part
            stack.extend(reversed(part.parts()))


def rebuilt(node: Any, change: Callable[[nodes.Node], Any]) -> Any:
    """Return a copy of a tree with *change* applied to each node, to the inner ones first."""
    if isinstance(node, tuple):
        return tuple([rebuilt(part, change) for part in node])
    if not isinstance(node, nodes.Node):
        return node
    return change(type(node)(*[rebuilt(part, change) for part in node.parts()], span=node.span))


def is_ground(node: object) -> bool:
    """Return whether there is no variable in a piece of syntax."""
    return next(variables_in(node), None) is None


def children(node: nodes.Node) -> Iterator[nodes.Node]:
    """Yield the direct children of *node*, in source order."""
    for part in node.parts():
        if isinstance(part, nodes.Node):
            yield part
        elif isinstance(part, tuple):
            yield from part


def variables_in(node: object) -> Iterator[nodes.Variable]:
    """Yield all occurrences of variables, in order, those of nested plans and bodies included."""
    return nodes_in(nodes.Variable, node)


def names_in(*parts: object) -> list[str]:
    """Return the names of the variables, each once, in order of appearance; unnamed ones are left out."""
    names: dict[str, None] = {}
    for part in parts:
        for variable in variables_in(part):
            if not variable.unnamed:
                names[variable.name] = None
    return list(names)


def occurrences(*parts: object) -> dict[str, int]:
    """Count the occurrences of each named variable."""
    counts: dict[str, int] = {}
    for part in parts:
        for variable in variables_in(part):
            if not variable.unnamed:
                counts[variable.name] = counts.get(variable.name, 0) + 1
    return counts


def parts_of(formula: nodes.Term) -> Iterator[nodes.Term]:
    """Yield the conditions that *formula* joins by ``&``, ``|`` and ``not``, in source order."""
    stack = [formula]
    while stack:
        term = stack.pop()
        if isinstance(term, nodes.Connective):
            stack += reversed(term.operands)
        else:
            yield term


Kind = TypeVar("Kind", bound=nodes.Node)


def nodes_in(kind: type[Kind], node: object) -> Iterator[Kind]:
    """Yield all nodes of a kind in a piece of syntax, in order."""
    return (part for part in walk(node) if isinstance(part, kind))


def operands(node: nodes.And | nodes.Or) -> list[nodes.Node]:
    """Return the formulae that a chain of the same operator joins, from left to right."""
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
    """Return the tree without places and with numbered variables, for comparison.

    Trees that differ only in the names of their variables have equal shapes.
    """
    names = {} if names is None else names
    if isinstance(node, nodes.Variable):
        number = names.setdefault(node.name, len(names))
        return (number, shape(node.annotations, names), shape(node.namespace, names), node.negated)
    if isinstance(node, tuple):
        return tuple([shape(part, names) for part in node])
    if isinstance(node, nodes.Node):
        return (type(node).__name__, *[shape(part, names) for part in node.parts()])
    return node


class ByKind:
    """All nodes of pieces of syntax by their kind, collected in one walk."""

    def __init__(self, *roots: object) -> None:
        self._nodes: defaultdict[type, list[Any]] = defaultdict(list)
        for node in walk(*roots):
            self._nodes[type(node)].append(node)

    def of(self, *kinds: type[Kind]) -> list[Kind]:
        """Return the nodes of these kinds, in order for each kind."""
        return [node for kind in kinds for node in self._nodes[kind]]
