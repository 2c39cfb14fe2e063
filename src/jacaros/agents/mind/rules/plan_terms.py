"""Plans as terms, ``{ +!g : c <- a; b }``, and plan bodies held by variables.

The steps of a body that a variable holds run in a frame above the plan that holds it.
"""

from typing import Any

from jacaros.agents.language import nodes
from jacaros.agents.language.loader import parse_trigger
from jacaros.agents.language.lowering import Reflection, fresh_names, lower_plan, lower_trigger
from jacaros.agents.mind.state.belief_base import has_source, parts
from jacaros.agents.mind.state.circumstance import Circumstance
from jacaros.agents.mind.state.intention import GOAL, PLAN, STEP, Frame, NextStep
from jacaros.agents.mind.state.plan import Failure, Plan
from jacaros.agents.mind.state.triggers import Trigger, trigger
from jacaros.agents.terms.order import annotation_set
from jacaros.agents.terms.plans import PLAN as PLAN_TERM
from jacaros.agents.terms.plans import RULE, TRIGGERS, body_steps, is_body, step_parts, trigger_parts
from jacaros.agents.terms.substitution import resolve
from jacaros.agents.terms.unifier import Trail, undo, unify
from jacaros.agents.terms.values import (
    ACTION,
    BY_SELF,
    SOURCE,
    Annotated,
    String,
    Term,
    Var,
    annotations_of,
    arguments_of,
    atom,
    bare,
    deref,
    functor,
    functor_of,
    make_list,
    structure,
)
from jacaros.agents.terms.values import PLAN as PLAN_KIND


def plan_term(agent: Circumstance, plan: Plan) -> Term:
    """A plan of an agent as a term, with its label and what is known of it."""
    term = lower_plan(plan.node, fresh_names())
    return (term[0], agent.library.label(plan), *term[2:])


def variables_of(frame: Frame) -> dict[str, Term]:
    """The variables of a frame that have been given a value."""
    slots = frame[PLAN].slots
    return {
        name: frame[slot] for name, slot in slots.items() if slot < len(frame) and frame[slot] is not None
    }


def bindings_of(frame: Frame) -> Term:
    """The list ``[map('Var', Value), …]`` of a frame; variables without value are left out."""
    values = ((name, resolve(value)) for name, value in variables_of(frame).items())
    return make_list(
        [
            structure("map", atom(f"'{name}'"), value)
            for name, value in values
            if bare(value).__class__ is not Var
        ]
    )


def trigger_of(term: Term) -> tuple[Trigger | None, Term, str] | None:
    """Trigger object (None when its literal is a variable), literal and operator of a trigger term, or None."""
    term = deref(term)
    if term.__class__ is String:
        term = lower_trigger(parse_trigger(str(term)), fresh_names())
    if term.__class__ is tuple and term[0] in TRIGGERS:
        operator, literal = trigger_parts(term)
    elif is_body(term):
        steps = list(body_steps(term))
        if len(steps) != 1:
            return None
        operator, operands = step_parts(steps[0])
        if operator not in ("+", "-"):
            return None
        literal = operands[0]
    else:
        return None
    symbol = parts(literal)[0]
    return (None if symbol is None else trigger(operator[0], operator[1:], symbol)), literal, operator


def relevant_plans(agent: Circumstance, event: Term) -> list[Plan] | None:
    """Return the plans whose triggers unify with an event, in order; None if it is not a trigger.

    An event without a source stands for events from any source.
    """
    found = trigger_of(event)
    if found is None:
        return None
    symbol, literal, operator = found
    if symbol is None:
        return [p for p in agent.library.plans if p.node.trigger.operator + p.node.trigger.kind == operator]
    literal = resolve(literal)
    annotations = annotations_of(literal)
    if not has_source(annotations):
        literal = Annotated(bare(literal), annotation_set((*annotations, (SOURCE, Var()))))
    return [plan for plan in agent.library.relevant(symbol) if _fits(plan, literal)]


def _fits(plan: Plan, literal: Term) -> bool:
    trail = Trail()
    head = trigger_parts(lower_trigger(plan.node.trigger, fresh_names()))[1]
    fits = unify(head, literal, trail)
    undo(trail, 0)
    return fits


ERROR = functor("error", 1)
_BODY = trigger("+", "", functor("body", 0, namespace="jacaros"))


def is_body_frame(frame: Frame) -> bool:
    """Whether a frame runs a body held by a variable, not a plan of its own."""
    return frame[GOAL][0] is _BODY


def run_value(agent: Circumstance, value: Term, frame: Frame, next_step: NextStep) -> Any:
    """A variable as a body formula: a plan body, or an action."""
    term = resolve(value)
    if is_body(term):
        return _run_body(agent, term, frame, next_step)
    symbol = functor_of(term)
    if symbol is None or symbol in TRIGGERS or symbol in (PLAN_TERM, RULE):
        unknown = bare(term).__class__ is Var
        raise Failure((ERROR, atom("body_var_without_value" if unknown else "body_var_not_literal")))
    if symbol.kind in (ACTION, PLAN_KIND):
        return _run_body(agent, term, frame, next_step)
    return agent.begin_act(symbol, arguments_of(term), annotations_of(term), next_step)  # type: ignore[attr-defined]


def _run_body(agent: Circumstance, term: Term, frame: Frame, next_step: NextStep) -> Any:
    """Run a body held by a variable, on a frame of its own above the plan's."""
    frame[STEP] = next_step
    plan = plan_of_body(agent, term)
    assert agent.current is not None
    if plan.first is not None:
        inner: Frame = [plan.first, (_BODY,), BY_SELF, agent.trail.serial, plan, *([None] * plan.size)]
        agent.current.frames.append(inner)
        return plan.first(agent, inner)
    return None


def plan_of_body(agent: Circumstance, term: Term) -> Plan:
    """A body as a plan; one that is run often is made once."""
    known = agent.library.bodies.get(id(term))
    if known is not None and known[0] is term:
        plan: Plan = known[1]
        return plan
    body = Reflection(shared=True).body(term)
    node = nodes.Plan(None, nodes.Trigger("+", "!", nodes.Literal("body")), None, body)
    plan = Plan(node, atom("body"))
    plan.body_term = term
    plan.keep_all_variables()
    agent.engine.give_steps(plan)
    if len(agent.library.bodies) > 256:
        agent.library.bodies.clear()
    agent.library.bodies[id(term)] = (term, plan)
    return plan
