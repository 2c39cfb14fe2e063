"""Choosing among the applicable plans of an event, for agents that do not simply take the first one.

A program does it with rules for ``select__option(Trigger, Intention, Plan, Bindings)``: the first option for which
they hold is taken.  Label annotation ``all_unifs``: every answer of the plan's context is an option, not the first
one only.
"""

from collections.abc import Iterator

from jacaros.bdi.rules.plan_terms import bindings_of, plan_term
from jacaros.bdi.rules.query import solve_formula
from jacaros.bdi.rules.searching import run
from jacaros.bdi.state.belief_base import SELECT_OPTION
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.intention import ANNOTATIONS, GOAL, PLAN, Frame, Intention
from jacaros.bdi.state.literals import EventAnnotations, literal_of
from jacaros.bdi.state.triggers import Goal
from jacaros.terms.plans import trigger
from jacaros.terms.unifier import undo
from jacaros.terms.values import Term, Var


def options(agent: Circumstance, goal: Goal, annotations: EventAnnotations) -> Iterator[Frame]:
    """The frames of all applicable plans, in the order of the program; a frame holds until the next is asked for."""
    every = agent.library.every_option(goal[0])
    return iter(()) if every is None else every(agent, goal, annotations)


def first_option(
    agent: Circumstance, goal: Goal, annotations: EventAnnotations, intention: Intention | None
) -> Frame | None:
    """The first applicable plan that the rules for ``select__option`` let pass."""
    agent.refused_options = False
    found = options(agent, goal, annotations)
    for frame in found:
        if _passes(agent, frame, intention):
            agent.trail.clear()
            agent.refused_options = False
            return frame
        agent.refused_options = True
    return None


def _passes(agent: Circumstance, frame: Frame, intention: Intention | None) -> bool:
    number: Term = Var("Intention") if intention is None else float(intention.id)
    operator = frame[GOAL][0].operator + frame[GOAL][0].kind
    rest = (number, plan_term(agent, frame[PLAN]), bindings_of(frame))
    # A rule may ask for annotations of the event, but most are written without.
    events = (literal_of(frame[GOAL], frame[ANNOTATIONS]), literal_of(frame[GOAL], ()))
    return any(_holds(agent, (SELECT_OPTION, trigger(operator, event), *rest)) for event in events)


def _holds(agent: Circumstance, question: Term) -> bool:
    mark = len(agent.trail)
    holds = any(True for _ in run(solve_formula(agent, question, agent.trail), agent.rule_depth))
    undo(agent.trail, mark)
    return holds
