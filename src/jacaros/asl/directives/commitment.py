"""Commitment strategies: how long an agent goes on with a declarative goal."""

from dataclasses import replace

from jacaros.asl import nodes
from jacaros.asl.directives.goal_patterns import backtracking
from jacaros.asl.directives.pattern import PatternCall, on, with_plans
from jacaros.asl.section import Section


def blind(call: PatternCall, section: Section) -> Section:
    """``bc(g)`` or ``bc(g, pattern)``: the goal is pursued until it is believed, whatever fails.

    The plans for g are treated by *pattern* (``bdg`` if none is named), and a last plan posts the goal again
    when no other plan is applicable.
    """
    call.at_most(2)
    if len(call.arguments) < 2:
        return _committed(call, section)
    return _with_last_plan(call, call.nested(section, 1))


def single_minded(call: PatternCall, section: Section) -> Section:
    """``smc(g, f)``: the goal is pursued until it is believed, or *f*, that it is impossible, is believed.

    When f comes to be believed the goal fails, and the failure goes on to whoever posted it; the retry of the
    blind commitment inside does not catch it (in the reference it does).
    """
    call.at_most(2)
    return _committed(call, section, call.literal(1, "the belief that the goal is impossible"))


def relativised(call: PatternCall, section: Section) -> Section:
    """``rc(g, m)``: the goal is pursued until it is believed, or its motivation *m* is no longer believed."""
    call.at_most(2)
    return _motivated(call, _committed(call, section), call.literal(1, "the motivation"))


def open_minded(call: PatternCall, section: Section) -> Section:
    """``omc(g, f, m)``: a belief *f* makes the goal fail, and losing the motivation *m* ends it."""
    call.at_most(3)
    committed = _committed(call, section, call.literal(1, "the belief that the goal is impossible"))
    return _motivated(call, committed, call.literal(2, "the motivation"))


def _committed(call: PatternCall, section: Section, impossible: nodes.Literal | None = None) -> Section:
    """Blind commitment, given up when *impossible* is believed."""
    goal = call.literal(0, "the goal")
    alone = replace(call, arguments=call.arguments[:1])
    if impossible is None:
        return _with_last_plan(call, backtracking(alone, section))
    possible = nodes.Not(impossible, span=call.span)
    inner = _with_last_plan(call, backtracking(alone, section, possible), possible)
    reason = nodes.Literal("error", (nodes.Literal("impossible"),), span=call.span)
    message = nodes.Literal(
        "error_msg", (nodes.String("the goal is believed to be impossible"),), span=call.span
    )
    give_up = call.plan(on("-!", goal), call.internal(".fail", reason, message))
    fail = call.plan(on("+", impossible), call.internal(".fail_goal", goal))
    return with_plans(inner, [], inner.plans, [give_up, fail])


def _with_last_plan(call: PatternCall, section: Section, possible: nodes.Term | None = None) -> Section:
    """*section* with ``+!g <- !g`` as the last plan for the goal."""
    goal = call.literal(0, "the goal")
    again = call.plan(on("+!", goal), call.achieve(goal), context=possible)
    return with_plans(section, [], section.plans, [again])


def _motivated(call: PatternCall, section: Section, motivation: nodes.Literal) -> Section:
    """*section* with a plan that ends the goal, as if achieved, when *motivation* is lost."""
    unmotivated = call.plan(on("-", motivation), call.internal(".succeed_goal", call.literal(0, "the goal")))
    return with_plans(section, [], section.plans, [unmotivated])
