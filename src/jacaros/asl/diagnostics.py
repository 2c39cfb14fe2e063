"""Messages about a program: what is wrong, where, and what to do."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal as OneOf

from jacaros.asl.source import Span
from jacaros.errors import JacarosError
from jacaros.excerpts import MOST, escaped, marked, printable

Severity = OneOf["error", "warning", "note"]
"""An error refuses the program; a warning is nearly always a mistake; a note is worth knowing."""


@dataclass(frozen=True, slots=True)
class Diagnostic:
    """One message about a program text; ``span`` is None when no single place is to blame.

    ``code`` names the kind of the problem; docs/reference/diagnostics.md lists them.  ``opened`` is the bracket that is
    not closed.
    """

    severity: Severity
    message: str
    span: Span | None = None
    hint: str | None = None
    code: str = ""
    opened: Span | None = None

    def render(self, with_code: bool = False) -> str:
        """Return the message as printed: place, message (with its code, if wanted), excerpt with carets, hint.

        Characters that a terminal would obey are escaped, and long lines are cut: see `jacaros.excerpts`.
        """
        code = f" [{self.code}]" if with_code and self.code else ""
        lines = [f"{self.place()}{self.severity}: {printable(self.message)}{code}"]
        if self.span is not None:
            if self.opened is not None and self.opened.line != self.span.line:
                lines.extend(excerpt(self.opened))
            lines.extend(excerpt(self.span))
        if self.hint is not None:
            lines.append(f"hint: {printable(self.hint)}")
        return "\n".join(lines)

    def place(self) -> str:
        """``file:line:column: ``, or nothing without a place."""
        if self.span is None:
            return ""
        return f"{escaped(self.span.file.name)}:{self.span.line}:{self.span.column}: "


def excerpt(span: Span) -> list[str]:
    """The first line of *span* and a line of carets under the part that is meant."""
    lines = span.file.lines
    if not 1 <= span.line <= len(lines):
        return []
    text = lines[span.line - 1]
    end = span.end_column if span.end_line == span.line else len(text) + 1
    number = str(span.line)
    shown, carets = marked(text, span.column, min(end, len(text) + 1))
    return [f"  {number} | {shown}", f"  {' ' * len(number)} | {carets}"]


def bounded(diagnostics: Sequence[Diagnostic]) -> list[Diagnostic]:
    """Return the diagnostics, at most `MOST` of each file; one more per file states the number of the others.

    Errors are kept before warnings, warnings before notes.
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
    told = " and ".join(f"{count} more {level}{'s'[: count > 1]}" for level, count in counts if count)
    where = f" in {name}" if name else ""
    severity = others[0].severity
    return Diagnostic(severity, f"{told}{where}", None, "correct the first ones, and check again", "too-many")


def render_all(diagnostics: Sequence[Diagnostic]) -> str:
    """Return all messages in the order given, a blank line between two; of very many only the first ones."""
    return "\n\n".join(diagnostic.render() for diagnostic in bounded(diagnostics))


class AslError(JacarosError):
    """A program with errors.  ``diagnostics`` holds all of them (and the warnings), ``str()`` shows them."""

    def __init__(self, diagnostics: Sequence[Diagnostic]) -> None:
        self.diagnostics = tuple(diagnostics)
        super().__init__(render_all(self.diagnostics))
