"""What the translation of a method knows, and the Python expressions that it gives."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from jacaros.porting.model import JavaClass, Method, local_name
from jacaros.porting.types import UNKNOWN, JavaType

if TYPE_CHECKING:
    from tree_sitter import Node

ATOM, AWAIT, UNARY, TIMES, PLUS, SHIFT, BITS, COMPARE, NOT, AND, OR, CHOICE = range(16, 4, -1)
"""How tightly the operators of Python bind."""


class Unported(Exception):
    """A part of the Java code that has no translation."""

    def __init__(self, node: Node) -> None:
        super().__init__(node.type)
        self.node = node


@dataclass(frozen=True, slots=True)
class Py:
    """A Python expression.

    Attributes:
        text: the expression; the name of an observable property for `PROPERTY`.
        type: its type in Java.
        tight: how tightly its operator binds.
        where: for an observable property, the values that select it.
    """

    text: str
    type: JavaType = UNKNOWN
    tight: int = ATOM
    where: str = ""

    def within(self, tight: int) -> str:
        """Return the text for use beside an operator that binds like this."""
        return self.text if self.tight >= tight else f"({self.text})"

    @property
    def atom(self) -> str:
        """The text for use in front of a dot or bracket."""
        return self.within(ATOM)


@dataclass(slots=True)
class Scope:
    """A method that is translated.

    Attributes:
        of: its class.
        method: the method, or None for initial values of fields.
        variables: parameters and local variables by their Java names; None for one that is not ported.
        before: statements that have to run before the current one.
        after: statements that have to run after it.
    """

    of: JavaClass
    method: Method | None = None
    variables: dict[str, Py | None] = field(default_factory=dict)
    before: list[str] = field(default_factory=list)
    after: list[str] = field(default_factory=list)
    in_class_body: bool = False

    def declare(self, name: str, kind: JavaType) -> str:
        """Add a local variable; return its name in Python."""
        python = local_name(name)
        self.variables[name] = Py(python, kind)
        return python

    @property
    def can_wait(self) -> bool:
        """Whether ``await`` is possible."""
        return self.method is not None and self.method.pauses
