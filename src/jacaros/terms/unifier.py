"""Unification, substitution and renaming of terms.

Variables are bound in place; a `Trail` remembers which, so that a search can take bindings back.  What
differs from textbook unification is the treatment of annotations (Jason): those of the left term must be a
subset of those of the right one.
"""

from collections.abc import Iterator
from typing import Any

from jacaros.terms.arithmetic import settle
from jacaros.terms.deep import MANY_TURNS, Turns, rebuild
from jacaros.terms.negation import positive_form, qualify
from jacaros.terms.order import annotation_set
from jacaros.terms.plans import TWINS
from jacaros.terms.values import (
    ARITHMETIC,
    CONS,
    FUNCTION,
    NEGATED,
    NIL,
    Annotated,
    Functor,
    String,
    Term,
    Var,
    deref,
    make_list,
)


class Trail(list[Var]):
    """The variables bound since a search began, in order.

    Attributes:
        serial: number of goals posted so far; stamped on every binding, so that those made for a failed goal
            can be told from older ones.
        deep: a unification is under way that does without Python's stack.
        room: how many more rules the search under way may open.
    """

    __slots__ = ("deep", "room", "serial")

    def __init__(self) -> None:
        super().__init__()
        self.serial = 0
        self.deep = False
        self.room = 0


ATOMIC = frozenset({float, String, Functor})
"""Classes of values that hold no variables and evaluate to themselves."""
HOLDERS = frozenset({tuple, Annotated})
"""Classes of values that may hold variables."""


def bind(variable: Var, value: Term, trail: Trail) -> None:
    """Give an unbound variable its value."""
    variable.ref = value
    variable.at = trail.serial
    trail.append(variable)


def undo(trail: Trail, mark: int) -> None:
    """Take back all bindings made since the trail had the length *mark*."""
    while len(trail) > mark:
        trail.pop().ref = None


def unify(left: Term, right: Term, trail: Trail) -> bool:  # noqa: C901 - the inner loop of every search
    """Make two terms equal by binding variables; the annotations of *left* must be among those of *right*.

    On failure bindings may be left on the trail: the caller takes them back.
    """
    kind = left.__class__
    if kind in ATOMIC:  # the most frequent cases, written out
        if right.__class__ in ATOMIC:
            return kind is right.__class__ and bool(left == right)
        if right.__class__ is Var and right.ref is None:
            right.ref = left
            right.at = trail.serial
            trail.append(right)
            return True
    elif kind is Var and left.ref is None and right.__class__ in ATOMIC:
        left.ref = right
        left.at = trail.serial
        trail.append(left)
        return True
    turns = 0
    try:
        while turns < MANY_TURNS:
            left, right = settle(left), settle(right)
            if left is right:
                return True
            kind = left.__class__
            if kind is Var:
                return _bind_checked(left, right, trail)
            if right.__class__ is Var:
                return _bind_checked(right, left, trail)
            if (kind is tuple and left[0] is NEGATED) or (right.__class__ is tuple and right[0] is NEGATED):
                return _unify_negated(left, right, trail)
            if kind is tuple and right.__class__ is tuple:
                if left[0] is not right[0] and TWINS.get(left[0]) is not right[0]:
                    return False
                for i in range(1, len(left) - 1):
                    if not unify(left[i], right[i], trail):
                        return False
                left, right = left[-1], right[-1]
                turns += 1
                continue
            if kind is Annotated or right.__class__ is Annotated:
                return _unify_annotated(left, right, trail)
            return kind is right.__class__ and bool(left == right)
    except RecursionError:
        # What was bound so far stays: it is made equal once more.
        if trail.deep:
            raise
    trail.deep = True
    try:
        return _unify_deep(left, right, trail)
    finally:
        trail.deep = False


def _unify_deep(left: Term, right: Term, trail: Trail) -> bool:
    """`unify` of terms that are nested too deeply for Python's stack, or without end.

    Raises:
        RecursionError: when it is their annotations that are nested so deeply.
    """
    todo: list[tuple[Term, ...]] = [(left, right)]
    met: set[tuple[int, int]] = set()
    while todo:
        item = todo.pop()
        if len(item) == 4:
            if not unify_annotations(*item, trail):
                return False
            continue
        left, right = item
        by_variable = left.__class__ is Var or right.__class__ is Var
        left, right = settle(left), settle(right)
        both = {left.__class__, right.__class__}
        if Annotated in both and Var not in both:
            left, left_annotations, left_tail = _parts(left)
            right, right_annotations, right_tail = _parts(right)
            todo.append((left_annotations, left_tail, right_annotations, right_tail))
            todo.append((left, right))
        elif both != {tuple} or left[0] is NEGATED or right[0] is NEGATED:
            if not unify(left, right, trail):
                return False
        elif left is not right:
            if left[0] is not right[0] and TWINS.get(left[0]) is not right[0]:
                return False
            if by_variable:
                if (id(left), id(right)) in met:
                    continue
                met.add((id(left), id(right)))
            todo.extend(zip(left[:0:-1], right[:0:-1], strict=True))
    return True


