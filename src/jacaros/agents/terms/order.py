"""The total order of terms: numbers, strings, lists, literals, other values, unbound variables.

>>> from jacaros.agents.terms.text import text
>>> from jacaros.agents.terms.values import atom, make_list, structure
>>> text(make_list(sorted_terms([Var("X"), structure("b", 1.0), atom("a"), String("s"), 2.0])))
'[2,"s",a,b(1),X]'
>>> compare(1.0, 2.0) < 0
True

It never depends on addresses, so runs with the same seed sort alike.
"""

import itertools
from bisect import bisect_left
from collections.abc import Callable, Iterable, Sequence
from functools import cmp_to_key
from operator import itemgetter, ne
from typing import Any

from jacaros.agents.terms.operators import settle
from jacaros.agents.terms.values import (
    ARITHMETIC,
    CONS,
    FUNCTION,
    MOST_CELLS,
    NIL,
    NUMBERS,
    TOO_LONG,
    Annotated,
    Functor,
    List,
    Reference,
    String,
    Term,
    Var,
    annotations_of,
    bare,
    parts_of_list,
)

_NUMBER, _STRING, _LIST, _LITERAL, _OTHER, _VARIABLE = range(6)
_EVALUATED = (ARITHMETIC, FUNCTION)
_variable_numbers = itertools.count()


def _rank(term: Term) -> int:
    kind = term.__class__
    if kind in NUMBERS:
        return _NUMBER
    if kind is String:
        return _STRING
    if kind is tuple:
        return _LIST if term[0] is CONS else _LITERAL
    if kind is List:
        return _LIST
    if kind is Functor:
        return _LIST if term is NIL else _LITERAL
    if kind is Annotated:
        return _LITERAL
    return _VARIABLE if kind is Var else _OTHER


def compare(left: Term, right: Term) -> int:
    """Return a negative number, zero or a positive number as *left* comes before, with or after *right*.

    Raises:
        RecursionError: a term is nested too deeply for Python's stack, or contains itself.
    """
    for _ in range(MOST_CELLS):
        left, right = settle(left), settle(right)
        if left is right:
            return 0
        rank, other = _rank(left), _rank(right)
        if rank != other:
            return rank - other
        if rank != _LIST or left is NIL or right is NIL or left.__class__ is right.__class__ is List:
            return _COMPARE[rank](left, right)
        # An open list, or one that may be: compare element by element, as a closed one would be copied for each.
        first, left = parts_of_list(left)
        second, right = parts_of_list(right)
        order = compare(first, second)
        if order:
            return order
    raise RecursionError(TOO_LONG)


def _compare_each(left: Sequence[Term], right: Sequence[Term]) -> int:
    """Compare pairwise; of two that are equal so far, the shorter one comes first."""
    for x, y in zip(left, right, strict=False):
        order = compare(x, y)
        if order:
            return order
    return len(left) - len(right)


def _compare_lists(left: Term, right: Term) -> int:
    if left is NIL or right is NIL:
        return (left is not NIL) - (right is not NIL)
    return _compare_each(left.elements(), right.elements())


def _compare_literals(left: Term, right: Term) -> int:
    """Compare by namespace, functor, positive before negated, arguments pairwise, arity, and annotations."""
    if left.__class__ is Annotated or right.__class__ is Annotated:
        bare_left, bare_right = settle(bare(left)), settle(bare(right))
        order = compare(bare_left, bare_right)
        if order or _rank(bare_left) != _LITERAL:
            return order
        return _compare_each(annotations_of(left), annotations_of(right))
    first = left[0] if left.__class__ is tuple else left
    second = right[0] if right.__class__ is tuple else right
    if first is not second:
        order = _compare_functors(first, second)
        if order:
            return order
    return _compare_each(_arguments(left), _arguments(right))


def _compare_others(left: Term, right: Term) -> int:
    """Compare sets, maps and queues by kind and contents; opaque objects by their numbers."""
    if left.__class__ is not right.__class__:
        return -1 if left.__class__.__name__ < right.__class__.__name__ else 1
    if left.__class__ is Reference:
        return 0 if left == right else int(left.number - right.number)
    return compare(left.as_list(), right.as_list())


def _compare_strings(left: String, right: String) -> int:
    return -1 if left < right else int(left > right)


def _compare_numbers(left: float, right: float) -> int:
    """Compare by value; NaN comes last, so that sorting is well defined."""
    if left == right:
        return 0
    if left < right:
        return -1
    return 1 if left > right else (left != left) - (right != right)


def _compare_variables(left: Var, right: Var) -> int:
    if left.name != right.name:
        return -1 if left.name < right.name else 1
    return number_of(left) - number_of(right)


