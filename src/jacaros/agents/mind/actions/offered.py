"""Internal actions for goals and events that callers outside hear of, see `jacaros.agents.language.offers`."""

from jacaros.agents.mind.actions.goals import ERROR, ERROR_MSG
from jacaros.agents.mind.actions.internal_action import internal_action, number, string
from jacaros.agents.mind.rules.context import Context
from jacaros.agents.mind.state.act import Callers
from jacaros.agents.mind.state.plan import Failure
from jacaros.agents.terms.substitution import is_ground
from jacaros.agents.terms.text import display, text
from jacaros.agents.terms.values import String, Term, atom, functor, functor_of

REFUSED = functor("refused", 1)
"""Functor of the reason of a goal that the agent refuses."""


def _callers(ctx: Context) -> Callers | None:
    callers: Callers | None = ctx.agent.observers.callers
    return callers


@internal_action(".accept", arity=0, body_only=True)
def accept(ctx: Context) -> None:
    """``.accept``: the goal that a caller gave is accepted, before its plan acts or waits."""
    callers = _callers(ctx)
    if callers is not None and ctx.intention is not None:
        callers.accepted(ctx.intention)


@internal_action(".refuse", arity=1, body_only=True, prints=True)
def refuse(ctx: Context, reason: Term) -> None:
    """``.refuse(Reason)`` fails with ``refused(Reason)``; a goal that is not accepted yet counts as refused."""
    del ctx
    told = String(display(reason))
    raise Failure((REFUSED, reason), (ERROR, atom("refused")), (ERROR_MSG, told))


@internal_action(".progress", arity=(1, 2), body_only=True)
def progress(ctx: Context, fraction: Term, note: Term = None) -> None:
    """``.progress(Fraction [,Text])`` tells the caller of the goal how far it is, from 0 to 1."""
    done = min(1.0, max(0.0, number(fraction, "the first argument")))
    told = "" if note is None else string(note, "the second argument")
    callers = _callers(ctx)
    if callers is not None and ctx.intention is not None:
        callers.progressed(ctx.intention, done, told)


@internal_action(".announce", arity=1, body_only=True, prints=True)
def announce(ctx: Context, event: Term) -> None:
    """``.announce(Event)`` tells callers of an event that the program offers; another one is not tolerated."""
    symbol, callers = functor_of(event), _callers(ctx)
    if symbol is None or not is_ground(event):
        raise Failure((ERROR, atom("wrong_arguments")), (ERROR_MSG, String(f"no event: {text(event)}")))
    if not any(
        each.what == "event" and (each.name, len(each.parameters)) == (symbol.name, symbol.arity)
        for each in ctx.agent.program.offers
    ):
        told = f"the program does not offer the event {symbol.name}/{symbol.arity}"
        raise Failure((ERROR, atom("not_offered")), (ERROR_MSG, String(told)))
    if callers is not None:
        callers.announced(event)
