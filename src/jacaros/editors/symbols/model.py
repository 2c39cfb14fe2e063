"""What a position in a program means, in plain data: symbols, their occurrences, and what editors show of them.

Lines and columns count from 1, columns in characters of the text, and the end of a range is exclusive, as in
`jacaros.agents.language.diagnostics.Span`.
"""

from dataclasses import dataclass
from typing import Literal as OneOf
from typing import NamedTuple

from jacaros.agents.language.diagnostics import Span
from jacaros.runtime.errors import JacarosError

Kind = OneOf["belief", "goal", "plan", "operation", "internal action", "variable"]
"""Observable properties and test goals are beliefs. A plan is named by its label."""
Role = OneOf["defines", "adds", "removes", "asks", "handles", "calls", "tells", "offers", "mentions"]
"""What is done where a name occurs: a fact or rule *defines* a belief, a trigger *handles* a goal, a step *calls* it."""


class Position(NamedTuple):
    """A place between two characters of a text."""

    line: int
    column: int


class Symbol(NamedTuple):
    """What a name means.

    Attributes:
        kind: its kind.
        name: as written, without quotes; a strongly negated belief has the name of the other one.
        arity: number of arguments; 0 for plans, variables and internal actions.
        scope: the namespace of a belief or goal; the place of the clause of a variable; otherwise empty.
    """

    kind: Kind
    name: str
    arity: int = 0
    scope: str = ""

    def __str__(self) -> str:
        marked = (
            f"!{self.name}" if self.kind == "goal" else f"@{self.name}" if self.kind == "plan" else self.name
        )
        return f"{marked}/{self.arity}" if self.kind in ("belief", "goal", "operation") else marked


class Occurrence(NamedTuple):
    """A place where a name is written.

    Attributes:
        symbol: what it means.
        role: what is done there.
        span: the name alone.
        clause: the whole clause around it.
        arguments: names of the variables that are its arguments; empty texts for others.
    """

    symbol: Symbol
    role: Role
    span: Span
    clause: Span
    arguments: tuple[str, ...] = ()


class Edit(NamedTuple):
    """A range of a text and its replacement."""

    span: Span
    text: str


@dataclass(frozen=True, slots=True)
class Completion:
    """A proposal for the text at the cursor.

    Attributes:
        label: what the list shows, such as ``battery(Level)``.
        kind: a kind of symbol, or ``keyword``, ``annotation``, ``property``, ``key``, ``value``.
        insert: the text that replaces `replaces`; a snippet (``${1:Level}``, ``$0``) as in the Language Server Protocol.
        replaces: the part of a name before the cursor.
        detail: one line: where it comes from.
        documentation: Markdown.
        rank: the smaller, the higher in the list.
    """

    label: str
    kind: str
    insert: str
    replaces: Span
    detail: str = ""
    documentation: str = ""
    rank: int = 0


class Hover(NamedTuple):
    """What a name means, as Markdown."""

    text: str
    span: Span


class Hint(NamedTuple):
    """A note inside a line: the name of a parameter before an argument (``x:``), or a unit after it (``m``)."""

    at: Position
    text: str
    kind: OneOf["parameter", "unit"]
    tooltip: str = ""


class RenameRefused(JacarosError):
    """A name cannot be changed, or not to the wanted one; ``help`` says what can be done."""

    def __init__(self, message: str, help: str) -> None:
        super().__init__(message)
        self.message, self.help = message, help
