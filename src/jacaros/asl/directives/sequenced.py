"""Sequenced goal adoption: events whose goals are pursued one after the other."""

from jacaros.asl import nodes
from jacaros.asl.directives.pattern import TRUE, PatternCall, PatternError, on, with_plans


def sequenced(call: PatternCall, section: nodes.Section) -> nodes.Section:
    """``sga("trigger", "context", g)``: each such event adopts *g*, one goal after the other.

    Goals that wait are kept in order in beliefs ``p__queue(N, g)``; one that is waiting already is not queued
    twice.  Each goal is an intention of its own, and a goal that fails makes room for the next one, too.  (In
    the reference a waiting goal is taken up only if its arguments equal those of the goal that ended.)
    """
    call.at_most(3)
    trigger, context = _trigger(call), _context(call)
    goal = call.literal(2, "the goal")
    key = nodes.Number(float(call.number), span=call.span)
    any_goal = nodes.Variable("_0", span=call.span)
    busy = nodes.Literal("p__busy", (key,), span=call.span)
    serve = nodes.Literal("p__serve", (key, any_goal), span=call.span)
    queued = nodes.Literal("p__queue", (key, any_goal), span=call.span)
    turn = nodes.Literal("p__next", (key,), span=call.span)
    idle: nodes.Term = nodes.Not(busy, span=call.span)
    serve_this = nodes.Literal("p__serve", (key, goal), span=call.span)
    queue_this = nodes.Literal("p__queue", (key, goal), span=call.span)
    # Whether the queue is busy is asked and noted without anything in between, hence the atomic plans.
    adopted = [
        call.plan(
            trigger,
            call.change("+", busy),
            call.achieve(serve_this, separate=True),
            context=idle if context is None else nodes.And(idle, context, span=call.span),
            atomic="begin",
        ),
        call.plan(trigger, call.change("+>", queue_this), context=context, atomic="wait"),
        call.plan(
            on("+!", serve), nodes.Achieve(any_goal, span=call.span), call.achieve(turn, separate=True)
        ),
        call.plan(on("-!", serve), call.achieve(turn, separate=True), call.internal(".fail")),
        call.plan(
            on("+!", turn),
            call.change("-", queued),
            call.achieve(serve, separate=True),
            context=queued,
            atomic="next",
        ),
        call.plan(on("+!", turn), call.change("-", busy), atomic="end"),
    ]
    return with_plans(section, [], section.plans, adopted)


def _trigger(call: PatternCall) -> nodes.Trigger:
    """The first argument: a trigger as text or in braces."""
    argument = call.arguments[0] if call.arguments else None
    if isinstance(argument, nodes.String):
        return call.parse_trigger(argument.value)
    if isinstance(argument, nodes.TriggerTerm):
        return argument.trigger
    if isinstance(argument, nodes.BodyTerm) and len(argument.body.steps) == 1:
        step = argument.body.steps[0]
        if isinstance(step, nodes.BeliefChange) and isinstance(step.operand, nodes.Literal | nodes.Variable):
            return nodes.Trigger(step.operator, "", step.operand, span=step.span)
    raise PatternError("argument 1 of 'sga' is a trigger", 'as in sga("+order(X)", "true", serve(X))')


def _context(call: PatternCall) -> nodes.Term | None:
    """The second argument: a condition, as text or as it is; None for ``true``."""
    if len(call.arguments) < 2:
        raise PatternError("'sga' needs a context as argument 2", '"true" if there is none')
    argument = call.arguments[1]
    formula = call.parse_formula(argument.value) if isinstance(argument, nodes.String) else argument
    return None if formula == TRUE else formula
