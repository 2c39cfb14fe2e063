"""A plan for a goal or event becomes part of an intention: rule AddIM."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Literal

from jacaros.agents.language import nodes
from jacaros.agents.language.lowering import Variables, lower
from jacaros.agents.language.nodes import names_in
from jacaros.agents.mind.actions.internal_action import InternalAction
from jacaros.agents.mind.rules import failure_reason, forks, meta_events, needs
from jacaros.agents.mind.rules.body_steps import interpreted
from jacaros.agents.mind.rules.deadlines import begin_guarded
from jacaros.agents.mind.rules.failure import has_room, too_deep, unplanned
from jacaros.agents.mind.rules.query import answers, interpret_rule
from jacaros.agents.mind.rules.searching import run, unify_rows
from jacaros.agents.mind.state.circumstance import Circumstance
from jacaros.agents.mind.state.intention import (
    ANNOTATIONS,
    GOAL,
    PLAN,
    STEP,
    Event,
    Frame,
    Intention,
    NextStep,
)
from jacaros.agents.mind.state.plan import ALL_UNIFIERS, Answers, Engine, Every, Plan, Rule, Select
from jacaros.agents.mind.state.triggers import (
    EventAnnotations,
    Goal,
    Trigger,
    annotations_of_event,
    apart,
    literal_of,
    namespace_of,
)
from jacaros.agents.terms.unifier import Trail, undo, unify, unify_annotations
from jacaros.agents.terms.values import BY_SELF, Annotated, Term, Var, arguments_of, deref
from jacaros.runtime.errors import InternalError
from jacaros.runtime.trace import Cause

# Select a plan for an event: rules RelPl, ApplPl and SelAppl.
#
# A `Selection` tries the plans for one kind of event in order. A plan is relevant if its trigger unifies with the event,
# and applicable if its context then has an answer; the first applicable plan is selected. The code that is generated for
# plans (`jacaros.agents.mind.fast`) does the same, and makes the same frames.


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
        names = Variables() if self.outer is None else _names_of(self.outer, agent.outer_frame, plan)
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


def is_relevant(
    plan: Plan, goal: Goal, annotations: EventAnnotations, names: Variables, trail: Trail
) -> bool:
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


def _names_of(outer: Plan, frame: Frame, plan: Plan) -> Variables:
    """Return the variables that a sub-plan shares with its outer plan."""
    names = Variables()
    for name in names_in(plan.node):
        slot = outer.slots.get(name)
        if slot is not None:
            names[name] = frame[slot] = Var(name) if frame[slot] is None else frame[slot]
    return names


def _frame(plan: Plan, goal: Goal, annotations: EventAnnotations, names: Variables, serial: int) -> Frame:
    """Return the frame of an applicable plan, at its first step."""
    body = interpreted(plan)
    for name in body.known:
        names[name]  # made if it has not been asked for: it may be on another branch
    values = [deref(names[name]) if name in names else None for name in plan.slots]
    first = begin_guarded if plan.guards else body.first
    return [first, goal, annotations, serial, plan, *values, *([None] * body.extra)]


def push(
    agent: Circumstance,
    intention: Intention | None,
    goal: Goal,
    annotations: EventAnnotations,
    cause: Cause | None = None,
) -> Intention | Literal[False] | None:
    """Rules RelPl, ApplPl, SelAppl and AddIM: select a plan for an event, and put it on an intention.

    The plan replaces its caller if that has nothing left to do (tail call).

    Args:
        agent: that handles the event.
        intention: whose event it is; None for an external event: a new intention begins.
        goal, annotations: the event.
        cause: why an external event came.

    Returns:
        the intention if it can continue now, and None if it cannot; False if an external event has no plan.
    """
    trail, kind = agent.trail, goal[0]
    trail.serial += 1
    if agent.unusual:
        frame, cause = _consider(agent, intention, goal, annotations, cause)
    else:
        select = agent.library.selects[kind]
        frame = None if select is None else select(agent, goal, annotations)
    if trail:
        trail.clear()
    if frame is None:
        return False if intention is None else go_without(agent, intention, goal, annotations, None)
    if intention is None:
        intention = Intention(agent, cause)
        intention.frames.append(frame)
        if kind.failing:
            intention.handlers.append(0)
    else:
        frames = intention.frames
        if (
            frames
            and (caller := frames[-1])[STEP] is None
            and caller[GOAL][0] is kind
            and caller[PLAN].replaceable
            and kind.on_fail is not None
            and agent.options.tail_calls
            and not (agent.waits.needs and any(need.is_of(caller) for need in agent.waits.needs.values()))
        ):
            frames[-1] = frame
            if agent.unusual or agent.atomic is not None:
                _note_replaced(agent, intention, caller)
        else:
            frames.append(frame)
            if len(frames) > agent.options.goal_depth:
                return begin_plan(agent, intention, frame)
    if (
        frame[PLAN].special
        or agent.unusual
        # Only a goal with annotations beside its source may name resources.
        or not (annotations is BY_SELF or not kind.kind or kind.failing or len(annotations) == 1)  # type: ignore[arg-type]
    ):
        return begin_plan(agent, intention, frame)
    return intention


def _note_replaced(agent: Circumstance, intention: Intention, caller: Frame) -> None:
    """A plan has taken the place of its caller on the stack."""
    if agent.features.meta:
        meta_events.observe(agent, intention, caller, "replaced")
    if agent.atomic is intention and not intention.is_atomic():
        agent.atomic_over = True


def _consider(
    agent: Circumstance,
    intention: Intention | None,
    goal: Goal,
    annotations: EventAnnotations,
    cause: Cause | None,
) -> tuple[Frame | None, Cause | None]:
    """Select a plan where sub-plans come first, the program or the project chooses, or an observer hears why."""
    observer, selections, frame = agent.observers.mind, agent.selections, None
    asked = goal if observer is None else apart(goal)  # heads of plans bind variables of the goal
    if agent.holders and intention is not None:
        frame = forks.select_in_scope(agent, intention, goal, annotations)
    if frame is None:
        if selections.chooses or selections.option_filter.rows:
            frame = selections.select_option(goal, annotations, intention)
        else:
            select = agent.library.selects[goal[0]]
            frame = None if select is None else select(agent, goal, annotations)
    agent.trail.clear()
    if observer is not None:
        cause = observer.selected(asked, annotations, intention, frame, cause)
    return frame, cause


def begin_plan(agent: Circumstance, intention: Intention, frame: Frame) -> Intention | Literal[False] | None:
    """Do what comes before the first step of a plan on the stack; return the intention if it can continue now."""
    plan: Plan = frame[PLAN]
    if plan.special:
        if plan.atomic:
            agent.atomic, agent.atomic_over = intention, False
        agent.note_plan(intention, plan)
    if agent.features.meta:
        kind = frame[GOAL][0]
        if kind.kind and not kind.failing:
            meta_events.frame_state(agent, intention, frame, "executing")
    if len(intention.frames) > agent.options.goal_depth and not has_room(agent, intention):
        return go_without(agent, intention, frame[GOAL], frame[ANNOTATIONS], frame)
    return intention if needs.acquire(agent, intention) else None


def go_without(
    agent: Circumstance, intention: Intention, goal: Goal, annotations: EventAnnotations, frame: Frame | None
) -> Intention | Literal[False] | None:
    """Handle a goal or event without a plan, or (if *frame* is given, and on the stack) without room for it.

    Return the intention if it can continue now.
    """
    if frame is None and goal[0].kind == "":
        log_inapplicable(agent, goal, annotations)
        return intention
    posted = unplanned(agent, intention, goal, annotations) if frame is None else too_deep(agent, intention)
    if posted is None:
        return None
    event: Event = (posted.goal, intention, posted.annotations, None)
    if agent.conditioned or (
        agent.atomic is None and (agent.events or agent.intentions or agent.incoming.called)
    ):
        agent.post(event)
        return None
    agent.note(posted.goal[0])
    if agent.waits.events:
        agent.notify_listeners(event)
    return push(agent, intention, posted.goal, posted.annotations)


def log_inapplicable(agent: Circumstance, goal: Goal, annotations: EventAnnotations) -> None:
    """Log why no plan was selected for an event that has relevant ones, if the agent logs details."""
    if agent.options.verbose > 1 and agent.library.relevant(goal[0]):
        agent.architecture.log("debug", failure_reason.inapplicable(agent, goal, annotations).text())


# Run plans and rules as the language defines them, without code made for speed.


class Interpreter(Engine):
    """Runs plans and rules, see `jacaros.agents.mind.state.plan.Engine`.

    Args:
        actions: the internal actions that plans may call.
    """

    def __init__(self, actions: Mapping[str, InternalAction]) -> None:
        self.actions = actions

    def select(self, trigger: Trigger, plans: Sequence[Plan], outer: Plan | None = None) -> Select:
        """Return the selection among plans for one kind of event."""
        del trigger
        return Selection(plans, outer)

    def every(self, trigger: Trigger, plans: Sequence[Plan]) -> Every:
        """Return the same for all applicable plans."""
        del trigger
        return Selection(plans).every

    def give_steps(self, plan: Plan) -> None:
        """Give steps to a plan made from a body at run time."""
        interpreted(plan)

    def step_at(self, plan: Plan, position: str) -> NextStep:
        """Return the step at a position (`plan.position_of`); generated code has the same numbers."""
        return interpreted(plan).by_name[f"step_{position[1:]}"]

    def answers(self, agent: Any, rule: Rule, arguments: tuple[Term, ...], trail: Trail) -> Answers:
        """Return the answers of a rule."""
        return interpret_rule(agent, rule.node, arguments, trail)
