"""Internal actions that wait, post events later, and read the run's clock."""

import re
from typing import TYPE_CHECKING, Any

from jacaros.agents.mind.actions.internal_action import WrongArguments, internal_action
from jacaros.agents.mind.rules import waits
from jacaros.agents.mind.rules.context import Context
from jacaros.agents.mind.rules.goals import post_external
from jacaros.agents.mind.rules.pending import listen, now, set_alarm, watch
from jacaros.agents.mind.rules.plan_terms import trigger_of
from jacaros.agents.mind.state.pending import Waiting
from jacaros.agents.terms.substitution import rename
from jacaros.agents.terms.text import text
from jacaros.agents.terms.values import Annotated, String, Term, functor, make_list

if TYPE_CHECKING:
    from datetime import datetime

TIME, WAIT = functor("time", 1), functor("wait", 1)


@internal_action(".wait", arity=(1, 3), suspends=True, body_only=True, awaits=True)
def wait(ctx: Context, what: Term, limit: Term = None, elapsed: Term = None) -> Any:
    """``.wait(Ms)``, ``.wait({+e} [,Ms [,Elapsed]])``, ``.wait(Condition [,Ms [,Elapsed]])``.

    Waits for a time in milliseconds, for an event, or until a condition holds. After *Ms* milliseconds it fails with
    ``error(wait_timeout)``, unless *Elapsed* is given: then it succeeds, and *Elapsed* is the time waited, in
    milliseconds.
    """
    if limit is not None and limit.__class__ is not float:
        raise WrongArguments(f"the timeout must be a number of milliseconds, not {text(limit)}")
    agent = ctx.agent
    if what.__class__ is float:
        timed = _begin(ctx, (TIME, what), elapsed)
        timed.pending.append(set_alarm(agent, what / 1000.0, waits.come_true, timed))
        return timed
    found = trigger_of(what)
    if found is not None:
        waiting = _begin(ctx, rename(found[1]), elapsed)
        waiting.pending.append(listen(agent, *found[:2], waits.come_true, waiting))
    elif ctx.succeeds(what):
        return None if elapsed is None else ctx.unify(elapsed, 0.0)
    else:
        waiting = _begin(ctx, rename(what), elapsed)
        waiting.pending.append(watch(agent, what, waits.see_condition, waiting))
    if limit is not None:
        waiting.pending.append(set_alarm(agent, limit / 1000.0, waits.time_out, waiting))
    return waiting


def _begin(ctx: Context, awaited: Term, elapsed: Term) -> Waiting:
    """Begin to wait. The reason is that of Jason: the number of the intention, and what it waits for."""
    intention = ctx.suspendable()
    reason = Annotated((WAIT, float(intention.id)), (awaited,))
    return Waiting(intention, reason, began=now(ctx.agent), elapsed=elapsed)


_UNITS = {"": 0.001, "ms": 0.001, "s": 1.0, "m": 60.0, "h": 3600.0, "d": 86400.0}
_MOMENT = re.compile(r"\s*now\s*(?:\+\s*([0-9.]+)\s*([a-z]*))?\s*$")


def _unit(word: str) -> str | None:
    for known in ("second", "minute", "hour", "day"):
        if word.rstrip("s") == known:
            return known[0]
    return word if word in _UNITS else "ms" if word.startswith("milli") else None


@internal_action(".at", arity=2)
def at(ctx: Context, moment: Term, event: Term) -> None:
    """``.at("now +5 s", {+!g})`` posts an event later; units ms (the default), s, m, h and d.

    ``.drop_all_intentions`` cancels it.
    """
    found = trigger_of(event)
    match = _MOMENT.match(str(moment)) if moment.__class__ is String else None
    unit = _unit(match.group(2) or "") if match else None
    if found is None or found[0] is None or match is None or unit is None:
        raise WrongArguments('.at expects a moment such as "now +5 s" and an event such as {+!g}')
    delay = float(match.group(1) or 0) * _UNITS[unit]
    set_alarm(ctx.agent, delay, post_external, found[0], rename(found[1]))


@internal_action(".signal", arity=(1, 2))
def signal(ctx: Context, event: Term, kind: Term = None) -> None:
    """``.signal({+e})`` posts an event without changing beliefs."""
    del kind
    found = trigger_of(event)
    if found is None or found[0] is None:
        raise WrongArguments(".signal expects an event such as {+e}")
    post_external(ctx.agent, found[0], found[1])


@internal_action(".time", arity=(3, 4), pure=True)
def time(ctx: Context, hour: Term, minute: Term, second: Term, *millisecond: Term) -> bool:
    """``.time(H, M, S[, Ms])``: the time of day in UTC, as integers. Fails if the arguments are another time."""
    now = _now(ctx)
    parts = (now.hour, now.minute, now.second, now.microsecond // 1000)
    asked = (hour, minute, second, *millisecond)
    return ctx.unify(make_list(asked), make_list([float(part) for part in parts[: len(asked)]]))


@internal_action(".date", arity=3, pure=True)
def date(ctx: Context, year: Term, month: Term, day: Term) -> bool:
    """``.date(Y, M, D)``: the date in UTC, month and day counted from 1. Fails if the arguments are another date."""
    now = _now(ctx)
    return ctx.unify(
        make_list((year, month, day)), make_list([float(now.year), float(now.month), float(now.day)])
    )


@internal_action(".nano_time", arity=1, pure=True)
def nano_time(ctx: Context, nanoseconds: Term) -> bool:
    """``.nano_time(T)``: *T* is the number of nanoseconds since the Unix epoch, with the precision of a double."""
    return ctx.unify(nanoseconds, float(round(ctx.architecture.now() * 1e9)))


def _now(ctx: Context) -> "datetime":
    """The present in UTC, not in local time: programs behave the same everywhere, and on a virtual clock."""
    from datetime import UTC, datetime  # imported here: few programs ask for the time

    return datetime.fromtimestamp(ctx.architecture.now(), UTC)
