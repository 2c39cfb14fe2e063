"""Messages about a program: what is wrong, where, and what to do."""

from dataclasses import dataclass
from typing import Literal as OneOf

from jacaros.asl.source import Span

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
        """The message as people read it: place, message (with its code, if wanted), excerpt with carets, hint."""
        code = f" [{self.code}]" if with_code and self.code else ""
        lines = [f"{self.place()}{self.severity}: {self.message}{code}"]
        if self.span is not None:
            if self.opened is not None and self.opened.line != self.span.line:
                lines.extend(excerpt(self.opened))
            lines.extend(excerpt(self.span))
        if self.hint is not None:
            lines.append(f"hint: {self.hint}")
        return "\n".join(lines)

    def place(self) -> str:
        """``file:line:column: ``, or nothing without a place."""
        if self.span is None:
            return ""
        return f"{self.span.file.name}:{self.span.line}:{self.span.column}: "


def excerpt(span: Span) -> list[str]:
    """The first line of *span* and a line of carets under the part that is meant."""
    lines = span.file.lines
    if not 1 <= span.line <= len(lines):
        return []
    text = lines[span.line - 1]
    end = span.end_column if span.end_line == span.line else len(text) + 1
    # Tabs are repeated below, so that the carets stand under the same stretch at any width of a tab.
    indent = "".join("\t" if char == "\t" else " " for char in text[: span.column - 1])
    number = str(span.line)
    carets = "^" * max(1, min(end, len(text) + 1) - span.column)
    return [f"  {number} | {text}", f"  {' ' * len(number)} | {indent}{carets}"]


def render_all(diagnostics: "list[Diagnostic] | tuple[Diagnostic, ...]") -> str:
    """All messages in the order of their places, a blank line between two."""
    return "\n\n".join(diagnostic.render() for diagnostic in diagnostics)
