"""Internal actions that tell the time of the run's clock, always in UTC.

Local time is not used: programs behave the same everywhere, and on a virtual clock.
"""

from typing import TYPE_CHECKING

from jacaros.bdi.actions.internal_action import internal_action
from jacaros.bdi.rules.context import Context
from jacaros.terms.values import Term, make_list

if TYPE_CHECKING:
    from datetime import datetime


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
    from datetime import UTC, datetime  # here: few programs ask for the time

    return datetime.fromtimestamp(ctx.architecture.now(), UTC)
