"""Plan bodies held by variables: they have steps like any other, and run above the plan that holds them."""

from typing import Any

from jacaros.asl import nodes
from jacaros.asl.reflection import Reflection
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.intention import Frame, NextStep
from jacaros.bdi.state.outcomes import Failure
from jacaros.bdi.state.plan import Plan
from jacaros.bdi.state.triggers import trigger
from jacaros.terms.plans import PLAN as PLAN_TERM
from jacaros.terms.plans import RULE, TRIGGERS, is_body
from jacaros.terms.substitution import resolve
from jacaros.terms.values import (
    ACTION,
    BY_SELF,
    PLAN,
    Term,
    Var,
    annotations_of,
    arguments_of,
    atom,
    bare,
    functor,
    functor_of,
)

ERROR = functor("error", 1)
_BODY = trigger("+", "", functor("body", 0, namespace="jacaros"))


def is_body_frame(frame: Frame) -> bool:
    """Whether a frame runs a body held by a variable, not a plan of its own."""
    return frame[1][0] is _BODY


def run_value(agent: Circumstance, value: Term, frame: Frame, next_step: NextStep) -> Any:
    """A variable as a body formula: a plan body, or an action."""
    term = resolve(value)
    if is_body(term):
        return _run_body(agent, term, frame, next_step)
    symbol = functor_of(term)
    if symbol is None or symbol in TRIGGERS or symbol in (PLAN_TERM, RULE):
        unknown = bare(term).__class__ is Var
        raise Failure((ERROR, atom("body_var_without_value" if unknown else "body_var_not_literal")))
    if symbol.kind in (ACTION, PLAN):
        return _run_body(agent, term, frame, next_step)
    return agent.begin_act(symbol, arguments_of(term), annotations_of(term), next_step)  # type: ignore[attr-defined]


def _run_body(agent: Circumstance, term: Term, frame: Frame, next_step: NextStep) -> Any:
    """Run a body held by a variable, on a frame of its own above the plan's."""
    frame[0] = next_step
    plan = plan_of_body(agent, term)
    assert agent.current is not None
    if plan.first is not None:
        inner: Frame = [plan.first, (_BODY,), BY_SELF, agent.trail.serial, plan, *([None] * plan.size)]
        agent.current.frames.append(inner)
        return plan.first(agent, inner)
    return None


def plan_of_body(agent: Circumstance, term: Term) -> Plan:
    """A body as a plan; one that is run often is made once."""
    known = agent.bodies.get(id(term))
    if known is not None and known[0] is term:
        plan: Plan = known[1]
        return plan
    body = Reflection(shared=True).body(term)
    node = nodes.Plan(None, nodes.Trigger("+", "!", nodes.Literal("body")), None, body)
    plan = Plan(node, atom("body"))
    plan.body_term = term
    plan.keep_all_variables()
    agent.engine.give_steps(plan)
    if len(agent.bodies) > 256:
        agent.bodies.clear()
    agent.bodies[id(term)] = (term, plan)
    return plan
