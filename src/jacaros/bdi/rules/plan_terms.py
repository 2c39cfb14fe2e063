"""Plans, triggers and frames as terms."""

from jacaros.asl.loader import parse_trigger
from jacaros.asl.lowering import fresh_names, lower_plan, lower_trigger
from jacaros.bdi.state.belief_base import has_source, parts
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.intention import PLAN, Frame
from jacaros.bdi.state.plan import Plan
from jacaros.bdi.state.triggers import Trigger, trigger
from jacaros.terms.order import annotation_set
from jacaros.terms.plans import TRIGGERS, body_steps, is_body, step_parts, trigger_parts
from jacaros.terms.substitution import resolve
from jacaros.terms.unifier import Trail, undo, unify
from jacaros.terms.values import (
    SOURCE,
    Annotated,
    String,
    Term,
    Var,
    annotations_of,
    atom,
    bare,
    deref,
    make_list,
    structure,
)


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
    """The list ``[map('Var', Value), …]`` of a frame."""
    return make_list(
        [structure("map", atom(f"'{name}'"), resolve(value)) for name, value in variables_of(frame).items()]
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
    """The plans whose triggers unify with an event, in the order in which they are tried; None when it is no trigger.

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
