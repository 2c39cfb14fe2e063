"""Arithmetic on terms, evaluated when operands are known, kept as a term until then: doubles, and exact integers.

>>> from jacaros.agents.terms.operators import BINARY
>>> distance = Var("D")
>>> half = (BINARY["/"].functor, distance, 2.0)
>>> settle(half) is half
True
>>> distance.ref = 5.0
>>> settle(half)
2.5
"""

import math
from collections.abc import Callable, Mapping
from contextvars import ContextVar
from types import MappingProxyType
from typing import Any, Protocol

from jacaros.agents.terms.operators import COMPUTE, named
from jacaros.agents.terms.values import (
    ARITHMETIC,
    FUNCTION,
    NUMBERS,
    Annotated,
    Functor,
    Term,
    Var,
    deref,
    double,
    number,
)

Evaluator = Callable[..., Term]
function_table: Mapping[str, Evaluator] = MappingProxyType({})
"""The functions of the language by name, registered by `jacaros.agents.terms.functions`.

They are called with the evaluated arguments and return a number, or None while the arguments are unknown. Functions that
need an agent are called on the agent in `RUNNING`.
"""


class Caller(Protocol):
    """The agent for which terms are evaluated."""

    @property
    def call_own(self) -> Callable[[Term], Term]:
        """Returns the value of a call of a function that needs an agent, or None while it has none."""

    def warn_of_operand(self, what: str, value: Term) -> None:
        """Handle an operand that is not a number: a description of it, and its value."""


RUNNING: ContextVar[Caller | None] = ContextVar("RUNNING", default=None)
"""The agent whose turn it is; systems on other loops and in other threads have their own."""


def warn(what: str, value: Term) -> None:
    """Warn of an operand that is not a number. As in Jason, the result is NaN."""
    agent = RUNNING.get()
    if agent is not None:
        agent.warn_of_operand(what, value)


def settle(term: Term) -> Term:
    """Dereference, and evaluate arithmetic whose operands are known."""
    while term.__class__ is Var:
        if term.ref is None:
            return term
        term = term.ref
    if term.__class__ is tuple:
        kind = term[0].kind
        if kind == ARITHMETIC:
            operands = []
            # No comprehension: the depth of a sum is limited by the functions on Python's stack, and a call from C, as
            # `map` makes it, takes much more of the thread's own stack.
            for operand in term[1:]:
                operands.append(settle(operand))
            return _apply(term, operands)
        if kind == FUNCTION:
            return call(term)
    return term


def _apply(term: Term, operands: list[Term]) -> Term:
    """Return the value of an operation, or the term itself while an operand is unknown."""
    for operand in operands:
        if operand.__class__ not in NUMBERS and _is_open(operand):
            return term
    numbers = [_number(o, term) for o in operands]
    if any(n.__class__ is int for n in numbers):
        return _exactly(term[0], numbers)
    return COMPUTE[term[0]](*numbers)


def _remainder(left: int, right: int) -> int:
    """Return the remainder with the sign of *left*, as Java does."""
    return left - right * (abs(left) // abs(right)) * (1 if (left < 0) == (right < 0) else -1)


_EXACT: Mapping[str, Callable[..., int]] = MappingProxyType(
    {
        "+": lambda left, right=0: left + right,
        "-": lambda left, right=None: -left if right is None else left - right,
        "*": lambda left, right: left * right,
        "div": lambda left, right: (left - _remainder(left, right)) // right,
        "mod": _remainder,
    }
)
"""Operations of integers with an integer as their value, by symbol."""


def _exactly(symbol: Functor, numbers: list[float]) -> float:
    """Return the value of an operation with an operand that no double is equal to: exact between integers."""
    exact = _EXACT.get(symbol.name)
    if exact is None or not all(n.__class__ is int or n.is_integer() for n in numbers):
        return COMPUTE[symbol](*map(double, numbers))
    try:
        return number(exact(*map(int, numbers)))
    except ZeroDivisionError:
        return COMPUTE[symbol](*map(double, numbers))


def _is_open(operand: Term) -> bool:
    """Return whether an operand still waits for a value."""
    return operand.__class__ is Var or (
        operand.__class__ is tuple and operand[0].kind in (ARITHMETIC, FUNCTION)
    )


def _number(operand: Term, term: Term) -> Any:
    if operand.__class__ in NUMBERS:
        return operand
    if operand.__class__ is Annotated:
        return _number(deref(operand.term), term)
    warn(f"operand of `{term[0].name}`", operand)
    return math.nan


def call(term: Term) -> Term:
    """Evaluate a function call; return the call itself while arguments are unknown."""
    function = function_table.get(term[0].name)
    if function is not None:
        value = function(*term[1:])
    else:
        agent = RUNNING.get()
        value = None if agent is None else agent.call_own(term)
    return term if value is None else value


def calculated(symbol: str, *operands: Term) -> Term:
    """Return the value of an operation on any terms: the slow path of compiled arithmetic."""
    values = [settle(operand) for operand in operands]
    return _apply((named(symbol, len(values)).functor, *values), values)