def number_of(variable: Var) -> int:
    """Return the variable's position among those of its name, assigned at the first comparison."""
    try:
        return variable.number
    except AttributeError:
        variable.number = next(_variable_numbers)
        return variable.number


_COMPARE: dict[int, Callable[[Any, Any], int]] = {
    _NUMBER: _compare_numbers,
    _STRING: _compare_strings,
    _LIST: _compare_lists,
    _LITERAL: _compare_literals,
    _OTHER: _compare_others,
    _VARIABLE: _compare_variables,
}
"""How terms of the same rank are compared."""


def _compare_functors(first: Functor, second: Functor) -> int:
    """Compare by namespace, name and negation; the number of arguments counts only after the arguments."""
    a = (first.namespace or "", first.name, first.negated)
    b = (second.namespace or "", second.name, second.negated)
    return 0 if a == b else -1 if a < b else 1


def _arguments(term: Term) -> tuple[Term, ...]:
    return term[1:] if term.__class__ is tuple else ()


SortKey = cmp_to_key(compare)


def sorted_terms(terms: Iterable[Term]) -> list[Term]:
    """Return the terms in the standard order; equal ones keep their order."""
    items = list(terms)
    if ordered_by_python(items):
        return sorted(items)
    groups = _by_name(items)
    if groups is None:
        return sorted(items, key=SortKey)
    return [item for name in sorted(groups) for item in _sorted_namesakes(groups[name])]


def _by_name(items: list[Term]) -> dict[tuple[str, str, bool], list[Term]] | None:
    """Group atoms and structures by name; return None if there are other terms."""
    groups: dict[tuple[str, str, bool], list[Term]] = {}
    for item in items:
        symbol = item[0] if item.__class__ is tuple else item
        if symbol.__class__ is not Functor or symbol is CONS or symbol is NIL or symbol.kind in _EVALUATED:
            return None
        groups.setdefault((symbol.namespace or "", symbol.name, symbol.negated), []).append(item)
    return groups


def _sorted_namesakes(items: list[Term]) -> list[Term]:
    """Sort terms of the same name: by their arguments alone if Python's own comparison suffices."""
    if len(items) == 1:
        return items
    symbols = {item[0] if item.__class__ is tuple else item for item in items}
    if len(symbols) == 1:
        arity = len(items[0]) - 1 if items[0].__class__ is tuple else 0
        if not arity:
            return items
        if all(ordered_by_python([item[place] for item in items]) for place in range(1, arity + 1)):
            return sorted(items, key=itemgetter(*range(1, arity + 1)))
    return sorted(items, key=SortKey)


def ordered_by_python(items: list[Term]) -> bool:
    """Return whether Python's own, much faster comparison gives the standard order: only numbers, or only strings."""
    kinds = set(map(type, items))
    return kinds == {String} or (kinds == {float} and not any(map(ne, items, items)))


def sorted_set(items: list[Term]) -> list[Term]:
    """Return the terms in the standard order, the first one of equal ones."""
    if ordered_by_python(items):
        return sorted(dict.fromkeys(items))
    groups = _by_name(items)
    if groups is None:
        return _without_doubles(sorted(items, key=SortKey))
    result: list[Term] = []
    for name in sorted(groups):
        group = groups[name]
        result += group if len(group) == 1 else _without_doubles(_sorted_namesakes(group))
    return result


def _without_doubles(items: list[Term]) -> list[Term]:
    result = items[:1]
    for item in items[1:]:
        if compare(result[-1], item) != 0:
            result.append(item)
    return result


def annotation_set(annotations: tuple[Term, ...]) -> tuple[Term, ...]:
    """Return annotations as they are kept: sorted, without duplicates."""
    if len(annotations) < 2:
        return annotations
    return tuple(sorted_set(list(annotations)))


def merge_annotations(
    held: tuple[Term, ...], added: tuple[Term, ...]
) -> tuple[tuple[Term, ...], tuple[Term, ...]]:
    """Insert *added* into the sorted annotations *held*; return all of them, and those that are new.

    Each is inserted by bisection: a belief with many annotations must not be sorted again for each new one.
    """
    merged = list(held)
    new = []
    for annotation in added:
        place = len(merged)
        if merged and compare(merged[-1], annotation) >= 0:  # times mostly come in order
            place = bisect_left(merged, SortKey(annotation), key=SortKey)
        if place == len(merged) or compare(merged[place], annotation) != 0:
            merged.insert(place, annotation)
            new.append(annotation)
    return tuple(merged), tuple(new)
