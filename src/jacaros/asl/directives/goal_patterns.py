"""Goal patterns: declarative goals, commitment strategies, and goals pursued in sequence.

A declarative goal is achieved when its belief holds.
"""

from dataclasses import replace

from jacaros.asl import nodes
from jacaros.asl.directives.pattern import TRUE, PatternCall, PatternError, achieves, is_about, on, with_plans


def declarative(call: PatternCall, section: nodes.Section) -> nodes.Section:
    """``dg(g)``: the goal is achieved when, and only when, *g* is believed.

    Adds ``+!g : g``, a test ``?g`` at the end of each plan for g (its ``-!g`` plans among them), and ``+g <-
    .succeed_goal(g)``. Jason also treats a goal that is already intended as achieved, which ends the retry of ``bdg``
    and ``bc`` immediately; ours does not.
    """
    call.at_most(1)
    goal = call.literal(0, "the goal")
    believed = call.plan(on("+!", goal), context=goal)
    plans = [_tested(plan, call) if is_about(plan, goal) else plan for plan in section.plans]
    succeed = call.plan(on("+", goal), call.internal(".succeed_goal", goal))
    return with_plans(section, [believed], plans, [succeed])


def backtracking(
    call: PatternCall, section: nodes.Section, possible: nodes.Term | None = None
) -> nodes.Section:
    """``bdg(g)``: a declarative goal that is retried when a plan fails, as long as *possible* holds."""
    goal = call.literal(0, "the goal")
    inner = declarative(call, section)
    retry = call.plan(on("-!", goal), call.achieve(goal), context=possible)
    return with_plans(inner, [], inner.plans, [retry])


def exclusive(call: PatternCall, section: nodes.Section) -> nodes.Section:
    """``ebdg(g)``: a backtracking declarative goal that tries each plan at most once.

    Plans that were tried are recorded in beliefs ``p__tried(Plan, g)``, which are removed when the goal ends. When no
    plan is left, the goal fails (Jason retries it forever).
    """
    goal = call.literal(0, "the goal")
    plans: list[nodes.Plan] = []
    for plan in section.plans:
        plans.append(_tried_once(plan, len(plans), call) if achieves(plan, goal) else plan)
    inner = declarative(call, replace(section, plans=plans))
    forget = call.internal(".abolish", _tried(nodes.Variable("_", unnamed=True, span=call.span), goal))
    no_plan = nodes.Literal("error", (nodes.Literal("no_applicable"),), span=call.span)
    exhausted = nodes.replace(goal, annotations=nodes.Annotations((no_plan,)))
    message = nodes.Literal(
        "error_msg", (nodes.String("all plans for the goal have been tried"),), span=call.span
    )
    failing = call.plan(on("-!", exhausted), forget, call.internal(".fail", no_plan, message))
    retry = call.plan(on("-!", goal), call.achieve(goal))
    *others, succeed = inner.plans
    assert isinstance(succeed.body, nodes.Body)
    succeed = nodes.replace(succeed, body=nodes.replace(succeed.body, steps=(forget, *succeed.body.steps)))
    return with_plans(inner, others, [succeed], [failing, retry])


def maintenance(call: PatternCall, section: nodes.Section) -> nodes.Section:
    """``mg(g)`` or ``mg(g, pattern)``: *g* holds initially, and is pursued again whenever it is lost.

    *pattern* is applied to the plans for g; the default is blind commitment (``bc``).
    """
    call.at_most(2)
    goal = call.literal(0, "the goal")
    named = len(call.arguments) > 1
    inner = call.nested(section, 1) if named else call.apply(replace(call, name="bc"), section)
    pursue = call.plan(on("-", goal), call.achieve(goal))
    return replace(with_plans(inner, [], inner.plans, [pursue]), beliefs=[*_initial(goal), *inner.beliefs])


def blind(call: PatternCall, section: nodes.Section) -> nodes.Section:
    """``bc(g)`` or ``bc(g, pattern)``: the goal is pursued until it is believed, whatever fails.

    *pattern* (default: ``bdg``) is applied to the plans for g, and a last plan posts the goal again if no
    other
    plan is applicable.
    """
    call.at_most(2)
    if len(call.arguments) < 2:
        return _committed(call, section)
    return _with_last_plan(call, call.nested(section, 1))


def single_minded(call: PatternCall, section: nodes.Section) -> nodes.Section:
    """``smc(g, f)``: the goal is pursued until it or *f*, which says that it is impossible, is believed.

    When f is believed, the goal fails, and its failure reaches the goal or plan that posted it; the retry of the blind
    commitment inside does not catch it (in Jason it does).
    """
    call.at_most(2)
    return _committed(call, section, call.literal(1, "the belief that the goal is impossible"))


def relativised(call: PatternCall, section: nodes.Section) -> nodes.Section:
    """``rc(g, m)``: the goal is pursued until it is believed, or its motivation *m* is no longer believed."""
    call.at_most(2)
    return _motivated(call, _committed(call, section), call.literal(1, "the motivation"))


