"""Arithmetic on terms: doubles throughout, evaluated when operands are known, kept as a term until then."""

import math
from collections.abc import Callable
from contextvars import ContextVar
from typing import Protocol

from jacaros.terms.values import (
    ARITHMETIC,
    FUNCTION,
    Annotated,
    Term,
    Var,
    deref,
    functor,
)


class ArithmeticFault(Exception):
    """An operation without a result, such as a division by zero of ``div``; it fails the step."""


def divide(left: float, right: float) -> float:
    """Division of reals: ``x / 0`` is infinite or not a number, as in IEEE."""
    if right == 0.0:
        if left == 0.0 or left != left:
            return math.nan
        return math.copysign(math.inf, left) * math.copysign(1.0, right)
    return left / right


def to_int(value: float) -> int:
    """Truncate as Java casts a double to a 32-bit integer."""
    if value != value:
        return 0
    return math.trunc(max(-(2.0**31), min(2.0**31 - 1, value)))


def integer_divide(left: float, right: float) -> float:
    """``div``: both operands and the quotient truncated towards zero.

    Raises:
        ArithmeticFault: when the divisor is zero.
    """
    dividend, divisor = to_int(left), to_int(right)
    if divisor == 0:
        raise ArithmeticFault("integer division by zero")
    quotient = abs(dividend) // abs(divisor)
    return float(quotient if (dividend < 0) == (divisor < 0) else -quotient)


def remainder(left: float, right: float) -> float:
    """``mod``: the remainder that has the sign of the dividend."""
    if right == 0.0 or not math.isfinite(left):
        return math.nan
    return math.fmod(left, right)


def power(left: float, right: float) -> float:
    """``**``; infinite or not a number where there is no real result, and ``1 ** x`` is 1 for finite x only."""
    if abs(left) == 1.0 and not math.isfinite(right):
        return math.nan
    try:
        result = left**right
    except ZeroDivisionError:
        return math.inf
    except OverflowError:
        return -math.inf if left < 0 and right % 2 == 1 else math.inf
    return result if result.__class__ is float else math.nan


OPERATIONS: dict[str, Callable[[float, float], float]] = {
    "+": lambda a, b: a + b,
    "-": lambda a, b: a - b,
    "*": lambda a, b: a * b,
    "/": divide,
    "div": integer_divide,
    "mod": remainder,
    "**": power,
}

ADD = functor("+", 2, kind=ARITHMETIC)
SUBTRACT = functor("-", 2, kind=ARITHMETIC)
MULTIPLY = functor("*", 2, kind=ARITHMETIC)
NEGATE = functor("-", 1, kind=ARITHMETIC)
AFFIRM = functor("+", 1, kind=ARITHMETIC)

Evaluator = Callable[..., Term]
functions: dict[str, Evaluator] = {}
"""Arithmetic functions by name; they are given the evaluated arguments and return a number, or None when the
arguments are not known yet.  Functions that need an agent are known to the one that is `RUNNING`."""


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
        return _evaluate_deep(term)
    return _apply(term, operands)


_TOO_MANY = 1_000_000
"""Operations that wait for their operands at the same time."""


def _evaluate_deep(term: Term) -> Term:
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
    numbers = [_number(o, term) for o in operands]
    if len(numbers) == 1:
        return -numbers[0] if term[0].name == "-" else numbers[0]
    return OPERATIONS[term[0].name](numbers[0], numbers[1])


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


def binary(operator: str, left: Term, right: Term) -> Term:
    """The value of an operation on any terms: the slow path of compiled arithmetic."""
    left, right = settle(left), settle(right)
    if left.__class__ is float and right.__class__ is float:
        return OPERATIONS[operator](left, right)
    return _evaluate((functor(operator, 2, kind=ARITHMETIC), left, right))


def negate(operand: Term) -> Term:
    """The value of unary minus on any term."""
    operand = settle(operand)
    return -operand if operand.__class__ is float else _evaluate((NEGATE, operand))


def affirm(operand: Term) -> Term:
    """The value of unary plus on any term."""
    operand = settle(operand)
    return operand if operand.__class__ is float else _evaluate((AFFIRM, operand))
