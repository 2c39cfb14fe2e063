"""The total order of terms: numbers, strings, lists, literals, other values, unbound variables.

>>> from jacaros.terms.text import text
>>> from jacaros.terms.values import atom, make_list, structure
>>> text(make_list(sorted_terms([Var("X"), structure("b", 1.0), atom("a"), String("s"), 2.0])))
'[2,"s",a,b(1),X]'
>>> compare(1.0, 2.0) < 0
True

It never depends on addresses, so runs with the same seed sort alike.
"""

import itertools
from bisect import bisect_left
from collections.abc import Iterable, Iterator
from functools import cmp_to_key
from operator import itemgetter, ne
from typing import Any

from jacaros.terms.arithmetic import settle
from jacaros.terms.values import (
    ARITHMETIC,
    CONS,
    FUNCTION,
    NIL,
    NUMBERS,
    Annotated,
    Functor,
    List,
    Reference,
    String,
    Term,
    Var,
    annotations_of,
    parts_of_list,
)

_NUMBER, _STRING, _LIST, _LITERAL, _OTHER, _VARIABLE = range(6)
_EVALUATED = (ARITHMETIC, FUNCTION)
_variable_numbers = itertools.count()
MOST_CELLS = 1_000_000
"""Maximum number of cells of an open list, or of structures in each other's last arguments: a walk along a term that
contains itself ends there.
"""
TOO_LONG = f"a term has more than {MOST_CELLS} levels, or contains itself"


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
        rank = _rank(left)
        other = _rank(right)
        if rank != other:
            return rank - other
        if rank == _NUMBER:
            return _compare_numbers(left, right)
        if rank == _STRING:
            return -1 if left < right else int(left > right)
        if rank == _VARIABLE:
            return _compare_variables(left, right)
        if rank == _LIST and not (
            (left.__class__ is List and right.__class__ is List) or left is NIL or right is NIL
        ):
            # An open list, or one that may be: compare element by element, as a closed one would be copied for each.
            first, left = parts_of_list(left)
            second, right = parts_of_list(right)
            order = compare(first, second)
            if order:
                return order
            continue
        if rank == _LITERAL and left.__class__ is not Annotated and right.__class__ is not Annotated:
            return _compare_plain(left, right)
        for decision in _decisions(left, right, rank):
            order = decision if decision.__class__ is int else compare(*decision)
            if order:
                return order
        return 0
    raise RecursionError(TOO_LONG)


def _compare_plain(left: Term, right: Term) -> int:
    """Compare atoms and structures without annotations: `_decisions` inlined for speed."""
    first = left[0] if left.__class__ is tuple else left
    second = right[0] if right.__class__ is tuple else right
    if first is not second:
        order = _compare_functors(first, second)
        if order or first is left or second is right:
            return order or int(first.arity - second.arity)
    elif first is left:
        return 0
    for x, y in zip(left[1:], right[1:], strict=False):
        order = compare(x, y)
        if order:
            return order
    return int(first.arity - second.arity)


def _decisions(left: Term, right: Term, rank: int) -> Iterator[Any]:
    """Yield what decides between two terms of the same rank, in order: pairs of terms to compare, and decisions.

    Literals: by namespace, functor, positive before negated, arguments pairwise, arity, annotations. Sets, maps and
    queues: by kind and contents. Opaque objects: by their numbers.
    """
    if rank == _OTHER:
        if left.__class__ is not right.__class__:
            yield -1 if left.__class__.__name__ < right.__class__.__name__ else 1
        elif left.__class__ is Reference:
            yield 0 if left == right else left.number - right.number
        else:
            yield left.as_list(), right.as_list()
        return
    if rank == _LIST:
        if left is NIL or right is NIL:
            yield (left is not NIL) - (right is not NIL)
        elif left.__class__ is List and right.__class__ is List:
            yield from zip(left.elements(), right.elements(), strict=False)
            yield left.size - right.size
        else:
            yield from zip(parts_of_list(left), parts_of_list(right), strict=True)
        return
    left_bare = settle(left.term) if left.__class__ is Annotated else left
    right_bare = settle(right.term) if right.__class__ is Annotated else right
    if _rank(left_bare) != _LITERAL or _rank(right_bare) != _LITERAL:
        yield left_bare, right_bare
        return
    first = left_bare[0] if left_bare.__class__ is tuple else left_bare
    second = right_bare[0] if right_bare.__class__ is tuple else right_bare
    if first is not second:
        yield _compare_functors(first, second)
    yield from zip(_arguments(left_bare), _arguments(right_bare), strict=False)
    yield first.arity - second.arity
    if left.__class__ is Annotated or right.__class__ is Annotated:
        more, others = annotations_of(left), annotations_of(right)
        yield from zip(more, others, strict=False)
        yield len(more) - len(others)


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
