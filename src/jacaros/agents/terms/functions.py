"""The arithmetic functions of the language (``math.abs``, ``math.sum`` …).

>>> FUNCTIONS["math.max"](1.0, 3.0, 2.0)
3.0
>>> is_function("math.abs", 2, {})
False

The parser tells them from internal actions by name and number of arguments.
"""

import math
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Final

from jacaros.agents.terms import operators
from jacaros.agents.terms.collections import MapValue, QueueValue, SetValue
from jacaros.agents.terms.operators import ArithmeticFault, Evaluator, settle
from jacaros.agents.terms.substitution import free_variables, resolve
from jacaros.agents.terms.values import (
    NUMBERS,
    Annotated,
    String,
    Term,
    double,
    is_list,
    list_items,
    list_length,
)


def _on_number(compute: Callable[[float], float]) -> Callable[..., Term]:
    def function(argument: Term) -> Term:
        value = settle(argument)
        if value.__class__ not in NUMBERS:
            if free_variables(value):
                return None
            operators.warn("argument of a function", value)
            return math.nan
        try:
            return float(compute(double(value)))
        except OverflowError:
            return math.inf
        except ValueError:
            return math.nan

    return function


def _toward(rounded: Callable[[float], int]) -> Callable[[float], float]:
    """Floor or ceiling; infinite values stay as they are."""
    return lambda value: float(rounded(value)) if math.isfinite(value) else value


def _round(value: float) -> float:
    """The nearest 64-bit integer, halves up."""
    if value != value:
        return 0.0
    if not math.isfinite(value):
        return math.copysign(2.0**63, value)
    whole = math.floor(value)
    return float(max(-(2**63), min(2**63 - 1, whole + (value - whole >= 0.5))))


def _log(value: float) -> float:
    return -math.inf if value == 0.0 else math.log(value)


def _on_list(compute: Callable[[list[float]], float]) -> Callable[..., Term]:
    """A function of the numbers in a list (other elements are ignored), or of its arguments."""

    def function(*arguments: Term) -> Term:
        values = [resolve(a) for a in arguments]
        if any(free_variables(v) for v in values):
            return None
        if len(values) == 1:
            if isinstance(values[0], (SetValue, QueueValue)):
                values = list(values[0])
            elif is_list(values[0]):
                values = list(list_items(values[0]))
        return compute([v for v in values if v.__class__ in NUMBERS])

    return function


def _of_some(compute: Callable[[list[float]], float]) -> Callable[[list[float]], float]:
    """A function that has no value for an empty list of numbers."""

    def function(numbers: list[float]) -> float:
        if not numbers:
            raise ArithmeticFault("list without numbers as argument of a function")
        return compute(numbers)

    return function


def _sum(numbers: list[float]) -> float:
    """Add from the left, so that every Python version rounds as Java does."""
    total = 0.0
    for number in numbers:
        total += number
    return total


def _average(numbers: list[float]) -> float:
    return _sum(numbers) / len(numbers)


def _median(numbers: list[float]) -> float:
    ordered = sorted(numbers)
    middle = len(ordered) // 2
    return ordered[middle] if len(ordered) % 2 else (ordered[middle - 1] + ordered[middle]) / 2


def _standard_deviation(numbers: list[float]) -> float:
    """The standard deviation of a sample: 0 for no numbers, NaN for a single one."""
    if len(numbers) < 2:
        return math.nan if numbers else 0.0
    average = _average(numbers)
    return math.sqrt(_sum([(n - average) * (n - average) for n in numbers]) / (len(numbers) - 1))


def _length(argument: Term) -> Term:
    value = resolve(argument)
    if value.__class__ is String:
        return float(len(value))
    if is_list(value):
        return float(list_length(value))
    if isinstance(value, (SetValue, MapValue, QueueValue)):
        return float(len(value))
    if value.__class__ is Annotated:
        return _length(value.term)
    return None if free_variables(value) else math.nan


_OF_A_NUMBER: dict[str, Callable[[float], float]] = {
    "math.abs": abs,
    "math.acos": math.acos,
    "math.asin": math.asin,
    "math.atan": math.atan,
    "math.ceil": _toward(math.ceil),
    "math.cos": math.cos,
    "math.floor": _toward(math.floor),
    "math.log": _log,
    "math.round": _round,
    "math.sin": math.sin,
    "math.sqrt": math.sqrt,
    "math.tan": math.tan,
}
_OF_NUMBERS: dict[str, Callable[[list[float]], float]] = {
    "math.average": _of_some(_average),
    "math.max": _of_some(max),
    "math.mean": _of_some(_average),
    "math.median": _of_some(_median),
    "math.min": _of_some(min),
    "math.std_dev": _standard_deviation,
    "math.sum": _sum,
}
FUNCTIONS: Final[Mapping[str, Evaluator]] = MappingProxyType(
    {
        **{name: _on_number(compute) for name, compute in _OF_A_NUMBER.items()},
        **{name: _on_list(compute) for name, compute in _OF_NUMBERS.items()},
        "math.e": lambda: math.e,
        "math.pi": lambda: math.pi,
        ".length": _length,
    }
)
operators.function_table = FUNCTIONS

ARITIES: Final[dict[str, tuple[int, float]]] = {
    **dict.fromkeys(_OF_A_NUMBER, (1, 1)),
    **dict.fromkeys(_OF_NUMBERS, (1, math.inf)),
    **dict.fromkeys(("math.e", "math.pi", "system.time"), (0, 0)),
    "math.random": (0, 1),
    ".length": (1, 1),
    ".count": (1, 1),
}
"""Minimum and maximum number of arguments of each function of the language, including those that need an agent."""


def is_function(name: str, arity: int, registered: Mapping[str, int]) -> bool:
    """Return whether *name* with *arity* arguments is a function of the language or a *registered* one."""
    limits = ARITIES.get(name)
    if limits is not None and limits[0] <= arity <= limits[1]:
        return True
    return registered.get(name) == arity


class FunctionNames(dict[str, int]):
    """The functions that a running program has registered, with their numbers of arguments.

    Attributes:
        known: those of the project, with their minimum and maximum numbers of arguments.
    """

    def __init__(
        self, registered: Mapping[str, int], known: Mapping[str, tuple[int, int | None]] | None = None
    ) -> None:
        super().__init__(registered)
        self.known = {} if known is None else known
