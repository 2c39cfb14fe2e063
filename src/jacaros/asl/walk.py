"""All nodes of a tree."""

from collections.abc import Iterator

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