def open_minded(call: PatternCall, section: nodes.Section) -> nodes.Section:
    """``omc(g, f, m)``: a belief *f* makes the goal fail, and losing the motivation *m* ends it."""
    call.at_most(3)
    committed = _committed(call, section, call.literal(1, "the belief that the goal is impossible"))
    return _motivated(call, committed, call.literal(2, "the motivation"))


def _initial(goal: nodes.Literal) -> list[nodes.Literal]:
    """Return the belief that the goal holds, unless it has variables."""
    stack: list[nodes.Term] = list(goal.arguments)
    while stack:
        term = stack.pop()
        if isinstance(term, nodes.Variable):
            return []
        if isinstance(term, nodes.Literal):
            stack.extend(term.arguments)
        elif isinstance(term, nodes.ListTerm):
            stack.extend(term.items)
    return [goal]


def _tested(plan: nodes.Plan, call: PatternCall) -> nodes.Plan:
    """Return *plan* with a last step that tests its own goal."""
    assert isinstance(plan.body, nodes.Body)
    test = nodes.Test(_own_goal(plan), span=call.span)
    return nodes.replace(plan, body=nodes.replace(plan.body, steps=(*plan.body.steps, test)))


def _tried_once(plan: nodes.Plan, index: int, call: PatternCall) -> nodes.Plan:
    """Return *plan* restricted to goals for which it has not been tried."""
    assert isinstance(plan.body, nodes.Body)
    mark = _tried(nodes.Number(float(index), span=call.span), _own_goal(plan))
    untried: nodes.Term = nodes.Not(mark, span=call.span)
    context = untried if plan.context is None else nodes.And(untried, plan.context, span=plan.context.span)
    steps = (call.change("+", mark), *plan.body.steps)
    return nodes.replace(plan, context=context, body=nodes.replace(plan.body, steps=steps))


def _own_goal(plan: nodes.Plan) -> nodes.Literal:
    """Return the goal of a plan with the plan's own variables, without annotations."""
    assert isinstance(plan.trigger.literal, nodes.Literal)
    return nodes.replace(plan.trigger.literal, annotations=None)


def _tried(index: nodes.Term, goal: nodes.Literal) -> nodes.Literal:
    return nodes.Literal("p__tried", (index, goal), span=goal.span)


def _committed(
    call: PatternCall, section: nodes.Section, impossible: nodes.Literal | None = None
) -> nodes.Section:
    """Blind commitment that fails when *impossible* is believed."""
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
    failing = call.plan(on("-!", goal), call.internal(".fail", reason, message))
    fail = call.plan(on("+", impossible), call.internal(".fail_goal", goal))
    return with_plans(inner, [], inner.plans, [failing, fail])


def _with_last_plan(
    call: PatternCall, section: nodes.Section, possible: nodes.Term | None = None
) -> nodes.Section:
    """Return *section* with ``+!g <- !g`` as the last plan for the goal."""
    goal = call.literal(0, "the goal")
    again = call.plan(on("+!", goal), call.achieve(goal), context=possible)
    return with_plans(section, [], section.plans, [again])


def _motivated(call: PatternCall, section: nodes.Section, motivation: nodes.Literal) -> nodes.Section:
    """Return *section* with a plan that ends the goal, as if achieved, when *motivation* is lost."""
    unmotivated = call.plan(on("-", motivation), call.internal(".succeed_goal", call.literal(0, "the goal")))
    return with_plans(section, [], section.plans, [unmotivated])


def sequenced(call: PatternCall, section: nodes.Section) -> nodes.Section:
    """``sga("trigger", "context", g)``: each such event adopts *g*, one goal at a time.

    Waiting goals are kept in order in beliefs ``p__queue(N, g)``; a goal that is already waiting is not queued again.
    Each goal is an intention of its own, and a goal that fails also makes room for the next one. (Jason adopts a waiting
    goal only if its arguments equal those of the goal that ended.)
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
    # The plans are atomic: nothing may happen between asking whether the queue is busy and noting that it is.
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
    """Return the first argument: a trigger as text or in braces."""
    argument = call.arguments[0] if call.arguments else None
    if isinstance(argument, nodes.String):
        return call.parse_trigger(argument.value)
    if isinstance(argument, nodes.TriggerTerm):
        return argument.trigger
    if isinstance(argument, nodes.BodyTerm) and len(argument.body.steps) == 1:
        step = argument.body.steps[0]
        if isinstance(step, nodes.BeliefChange) and isinstance(step.operand, nodes.Literal | nodes.Variable):
            return nodes.Trigger(step.operator, "", step.operand, span=step.span)
    raise PatternError("argument 1 of `sga` is not a trigger", 'write sga("+order(X)", "true", serve(X))')


def _context(call: PatternCall) -> nodes.Term | None:
    """Return the second argument: a condition, as text or as a term; None for ``true``."""
    if len(call.arguments) < 2:
        raise PatternError("`sga` expects a context as argument 2", 'write "true" for no context')
    argument = call.arguments[1]
    formula = call.parse_formula(argument.value) if isinstance(argument, nodes.String) else argument
    return None if formula == TRUE else formula
