"""Internal actions about the plan library."""

from collections.abc import Iterator

from jacaros.asl.diagnostics import AslError
from jacaros.asl.reflection import NotAPlan
from jacaros.bdi.actions.internal_action import ActionError, WrongArguments, internal_action
from jacaros.bdi.rules import plan_terms
from jacaros.bdi.rules.context import Context
from jacaros.bdi.state.plan import Plan
from jacaros.terms.text import plan_text, text
from jacaros.terms.values import SELF, Term, atom, bare, is_list, list_items, make_list


def _source(term: Term) -> Term:
    """The source that an argument names, the agent itself by default."""
    return SELF if term is None else bare(term)


def _term(ctx: Context, plan: Plan) -> Term:
    """A plan as a term, with its label and what is known of it."""
    return plan_terms.plan_term(ctx.agent, plan)


@internal_action(".add_plan", arity=(1, 3), brings_in=True, changes_plans=True)
def add_plan(ctx: Context, plan: Term, source: Term = None, where: Term = None) -> None:
    """``.add_plan(P [,Source [,begin]])``: P is a plan term, a string, or a list of them."""
    first = where is not None and bare(where) is atom("begin")
    try:
        ctx.agent.add_plan(plan, _source(source), first)
    except NotAPlan as fault:
        raise WrongArguments(str(fault)) from fault
    except AslError as fault:
        raise ActionError(f"the text is no plan: {fault}") from fault


@internal_action(".remove_plan", arity=(1, 2), changes_plans=True)
def remove_plan(ctx: Context, wanted: Term, source: Term = None) -> None:
    """``.remove_plan(Label [,Source])``: also a list of labels, or a plan term; there need not be such a plan."""
    for item in list_items(wanted) if is_list(wanted) else (wanted,):
        ctx.agent.remove_plan(item, _source(source))


@internal_action(".plan_label", arity=2, backtracks=True)
def plan_label(ctx: Context, target: Term, label: Term) -> Iterator[None]:
    """``.plan_label(P, L)``: each plan with its label."""
    for plan in list(ctx.agent.library.plans):
        if ctx.unify_all((label, ctx.agent.library.label(plan)), (target, _term(ctx, plan))):
            yield


def _relevant(ctx: Context, event: Term) -> list[Plan]:
    plans = plan_terms.relevant_plans(ctx.agent, event)
    if plans is None:
        raise WrongArguments(f"an event such as {{+!g}} is expected, not {text(event)}")
    return plans


@internal_action(".relevant_plans", arity=(2, 3))
def relevant_plans(ctx: Context, event: Term, target: Term, labels: Term = None) -> bool:
    """``.relevant_plans({T}, Ps [,Labels])``: the plans whose triggers unify with an event, in their order."""
    plans = _relevant(ctx, event)
    if not ctx.unify(target, make_list([_term(ctx, p) for p in plans])):
        return False
    return labels is None or ctx.unify(labels, make_list([ctx.agent.library.label(p) for p in plans]))


@internal_action(".relevant_plan", arity=2, backtracks=True)
def relevant_plan(ctx: Context, event: Term, target: Term) -> Iterator[None]:
    """``.relevant_plan({T}, P)``: each plan for an event."""
    for plan in _relevant(ctx, event):
        if ctx.unify(target, _term(ctx, plan)):
            yield


@internal_action(".list_plans", arity=(0, 1))
def list_plans(ctx: Context, event: Term = None) -> None:
    """``.list_plans [({T})]``: print the plans."""
    for plan in ctx.agent.library.plans if event is None else _relevant(ctx, event):
        ctx.architecture.print(plan_text(_term(ctx, plan)))
