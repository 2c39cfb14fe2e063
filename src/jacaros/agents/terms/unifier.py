"""Unification of terms.

>>> from jacaros.agents.terms.text import text
>>> from jacaros.agents.terms.values import atom, structure
>>> place, trail = Var("Place"), Trail()
>>> unify(structure("at", place), structure("at", atom("kitchen")), trail)
True
>>> text(place)
'kitchen'
>>> undo(trail, 0)
>>> place.ref is None
True

Variables are bound in place; a `Trail` records which, so that a search can undo bindings. The difference from textbook
unification is the treatment of annotations (as in Jason): those of the left term must be a subset of those of the right
one.
"""

from collections.abc import Iterator

from jacaros.agents.terms.operators import positive_form, qualify, settle
from jacaros.agents.terms.order import annotation_set
from jacaros.agents.terms.plans import TWINS
from jacaros.agents.terms.substitution import ATOMIC, HOLDERS, free_variables, replace_variable, with_tail
from jacaros.agents.terms.values import (
    CONS,
    MOST_CELLS,
    NEGATED,
    NO_KEY,
    TOO_LONG,
    Annotated,
    List,
    Term,
    Var,
    deref,
    make_list,
    parts_of_list,
)


class Trail(list[Var]):
    """The variables bound since a search began, in order.

    Attributes:
        serial: number of goals posted so far; stamped on every binding, so that bindings made for a failed goal
            can be distinguished from older ones.
        room: how many more rules the current search may open.
    """

    __slots__ = ("room", "serial")

    def __init__(self) -> None:
        super().__init__()
        self.serial = 0
        self.room = 0


def bind(variable: Var, value: Term, trail: Trail) -> None:
    """Bind an unbound variable."""
    trail.append(variable)  # first: a search can be interrupted
    variable.ref = value
    variable.at = trail.serial


def undo(trail: Trail, mark: int) -> None:
    """Undo all bindings made since the trail had the length *mark*."""
    while len(trail) > mark:
        trail.pop().ref = None


def unify(left: Term, right: Term, trail: Trail) -> bool:  # noqa: C901 - the inner loop of every search
    """Make two terms equal by binding variables; the annotations of *left* must be among those of *right*.

    On failure, bindings may remain on the trail: the caller undoes them.

    Raises:
        RecursionError: a term is nested too deeply for Python's stack, or contains itself.
    """
    kind = left.__class__
    if kind in ATOMIC:  # the most frequent cases first
        if right.__class__ in ATOMIC:
            return kind is right.__class__ and bool(left == right)
        if right.__class__ is Var and right.ref is None:
            trail.append(right)
            right.ref = left
            right.at = trail.serial
            return True
    elif kind is Var and left.ref is None and right.__class__ in ATOMIC:
        trail.append(left)
        left.ref = right
        left.at = trail.serial
        return True
    for _ in range(MOST_CELLS):
        left, right = settle(left), settle(right)
        if left is right:
            return True
        kind = left.__class__
        if kind is Var:
            return _bind_checked(left, right, trail)
        if right.__class__ is Var:
            return _bind_checked(right, left, trail)
        other = right.__class__
        if kind is other is tuple and left[0] is not NEGATED and right[0] is not NEGATED:
            if left[0] is not right[0] and TWINS.get(left[0]) is not right[0]:
                return False
            for i in range(1, len(left) - 1):
                if not unify(left[i], right[i], trail):
                    return False
            left, right = left[-1], right[-1]
        elif (kind is List and other is tuple and right[0] is CONS) or (
            kind is tuple and other is List and left[0] is CONS
        ):
            first, left = parts_of_list(left)
            second, right = parts_of_list(right)
            if not unify(first, second, trail):
                return False
        else:
            return _unify_others(left, right, trail)
    raise RecursionError(TOO_LONG)


def _unify_others(left: Term, right: Term, trail: Trail) -> bool:
    """Unify two settled values: no variable, not two ordinary structures, and not part of an open list."""
    kind = left.__class__
    if kind is right.__class__ is List:
        return _unify_lists(left, right, trail)
    if (kind is tuple and left[0] is NEGATED) or (right.__class__ is tuple and right[0] is NEGATED):
        return _unify_negated(left, right, trail)
    if kind is Annotated or right.__class__ is Annotated:
        return _unify_annotated(left, right, trail)
    return kind is right.__class__ and bool(left == right)


def _unify_lists(left: List, right: List, trail: Trail) -> bool:
    if left.size != right.size:
        return False
    if left.is_settled() and right.is_settled() and max(left.depth, right.depth) < NO_KEY:
        if left == right:
            return True
        if left.depth == right.depth == 1:
            return False
    for one, other in zip(left.elements(), right.elements(), strict=True):  # noqa: SIM110 - `all` is a call from C
        if not unify(one, other, trail):
            return False
    return True


