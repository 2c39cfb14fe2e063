"""Types of Java, as far as the Python code depends on them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from jacaros.porting.reading import children, field, source

if TYPE_CHECKING:
    from tree_sitter import Node

INTEGERS = frozenset({"int", "long", "short", "byte", "Integer", "Long", "Short", "Byte"})
FLOATS = frozenset({"double", "float", "Double", "Float"})
BOOLEANS = frozenset({"boolean", "Boolean"})
TEXTS = frozenset({"String", "char", "Character", "CharSequence", "StringBuilder", "StringBuffer"})
BUILDERS = frozenset({"StringBuilder", "StringBuffer"})
STACKS = frozenset({"Stack"})
LISTS = STACKS | {
    *("List", "ArrayList", "LinkedList", "Vector", "Collection", "Queue", "Deque", "ArrayDeque"),
    *("CopyOnWriteArrayList", "ConcurrentLinkedQueue", "LinkedBlockingQueue", "[]"),
}
MAPS = frozenset(
    {"Map", "HashMap", "TreeMap", "LinkedHashMap", "ConcurrentHashMap", "Hashtable", "SortedMap"}
)
SETS = frozenset({"Set", "HashSet", "TreeSet", "LinkedHashSet", "SortedSet"})
TERMS = frozenset(
    {"Term", "Literal", "Structure", "LiteralImpl", "NumberTerm", "StringTerm", "ListTerm", "Atom"}
)
AGENT = "AgentId"
ARTIFACT_ID = "ArtifactId"
OUT = "OpFeedbackParam"
PROPERTY = "ObsProperty"
LOGGER = "Logger"
LOCKS = frozenset({"Lock", "ReentrantLock"})


@dataclass(frozen=True, slots=True)
class JavaType:
    """A type: its name without package, and the types of its elements."""

    name: str = "?"
    elements: tuple[JavaType, ...] = ()

    @property
    def is_number(self) -> bool:
        """Whether it is a type of numbers."""
        return self.name in INTEGERS or self.name in FLOATS

    def element(self, index: int = -1) -> JavaType:
        """Return the type of its elements; for a map, 0 gives the keys."""
        return self.elements[index] if self.elements else UNKNOWN


UNKNOWN = JavaType()
INT, DOUBLE, BOOLEAN, STRING, VOID = map(JavaType, ("int", "double", "boolean", "String", "void"))


def type_of(node: Node | None, dimensions: int = 0) -> JavaType:
    """Return the type that a node of the tree names."""
    if node is None:
        return UNKNOWN
    if dimensions:
        return JavaType("[]", (type_of(node, dimensions - 1),))
    if node.type == "array_type":
        return type_of(field(node, "element"), source(field(node, "dimensions")).count("["))
    if node.type == "generic_type":
        name, *arguments = children(node)
        inner = children(arguments[0]) if arguments else []
        return JavaType(type_of(name).name, tuple(map(type_of, inner)))
    return JavaType(source(node).rpartition(".")[2])


def annotation_of(kind: JavaType, known: frozenset[str]) -> str:
    """Return the Python annotation of a parameter or result."""
    for names, annotation in (
        (INTEGERS, "int"),
        (FLOATS, "float"),
        (BOOLEANS, "bool"),
        (TEXTS, "str"),
        (SETS, "set[Any]"),
        (MAPS, "dict[Any, Any]"),
    ):
        if kind.name in names:
            return annotation
    if kind.name in LISTS:
        inner = annotation_of(kind.element(), known)
        return f"list[{'Any' if inner == 'object' else inner}]"
    if kind.name == "void":
        return "None"
    if kind.name == OUT:
        return "Out"
    return kind.name if kind.name in known else "object"


def default_of(kind: JavaType) -> str:
    """Return the value of a field of this type before the first assignment."""
    if kind.name in INTEGERS and kind.name.islower():
        return "0"
    if kind.name in FLOATS and kind.name.islower():
        return "0.0"
    return "False" if kind.name == "boolean" else "None"
