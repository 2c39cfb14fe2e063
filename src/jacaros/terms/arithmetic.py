"""Arithmetic on terms: doubles throughout, evaluated when operands are known, kept as a term until then."""

import math
from collections.abc import Callable, Mapping
from contextvars import ContextVar
from types import MappingProxyType
from typing import Protocol

from jacaros.terms.operators import COMPUTE, named
from jacaros.terms.values import ARITHMETIC, FUNCTION, Annotated, Term, Var, deref

Evaluator = Callable[..., Term]
functions: Mapping[str, Evaluator] = MappingProxyType({})
"""The functions of the language by name, put here by `jacaros.terms.functions`.

They are called with the evaluated arguments and return a number, or None while the arguments are not known.  The agent
that is `RUNNING` knows those that need an agent.
"""


class Caller(Protocol):
    """The agent for which terms are evaluated."""

    @property
    def call_own(self) -> Callable[[Term], Term]:
        """Gives the value of a call of a function that needs an agent, or None while it has none."""

    def warn_of_operand(self, what: str, value: Term) -> None:
        """Take note of an operand that is no number: what it is for, and its value."""


RUNNING: ContextVar[Caller | None] = ContextVar("RUNNING", default=None)
"""The agent whose turn it is; systems on other loops and in other threads have theirs."""


def warn(what: str, value: Term) -> None:
    """Warn of an operand that is no number, by what it is for and its value; the result is not a number then, as in
    Jason."""
    agent = RUNNING.get()
    if agent is not None:
        agent.warn_of_operand(what, value)


def settle(term: Term) -> Term:
    """Dereference, and evaluate when the term is arithmetic whose operands are known."""
    while term.__class__ is Var:
        if term.ref is None:
            return term
        term = term.ref
    if term.__class__ is tuple:
        kind = term[0].kind
        if kind == ARITHMETIC:
            return _evaluate(term)
        if kind == FUNCTION:
            return call(term)
    return term


def _evaluate(term: Term) -> Term:
    try:
        operands = [settle(a) for a in term[1:]]
    except RecursionError:
        return _evaluate_iteratively(term)
    return _apply(term, operands)


_TOO_MANY = 1_000_000
"""Operations that wait for their operands at the same time."""


def _evaluate_iteratively(term: Term) -> Term:
    """The value of arithmetic that is nested too deeply for Python's stack; calls of functions inside stay as they are.

    Raises:
        RecursionError: it is nested without end.
    """
    todo: list[Term] = [term]
    done: list[Term] = []
    while todo:
        item = deref(todo.pop())
        if item.__class__ is list:
            (operation,) = item
            count = len(operation) - 1
            operands = done[-count:]
            del done[-count:]
            done.append(_apply(operation, operands))
        elif item.__class__ is tuple and item[0].kind == ARITHMETIC:
            todo.append([item])
            todo.extend(item[:0:-1])
            if len(todo) > _TOO_MANY:
                raise RecursionError("arithmetic is nested too deeply")
        else:
            done.append(item)
    return done[0]


def _apply(term: Term, operands: list[Term]) -> Term:
    """The value of an operation, or the term itself while an operand is not known."""
    for operand in operands:
        if operand.__class__ is not float and _is_open(operand):
            return term
    return COMPUTE[term[0]](*[_number(o, term) for o in operands])


def _is_open(operand: Term) -> bool:
    """Whether an operand still waits for a value."""
    return operand.__class__ is Var or (
        operand.__class__ is tuple and operand[0].kind in (ARITHMETIC, FUNCTION)
    )


def _number(operand: Term, term: Term) -> float:
    if operand.__class__ is float:
        return operand
    if operand.__class__ is Annotated:
        return _number(deref(operand.term), term)
    warn(f"an operand of '{term[0].name}'", operand)
    return math.nan


def call(term: Term) -> Term:
    """Evaluate a function call; the call itself comes back while arguments are unknown."""
    function = functions.get(term[0].name)
    if function is not None:
        value = function(*term[1:])
    else:
        agent = RUNNING.get()
        value = None if agent is None else agent.call_own(term)
    return term if value is None else value


def calculated(symbol: str, *operands: Term) -> Term:
    """The value of an operation on any terms: the slow path of compiled arithmetic."""
    values = [settle(operand) for operand in operands]
    return _apply((named(symbol, len(values)).functor, *values), values)
