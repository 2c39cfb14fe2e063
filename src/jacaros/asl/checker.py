"""Warnings about programs that run but probably do not do what you mean.

>>> from jacaros.asl.loader import load_program
>>> program, _ = load_program("robot.asl", "!start. +!start <- !leave.")
>>> [each.message for each in check(program, KnownActions({}))]
['no plan for `!leave/0`']
"""

from bisect import bisect_left
from collections.abc import Mapping, Sequence

from jacaros.asl import nodes
from jacaros.asl.checks.actions import (
    KnownActions,
    acting_conditions,
    doubtful_values,
    unknown_actions,
    unknown_performatives,
    wrong_arguments,
)
from jacaros.asl.checks.formulas import clauses as clauses_of
from jacaros.asl.checks.goals import goals_without_plan
from jacaros.asl.checks.needs import wrong_needs
from jacaros.asl.checks.plans import (
    contexts_never_true,
    narrow_handlers,
    never_selected,
    wrong_labels,
)
from jacaros.asl.checks.supervision import wrong_supervision
from jacaros.asl.checks.variables import singletons, singletons_of_facts, vain_comparisons
from jacaros.asl.diagnostics import Diagnostic
from jacaros.asl.source import Span
from jacaros.asl.walk import ByKind


def check(program: nodes.Program, known: KnownActions, errors: Sequence[Diagnostic] = ()) -> list[Diagnostic]:
    """Return warnings and notes about *program*, in source order.

    Args:
        program: the clauses that could be parsed.
        known: the internal actions that the program may use.
        errors: its syntax errors. Clauses with errors are skipped. So are the checks that need all clauses,
            because a definition that seems to be missing may be in a clause with errors.
    """
    warnings = _mistakes(program, known, errors)
    warnings += doubtful_values(ByKind(*_sound(program, errors)))
    for clause in _sound(program, errors):
        warnings += singletons(clause)
    facts = (belief for belief in program.beliefs if not isinstance(belief, nodes.Rule))
    warnings += [*singletons_of_facts(facts, "belief"), *singletons_of_facts(program.goals, "goal")]
    if not errors:
        warnings += narrow_handlers(program)
    return sorted(dict.fromkeys(warnings), key=place)


def check_for_run(program: nodes.Program, known: KnownActions) -> list[Diagnostic]:
    """Return the warnings of `check` that nearly always point to a mistake; matters of style are left out."""
    return sorted(dict.fromkeys(_mistakes(program, known, ())), key=place)


def _mistakes(program: nodes.Program, known: KnownActions, errors: Sequence[Diagnostic]) -> list[Diagnostic]:
    clauses = _sound(program, errors)
    facts = [belief for belief in program.beliefs if not isinstance(belief, nodes.Rule)]
    # One walk for all checks: a program may have many thousands of beliefs.
    found = ByKind(*facts, *clauses)
    warnings = [
        *unknown_actions(program, found, known),
        *wrong_arguments(found, known),
        *acting_conditions(found, known),
        *unknown_performatives(found, known),
        *contexts_never_true(found),
        *wrong_labels(found),
        *wrong_supervision(program.goals, found),
        *wrong_needs(found),
    ]
    for clause in clauses:
        warnings += vain_comparisons(clause)
    if not errors:
        warnings += [*goals_without_plan(program, found, known), *never_selected(program, found, known)]
    return warnings


def _sound(program: nodes.Program, errors: Sequence[Diagnostic]) -> list[nodes.Plan | nodes.Rule]:
    """Return the plans and rules without errors."""
    wrong: dict[int, list[int]] = {}
    for error in errors:
        if error.span is not None:
            wrong.setdefault(id(error.span.file), []).append(error.span.line)
    for lines in wrong.values():
        lines.sort()
    return [clause for clause in clauses_of(program) if not _holds_any(clause.span, wrong)]


def place(diagnostic: Diagnostic) -> tuple[str, int, int]:
    """Sort key of diagnostics: file, line, column."""
    span = diagnostic.span
    return ("", 0, 0) if span is None else (span.file.name, span.line, span.column)


def _holds_any(span: Span | None, wrong: Mapping[int, Sequence[int]]) -> bool:
    """Return whether a line with errors (sorted, by file) belongs to the clause."""
    lines = wrong.get(id(span.file)) if span is not None else None
    if span is None or lines is None:
        return False
    at = bisect_left(lines, span.line)
    return at < len(lines) and lines[at] <= span.end_line
