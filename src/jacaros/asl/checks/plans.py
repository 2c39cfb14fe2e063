"""Check for plans that can never be selected, and for handlers that drop more than you may expect.

>>> from jacaros.asl.loader import load_program
>>> program, _ = load_program("robot.asl", "+!go. +!go : near.")
>>> [each.message for each in never_selected(program, ByKind(program.plans), KnownActions({}))]
['unreachable plan: the plan at line 1 already handles all of these events']
"""

from collections.abc import Iterator, Sequence
from itertools import chain
from typing import Final

from jacaros.asl import nodes
from jacaros.asl.checks.actions import KnownActions
from jacaros.asl.checks.formulas import contradiction, is_true, labelled
from jacaros.asl.diagnostics import Diagnostic, problem
from jacaros.asl.slips import is_slip_of
from jacaros.asl.walk import ByKind, is_ground
from jacaros.suggestions import did_you_mean

_LABEL_WORDS: Final = ("atomic", "breakpoint", "all_unifs", "urgency", "needs", "policy", "within", "cleanup")


def never_selected(program: nodes.Program, found: ByKind, known: KnownActions) -> Iterator[Diagnostic]:
    """Warn of plans that an earlier plan makes unreachable.

    Programs that change their plans or select among them by their own rules are skipped.
    """
    changed = (nodes.PlanTerm, nodes.Variable)
    if not (
        any(known.of(call).changes_plans for call in found.of(nodes.InternalAction))
        or any(isinstance(change.operand, changed) for change in found.of(nodes.BeliefChange))
        or any(rule.head.functor == "select__option" for rule in found.of(nodes.Rule))
    ):
        yield from _shadowed(program.plans)


def _shadowed(plans: Sequence[nodes.Plan]) -> Iterator[Diagnostic]:
    taken = _Taken()
    for plan in plans:
        yield from _shadowed(plan.subplans)
        literal = plan.trigger.literal
        if isinstance(literal, nodes.Variable):
            continue
        before = taken.covering(plan.trigger, literal)
        if before is not None:
            if _is_made(plan):
                continue
            where = _where(before, plan)
            yield problem(
                "plan-never-selected",
                f"unreachable plan: the plan{where} already handles all of these events",
                plan.trigger.span,
                "give that plan a context, or move it after this one",
            )
        elif is_true(plan.context):
            taken.add(plan, literal)


class _Taken:
    """The plans that are always selected, indexed by the arguments that their triggers fix.

    A program may have thousands of plans for one event.
    """

    def __init__(self) -> None:
        self._number = 0
        # For each kind of event: the fixed arguments, and by their values the first such plan with its
        # number.
        self._plans: dict[object, dict[tuple[int, ...], dict[object, tuple[int, nodes.Plan]]]] = {}

    def add(self, plan: nodes.Plan, literal: nodes.Literal) -> None:
        """Add a plan, unless its trigger matches fewer events than its fixed arguments show."""
        annotations = literal.annotations
        if annotations is not None and not is_ground(annotations):
            return
        fixed: list[int] = []
        met: set[str] = set()
        for place, argument in enumerate(literal.arguments):
            if isinstance(argument, nodes.Variable):
                if argument.annotations is not None or argument.negated or argument.name in met:
                    return
                met.add(argument.name)
            elif is_ground(argument):
                fixed.append(place)
            else:
                return
        self._number += 1
        of_event = self._plans.setdefault(_event(plan.trigger, literal, annotations), {})
        by_values = of_event.setdefault(tuple(fixed), {})
        by_values.setdefault(_values(literal, fixed), (self._number, plan))

    def covering(self, trigger: nodes.Trigger, literal: nodes.Literal) -> nodes.Plan | None:
        """Return the first plan that handles every event that a trigger with this literal matches."""
        found: list[tuple[int, nodes.Plan]] = []
        for annotations in dict.fromkeys((None, literal.annotations)):
            for fixed, plans in self._plans.get(_event(trigger, literal, annotations), {}).items():
                plan = plans.get(_values(literal, fixed))
                if plan is not None:
                    found.append(plan)
        return min(found, key=lambda each: each[0])[1] if found else None


def _event(trigger: nodes.Trigger, literal: nodes.Literal, annotations: nodes.Annotations | None) -> object:
    kind = (trigger.operator, trigger.kind, literal.functor, len(literal.arguments))
    return (*kind, literal.negated, literal.namespace, annotations)


def _values(literal: nodes.Literal, places: Sequence[int]) -> object:
    return tuple([literal.arguments[place] for place in places])


def _is_made(plan: nodes.Plan) -> bool:
    """Return whether a directive made the plan: such plans have the place of the directive."""
    span = plan.span
    return span is not None and span.file.lines[span.line - 1][span.column - 1 :].startswith("{")


def _where(before: nodes.Plan, plan: nodes.Plan) -> str:
    if before.span is None or plan.span is None:
        return ""
    file = "" if before.span.file is plan.span.file else f" of {before.span.file.name}"
    return f" at line {before.span.line}{file}"


def contexts_never_true(found: ByKind) -> Iterator[Diagnostic]:
    """Warn of plans whose context contradicts itself."""
    for plan in found.of(nodes.Plan):
        why = None if plan.context is None else contradiction(plan.context)
        if plan.context is not None and why is not None:
            span = plan.context.span or plan.trigger.span
            yield problem("context-never-true", f"unreachable plan: {why}", span)


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
        literal = trigger.literal
        key = (trigger.kind, literal.namespace, literal.negated, literal.functor, len(literal.arguments))
        handlers.setdefault(key, []).append(plan)
    for plans in handlers.values():
        if not any(is_true(plan.context) for plan in plans):
            trigger = plans[-1].trigger
            yield problem(
                "narrow-handler",
                "if no context of these failure plans holds, the whole intention is dropped",
                trigger.span,
                "add a failure plan without a context; the failure is not passed to the goals further out",
            )


def wrong_labels(found: ByKind) -> Iterator[Diagnostic]:
    """Warn of misspelt annotations of labels, and of an ``urgency`` that is not a non-negative integer."""
    for item in chain.from_iterable(map(labelled, found.of(nodes.Plan))):
        meant = [word for word in _LABEL_WORDS if is_slip_of(item.functor, word)]
        if meant:
            message = f"label annotation `{item.functor}` has no meaning"
            yield problem("misspelt-annotation", message, item.span, did_you_mean(meant[:1]))
        elif item.functor == "urgency" and not _is_urgency(item):
            yield problem(
                "wrong-urgency",
                "urgency must be a non-negative integer; this one has no effect",
                item.span,
                "write a number, such as `urgency(10)`; the greatest goes first",
            )


def _is_urgency(item: nodes.Literal) -> bool:
    if len(item.arguments) != 1:
        return False
    argument = item.arguments[0]
    if isinstance(argument, nodes.Number):
        return argument.value >= 0 and float(argument.value).is_integer()
    # Its value is known only at run time.
    return isinstance(argument, nodes.Arithmetic)
