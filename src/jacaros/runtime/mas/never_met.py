"""Report at the end of a run what nothing has met, if a similar belief is there: events that plans and waits name.

Only a belief that no plan takes counts as similar, so a plan for another event of that name, or for a rare one, is not
reported.
"""

from collections.abc import Iterator
from typing import TYPE_CHECKING

from jacaros.agents.checks.beliefs import is_misspelt
from jacaros.agents.language import nodes
from jacaros.agents.language.lowering import Variables, format_term, lower
from jacaros.agents.mind.rules.failure_reason import Place, unanswered
from jacaros.agents.mind.rules.unmet import other_kind
from jacaros.agents.mind.state.belief_base import literal
from jacaros.agents.mind.state.intention import STEP
from jacaros.agents.mind.state.plan import Plan
from jacaros.agents.terms.text import excerpt, text
from jacaros.agents.terms.unifier import Trail, undo, unify
from jacaros.agents.terms.values import Functor, Term, arguments_of, functor_of

if TYPE_CHECKING:
    from jacaros.agents.mind.mind import Mind


def never_met(mind: "Mind") -> Iterator[str]:
    """Yield a line for each plan for a belief, and each `.wait`, that only a similar belief would meet."""
    plans = [plan for plan in mind.library.plans if _is_for_belief(plan)]
    triggers = [lower(plan.node.trigger.literal, Variables().__getitem__) for plan in plans]
    untaken = {
        symbol: fact for symbol, fact in _facts(mind) if not any(_unify(fact, each) for each in triggers)
    }
    for plan, wanted in zip(plans, triggers, strict=True):
        why = _similar(mind, wanted, untaken)
        if why:
            yield f"`+{format_term(plan.node.trigger.literal)}` has not happened ({_place(plan)}): {why}"
    for intention in mind.alive.values():
        frame = None if intention.waiting is None else intention.waiting.frame
        if frame is None:
            continue
        place = Place(frame, getattr(frame[STEP], "info", None))
        for why in unanswered(mind, place):
            if why.endswith("?") or "there is" in why or "the belief is" in why or "before" in why:
                yield f"`{place.step()}` has not ended ({place.where()}): {why}"


def _is_for_belief(plan: Plan) -> bool:
    trigger = plan.node.trigger
    return (trigger.operator, trigger.kind) == ("+", "") and isinstance(trigger.literal, nodes.Literal)


def _facts(mind: "Mind") -> Iterator[tuple[Functor, Term]]:
    """Yield the newest fact of each belief."""
    for symbol, table in mind.beliefs.items():
        row = next(reversed(table.rows), None) if not table.others else None
        if row is not None:
            yield symbol, literal(symbol, row)


def _unify(fact: Term, trigger: Term) -> bool:
    trail = Trail()
    try:
        return unify(fact, trigger, trail)
    finally:
        undo(trail, 0)


def _similar(mind: "Mind", wanted: Term, untaken: dict[Functor, Term]) -> str:
    """Return which untaken belief is nearly the one that a plan is for, or an empty string."""
    symbol = functor_of(wanted)
    if symbol is None or symbol.namespace is not None:
        return ""
    if symbol in untaken:
        return other_kind(mind.beliefs, symbol, arguments_of(wanted))
    if symbol in mind.beliefs and mind.beliefs[symbol].rows:
        return ""
    for other, fact in untaken.items():
        # One of this name with another number of arguments may be a signal, which leaves no belief.
        if other.arity == symbol.arity and is_misspelt(symbol.name, other.name):
            return f"the belief is `{text(excerpt(fact))}`"
    return ""


def _place(plan: Plan) -> str:
    span = plan.node.span
    return plan.file if span is None else f"{span.file.name}:{span.line}"
