"""Select a plan for an event: rules RelPl, ApplPl and SelAppl.

A `Selection` tries the plans for one kind of event in order. A plan is relevant if its trigger unifies with the event,
and applicable if its context then has an answer; the first applicable plan is selected. The code that is generated for
plans (`jacaros.bdi.fast`) does the same, and makes the same frames.
"""

from collections.abc import Iterator, Sequence

from jacaros.asl import nodes
from jacaros.asl.lowering import Names, lower
from jacaros.asl.walk import names_in
from jacaros.bdi.rules.body_steps import interpreted
from jacaros.bdi.rules.deadlines import begin_guarded
from jacaros.bdi.rules.query import answers
from jacaros.bdi.rules.searching import run, unify_rows
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.intention import Frame
from jacaros.bdi.state.literals import EventAnnotations, annotations_of_event, literal_of, namespace_of
from jacaros.bdi.state.plan import ALL_UNIFIERS, Plan
from jacaros.bdi.state.triggers import Goal
from jacaros.errors import InternalError
from jacaros.terms.unifier import Trail, undo, unify, unify_annotations
from jacaros.terms.values import Annotated, Var, arguments_of, deref


class Selection:
    """The plans for one kind of event.

    Args:
        plans: the relevant ones by name and arity, in the order in which they are tried.
        outer: the plan that they are sub-plans of; they see the variables of its frame.
    """

    __slots__ = ("outer", "plans")

    def __init__(self, plans: Sequence[Plan], outer: Plan | None = None) -> None:
        self.plans, self.outer = plans, outer

    def __call__(self, agent: Circumstance, goal: Goal, annotations: EventAnnotations) -> Frame | None:
        """Return the frame of the first applicable plan, or None."""
        return next(self.frames(agent, goal, annotations), None)

    def every(self, agent: Circumstance, goal: Goal, annotations: EventAnnotations) -> Iterator[Frame]:
        """Yield the frames of all applicable plans: of each plan the first, or, with ``all_unifs`` in its label, one for
        each answer of its context.
        """
        for plan in self.plans:
            for frame in self._frames_of(plan, agent, goal, annotations):
                yield frame
                if ALL_UNIFIERS not in plan.annotations:
                    break
            undo(agent.trail, 0)

    def frames(self, agent: Circumstance, goal: Goal, annotations: EventAnnotations) -> Iterator[Frame]:
        """Yield the first frame of each applicable plan, with the bindings of its context."""
        for plan in self.plans:
            found = next(self._frames_of(plan, agent, goal, annotations), None)
            if found is not None:
                yield found
            undo(agent.trail, 0)

    def _frames_of(
        self, plan: Plan, agent: Circumstance, goal: Goal, annotations: EventAnnotations
    ) -> Iterator[Frame]:
        """Yield a frame for each answer of the context. A plan whose context cannot be evaluated is not applicable."""
        names = Names() if self.outer is None else _names_of(self.outer, agent.outer_frame, plan)
        try:
            if not is_relevant(plan, goal, annotations, names, agent.trail):
                return
            if plan.node.context is None:
                yield _frame(plan, goal, annotations, names, agent.trail.serial)
                return
            context = answers(agent, plan.node.context, names.__getitem__, agent.trail)
            for _ in run(context, agent.options.rule_depth):
                yield _frame(plan, goal, annotations, names, agent.trail.serial)
        except InternalError:
            raise
        except Exception as fault:
            agent.context.report_plan(plan, fault)


def is_relevant(plan: Plan, goal: Goal, annotations: EventAnnotations, names: Names, trail: Trail) -> bool:
    """Rule RelPl: return whether the trigger of a plan unifies with an event; bind the variables of the plan."""
    literal = plan.node.trigger.literal
    if not isinstance(literal, nodes.Variable) and isinstance(literal.namespace, nodes.Variable):
        symbol = goal[0].functor
        wanted = literal.functor, len(literal.arguments), literal.negated
        if (symbol.name, symbol.arity, symbol.negated) != wanted:
            return False
        if not unify(names[literal.namespace.name], namespace_of(symbol), trail):
            return False
        literal = nodes.replace(literal, namespace=None)
    pattern, items, tail = lower(literal, names.__getitem__), (), None
    if pattern.__class__ is Annotated:
        pattern, items, tail = pattern.term, pattern.annotations, pattern.tail
    if not isinstance(literal, nodes.Variable):
        fits = unify_rows(arguments_of(pattern), goal[1:], trail)
    elif literal.negated or not literal.unnamed:
        fits = unify(pattern, literal_of(goal, annotations if literal.annotations is None else ()), trail)
    else:
        fits = True
    if not fits or (not items and tail is None):
        return fits
    return unify_annotations(items, tail, annotations_of_event(annotations), None, trail)


def _names_of(outer: Plan, frame: Frame, plan: Plan) -> Names:
    """Return the variables that a sub-plan shares with its outer plan."""
    names = Names()
    for name in names_in(plan.node):
        slot = outer.slots.get(name)
        if slot is not None:
            names[name] = frame[slot] = Var(name) if frame[slot] is None else frame[slot]
    return names


def _frame(plan: Plan, goal: Goal, annotations: EventAnnotations, names: Names, serial: int) -> Frame:
    """Return the frame of an applicable plan, at its first step."""
    body = interpreted(plan)
    for name in body.known:
        names[name]  # made if it has not been asked for: it may be on another branch
    values = [deref(names[name]) if name in names else None for name in plan.slots]
    first = begin_guarded if plan.guards else body.first
    return [first, goal, annotations, serial, plan, *values, *([None] * body.extra)]
