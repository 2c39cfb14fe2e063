"""Check for plans that can never be selected, because of their own context or because of an earlier plan.

>>> from jacaros.agents.language.loader import load_program
>>> program, _ = load_program("robot.asl", "+!go(X) : X > 3. +!go(X) : X > 5 & near.")
>>> [each.message for each in never_selected(program, ByKind(program.plans), KnownActions({}))]
['unreachable plan: if its context holds, that of the plan at line 1 holds, too, and is tried first']
"""

from collections.abc import Iterator, Mapping, Sequence
from typing import Final

from jacaros.agents.checks.flow import is_own
from jacaros.agents.checks.formulas import conditions, contradiction, implies, is_true
from jacaros.agents.checks.goals import KnownActions, signature
from jacaros.agents.language import nodes
from jacaros.agents.language.diagnostics import Diagnostic, Span, problem
from jacaros.agents.language.nodes import ByKind, is_ground, names_in, parts_of, rebuilt


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
    taken, narrower = _Taken(), _Conditional()
    own = {getattr(each.trigger.literal, "functor", "") for each in plans if is_own(each)}
    for plan in plans:
        if plan.subplans:
            yield from _shadowed(plan.subplans)
        literal = plan.trigger.literal
        if isinstance(literal, nodes.Variable) or literal.functor not in own:
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
        elif (stronger := narrower.covering(plan)) is not None:
            yield problem(
                "plan-never-selected",
                f"unreachable plan: if its context holds, that of the plan{_where(stronger, plan)} holds, too, and is "
                "tried first",
                plan.trigger.span,
                "move it before that plan, or change one of the contexts",
            )
        else:
            narrower.add(plan)


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


_MOST: Final = 50
"""Maximum number of plans for one event that a plan is compared with."""


class _Conditional:
    """Plans with contexts, by the events that they are for."""

    def __init__(self) -> None:
        self._plans: dict[object, list[nodes.Plan]] = {}

    def add(self, plan: nodes.Plan) -> None:
        """Add a plan, unless its context may differ each time it is evaluated."""
        literal, context = plan.trigger.literal, plan.context
        assert isinstance(literal, nodes.Literal)
        found = ByKind(context)
        if (
            context is None
            or found.of(nodes.InternalAction, nodes.FunctionCall)
            or plan.goal_condition is not None
        ):
            return
        bound = names_in(literal, *(part for part in parts_of(context) if part not in _denied(found)))
        if not all(name in bound for name in names_in(*_denied(found))):  # `not p(X)`: for no X
            return
        before = self._plans.setdefault(_event(plan.trigger, literal, literal.annotations), [])
        if len(before) < _MOST:
            before.append(plan)

    def covering(self, plan: nodes.Plan) -> nodes.Plan | None:
        """Return the first plan whose context holds whenever that of *plan* does, for all events of *plan*."""
        literal = plan.trigger.literal
        assert isinstance(literal, nodes.Literal)
        if plan.context is None or (literal.annotations is not None and not is_ground(literal.annotations)):
            return None
        for before in self._plans.get(_event(plan.trigger, literal, literal.annotations), ()):
            names = _renaming(before.trigger.literal, literal)
            context = None if names is None else _renamed(before.context, names)
            if context is not None and implies(plan.context, context):
                return before
        return None


def _denied(found: ByKind) -> list[nodes.Term]:
    """Return the operands of ``not``."""
    return [part for each in found.of(nodes.Not) for part in parts_of(each.operand)]


def _renaming(general: nodes.Node, special: nodes.Literal) -> dict[str, nodes.Term] | None:
    """Return the terms that variables of a trigger have in the events of another one; None if it misses some events."""
    assert isinstance(general, nodes.Literal)
    names: dict[str, nodes.Term] = {}
    for one, other in zip(general.arguments, special.arguments, strict=True):
        if isinstance(one, nodes.Variable) and one.annotations is None and not one.negated:
            if names.setdefault(one.name, other) != other:
                return None
        elif one != other or not is_ground(one):
            return None
    return names


def _renamed(context: nodes.Term | None, names: Mapping[str, nodes.Term]) -> nodes.Term | None:
    """Return a context with the terms for its variables; None if one is not a variable: an event may not know its value."""
    used = names_in(context)
    if not all(isinstance(names.get(name, nodes.Variable(name)), nodes.Variable) for name in used):
        return None
    changed: nodes.Term | None = rebuilt(
        context, lambda node: names.get(node.name, node) if isinstance(node, nodes.Variable) else node
    )
    return changed


def _event(trigger: nodes.Trigger, literal: nodes.Literal, annotations: nodes.Annotations | None) -> object:
    return trigger.operator, trigger.kind, signature(literal), annotations


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
    """Warn of plans whose context contradicts itself, and of such conditions of rules and statements."""
    for plan in filter(is_own, found.of(nodes.Plan)):
        if plan.context is not None:
            yield from _never(
                "unreachable plan", contradiction(plan.context), plan.context, plan.trigger.span
            )
    for node in filter(is_own, found.of(nodes.Rule, nodes.If, nodes.While)):
        for condition in conditions(node):  # a constant switches off what it is the condition of
            yield from _never(
                "this condition never holds", contradiction(condition, False), condition, node.span
            )


def _never(what: str, why: str | None, condition: nodes.Term, span: Span | None) -> Iterator[Diagnostic]:
    if why is not None:
        yield problem("context-never-true", f"{what}: {why}", condition.span or span)
