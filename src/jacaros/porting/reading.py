"""Java source as a syntax tree, read by tree-sitter."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from importlib.util import find_spec
from typing import TYPE_CHECKING

from jacaros.runtime.errors import JacarosError, UsageError
from jacaros.runtime.files.texts import help_line

if TYPE_CHECKING:
    from tree_sitter import Node

COMMENTS = ("line_comment", "block_comment")
_CLASSES = ("class_declaration", "enum_declaration", "interface_declaration", "record_declaration")


class NotPortable(JacarosError):
    """A Java file that cannot be ported at all."""


@dataclass(frozen=True, slots=True)
class JavaFile:
    """A Java file.

    Attributes:
        name: of the file, for messages.
        root: of its syntax tree.
        lines: of its text, for comments.
    """

    name: str
    root: Node
    lines: list[str]

    def code(self, node: Node) -> list[str]:
        """Return the lines of a node, without their common indentation."""
        first, last = node.start_point[0], node.end_point[0]
        if first == last:
            return [source(node).rstrip()]
        lines = [source(node).splitlines()[0].strip(), *self.lines[first + 1 : last + 1]]
        indents = [len(line) - len(line.lstrip()) for line in lines[1:] if line.strip()]
        cut = min([self._indent(first), *indents])
        return [lines[0], *(line[cut:].rstrip() for line in lines[1:])]

    def _indent(self, line: int) -> int:
        text = self.lines[line]
        return len(text) - len(text.lstrip())


def read(name: str, text: str) -> JavaFile:
    """Parse a Java file.

    Raises:
        UsageError: the parser is not installed.
        NotPortable: the text is not Java.
    """
    for library in ("tree_sitter", "tree_sitter_java"):
        if find_spec(library) is None:
            help = help_line('pip install "jacaros[java]"')
            raise UsageError(f"error: port needs the Python package {library}\n{help}")
    import tree_sitter_java
    from tree_sitter import Language, Parser

    text = text.expandtabs(4)
    root = Parser(Language(tree_sitter_java.language())).parse(text.encode()).root_node
    if root.has_error:
        wrong = next(node for node in every(root) if node.is_error or node.is_missing)
        raise NotPortable(f"{name}:{line_of(wrong)}: error: this is not valid Java")
    return JavaFile(name, root, text.splitlines())


def source(node: Node) -> str:
    """Return the Java text of a node."""
    return (node.text or b"").decode(errors="replace")


def line_of(node: Node) -> int:
    """Return the line of a node, from 1."""
    return node.start_point[0] + 1


def field(node: Node, name: str) -> Node:
    """Return a child that the grammar requires."""
    found = node.child_by_field_name(name)
    assert found is not None, f"{node.type} without {name}"
    return found


def children(node: Node | None) -> list[Node]:
    """Return the named children, without comments."""
    return [] if node is None else [each for each in node.named_children if each.type not in COMMENTS]


def every(node: Node, kind: str | None = None) -> Iterator[Node]:
    """Yield a node and all below it, or those of a kind."""
    if kind is None or node.type == kind:
        yield node
    for child in node.children:
        yield from every(child, kind)


def classes(root: Node) -> Iterator[Node]:
    """Yield all classes, those inside another one before it."""
    for child in root.named_children:
        if child.type in _CLASSES:
            yield from classes(field(child, "body"))
            yield child
        elif child.type == "enum_body_declarations":
            yield from classes(child)


def modifiers(node: Node) -> set[str]:
    """Return the keywords in front of a declaration, such as ``static``."""
    found = next((each for each in node.children if each.type == "modifiers"), None)
    return {each.type for each in found.children} if found else set()


def marks(node: Node) -> dict[str, Node]:
    """Return the annotations of a declaration, such as ``@OPERATION``, by their names."""
    found = next((each for each in node.children if each.type == "modifiers"), None)
    return {
        source(field(each, "name")).rpartition(".")[2]: each
        for each in (found.named_children if found else ())
        if each.type in ("annotation", "marker_annotation")
    }


def annotation_text(annotation: Node, key: str) -> str | None:
    """Return the text of a value in an annotation: ``guard`` of ``@OPERATION(guard="ready")``."""
    for pair in every(annotation, "element_value_pair"):
        value = field(pair, "value")
        if source(field(pair, "key")) == key and value.type == "string_literal":
            return source(value)[1:-1]
    return None


def documentation(node: Node) -> str:
    """Return the first sentence of the Javadoc in front of a declaration; empty without one."""
    before = node.prev_named_sibling
    if before is None or before.type != "block_comment" or not source(before).startswith("/**"):
        return ""
    lines = (line.strip().lstrip("*").strip() for line in source(before)[3:-2].splitlines())
    text = ""
    for line in lines:
        if line.startswith(("@", "<")) or (text and not line):
            break
        text = f"{text} {line}".strip()
    return text.partition(". ")[0].rstrip(".").replace("\\", "").replace('"', "'")[:100]
