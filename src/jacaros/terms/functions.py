"""The arithmetic functions of the language (``math.abs``, ``math.sum`` …)."""

import math
import statistics
from collections.abc import Callable

from jacaros.terms.arithmetic import ArithmeticFault, functions, settle, warn
from jacaros.terms.collections import MapValue, QueueValue, SetValue
from jacaros.terms.order import compare
from jacaros.terms.unifier import free_variables, resolve
from jacaros.terms.values import Annotated, String, Term, is_list, list_items


def _on_number(compute: Callable[[float], float]) -> Callable[..., Term]:
    def function(argument: Term) -> Term:
        value = settle(argument)
        if value.__class__ is not float:
            if free_variables(value):
                return None
            warn(f"the argument of a function is no number: {value!r}")
            return math.nan
        try:
            return float(compute(value))
        except OverflowError:
            return math.inf
        except ValueError:
            return math.nan

    return function


def _round(value: float) -> float:
    return value if not math.isfinite(value) else float(math.floor(value + 0.5))


def _on_values(compute: Callable[[list[Term]], Term]) -> Callable[..., Term]:
    """A function that takes one list, or its elements as arguments."""

    def function(*arguments: Term) -> Term:
        values = [resolve(a) for a in arguments]
        if any(free_variables(v) for v in values):
            return None
        if len(values) == 1:
            if isinstance(values[0], (SetValue, QueueValue)):
                values = list(values[0])
            elif is_list(values[0]):
                values = list(list_items(values[0]))
        if not values:
            raise ArithmeticFault("a function of an empty list")
        return compute(values)

    return function


def _greatest(values: list[Term]) -> Term:
    best = values[0]
    for value in values[1:]:
        if compare(value, best) > 0:
            best = value
    return best


def _smallest(values: list[Term]) -> Term:
    best = values[0]
    for value in values[1:]:
        if compare(value, best) < 0:
            best = value
    return best


def _length(argument: Term) -> Term:
    value = resolve(argument)
    if value.__class__ is String:
        return float(len(value))
    if is_list(value):
        return float(sum(1 for _ in list_items(value)))
    if isinstance(value, (SetValue, MapValue, QueueValue)):
        return float(len(value))
    if value.__class__ is Annotated:
        return _length(value.term)
    return None if free_variables(value) else math.nan


def _numbers(values: list[Term]) -> list[float]:
    return [v if v.__class__ is float else math.nan for v in values]


functions.update(
    {
        "math.abs": _on_number(abs),
        "math.acos": _on_number(math.acos),
        "math.asin": _on_number(math.asin),
        "math.atan": _on_number(math.atan),
        "math.ceil": _on_number(math.ceil),
        "math.cos": _on_number(math.cos),
        "math.exp": _on_number(math.exp),
        "math.floor": _on_number(math.floor),
        "math.log": _on_number(math.log),
        "math.round": _on_number(_round),
        "math.sin": _on_number(math.sin),
        "math.sqrt": _on_number(math.sqrt),
        "math.tan": _on_number(math.tan),
        "math.e": lambda: math.e,
        "math.pi": lambda: math.pi,
        "math.max": _on_values(_greatest),
        "math.min": _on_values(_smallest),
        "math.sum": _on_values(lambda v: float(sum(_numbers(v)))),
        "math.average": _on_values(lambda v: statistics.fmean(_numbers(v))),
        "math.mean": _on_values(lambda v: statistics.fmean(_numbers(v))),
        "math.median": _on_values(lambda v: float(statistics.median(_numbers(v)))),
        "math.std_dev": _on_values(lambda v: statistics.stdev(_numbers(v)) if len(v) > 1 else 0.0),
        ".length": _length,
    }
)
