"""Internal actions that wait, that post events later, and that read the run's clock."""

import re
from typing import TYPE_CHECKING, Any

from jacaros.bdi.actions.internal_action import WrongArguments, internal_action
from jacaros.bdi.rules.context import Context
from jacaros.bdi.rules.plan_terms import trigger_of
from jacaros.bdi.state.belief_base import parts
from jacaros.bdi.state.condition_waits import ConditionWait, asked_by
from jacaros.bdi.state.event_waits import EventWait
from jacaros.bdi.state.literals import own_annotations
from jacaros.bdi.state.triggers import Trigger
from jacaros.bdi.state.waiting import Waiting
from jacaros.terms.substitution import rename
from jacaros.terms.text import text
from jacaros.terms.values import Annotated, String, Term, atom, functor, make_list

if TYPE_CHECKING:
    from datetime import datetime

ERROR, TIME, WAIT = functor("error", 1), functor("time", 1), functor("wait", 1)


class _Wait:
    """A ``.wait`` under way."""

    def __init__(self, ctx: Context, awaited: Term, elapsed: Term) -> None:
        self.ctx = ctx
        self.waiting: Waiting = ctx.suspend("wait")
        assert ctx.intention is not None
        # As in Jason: with the number of the intention, and what it waits for.
        self.waiting.reason = Annotated((WAIT, float(ctx.intention.id)), (awaited,))
        self.elapsed = elapsed
        self.began = ctx.architecture.now()
        self.timer: Any = None
        self.entry: Any = None
        self.waiting.on_drop = self.forget

    def limit(self, milliseconds: float, fails: bool) -> None:
        """End after so many milliseconds."""
        self.timer = self.ctx.architecture.set_timer(
            milliseconds / 1000.0, self.timed_out if fails else self.resume
        )

    def timed_out(self) -> None:
        """The awaited thing did not come in time."""
        self.forget()
        if self.elapsed is not None:
            self.resume()
        else:
            self.waiting.fail("the wait is over without what it waited for", (ERROR, atom("wait_timeout")))

    @property
    def ended(self) -> bool:
        """Whether the intention goes on already, or is gone."""
        return self.waiting.ended

    def fail(self, message: str) -> None:
        """What is waited for cannot be evaluated."""
        self.forget()
        self.waiting.fail(message)

    def resume(self) -> None:
        """The wait ends well."""
        self.forget()
        if self.elapsed is not None:
            # A clock may be set back meanwhile.
            seconds = max(0.0, self.ctx.architecture.now() - self.began)
            milliseconds = float(round(seconds * 1000))
            self.ctx.unify(self.elapsed, milliseconds)
            del self.ctx.trail[:]
        self.waiting.resume()

    def forget(self) -> None:
        """Nothing is to be waited for any more."""
        agent = self.ctx.agent
        if self.timer is not None:
            self.timer.cancel()
        if isinstance(self.entry, EventWait):
            agent.event_waits.remove(self.entry)
        elif self.entry is not None:
            agent.condition_waits.remove(self.entry)


@internal_action(".wait", arity=(1, 3), suspends=True, body_only=True, awaits=True)
def wait(ctx: Context, what: Term, limit: Term = None, elapsed: Term = None) -> Any:
    """``.wait(Ms)``, ``.wait({+e} [,Ms [,Elapsed]])``, ``.wait(Condition [,Ms [,Elapsed]])``.

    Waits for a time in milliseconds, an event, or until a condition holds.  After *Ms* milliseconds it fails with
    ``error(wait_timeout)``, unless *Elapsed* is given: then that is the time waited, in milliseconds.
    """
    if limit is not None and limit.__class__ is not float:
        raise WrongArguments(f"the time-out must be a number of milliseconds, not {text(limit)}")
    if what.__class__ is float:
        waited = _Wait(ctx, (TIME, what), elapsed)
        waited.limit(what, fails=False)
        return waited.waiting
    found = trigger_of(what)
    if found is None:
        return _wait_for_condition(ctx, what, limit, elapsed)
    waited = _Wait(ctx, rename(found[1]), elapsed)
    waited.entry = EventWait(found[0], found[1], waited)
    ctx.agent.event_waits.add(waited.entry)
    if limit is not None:
        waited.limit(limit, fails=True)
    return waited.waiting


