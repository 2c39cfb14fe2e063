"""The total order of terms: numbers, strings, lists, literals, unbound variables."""

from collections.abc import Iterable
from functools import cmp_to_key

from jacaros.terms.arithmetic import settle
from jacaros.terms.values import CONS, NIL, Annotated, Functor, String, Term, Var, annotations_of

_NUMBER, _STRING, _LIST, _LITERAL, _OTHER, _VARIABLE = range(6)


def _rank(term: Term) -> int:
    kind = term.__class__
    if kind is float:
        return _NUMBER
    if kind is String:
        return _STRING
    if kind is tuple:
        return _LIST if term[0] is CONS else _LITERAL
    if kind is Functor:
        return _LIST if term is NIL else _LITERAL
    if kind is Annotated:
        return _LITERAL
    return _VARIABLE if kind is Var else _OTHER


def compare(left: Term, right: Term) -> int:
    """Negative, zero or positive as *left* comes before, with or after *right*."""
    while True:
        left, right = settle(left), settle(right)
        if left is right:
            return 0
        rank = _rank(left)
        other = _rank(right)
        if rank != other:
            return rank - other
        if rank in (_NUMBER, _STRING):
            return (left > right) - (left < right)
        if rank == _LIST:
            if left is NIL or right is NIL:
                return (left is not NIL) - (right is not NIL)
            order = compare(left[1], right[1])
            if order:
                return order
            left, right = left[2], right[2]
            continue
        if rank == _LITERAL:
            return _compare_literals(left, right)
        if rank == _VARIABLE:
            return (left.name > right.name) - (left.name < right.name) or (id(left) > id(right)) - (
                id(left) < id(right)
            )
        return (repr(left) > repr(right)) - (repr(left) < repr(right))


def _compare_literals(left: Term, right: Term) -> int:
    """Namespace, functor, positive before negated, arguments pairwise, arity, annotations."""
    left_bare = settle(left.term) if left.__class__ is Annotated else left
    right_bare = settle(right.term) if right.__class__ is Annotated else right
    if _rank(left_bare) != _LITERAL or _rank(right_bare) != _LITERAL:
        return compare(left_bare, right_bare)
    first = left_bare[0] if left_bare.__class__ is tuple else left_bare
    second = right_bare[0] if right_bare.__class__ is tuple else right_bare
    if first is not second:
        a = (first.namespace or "", first.name, first.negated)
        b = (second.namespace or "", second.name, second.negated)
        if a != b:
            return -1 if a < b else 1
    for x, y in zip(_arguments(left_bare), _arguments(right_bare), strict=False):
        order = compare(x, y)
        if order:
            return order
    if first.arity != second.arity:
        return int(first.arity - second.arity)
    return _compare_annotations(annotations_of(left), annotations_of(right))


def _arguments(term: Term) -> tuple[Term, ...]:
    return term[1:] if term.__class__ is tuple else ()


def _compare_annotations(left: tuple[Term, ...], right: tuple[Term, ...]) -> int:
    for x, y in zip(left, right, strict=False):
        order = compare(x, y)
        if order:
            return order
    return len(left) - len(right)


SortKey = cmp_to_key(compare)


def sorted_terms(terms: Iterable[Term]) -> list[Term]:
    """The terms in the standard order; equal ones keep their order."""
    return sorted(terms, key=SortKey)


def annotation_set(annotations: tuple[Term, ...]) -> tuple[Term, ...]:
    """Sorted, without duplicates, as annotations are kept."""
    if len(annotations) < 2:
        return annotations
    result: list[Term] = []
    for annotation in sorted_terms(annotations):
        if not result or result[-1] != annotation:
            result.append(annotation)
    return tuple(result)


def less(left: Term, right: Term) -> bool:
    """``<`` on any terms."""
    return compare(left, right) < 0


def at_most(left: Term, right: Term) -> bool:
    """``<=`` on any terms."""
    return compare(left, right) <= 0
