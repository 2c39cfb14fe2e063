"""The operators of the language, one line for each in `OPERATORS`, and arithmetic on terms.

>>> BINARY["div"].numbers(7.0, -2.0)
-3.0
>>> BINARY["&"].level < BINARY["<"].level < BINARY["+"].level
True
>>> distance = Var("D")
>>> half = (BINARY["/"].functor, distance, 2.0)
>>> settle(half) is half
True
>>> distance.ref = 5.0
>>> settle(half)
2.5

Lexer, parser, printers, `jacaros fmt`, compiler and interpreter read this table. To add an arithmetic operator, or a
relation that binds nothing, add a line here (and its function, if Python has none). A connective also needs a syntax
node and a meaning as a condition.
"""

import math
import operator
from collections.abc import Callable, Mapping
from contextvars import ContextVar
from types import MappingProxyType
from typing import Any, Final, NamedTuple

from jacaros.agents.terms.values import (
    ARITHMETIC,
    FUNCTION,
    LOGIC,
    NEGATED,
    NUMBERS,
    RELATION,
    Annotated,
    Functor,
    Term,
    Var,
    deref,
    double,
    functor,
    number,
)


class ArithmeticFault(Exception):
    """An operation without a result, such as a division by zero of ``div``; it fails the step."""


class Operator(NamedTuple):
    """One operator.

    Attributes:
        symbol: as written.
        kind: `LOGIC`, `RELATION` or `ARITHMETIC`.
        level: a higher one binds tighter.
        numbers: computes its value for numbers: a number, or whether the relation holds. None for connectives and ``=..``.
        code: the same as Python code, with ``{0}`` and ``{1}`` for the operands; by default a call of *numbers*.
        arity: number of operands; an operator with one is written before it.
        right: ``a op b op c`` means ``a op (b op c)``.
        binds: the relation may bind variables.
        partial: the value may not exist (`ArithmeticFault`), computed only when needed.
    """

    symbol: str
    kind: int
    level: int
    numbers: Callable[..., Any] | None = None
    code: str = ""
    arity: int = 2
    right: bool = False
    binds: bool = False
    partial: bool = False

    @property
    def functor(self) -> Functor:
        """The functor of its terms."""
        return functor(self.symbol, self.arity, kind=self.kind)

    @property
    def is_word(self) -> bool:
        """Whether it is written in letters, and therefore reserved."""
        return self.symbol.isalpha()

    @property
    def orders(self) -> bool:
        """Whether it is a relation that depends on the order of its operands."""
        return self.kind == RELATION and self.numbers not in (operator.eq, operator.ne, None)

    @property
    def between(self) -> str:
        """The symbol as it is printed between two operands."""
        return self.symbol if self.kind == ARITHMETIC and not self.is_word else f" {self.symbol} "

    def code_for(self, *operands: str) -> str:
        """Python code for the value of numbers."""
        if self.code:
            return self.code.format(*operands)
        assert self.numbers is not None
        return f"{self.numbers.__name__}({', '.join(operands)})"


def divide(left: float, right: float) -> float:
    """Division of reals: ``x / 0`` is infinite or NaN, as in IEEE 754."""
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
    """``div``: both operands and the quotient are truncated towards zero.

    Raises:
        ArithmeticFault: the divisor is zero.
    """
    dividend, divisor = to_int(left), to_int(right)
    if divisor == 0:
        raise ArithmeticFault("integer division by zero")
    quotient = abs(dividend) // abs(divisor)
    return float(quotient if (dividend < 0) == (divisor < 0) else -quotient)


def remainder(left: float, right: float) -> float:
    """``mod``: the remainder has the sign of the dividend."""
    if right == 0.0 or not math.isfinite(left):
        return math.nan
    return math.fmod(left, right)


def power(left: float, right: float) -> float:
    """``**``; infinite or NaN if there is no real result, and ``1 ** x`` is 1 only for finite x."""
    if abs(left) == 1.0 and not math.isfinite(right):
        return math.nan
    try:
        result = left**right
    except ZeroDivisionError:
        return math.inf
    except OverflowError:
        return -math.inf if left < 0 and right % 2 == 1 else math.inf
    return result if result.__class__ is float else math.nan