def _unify_negated(left: Term, right: Term, trail: Trail) -> bool:
    """``~X``: matches a negated literal, whose positive form X takes."""
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
    """``~X`` with the value that X has by now."""
    if term.__class__ is tuple and term[0] is NEGATED:
        value = deref(term[1])
        return term if value.__class__ is Var else qualify(value, None, True)
    return term


def _bind_checked(variable: Var, value: Term, trail: Trail) -> bool:
    """Bind; a value that contains the variable has a fresh one in its place, so that every term is finite."""
    if value.__class__ in HOLDERS and _occurs(variable, value):
        value = _rename(resolve(value), _Alone({variable: Var(variable.name)}))
    bind(variable, value, trail)
    return True


def _occurs(variable: Var, value: Term) -> bool:
    try:
        for _ in range(64):
            if value.__class__ is Annotated:
                tail = () if value.tail is None else (value.tail,)
                if any(_occurs(variable, deref(annotation)) for annotation in (*value.annotations, *tail)):
                    return True
                value = deref(value.term)
            if value.__class__ is not tuple:
                return value is variable
            for argument in value[1:-1]:
                argument = deref(argument)
                if argument is variable or (argument.__class__ in HOLDERS and _occurs(variable, argument)):
                    return True
            value = deref(value[-1])
    except RecursionError:
        return any(variable is other for other in free_variables(value))
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
    """First way to find every annotation of *left* in *right*; tails take what is over."""
    for _ in each_annotation_match(left, left_tail, right, right_tail, trail):
        return True
    return False


def each_annotation_match(
    left: tuple[Term, ...], left_tail: Term, right: tuple[Term, ...], right_tail: Term, trail: Trail
) -> Iterator[None]:
    """Every way to find the annotations of *left* in *right*, in the order of *right*.

    With an unbound tail on the left there is one answer at most.  The elements of bound tails are annotations
    like the others.
    """
    if left_tail is not None or right_tail is not None:
        left, left_tail = _with_tail(left, left_tail)
        right, right_tail = _with_tail(right, right_tail)
    return _annotation_matches(left, left_tail, right, right_tail, trail)


def _with_tail(annotations: tuple[Term, ...], tail: Term) -> tuple[tuple[Term, ...], Term]:
    """The annotations together with those of the tail, and what is unbound of it."""
    tail = deref(tail)
    if tail is None or tail.__class__ is Var:
        return annotations, tail
    more: list[Term] = []
    while tail.__class__ is tuple and tail[0] is CONS:
        more.append(tail[1])
        tail = deref(tail[2])
    return annotation_set((*annotations, *more)), tail if tail.__class__ is Var else None


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
    """The tail of the right side takes the annotations it lacks."""
    mark = len(trail)
    tail = deref(right_tail)
    if tail.__class__ is Var:
        bind(tail, make_list(left, Var()), trail)
        if _unify_tail(left_tail, right, trail):
            yield
    undo(trail, mark)


def _unify_tail(tail: Term, rest: tuple[Term, ...], trail: Trail) -> bool:
    return tail is None or unify(tail, make_list(rest), trail)


def resolve(term: Term) -> Term:
    """Apply all bindings: variables replaced by their values, arithmetic evaluated.

    The term itself is returned when there is nothing to replace.  Unbound variables stay as they are.
    """
    kind = term.__class__
    if kind in ATOMIC:
        return term
    try:
        if kind is Var:
            value = deref(term)
            return value if value.__class__ is Var else resolve(value)
        if kind is tuple:
            return _resolve_list(term) if term[0] is CONS else _resolve_structure(term)
        if kind is Annotated:
            return _resolve_annotated(term)
    except RecursionError:
        return rebuild(term, _itself, _settled, _annotate)
    return term


def _itself(term: Term) -> Term:
    return term


def _settled(term: Term) -> Term:
    """A structure whose arguments are resolved; arithmetic is evaluated."""
    return settle(term) if term[0].kind in (ARITHMETIC, FUNCTION) else term


def _resolve_structure(term: Term) -> Term:
    changed = False
    parts = [term[0]]
    for argument in term[1:]:
        new = argument if argument.__class__ in ATOMIC else resolve(argument)
        changed = changed or new is not argument
        parts.append(new)
    if changed:
        term = tuple(parts)
    kind = term[0].kind
    if kind in (ARITHMETIC, FUNCTION):
        return settle(term)
    return term


def _resolve_list(term: Term) -> Term:
    heads: list[Term] = []
    changed = False
    cell = term
    turns: Turns | None = None
    while cell.__class__ is tuple and cell[0] is CONS:
        head = cell[1]
        new = head if head.__class__ in ATOMIC else resolve(head)
        changed = changed or new is not head
        heads.append(new)
        tail = cell[2]
        if tail.__class__ is Var:
            if turns is None:
                turns = Turns()
            turns.pass_by(tail)
            cell = deref(tail)
            changed = changed or cell is not tail
        else:
            cell = tail
    if cell.__class__ is not Functor and cell.__class__ is not Var:
        new = resolve(cell)
        changed = changed or new is not cell
        cell = new
    return make_list(heads, cell) if changed else term


