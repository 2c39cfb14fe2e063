"""Warnings about programs that run but probably do not do what you mean.

>>> from jacaros.agents.language.loader import load_program
>>> program, _ = load_program("robot.asl", "!start. +!start <- !leave.")
>>> [each.message for each in check(program, KnownActions({}))]
['no plan for `!leave/0`']
"""

import re
from bisect import bisect_left
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Final

from jacaros.agents.checks.annotations import wrong_labels, wrong_needs, wrong_supervision
from jacaros.agents.checks.flow import is_own
from jacaros.agents.checks.formulas import (
    Clause,
    is_true,
    ordered_atoms,
    singletons,
    singletons_of_facts,
    vain_comparisons,
)
from jacaros.agents.checks.goals import (
    KnownActions,
    acting_conditions,
    doubtful_values,
    goals_without_plan,
    signature,
    unknown_actions,
    unknown_performatives,
    wrong_arguments,
)
from jacaros.agents.checks.handlers import facts_for_goals, unused_handlers
from jacaros.agents.checks.loops import loops_without_wait
from jacaros.agents.checks.missed_events import missed_events
from jacaros.agents.checks.offers import misspelt_choices, wrong_announcements
from jacaros.agents.checks.unreachable import contexts_never_true, never_selected
from jacaros.agents.language import nodes
from jacaros.agents.language.diagnostics import LEVELS, Diagnostic, SourceFile, Span, problem
from jacaros.agents.language.lexer import Comment, Token, tokenize

# Comments that switch warnings off.
#
# p(X) :- q(Y).     // jacaros: ignore singleton-variable       for this line
# // jacaros: ignore singleton-variable                         on its own line: for the next clause or line
# // jacaros: ignore-file singleton-variable, missing-context   for the file
# `allow` means the same as `ignore`.
#
# Errors cannot be switched off. Text after ``(`` is a comment for the reader.


_ORDER: Final = re.compile(r"jacaros:\s*(?:ignore|allow)(?P<file>-file)?\b(?P<codes>[^(\n]*)")
_CODE: Final = re.compile(r"[A-Za-z][\w-]*")


class Suppressions:
    """The suppression comments of one file; ``unknown`` warns of unknown codes."""

    def __init__(self, file: SourceFile) -> None:
        self.unknown: list[Diagnostic] = []
        self._everywhere: set[str] = set()
        self._lines: list[tuple[range, frozenset[str]]] = []
        comments: list[Comment] = []
        if "jacaros:" in file.text:
            tokens = tokenize(file, lambda _: None, comments)
            for comment in comments:
                self._take(file, comment, tokens)

    def _take(self, file: SourceFile, comment: Comment, tokens: list[Token]) -> None:
        order = _ORDER.search(comment.text)
        if order is None:
            return
        codes = frozenset(_CODE.findall(order["codes"]))
        for code in sorted(codes - LEVELS.keys()):
            span = Span(file, comment.line, comment.column, comment.line, comment.column + len(comment.text))
            self.unknown.append(problem("unknown-code", f"unknown code `{code}`", span))
        if order["file"]:
            self._everywhere |= codes
        else:
            self._lines.append((_lines_of(comment, tokens), codes))

    def switch_off(self, diagnostic: Diagnostic) -> bool:
        """Return whether a comment suppresses *diagnostic*, which is about this file."""
        if diagnostic.severity == "error" or diagnostic.span is None:
            return False
        if diagnostic.code in self._everywhere:
            return True
        line = diagnostic.span.line
        return any(line in lines and diagnostic.code in codes for lines, codes in self._lines)


def _lines_of(comment: Comment, tokens: list[Token]) -> range:
    """Return the lines that a comment applies to: its own, or the clause that begins below, or the next line."""
    if any(token.line == comment.line and token.column < comment.column for token in tokens[:-2]):
        return range(comment.line, comment.line + 1)
    at = comment.next_token
    first = tokens[at].line
    last = first
    if at == 0 or tokens[at - 1].kind in (".", "}"):
        while tokens[at].kind not in (".", "end"):
            at += 1
        last = tokens[at].line
    return range(first, last + 1)


def wanted(diagnostics: Iterable[Diagnostic]) -> Iterator[Diagnostic]:
    """Yield the diagnostics that no comment of their files suppresses."""
    known: dict[str, Suppressions] = {}
    for diagnostic in diagnostics:
        if diagnostic.severity == "error" or diagnostic.span is None:
            yield diagnostic
            continue
        file = diagnostic.span.file
        orders = known.get(file.name)
        if orders is None:
            orders = known[file.name] = Suppressions(file)
        if not orders.switch_off(diagnostic):
            yield diagnostic