OPERATORS: Final = (
    Operator("|", LOGIC, 1, right=True),
    Operator("&", LOGIC, 2, right=True),
    Operator("not", LOGIC, 3, arity=1),
    Operator("<", RELATION, 4, operator.lt, "{0} < {1}"),
    Operator("<=", RELATION, 4, operator.le, "{0} <= {1}"),
    Operator(">", RELATION, 4, operator.gt, "{0} > {1}"),
    Operator(">=", RELATION, 4, operator.ge, "{0} >= {1}"),
    Operator("==", RELATION, 4, operator.eq, "{0} == {1}"),
    Operator("\\==", RELATION, 4, operator.ne, "{0} != {1}"),
    Operator("=", RELATION, 4, operator.eq, "{0} == {1}", binds=True),
    Operator("=..", RELATION, 4, binds=True),
    Operator("+", ARITHMETIC, 5, operator.add, "{0} + {1}"),
    Operator("-", ARITHMETIC, 5, operator.sub, "{0} - {1}"),
    Operator("*", ARITHMETIC, 6, operator.mul, "{0} * {1}"),
    Operator("/", ARITHMETIC, 6, divide),
    Operator("div", ARITHMETIC, 6, integer_divide, partial=True),
    Operator("mod", ARITHMETIC, 6, remainder),
    Operator("**", ARITHMETIC, 7, power, right=True),
    Operator("-", ARITHMETIC, 8, operator.neg, "-{0}", arity=1),
    Operator("+", ARITHMETIC, 8, operator.pos, "{0}", arity=1),
)
BINARY: Final = {each.symbol: each for each in OPERATORS if each.arity == 2}
PREFIX: Final = {each.symbol: each for each in OPERATORS if each.arity == 1}
OR, AND, NOT, SUM = (each.level for each in (BINARY["|"], BINARY["&"], PREFIX["not"], BINARY["+"]))
"""Levels used by name in the grammar."""
COMPUTE: Final[dict[Functor, Callable[..., float]]] = {
    each.functor: each.numbers for each in OPERATORS if each.kind == ARITHMETIC and each.numbers is not None
}
"""The functions of arithmetic, by the functor of its terms."""
WORDS: Final = frozenset(each.symbol for each in OPERATORS if each.is_word)
"""The reserved words among the operators."""


def symbols_of(kind: int) -> list[str]:
    """The symbols of the binary operators of a kind."""
    return [symbol for symbol, each in BINARY.items() if each.kind == kind]


def named(symbol: str, arity: int) -> Operator:
    """The operator of that symbol and number of operands."""
    return (BINARY if arity == 2 else PREFIX)[symbol]


# Strong negation and namespaces of terms that are known only later: ``~X`` and ``ns::X``.


def qualify(value: Term, namespace: str | None, negated: bool) -> Term:
    """The literal with another namespace or with strong negation.

    ``~X`` with X unbound is kept as a term of its own, which unifies with negated literals only.
    """
    term = deref(value)
    if term.__class__ is Annotated:
        return Annotated(qualify(term.term, namespace, negated), term.annotations, term.tail)
    if term.__class__ is tuple and term[0] is not NEGATED:
        old = term[0]
        return (functor(old.name, old.arity, old.negated or negated, namespace or old.namespace), *term[1:])
    if term.__class__ is Functor:
        return functor(term.name, 0, term.negated or negated, namespace or term.namespace)
    if term.__class__ is Var and negated:
        return (NEGATED, term)
    return term


def positive_form(term: Term) -> Term | None:
    """Return a negated literal without its negation; None for any other term."""
    symbol = term[0] if term.__class__ is tuple else term
    if symbol.__class__ is not Functor or not symbol.negated:
        return None
    plain = functor(symbol.name, symbol.arity, False, symbol.namespace)
    return (plain, *term[1:]) if term.__class__ is tuple else plain


# Arithmetic on terms, evaluated when operands are known, kept as a term until then: doubles, and exact integers.

Evaluator = Callable[..., Term]
function_table: Mapping[str, Evaluator] = MappingProxyType({})
"""The functions of the language by name, registered by `jacaros.agents.terms.functions`.

They are called with the evaluated arguments and return a number, or None while the arguments are unknown. Functions that
need an agent are called on the agent in `RUNNING`.
"""

RUNNING: ContextVar[Any] = ContextVar("RUNNING", default=None)
"""The agent whose turn it is (`jacaros.agents.mind.state.circumstance.Circumstance`), or None. Systems on other loops and
in other threads have their own.
"""


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