def _resolve_annotated(term: Annotated) -> Term:
    annotations = tuple(resolve(a) for a in term.annotations)
    return _annotate(resolve(term.term), annotations, None if term.tail is None else resolve(term.tail))


def _annotate(inner: Term, annotations: tuple[Term, ...], tail: Term) -> Term:
    """A resolved term with resolved annotations."""
    if tail is not None:
        annotations, tail = _with_tail(annotations, tail)
    if inner.__class__ is Annotated:
        annotations += inner.annotations
        inner = inner.term
    annotations = annotation_set(annotations)
    if not annotations and tail is None:
        return inner
    return Annotated(inner, annotations, tail)


def is_flat(term: Term) -> bool:
    """Whether the term is an atom, or a structure of atoms, numbers and strings: nothing in it can be bound or evaluated.

    A quick test for the most frequent terms; False does not say that there are variables.
    """
    if term.__class__ is not tuple:
        return term.__class__ is Functor and not term.kind
    if term[0].kind:
        return False
    for part in term:  # noqa: SIM110 - twice as fast as `all`
        if part.__class__ not in ATOMIC:
            return False
    return True


def is_ground(term: Term) -> bool:
    """Whether the term holds no unbound variable."""
    return is_flat(term) or not free_variables(term)


def free_variables(term: Term, found: list[Var] | None = None) -> list[Var]:
    """The unbound variables of a term, each once, in order of appearance."""
    found = [] if found is None else found
    met = {id(variable) for variable in found}
    stack = [term]
    while stack:
        term = stack.pop()
        kind = term.__class__
        if kind in ATOMIC:
            continue
        if kind is Var:
            if id(term) not in met:
                met.add(id(term))
                if term.ref is None:
                    found.append(term)
                else:
                    stack.append(term.ref)
        elif kind is tuple:
            stack.extend(reversed(term[1:]))
        elif kind is Annotated:
            if term.tail is not None:
                stack.append(term.tail)
            stack.extend(reversed(term.annotations))
            stack.append(term.term)
    return found


def rename(term: Term, names: dict[Var, Var] | None = None) -> Term:
    """A copy with fresh variables in place of the unbound ones; ground terms are returned as they are."""
    if is_flat(term):
        return term
    term = resolve(term)
    if term.__class__ in ATOMIC or not free_variables(term):
        return term
    return _rename(term, {} if names is None else names)


class _Alone(dict[Var, Var]):
    """New names for the variables it holds; all others keep theirs."""

    def get(self, key: Var, default: Any = None) -> Any:
        del default
        return dict.get(self, key, key)


def _rename(term: Term, names: dict[Var, Var]) -> Term:
    try:
        return _renamed(term, names)
    except RecursionError:
        return rebuild(term, lambda variable: _renamed(variable, names), _itself, Annotated)


def _renamed(term: Term, names: dict[Var, Var]) -> Term:
    kind = term.__class__
    if kind is Var:
        fresh = names.get(term)
        if fresh is None:
            fresh = names[term] = Var(term.name)
        return fresh
    if kind is tuple:
        if term[0] is CONS:
            heads = []
            while term.__class__ is tuple and term[0] is CONS:
                heads.append(_rename(term[1], names))
                term = term[2]
            return make_list(heads, term if term is NIL else _rename(term, names))
        return (term[0], *(_rename(a, names) for a in term[1:]))
    if kind is Annotated:
        tail = None if term.tail is None else _rename(term.tail, names)
        return Annotated(_rename(term.term, names), tuple(_rename(a, names) for a in term.annotations), tail)
    return term


def equal(left: Term, right: Term) -> bool:
    """The relation ``==``: the same term after applying all bindings, annotations included."""
    left, right = resolve(left), resolve(right)
    if left.__class__ is not right.__class__:
        return False
    try:
        return bool(left == right)
    except RecursionError:
        return _equal_by_parts(left, right)


def _equal_by_parts(left: Term, right: Term) -> bool:
    """Equality of resolved terms that are nested too deeply for Python's own comparison."""
    stack = [(left, right)]
    while stack:
        a, b = stack.pop()
        if a is b:
            continue
        if a.__class__ is not b.__class__:
            return False
        if a.__class__ is tuple:
            if len(a) != len(b):
                return False
            stack.extend(zip(a, b, strict=True))
        elif a.__class__ is Annotated:
            if len(a.annotations) != len(b.annotations):
                return False
            stack.append((a.term, b.term))
            stack.extend(zip(a.annotations, b.annotations, strict=True))
        elif a != b:
            return False
    return True


_KEY_DEPTH = 300


def is_key(term: Term, depth: int = 0) -> bool:
    """Whether a resolved term can be looked up by equality: ground, without annotations, and not nested so deeply
    that Python could not compare or hash it."""
    while True:
        kind = term.__class__
        if kind is Var or kind is Annotated or depth > _KEY_DEPTH:
            return False
        if kind is not tuple:
            return True
        depth += 1
        for argument in term[1:-1]:
            if argument.__class__ not in ATOMIC and not is_key(argument, depth):
                return False
        term = term[-1]
