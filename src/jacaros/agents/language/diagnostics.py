"""Diagnostics: what is wrong in a program, where, and how to fix it; and the list of their codes.

>>> from jacaros.agents.language.diagnostics import SourceFile
>>> span = Span(SourceFile("robot.asl", "at(home"), 1, 3, 1, 4)
>>> print(problem("unclosed-bracket", "unclosed `(`", span, "close it with `)`").render(with_code=True))
robot.asl:1:3: error: unclosed `(` [unclosed-bracket]
  1 | at(home
    |   ^
  = help: close it with `)`
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Final, NamedTuple
from typing import Literal as OneOf

from jacaros.errors import JacarosError
from jacaros.files.texts import MOST, escaped, help_line, marked, printable

# Source files and positions in them.


TEXT: Final = "<string>"
"""The name of a text that is not in a file."""


@dataclass(frozen=True)
class SourceFile:
    """The text of one file; ``name`` is what diagnostics show (a path, or `TEXT`)."""

    name: str
    text: str = field(repr=False)

    @cached_property
    def lines(self) -> tuple[str, ...]:
        """The lines without their ends; only a line feed (optionally after a carriage return) ends a line."""
        return tuple(line.removesuffix("\r") for line in self.text.split("\n"))


class Span(NamedTuple):
    """A range of a source file: lines and columns count from 1, the end column is exclusive.

    A named tuple because a program has thousands of them, and these are created three times as fast as instances of a
    frozen dataclass.
    """

    file: SourceFile
    line: int
    column: int
    end_line: int
    end_column: int

    def to(self, other: "Span") -> "Span":
        """Return the range from the beginning of this one to the end of *other*."""
        return Span(self.file, self.line, self.column, other.end_line, other.end_column)


Severity = OneOf["error", "warning", "note"]
"""Errors reject the program; warnings are nearly always mistakes; notes are worth knowing."""


@dataclass(frozen=True, slots=True)
class Diagnostic:
    """One message about a program text; ``span`` is None if no single place is at fault.

    ``code`` is the kind of problem; docs/reference/diagnostics.md lists them. ``opened`` is the bracket that is not
    closed.
    """

    severity: Severity
    message: str
    span: Span | None = None
    help: str | None = None
    code: str = ""
    opened: Span | None = None

    def render(self, with_code: bool = False) -> str:
        """Return the message as printed: location, message (with its code, if wanted), excerpt with carets, help.

        Control characters are escaped, and long lines are cut: see `jacaros.files.texts`.
        """
        code = f" [{self.code}]" if with_code and self.code else ""
        lines = [f"{self.place()}{self.severity}: {printable(self.message)}{code}"]
        if self.span is not None:
            if self.opened is not None and self.opened.line != self.span.line:
                lines.extend(excerpt(self.opened))
            lines.extend(excerpt(self.span))
        if self.help is not None:
            lines.append(help_line(self.help))
        return "\n".join(lines)

    def place(self) -> str:
        """Return ``file:line:column: ``, or an empty string without a span."""
        if self.span is None:
            return ""
        return f"{escaped(self.span.file.name)}:{self.span.line}:{self.span.column}: "


def excerpt(span: Span) -> list[str]:
    """Return the first line of *span*, and a line of carets under the marked part."""
    lines = span.file.lines
    if not 1 <= span.line <= len(lines):
        return []
    text = lines[span.line - 1]
    end = span.end_column if span.end_line == span.line else len(text) + 1
    number = str(span.line)
    shown, carets = marked(text, span.column, min(end, len(text) + 1))
    return [f"  {number} | {shown}", f"  {' ' * len(number)} | {carets}"]


def bounded(diagnostics: Sequence[Diagnostic]) -> list[Diagnostic]:
    """Return the diagnostics, at most `MOST` per file, and one more that counts the rest.

    Errors are kept before warnings, and warnings before notes.
    """
    if len(diagnostics) <= MOST:
        return list(diagnostics)
    files: dict[str, list[Diagnostic]] = {}
    for each in diagnostics:
        files.setdefault("" if each.span is None else each.span.file.name, []).append(each)
    kept: list[Diagnostic] = []
    for name, found in files.items():
        important = sorted(found, key=lambda each: _LEVELS.index(each.severity))  # stable
        first = set(map(id, important[:MOST]))
        kept += [each for each in found if id(each) in first]
        if important[MOST:]:
            kept.append(_others(name, important[MOST:]))
    return kept


_LEVELS = ("error", "warning", "note")


def _others(name: str, others: Sequence[Diagnostic]) -> Diagnostic:
    counts = [(level, sum(each.severity == level for each in others)) for level in _LEVELS]
    rest = " and ".join(f"{count} more {level}{'s'[: count > 1]}" for level, count in counts if count)
    where = f" in {name}" if name else ""
    severity = others[0].severity
    return Diagnostic(severity, f"{rest}{where}", None, "fix these first, then check again", "too-many")


def render_all(diagnostics: Sequence[Diagnostic]) -> str:
    """Return all messages in the given order, separated by blank lines, limited as by `bounded`."""
    return "\n\n".join(diagnostic.render() for diagnostic in bounded(diagnostics))


class AslError(JacarosError):
    """Raised for a program with errors. ``diagnostics`` holds all errors and warnings; ``str()`` shows them."""

    def __init__(self, diagnostics: Sequence[Diagnostic]) -> None:
        self.diagnostics = tuple(diagnostics)
        super().__init__(render_all(self.diagnostics))


class Kind(NamedTuple):
    """The level and meaning of a diagnostic code."""

    level: Severity
    meaning: str


KINDS: Final[dict[str, Kind]] = {
    "acting-condition": Kind("warning", "an internal action that acts or waits is used as a condition"),
    "action-in-context": Kind("error", "an internal action that acts or waits is in a context"),
    "annotated-action": Kind("error", "an internal action has annotations"),
    "capital-constant": Kind("warning", "`True`, `False` or `None`, which are variables here"),
    "chained-relation": Kind("error", "chained relations, such as `1 < X < 5`"),
    "changed-variable": Kind("warning", "an assignment to a variable that already has a value"),
    "comparison-without-value": Kind("warning", "a comparison with a variable that has no value"),
    "condition-as-step": Kind("warning", "a condition where an action is expected"),
    "context-never-true": Kind("warning", "a context that contradicts itself"),
    "duplicate-label": Kind("error", "two different plans with the same label"),
    "else-if": Kind("error", "`else if` instead of `elif`"),
    "else-without-if": Kind("error", "`else` or `elif` without `if`"),
    "empty-brackets": Kind("error", "empty round brackets"),
    "empty-clause": Kind("error", "`.` or `;` with nothing before it"),
    "empty-step": Kind("error", "a missing step"),
    "end-without-begin": Kind("error", "`{ end }` without `{ begin ... }`"),
    "event-never-happens": Kind("warning", "a plan for a belief event that nothing causes"),
    "foreign-word": Kind("error", "a keyword of another language"),
    "formula-in-list": Kind("error", "a relation or another formula as an element of a list"),
    "include-circle": Kind("error", "files that include each other"),
    "include-not-found": Kind("error", "an included file that does not exist"),
    "java-function": Kind("warning", "a function written in Java"),
    "mismatched-bracket": Kind("error", "a bracket closed by another kind of bracket"),
    "misplaced-action": Kind("error", "an internal action outside a plan"),
    "missing-blank": Kind("error", "a final `.` that is read as part of the next word"),
    "missing-block": Kind("error", "a statement without its braces"),
    "missing-body": Kind("error", "no steps after `<-`"),
    "missing-condition": Kind("error", "a statement without its condition"),
    "missing-context": Kind("error", "no condition after `:`"),
    "missing-dot": Kind("error", "a clause without its final `.`"),
    "missing-semicolon": Kind("error", "two steps without `;` between them"),
    "missing-trigger": Kind("error", "a plan without its trigger"),
    "misspelt-annotation": Kind("warning", "a label annotation that looks like a misspelt one"),
    "misspelt-belief": Kind("warning", "a belief that nothing adds, with a name close to one that is added"),
    "misspelt-word": Kind("error", "a misspelt reserved word"),
    "narrow-handler": Kind("note", "failure plans that all have contexts"),
    "nested-too-deeply": Kind("error", "brackets nested too deeply"),
    "no-effect": Kind("warning", "something in a project file that has no effect"),
    "non-ascii-name": Kind("error", "a name with letters other than a to z"),
    "not-imported": Kind("note", "names that only running the project's Python code can reveal"),
    "ordered-atom": Kind("warning", "an atom compared with a number"),
    "not-a-belief": Kind("error", "a clause that is not a belief, rule, goal or plan"),
    "not-a-number": Kind("error", "arithmetic with something that is not a number"),
    "not-a-step": Kind("error", "a term where a step is expected"),
    "organisation-library": Kind("warning", "a library for organisations, which are not supported"),
    "plan-never-selected": Kind("warning", "an unreachable plan: an earlier one is always selected"),
    "plan-too-large": Kind("warning", "a plan that is too large for Python to compile"),
    "prefixed-action": Kind("error", "an internal action with `~` or a namespace"),
    "reserved-word": Kind("error", "a reserved word used as a name"),
    "second-body": Kind("error", "a plan with two `<-`"),
    "second-context": Kind("error", "a plan with two contexts"),
    "singleton-variable": Kind("warning", "a variable that occurs only once"),
    "tested-action": Kind("error", "an internal action after `?`"),
    "trigger-in-body": Kind("error", "`+!`, `-!` or `+?` as a step"),
    "too-many": Kind("warning", "the number of further problems; only the first 100 per file are printed"),
    "unclosed-block": Kind("error", "a { begin ... } without { end }"),
    "unclosed-bracket": Kind("error", "a bracket that is not closed"),
    "unclosed-comment": Kind("error", "a comment that is not closed"),
    "unclosed-string": Kind("error", "a string or quoted atom that is not closed"),
    "unexpected-end": Kind("error", "an unexpected end of the file"),
    "unexpected-token": Kind("error", "an unexpected token"),
    "unknown-artifact-type": Kind("warning", "an unknown artifact type"),
    "unknown-character": Kind("error", "a character that is not part of the language"),
    "unknown-code": Kind("warning", "a comment that ignores an unknown code"),
    "unknown-directive": Kind("error", "an unknown directive"),
    "unknown-goal": Kind("warning", "a goal without a plan"),
    "unknown-internal-action": Kind("warning", "an unknown internal action"),
    "unknown-library": Kind("warning", "an unknown library of another system"),
    "unknown-message-type": Kind("warning", "a message type that only the robot's middleware may know"),
    "unknown-operation": Kind("warning", "an action that no artifact of the project provides"),
    "unknown-performative": Kind("warning", "a misspelt performative"),
    "unknown-resource": Kind("warning", "a resource that no artifact of the project uses"),
    "unopened-bracket": Kind("error", "a closing bracket without an opening one"),
    "unreadable-file": Kind("error", "a file that does not exist or is not text"),
    "upper-case-functor": Kind("error", "a name with arguments that begins with an upper-case letter"),
    "wrong-arguments": Kind("warning", "an internal action with too few or too many arguments"),
    "wrong-belief-change": Kind("error", "an operator that does not change beliefs, or no belief after it"),
    "wrong-directive": Kind("error", "a directive with invalid arguments"),
    "short-wait": Kind("note", "a wait of less than 10 ms"),
    "quoted-atom": Kind("note", "a quoted atom that is printed"),
    "wrong-escape": Kind("error", "an invalid escape in a string"),
    "wrong-goal": Kind("error", "something that cannot be a goal"),
    "wrong-label": Kind("error", "something that cannot be a label"),
    "wrong-mapping": Kind("error", "an error in a mapping file"),
    "wrong-world": Kind("error", "an error in a world file or a fault file"),
    "wrong-operator": Kind("error", "an operator of another language"),
    "wrong-project": Kind("error", "an error in a project file"),
    "wrong-separator": Kind("error", "`,` where another separator is expected"),
    "wrong-supervision": Kind("warning", "an invalid or misplaced annotation such as `within` or `retry`"),
    "wrong-tail": Kind("error", "a tail of a list or of annotations that is not a variable"),
    "wrong-trigger": Kind("error", "something that cannot be a trigger"),
    "wrong-needs": Kind("warning", "needs of a plan or goal that can never be met"),
    "wrong-urgency": Kind("warning", "an urgency that is not a non-negative integer"),
}
"""All diagnostic codes. docs/reference/diagnostics.md shows an example of each.

The level is the usual one: what the thesis prints and Jason rejects is only a warning in programs of the thesis.
"""


def problem(code: str, message: str, span: Span | None, help: str | None = None) -> Diagnostic:
    """Return a diagnostic of a kind, at its usual level."""
    return Diagnostic(KINDS[code].level, message, span, help, code)
