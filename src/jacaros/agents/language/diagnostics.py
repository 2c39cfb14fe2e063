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
from typing import Any, Final, NamedTuple
from typing import Literal as OneOf

from jacaros.runtime.errors import JacarosError
from jacaros.runtime.files.texts import MOST, escaped, help_line, marked, printable

# Source files and positions in them.


TEXT: Final = "<string>"
"""The name of a text that is not in a file."""


@dataclass(frozen=True)
class SourceFile:
    """The text of one file; ``name`` is what diagnostics show (a path, or `TEXT`)."""

    name: str
    text: str = field(repr=False)

    def __reduce__(self) -> tuple[Any, ...]:
        return SourceFile, (self.name, self.text)

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


class Fix(str):
    """A help that an editor can apply.

    Attributes:
        text: replaces the range `where`.
        where: None for the text that the diagnostic marks.
    """

    text: str = ""
    where: Span | None = None


def fix(help: str, text: str, where: Span | None = None) -> Fix:
    """Return a help with its edit: *text* replaces *where*, or the text that the diagnostic marks."""
    found = Fix(help)
    found.text, found.where = text, where
    return found


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

        Control characters are escaped, and long lines are cut: see `jacaros.runtime.files.texts`.
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
        at = self.span
        return "" if at is None else f"{escaped(at.file.name)}:{at.line}:{at.column}: "


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
        important = sorted(found, key=lambda each: _ORDER.index(each.severity))  # stable
        first = set(map(id, important[:MOST]))
        kept += [each for each in found if id(each) in first]
        if important[MOST:]:
            kept.append(_others(name, important[MOST:]))
    return kept


def _others(name: str, others: Sequence[Diagnostic]) -> Diagnostic:
    counts = [(level, sum(each.severity == level for each in others)) for level in _ORDER]
    rest = " and ".join(f"{count} more {level}{'s'[: count > 1]}" for level, count in counts if count)
    where = f" in {name}" if name else ""
    severity = others[0].severity
    return Diagnostic(severity, f"{rest}{where}", None, "fix these first, then check again", "too-many")


def render_all(diagnostics: Sequence[Diagnostic]) -> str:
    """Return all messages in the given order, separated by blank lines, limited as by `bounded`."""
    return "\n\n".join(diagnostic.render() for diagnostic in bounded(diagnostics))


class SourceError(JacarosError):
    """Raised for source files with errors. ``diagnostics`` holds all errors and warnings; ``str()`` shows them."""

    def __init__(self, diagnostics: Sequence[Diagnostic]) -> None:
        self.diagnostics = tuple(diagnostics)
        super().__init__(render_all(self.diagnostics))


class AslError(SourceError):
    """Raised for a program with errors."""


_CODES: Final[dict[Severity, str]] = {
    "error": """
        action-in-context annotated-action chained-relation duplicate-label else-if else-without-if
        empty-brackets empty-clause empty-step end-without-begin foreign-word formula-in-list
        include-circle include-not-found mismatched-bracket misplaced-action missing-blank
        missing-block missing-body missing-condition missing-context missing-dot missing-semicolon
        missing-trigger misspelt-word nested-too-deeply non-ascii-name not-a-belief not-a-number
        not-a-step prefixed-action reserved-word second-body second-context tested-action
        trigger-in-body unclosed-block unclosed-bracket unclosed-comment unclosed-string
        unexpected-end unexpected-token unknown-character unknown-directive unopened-bracket
        unreadable-file upper-case-functor wrong-belief-change wrong-directive wrong-escape
        wrong-goal wrong-label wrong-mapping wrong-operator wrong-project wrong-separator wrong-tail
        wrong-trigger wrong-world
    """,
    "warning": """
        acting-condition capital-constant changed-variable comparison-without-value
        condition-as-step context-never-true event-never-happens java-function loop-without-wait
        misspelt-annotation misspelt-belief missing-mark never-matches no-effect not-offered ordered-atom
        organisation-library
        plan-never-selected plan-too-large singleton-variable too-many unknown-artifact-type
        unknown-belief unknown-choice unknown-code unknown-goal unknown-internal-action unknown-library
        unknown-message-type unknown-operation unknown-performative unknown-property unknown-resource
        unbound-argument unfocused-artifact unused-handler unused-offer wrong-arguments wrong-needs
        wrong-supervision wrong-unit wrong-urgency
    """,
    "note": """
        goal-never-posted narrow-handler not-imported quoted-atom short-wait unawaited-value
    """,
}
"""The codes of diagnostics, by their usual level: what the thesis prints and Jason rejects is only a warning in programs of
the thesis. docs/reference/diagnostics.md says what each means, with an example.
"""
_ORDER: Final = tuple(_CODES)
LEVELS: Final[dict[str, Severity]] = {
    code: level for level, codes in _CODES.items() for code in codes.split()
}
"""The usual level of each code."""


def problem(code: str, message: str, span: Span | None, help: str | None = None) -> Diagnostic:
    """Return a diagnostic of a kind, at its usual level."""
    return Diagnostic(LEVELS[code], message, span, help, code)


def one_line(error: Exception) -> str:
    """Return the error without excerpt and help, with its location if it is in a file."""
    if isinstance(error, AslError) and error.diagnostics:
        wrong = error.diagnostics[0]
        in_file = wrong.span is not None and wrong.span.file.name != TEXT
        return f"{wrong.place()}{wrong.message}" if in_file else wrong.message
    lines = [line.strip() for line in str(error).splitlines() if line.strip()]
    return lines[0].removeprefix("error: ") if lines else type(error).__name__
