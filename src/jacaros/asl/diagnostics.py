"""Messages about a program: what is wrong, where, and what to do; and the list of their kinds."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, NamedTuple
from typing import Literal as OneOf

from jacaros.asl.source import Span
from jacaros.errors import JacarosError
from jacaros.excerpts import MOST, escaped, help_line, marked, printable

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
    help: str | None = None
    code: str = ""
    opened: Span | None = None

    def render(self, with_code: bool = False) -> str:
        """Return the message as printed: place, message (with its code, if wanted), excerpt with carets, help.

        Characters that a terminal would obey are escaped, and long lines are cut: see `jacaros.excerpts`.
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


class Kind(NamedTuple):
    """A kind of problem, as a list of rules shows it."""

    level: Severity
    meaning: str


KINDS: Final[dict[str, Kind]] = {
    "acting-condition": Kind("warning", "an internal action that acts or waits is asked whether it holds"),
    "action-in-context": Kind("error", "an internal action that acts or waits stands in a context"),
    "annotated-action": Kind("error", "an internal action has annotations"),
    "capital-constant": Kind("warning", "True, False or None are variables here"),
    "chained-relation": Kind("error", "two relations without an operator between them"),
    "changed-variable": Kind("warning", "a variable cannot get another value"),
    "comparison-without-value": Kind("warning", "a variable without a value is compared by =="),
    "condition-as-step": Kind("warning", "a condition stands where an action is expected"),
    "context-never-true": Kind("warning", "the condition of a plan contradicts itself"),
    "duplicate-label": Kind("error", "two different plans have one label"),
    "else-if": Kind("error", "'else if' is written elif"),
    "else-without-if": Kind("error", "'else' or 'elif' without an 'if' before it"),
    "empty-brackets": Kind("error", "round brackets with nothing in them"),
    "empty-clause": Kind("error", "a '.' or ';' with nothing before it"),
    "empty-step": Kind("error", "no step where one is expected"),
    "end-without-begin": Kind("error", "{ end } without a { begin ... }"),
    "event-never-happens": Kind("warning", "a plan for an event of beliefs that nothing causes"),
    "foreign-word": Kind("error", "a word of another language"),
    "formula-in-list": Kind("error", "a relation or another formula as an element of a list"),
    "include-circle": Kind("error", "files that include each other"),
    "include-not-found": Kind("error", "an included file that is not there"),
    "java-function": Kind("warning", "a function that is written in Java"),
    "mismatched-bracket": Kind("error", "a bracket is closed by another kind of bracket"),
    "misplaced-action": Kind("error", "an internal action outside of plans"),
    "missing-blank": Kind("error", "a final '.' that is read as part of the next word"),
    "missing-block": Kind("error", "a statement without its braces"),
    "missing-body": Kind("error", "no steps behind '<-'"),
    "missing-condition": Kind("error", "a statement without its condition in brackets"),
    "missing-context": Kind("error", "no condition behind ':'"),
    "missing-dot": Kind("error", "a clause without its final '.'"),
    "missing-semicolon": Kind("error", "two steps without ';' between them"),
    "missing-trigger": Kind("error", "a plan without its trigger"),
    "misspelt-annotation": Kind("warning", "an annotation of a label that is nearly one with a meaning"),
    "misspelt-belief": Kind("warning", "a belief that nobody makes, and nearly one that somebody makes"),
    "misspelt-word": Kind("error", "nearly a reserved word"),
    "narrow-handler": Kind("note", "plans for a failure that all have conditions"),
    "nested-too-deeply": Kind("error", "too many brackets in each other"),
    "no-effect": Kind("warning", "something in a project file that has no effect here"),
    "non-ascii-name": Kind("error", "a name with other letters than a to z"),
    "not-imported": Kind("note", "names that only running the Python code of the project can tell"),
    "ordered-atom": Kind("warning", "an atom is compared with a number"),
    "not-a-belief": Kind("error", "a clause that is neither belief, rule, goal nor plan"),
    "not-a-number": Kind("error", "arithmetic with something that is no number"),
    "not-a-step": Kind("error", "a term where a step is expected"),
    "organisation-library": Kind("warning", "a library for organisations, which are not supported"),
    "plan-never-selected": Kind("warning", "a plan behind one that is always taken before it"),
    "plan-too-large": Kind("warning", "a plan that Python cannot compile"),
    "prefixed-action": Kind("error", "an internal action with '~' or a namespace"),
    "reserved-word": Kind("error", "a reserved word as a name"),
    "second-body": Kind("error", "a plan with two '<-'"),
    "second-context": Kind("error", "a plan with two contexts"),
    "singleton-variable": Kind("warning", "a variable that occurs only once"),
    "tested-action": Kind("error", "an internal action behind '?'"),
    "trigger-in-body": Kind("error", "'+!', '-!' or '+?' as a step"),
    "too-many": Kind("warning", "how many more problems a file has; only the first 100 are printed"),
    "unclosed-block": Kind("error", "a { begin ... } without { end }"),
    "unclosed-bracket": Kind("error", "a bracket that is not closed"),
    "unclosed-comment": Kind("error", "a comment without its end"),
    "unclosed-string": Kind("error", "a string or quoted atom without its end"),
    "unexpected-end": Kind("error", "the file ends too early"),
    "unexpected-token": Kind("error", "something else is expected here"),
    "unknown-artifact-type": Kind("warning", "a type of artifacts that there is not"),
    "unknown-character": Kind("error", "a character that does not belong to the language"),
    "unknown-code": Kind("warning", "a comment ignores a code that there is not"),
    "unknown-directive": Kind("error", "a directive that there is not"),
    "unknown-goal": Kind("warning", "a goal that no plan is for"),
    "unknown-internal-action": Kind("warning", "an internal action that there is not"),
    "unknown-library": Kind("warning", "a library of another system that is not known here"),
    "unknown-message-type": Kind("warning", "a message type that only the robot's middleware may know"),
    "unknown-operation": Kind("warning", "an action that no artifact of the project offers"),
    "unknown-performative": Kind("warning", "nearly a performative"),
    "unknown-resource": Kind("warning", "a resource that no artifact of the project uses"),
    "unopened-bracket": Kind("error", "a closing bracket without an opening one"),
    "unreadable-file": Kind("error", "a file that is not there or no text"),
    "upper-case-functor": Kind("error", "a name with arguments that begins with an upper-case letter"),
    "wrong-arguments": Kind("warning", "an internal action with too few or too many arguments"),
    "wrong-belief-change": Kind("error", "a sign that does not change beliefs, or no belief behind it"),
    "wrong-directive": Kind("error", "a directive with wrong arguments"),
    "wrong-escape": Kind("error", "a backslash in a string before a character that it does not go with"),
    "wrong-goal": Kind("error", "something that cannot be a goal"),
    "wrong-label": Kind("error", "something that cannot be a label"),
    "wrong-mapping": Kind("error", "a mistake in a mapping file"),
    "wrong-world": Kind("error", "a mistake in a world file or a fault file"),
    "wrong-operator": Kind("error", "an operator of another language"),
    "wrong-project": Kind("error", "a mistake in a project file"),
    "wrong-separator": Kind("error", "',' in place of another sign"),
    "wrong-supervision": Kind("warning", "an invalid or misplaced annotation such as `within` or `retry`"),
    "wrong-tail": Kind("error", "the tail of a list or of annotations is no variable"),
    "wrong-trigger": Kind("error", "something that cannot trigger a plan"),
    "no-history": Kind("warning", "a condition asks with `ago` for a history that is not kept"),
    "wrong-needs": Kind("warning", "needs of a plan or goal that can never be met"),
    "wrong-urgency": Kind("warning", "an urgency of a plan that is no whole number from 0 on"),
}
"""All kinds, by code.  docs/reference/diagnostics.md shows an example of each.

The level is the usual one: what the thesis writes and Jason refuses is only a warning in programs of the thesis.
"""