def _wait_for_condition(ctx: Context, formula: Term, limit: Term, elapsed: Term) -> Any:
    if ctx.succeeds(formula):
        return None if elapsed is None else ctx.unify(elapsed, 0.0)
    waited = _Wait(ctx, rename(formula), elapsed)

    def holds() -> bool:
        if ctx.succeeds(formula):
            del ctx.trail[:]
            return True
        return False

    agent = ctx.agent
    waited.entry = ConditionWait(holds, waited, asked_by(formula, agent.beliefs, agent.actions))
    agent.condition_waits.add(waited.entry)
    agent.called = True
    if limit is not None:
        waited.limit(limit, fails=True)
    return waited.waiting


_UNITS = {"": 0.001, "ms": 0.001, "s": 1.0, "m": 60.0, "h": 3600.0, "d": 86400.0}
_MOMENT = re.compile(r"\s*now\s*(?:\+\s*([0-9.]+)\s*([a-z]*))?\s*$")


def _unit(word: str) -> str | None:
    for known in ("second", "minute", "hour", "day"):
        if word.rstrip("s") == known:
            return known[0]
    return word if word in _UNITS else "ms" if word.startswith("milli") else None


@internal_action(".at", arity=2)
def at(ctx: Context, moment: Term, event: Term) -> None:
    """``.at("now +5 s", {+!g})``: post an event later; units ms (when none is given), s, m, h and d.

    ``.drop_all_intentions`` takes it back.
    """
    found = trigger_of(event)
    match = _MOMENT.match(str(moment)) if moment.__class__ is String else None
    unit = _unit(match.group(2) or "") if match else None
    if found is None or found[0] is None or match is None or unit is None:
        raise WrongArguments('.at takes a moment such as "now +5 s" and an event such as {+!g}')
    delay = float(match.group(1) or 0) * _UNITS[unit]
    kind, literal, delayed = found[0], rename(found[1]), ctx.agent.delayed_events

    def due() -> None:
        delayed.pop(timer, None)
        post_event(ctx, kind, literal)

    timer = ctx.architecture.set_timer(delay, due)
    delayed[timer] = None


def post_event(ctx: Context, kind: Trigger, literal: Term) -> None:
    """Post an external event."""
    _, arguments, annotations = parts(rename(literal))
    ctx.agent.post(((kind, *arguments), None, own_annotations(annotations), None))
    ctx.architecture.ready()


@internal_action(".signal", arity=(1, 2))
def signal(ctx: Context, event: Term, kind: Term = None) -> None:
    """``.signal({+e})``: post an event without changing beliefs."""
    del kind
    found = trigger_of(event)
    if found is None or found[0] is None:
        raise WrongArguments(".signal takes an event such as {+e}")
    post_event(ctx, found[0], found[1])


@internal_action(".time", arity=(3, 4), repeatable=True)
def time(ctx: Context, hour: Term, minute: Term, second: Term, *millisecond: Term) -> bool:
    """``.time(H, M, S[, Ms])``: the time of day in UTC, as whole numbers.  Fails when it is another."""
    now = _now(ctx)
    parts = (now.hour, now.minute, now.second, now.microsecond // 1000)
    asked = (hour, minute, second, *millisecond)
    return ctx.unify(make_list(asked), make_list([float(part) for part in parts[: len(asked)]]))


@internal_action(".date", arity=3, repeatable=True)
def date(ctx: Context, year: Term, month: Term, day: Term) -> bool:
    """``.date(Y, M, D)``: the date in UTC, month and day counted from 1.  Fails when it is another."""
    now = _now(ctx)
    return ctx.unify(
        make_list((year, month, day)), make_list([float(now.year), float(now.month), float(now.day)])
    )


@internal_action(".nano_time", arity=1)
def nano_time(ctx: Context, nanoseconds: Term) -> bool:
    """``.nano_time(T)``: nanoseconds since the Unix epoch, as exact as a double holds them."""
    return ctx.unify(nanoseconds, float(round(ctx.architecture.now() * 1e9)))


def _now(ctx: Context) -> "datetime":
    """The present in UTC, not in local time: programs behave the same everywhere, and on a virtual clock."""
    from datetime import UTC, datetime  # here: few programs ask for the time

    return datetime.fromtimestamp(ctx.architecture.now(), UTC)
