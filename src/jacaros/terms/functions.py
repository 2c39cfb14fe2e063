"""The arithmetic functions of the language (``math.abs``, ``math.sum`` …)."""

import math
from collections.abc import Callable

from jacaros.terms import arithmetic
from jacaros.terms.arithmetic import functions, settle
from jacaros.terms.collections import MapValue, QueueValue, SetValue
from jacaros.terms.operators import ArithmeticFault
from jacaros.terms.substitution import free_variables, resolve
from jacaros.terms.values import Annotated, String, Term, is_list, list_items, list_length


def _on_number(compute: Callable[[float], float]) -> Callable[..., Term]:
    def function(argument: Term) -> Term:
        value = settle(argument)
        if value.__class__ is not float:
            if free_variables(value):
                return None
            arithmetic.warn("the argument of a function", value)
            return math.nan
        try:
            return float(compute(value))
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
    """A function of the numbers in a list (other elements are passed over), or of its arguments."""

    def function(*arguments: Term) -> Term:
        values = [resolve(a) for a in arguments]
        if any(free_variables(v) for v in values):
            return None
        if len(values) == 1:
            if isinstance(values[0], (SetValue, QueueValue)):
                values = list(values[0])
            elif is_list(values[0]):
                values = list(list_items(values[0]))
        return compute([v for v in values if v.__class__ is float])

    return function


def _of_some(compute: Callable[[list[float]], float]) -> Callable[[list[float]], float]:
    """A function that has no value without numbers."""

    def function(numbers: list[float]) -> float:
        if not numbers:
            raise ArithmeticFault("a function of a list without numbers")
        return compute(numbers)

    return function


def _sum(numbers: list[float]) -> float:
    """Added up from the left, so that every Python rounds as Java does."""
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
    """Of a sample: 0 for no numbers, not a number for a single one."""
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


functions.update(
    {
        "math.abs": _on_number(abs),
        "math.acos": _on_number(math.acos),
        "math.asin": _on_number(math.asin),
        "math.atan": _on_number(math.atan),
        "math.ceil": _on_number(_toward(math.ceil)),
        "math.cos": _on_number(math.cos),
        "math.exp": _on_number(math.exp),
        "math.floor": _on_number(_toward(math.floor)),
        "math.log": _on_number(_log),
        "math.round": _on_number(_round),
        "math.sin": _on_number(math.sin),
        "math.sqrt": _on_number(math.sqrt),
        "math.tan": _on_number(math.tan),
        "math.e": lambda: math.e,
        "math.pi": lambda: math.pi,
        "math.max": _on_list(_of_some(max)),
        "math.min": _on_list(_of_some(min)),
        "math.sum": _on_list(_sum),
        "math.average": _on_list(_of_some(_average)),
        "math.mean": _on_list(_of_some(_average)),
        "math.median": _on_list(_of_some(_median)),
        "math.std_dev": _on_list(_standard_deviation),
        ".length": _length,
    }
)