def check(program: nodes.Program, known: KnownActions, errors: Sequence[Diagnostic] = ()) -> list[Diagnostic]:
    """Return warnings and notes about *program*, in source order.

    Args:
        program: the clauses that could be parsed.
        known: the internal actions that the program may use.
        errors: its syntax errors. Clauses with errors are skipped. So are the checks that need all clauses,
            because a definition that seems to be missing may be in a clause with errors.
    """
    program = _sound(program, errors)
    warnings = _mistakes(program, known, errors)
    warnings += doubtful_values(program.found)
    clauses: list[tuple[Clause, nodes.ByKind]] = [*program.in_plans]
    clauses += [(each, nodes.ByKind(each)) for each in program.beliefs if isinstance(each, nodes.Rule)]
    for clause, found in clauses:
        if is_own(clause):
            warnings += singletons(clause, found)
    facts = (belief for belief in program.beliefs if not isinstance(belief, nodes.Rule))
    warnings += [*singletons_of_facts(facts, "belief"), *singletons_of_facts(program.goals, "goal")]
    if not errors:
        warnings += narrow_handlers(program)
    return sorted(dict.fromkeys(warnings), key=place)


def check_for_run(program: nodes.Program, known: KnownActions) -> list[Diagnostic]:
    """Return the warnings of `check` that nearly always point to a mistake; matters of style are left out."""
    # A copy: the run keeps the program, and does not need the index of its nodes.
    return sorted(dict.fromkeys(_mistakes(replace(program, walked={}), known, ())), key=place)


def _mistakes(program: nodes.Program, known: KnownActions, errors: Sequence[Diagnostic]) -> list[Diagnostic]:
    found = program.found
    warnings = [
        *unknown_actions(program, found, known),
        *wrong_arguments(found, known),
        *acting_conditions(found, known),
        *unknown_performatives(found, known),
        *contexts_never_true(found),
        *wrong_labels(program, found),
        *wrong_supervision(program.goals, found),
        *wrong_needs(found),
    ]
    equating: list[Clause] = [each for each in program.beliefs if isinstance(each, nodes.Rule)]
    for plan, below in program.in_plans:
        if any(each.operator in ("=", "==") for each in below.of(nodes.Relation)):
            equating.append(plan)
    warnings += ordered_atoms(filter(is_own, found.of(nodes.Relation)))
    for clause in filter(is_own, equating):
        warnings += vain_comparisons(clause)
    if not errors:
        warnings += goals_without_plan(program, found, known)
        warnings += never_selected(program, found, known)
        warnings += loops_without_wait(program, found, known)
        warnings += missed_events(program, found, known)
        warnings += [*wrong_announcements(program, found), *misspelt_choices(program, found)]
        warnings += [*unused_handlers(program, known), *facts_for_goals(program)]
    return warnings


def _sound(program: nodes.Program, errors: Sequence[Diagnostic]) -> nodes.Program:
    """Return the program without the plans and rules that have errors."""
    if not errors:
        return program
    wrong: dict[int, list[int]] = {}
    for error in errors:
        if error.span is not None:
            wrong.setdefault(id(error.span.file), []).append(error.span.line)
    for lines in wrong.values():
        lines.sort()
    beliefs = [
        each
        for each in program.beliefs
        if not isinstance(each, nodes.Rule) or not _holds_any(each.span, wrong)
    ]
    plans = [each for each in program.plans if not _holds_any(each.span, wrong)]
    return replace(program, beliefs=tuple(beliefs), plans=tuple(plans))


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


# Check for handlers that drop more than you may expect.


def narrow_handlers(program: nodes.Program) -> Iterator[Diagnostic]:
    """Note goals whose ``-!`` plans all have contexts: if none holds, the whole intention is dropped."""
    handlers: dict[object, list[nodes.Plan]] = {}
    for plan in program.plans:
        trigger = plan.trigger
        if trigger.operator != "-" or not trigger.kind:
            continue
        if isinstance(trigger.literal, nodes.Variable):
            if is_true(plan.context):
                return
            continue
        handlers.setdefault((trigger.kind, signature(trigger.literal)), []).append(plan)
    for plans in handlers.values():
        if not any(is_true(plan.context) for plan in plans):
            trigger = plans[-1].trigger
            yield problem(
                "narrow-handler",
                "if no context of these failure plans holds, the whole intention is dropped",
                trigger.span,
                "add a failure plan without a context; the failure is not passed to the goals further out",
            )