def _unify_negated(left: Term, right: Term, trail: Trail) -> bool:
    """``~X``: matches a negated literal and binds X to its positive form."""
    left, right = _known_negation(left), _known_negation(right)
    if left.__class__ is tuple and left[0] is NEGATED:
        if right.__class__ is tuple and right[0] is NEGATED:
            return unify(left[1], right[1], trail)
        plain = positive_form(settle(right.term) if right.__class__ is Annotated else right)
        if plain is None:
            return False
        if right.__class__ is Annotated:
            plain = Annotated(plain, right.annotations, right.tail)
        return unify(left[1], plain, trail)
    if right.__class__ is tuple and right[0] is NEGATED:
        return _unify_negated(right, left, trail)
    return unify(left, right, trail)


def _known_negation(term: Term) -> Term:
    """Return ``~X`` with the present value of X."""
    if term.__class__ is tuple and term[0] is NEGATED:
        value = deref(term[1])
        return term if value.__class__ is Var else qualify(value, None, True)
    return term


def _bind_checked(variable: Var, value: Term, trail: Trail) -> bool:
    """Bind a variable; a value that contains it gets a fresh variable in its place, so that every term is finite."""
    if value.__class__ in HOLDERS and _occurs(variable, value):
        value = replace_variable(value, variable, Var(variable.name))
    bind(variable, value, trail)
    return True


def _occurs(variable: Var, value: Term) -> bool:
    # A search for the variable in each long value would make a loop over such values quadratic.
    for _ in range(64):
        if value.__class__ is Annotated:
            tail = () if value.tail is None else (value.tail,)
            for annotation in (*value.annotations, *tail):
                if _occurs(variable, deref(annotation)):
                    return True
            value = deref(value.term)
        if value.__class__ is List:
            return not value.is_settled() and any(variable is v for v in free_variables(value))
        if value.__class__ is not tuple:
            return value is variable
        for argument in value[1:-1]:
            argument = deref(argument)
            if argument is variable or (argument.__class__ in HOLDERS and _occurs(variable, argument)):
                return True
        value = deref(value[-1])
    return False


def _unify_annotated(left: Term, right: Term, trail: Trail) -> bool:
    left_term, left_annotations, left_tail = _parts(left)
    right_term, right_annotations, right_tail = _parts(right)
    if not unify(left_term, right_term, trail):
        return False
    return unify_annotations(left_annotations, left_tail, right_annotations, right_tail, trail)


def _parts(term: Term) -> tuple[Term, tuple[Term, ...], Term]:
    if term.__class__ is not Annotated:
        return term, (), None
    inner = settle(term.term)
    if inner.__class__ is Annotated:
        return inner.term, annotation_set((*term.annotations, *inner.annotations)), inner.tail or term.tail
    return inner, term.annotations, term.tail


def unify_annotations(
    left: tuple[Term, ...], left_tail: Term, right: tuple[Term, ...], right_tail: Term, trail: Trail
) -> bool:
    """Find every annotation of *left* in *right* in the first way possible; tails take the rest."""
    for _ in each_annotation_match(left, left_tail, right, right_tail, trail):
        return True
    return False


def each_annotation_match(
    left: tuple[Term, ...], left_tail: Term, right: tuple[Term, ...], right_tail: Term, trail: Trail
) -> Iterator[None]:
    """Find the annotations of *left* in *right* in every possible way, in the order of *right*.

    With an unbound tail on the left there is at most one answer. The elements of bound tails are ordinary annotations.
    """
    if left_tail is not None or right_tail is not None:
        left, left_tail = with_tail(left, left_tail)
        right, right_tail = with_tail(right, right_tail)
    return _annotation_matches(left, left_tail, right, right_tail, trail)


def _annotation_matches(
    left: tuple[Term, ...], left_tail: Term, right: tuple[Term, ...], right_tail: Term, trail: Trail
) -> Iterator[None]:
    if not left:
        mark = len(trail)
        if _unify_tail(left_tail, right, trail):
            yield
        undo(trail, mark)
        return
    for index, candidate in enumerate(right):
        mark = len(trail)
        try:
            found = unify(left[0], candidate, trail)
        except RecursionError:
            undo(trail, mark)
            raise
        if found:
            rest = right[:index] + right[index + 1 :]
            for _ in _annotation_matches(left[1:], left_tail, rest, right_tail, trail):
                yield
                if left_tail is not None:
                    undo(trail, mark)
                    return
        undo(trail, mark)
    if right_tail is not None:
        yield from _absorbed(left, left_tail, right, right_tail, trail)


def _absorbed(
    left: tuple[Term, ...], left_tail: Term, right: tuple[Term, ...], right_tail: Term, trail: Trail
) -> Iterator[None]:
    """Let the tail of the right side take the annotations that it lacks."""
    mark = len(trail)
    tail = deref(right_tail)
    if tail.__class__ is Var:
        bind(tail, make_list(left), trail)
        if _unify_tail(left_tail, right, trail):
            yield
    undo(trail, mark)


def _unify_tail(tail: Term, rest: tuple[Term, ...], trail: Trail) -> bool:
    return tail is None or unify(tail, make_list(rest), trail)
