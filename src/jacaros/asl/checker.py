"""Warnings about programs that can be run but probably do not do what is meant."""

from collections.abc import Iterator, Sequence
from typing import Final

from jacaros.asl import nodes
from jacaros.asl.checks.actions import (
    KnownActions,
    acting_conditions,
    unknown_actions,
    unknown_performatives,
    wrong_arguments,
)
from jacaros.asl.checks.formulas import clauses
from jacaros.asl.checks.goals import goals_without_plan
from jacaros.asl.checks.plans import (
    contexts_never_true,
    misspelt_label_words,
    narrow_handlers,
    never_selected,
)
from jacaros.asl.checks.variables import singletons, vain_comparisons
from jacaros.asl.diagnostics import Diagnostic
from jacaros.asl.source import Span

_STYLE: Final = frozenset({"singleton-variable", "capital-constant", "narrow-handler"})
"""What need not be told each time a program is run."""


def check(program: nodes.Program, known: KnownActions, errors: Sequence[Diagnostic] = ()) -> list[Diagnostic]:
    """Warnings and notes about *program*, in the order of the text.

    Args:
        program: what could be read.
        known: the internal actions that it may use.
        errors: what is wrong in it.  Clauses with errors are passed over, and so are the checks that need all
            clauses, since what is missing may stand in those with errors.
    """
    wrong = [error.span for error in errors if error.span is not None]
    sound = [clause for clause in clauses(program) if not _holds_any(clause.span, wrong)]
    plans = [clause for clause in sound if isinstance(clause, nodes.Plan)]
    roots = (*sound, *(belief for belief in program.beliefs if not isinstance(belief, nodes.Rule)))
    found = [
        *unknown_actions(program, roots, known),
        *wrong_arguments(roots, known),
        *acting_conditions(roots, known),
        *unknown_performatives(roots),
        *contexts_never_true(plans),
        *misspelt_label_words(plans),
        *(warning for clause in sound for warning in _of_clause(clause)),
    ]
    if not errors:
        found += [*goals_without_plan(program), *never_selected(program), *narrow_handlers(program)]
    return sorted(dict.fromkeys(found), key=place)


def check_for_run(program: nodes.Program, known: KnownActions) -> list[Diagnostic]:
    """The warnings of `check` that are nearly always mistakes: what is a matter of style is left out."""
    return [warning for warning in check(program, known) if warning.code not in _STYLE]


def place(diagnostic: Diagnostic) -> tuple[str, int, int]:
    """What diagnostics are sorted by: file, line, column."""
    span = diagnostic.span
    return ("", 0, 0) if span is None else (span.file.name, span.line, span.column)


def _of_clause(clause: nodes.Plan | nodes.Rule) -> Iterator[Diagnostic]:
    yield from singletons(clause)
    yield from vain_comparisons(clause)


def _holds_any(span: Span | None, places: Sequence[Span]) -> bool:
    return span is not None and any(
        place.file is span.file and span.line <= place.line <= span.end_line for place in places
    )
