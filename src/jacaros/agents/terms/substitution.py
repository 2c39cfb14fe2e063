"""Terms with all bindings applied: their values, copies with fresh variables, and when two are the same.

>>> from jacaros.agents.terms.values import structure
>>> place = Var("Place")
>>> term = structure("at", place)
>>> is_ground(term)
False
>>> place.ref = 2.0
>>> resolve(term)
(at/1, 2.0)
>>> equal(term, structure("at", 2.0))
True
"""

from collections.abc import Callable
from operator import is_not
from typing import Any

from jacaros.agents.terms import values
from jacaros.agents.terms.operators import BINARY, settle
from jacaros.agents.terms.order import annotation_set, compare
from jacaros.agents.terms.values import (
    ARITHMETIC,
    CONS,
    FUNCTION,
    MOST_CELLS,
    NEGATION,
    NIL,
    NO_KEY,
    TOO_LONG,
    Annotated,
    Functor,
    List,
    Term,
    Var,
    deref,
    make_list,
    parted,
)

ATOMIC = values.ATOMIC
"""Classes of values that hold no variables and evaluate to themselves."""
HOLDERS = frozenset({tuple, Annotated, List})
"""Classes of values that may hold variables."""


def resolve(term: Term) -> Term:
    """Apply all bindings: variables are replaced by their values, arithmetic is evaluated.

    If there is nothing to replace, the term itself is returned. Unbound variables are kept.

    Raises:
        RecursionError: it is nested too deeply for Python's stack, or contains itself.
    """
    if term.__class__ is Var:
        term = deref(term)
    kind = term.__class__
    if kind in ATOMIC:
        return term
    if kind is tuple:
        return _resolve_cells(term) if term[0] is CONS else _resolve_structure(term)
    if kind is List:
        return term if term.settled == term.size else _resolve_list(term)
    return _resolve_annotated(term) if kind is Annotated else term


def _resolve_structure(term: Term) -> Term:
    changed = False
    parts = [term[0]]
    for argument in term[1:]:
        new = argument if argument.__class__ in ATOMIC else resolve(argument)
        changed = changed or new is not argument
        parts.append(new)
    if changed:
        term = tuple(parts)
    return settle(term) if term[0].kind in (ARITHMETIC, FUNCTION) else term


def _resolve_list(term: List) -> Term:
    if term.is_settled():
        return term
    bottom = term.settled
    items = term.stack[bottom : term.size]
    # The first element first: evaluation may warn.
    new = []
    for item in reversed(items):  # no comprehension: it would be one more function on the stack
        new.append(resolve(item))
    new.reverse()
    if any(map(is_not, new, items)):
        term = List(term.stack[:bottom] + new, term.size, bottom, term.depth)
    _settle(term)
    return term


def _settle(term: List, level: int = 0) -> None:
    """Determine how many elements of a resolved list need not be checked again."""
    if term.is_settled():
        return
    count, depth = term.settled, term.depth
    for item in term.stack[count : term.size]:
        if item.__class__ not in ATOMIC:
            inner = _depth(item, level + 1)
            if inner is None:
                break
            depth = max(depth, inner + 1)
        count += 1
    # Set the depth first: another thread may read the list.
    term.depth = depth
    term.settled = count


def _depth(term: Term, level: int = 0) -> int | None:
    """Return how deep a resolved term is nested; `NO_KEY` with annotations, None while something in it may change."""
    kind = term.__class__
    if kind is Var or level > _KEY_DEPTH:
        return None
    if kind is tuple:
        if term[0].kind in (ARITHMETIC, FUNCTION, NEGATION) or term[0] is CONS:
            return None
        parts = term[1:]
    elif kind is List:
        if term.settled != term.size:
            _settle(term, level + 1)
        # A list takes two levels of Python's stack to compare or to hash.
        return term.depth + 1 if term.settled == term.size else None
    elif kind is Annotated:
        if term.tail is not None:
            return None
        parts = (term.term, *term.annotations)
    else:
        return 0
    deepest = 0
    for part in parts:
        if part.__class__ not in ATOMIC:
            depth = _depth(part, level + 1)
            if depth is None:
                return None
            deepest = max(deepest, depth)
    return NO_KEY if kind is Annotated else deepest + 1


def _resolve_cells(term: Term) -> Term:
    head, tail = term[1], term[2]
    if tail.__class__ is Var:
        tail = deref(tail)
    if tail.__class__ is List and tail.settled == tail.size and head.__class__ in ATOMIC:
        # The most frequent one: an element before a list.
        result = tail.with_first(head)
        result.settled = result.size
        return result
    heads: list[Term] = []
    changed = False
    cell = term
    while cell.__class__ is tuple and cell[0] is CONS:
        head = cell[1]
        new = head if head.__class__ in ATOMIC else resolve(head)
        changed = changed or new is not head
        heads.append(new)
        if len(heads) > MOST_CELLS:
            raise RecursionError(TOO_LONG)
        tail = cell[2]
        if tail.__class__ is Var:
            cell = deref(tail)
            changed = changed or cell is not tail
        else:
            cell = tail
    if cell.__class__ is not Functor and cell.__class__ is not Var:
        new = resolve(cell)
        changed = changed or new is not cell
        cell = new
    if cell is not NIL and cell.__class__ is not List:
        return make_list(heads, cell) if changed else term
    result = make_list(heads, cell)
    _settle(result)
    return result


def _resolve_annotated(term: Annotated) -> Term:
    annotations = tuple([resolve(annotation) for annotation in term.annotations])
    inner, tail = resolve(term.term), None
    if term.tail is not None:
        annotations, tail = with_tail(annotations, resolve(term.tail))
    if inner.__class__ is Annotated:
        annotations += inner.annotations
        inner = inner.term
    annotations = annotation_set(annotations)
    if not annotations and tail is None:
        return inner
    return Annotated(inner, annotations, tail)


def with_tail(annotations: tuple[Term, ...], tail: Term) -> tuple[tuple[Term, ...], Term]:
    """Return the annotations together with those of the tail, and its unbound rest."""
    tail = deref(tail)
    if tail is None or tail.__class__ is Var:
        return annotations, tail
    more, tail = parted(tail)
    return annotation_set((*annotations, *more)), tail if tail.__class__ is Var else None


def is_flat(term: Term) -> bool:
    """Return whether the term is an atom, or a structure of atoms, numbers and strings: nothing in it can be bound or
    evaluated.

    A quick test for the most frequent terms; False does not mean that there are variables.
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
    """Return whether the term contains no unbound variable."""
    return is_flat(term) or not free_variables(term)


def free_variables(term: Term) -> list[Var]:
    """Return the unbound variables of a term, each once, in order of appearance."""
    found: list[Var] = []
    met: set[int] = set()
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
        elif kind is List:
            if not term.is_settled():
                stack.extend(term.stack[term.settled : term.size])
        elif kind is Annotated:
            if term.tail is not None:
                stack.append(term.tail)
            stack.extend(reversed(term.annotations))
            stack.append(term.term)
    return found


def rename(term: Term, names: dict[Var, Var] | None = None) -> Term:
    """Return a copy with fresh variables in place of the unbound ones; ground terms are returned unchanged."""
    if is_flat(term):
        return term
    term = resolve(term)
    if term.__class__ in ATOMIC or not free_variables(term):
        return term
    return _rename(term, {} if names is None else names)


def replace_variable(term: Term, variable: Var, value: Var) -> Term:
    """Return the resolved term with one variable replaced by another."""
    return _rename(resolve(term), _Alone({variable: value}))


class _Alone(dict[Var, Var]):
    """New names for the variables it holds; all others keep theirs."""

    def get(self, key: Var, default: Any = None) -> Any:
        del default
        return dict.get(self, key, key)


def _rename(term: Term, names: dict[Var, Var]) -> Term:
    def fresh(part: Term) -> Term:
        if part.__class__ is not Var:
            return part
        new = names.get(part)
        if new is None:
            new = names[part] = Var(part.name)
        return new

    return with_parts(term, fresh, List.is_settled)


def with_parts(term: Term, change: Callable[[Term], Term], stays: Callable[[List], bool]) -> Term:
    """Return a copy of a resolved term with what *change* returns for each of its variables and values.

    Args:
        term: the term.
        change: returns what takes the place of a variable or value.
        stays: returns whether a list need not be copied.
    """
    kind = term.__class__
    if kind is tuple and term[0] is not CONS:
        return (term[0], *[with_parts(argument, change, stays) for argument in term[1:]])
    if kind is List and stays(term):
        return term
    if kind is tuple or kind is List:
        items, tail = parted(term)
        return make_list([with_parts(item, change, stays) for item in items], with_parts(tail, change, stays))
    if kind is Annotated:
        annotations = tuple([with_parts(each, change, stays) for each in term.annotations])
        tail = None if term.tail is None else with_parts(term.tail, change, stays)
        return Annotated(with_parts(term.term, change, stays), annotations, tail)
    return change(term)


def related(symbol: str, left: Term, right: Term) -> bool:
    """Return whether a relation that binds nothing holds: numbers by value, other terms by order or equality."""
    relation = BINARY[symbol]
    assert relation.numbers is not None
    left, right = settle(left), settle(right)
    if left.__class__ is float and right.__class__ is float:
        return bool(relation.numbers(left, right))
    if relation.orders:
        return bool(relation.numbers(compare(left, right), 0))
    return bool(relation.numbers(equal(left, right), True))


def equal(left: Term, right: Term) -> bool:
    """The relation ``==``: the same term after applying all bindings, annotations included."""
    left, right = resolve(left), resolve(right)
    while left.__class__ is right.__class__ is tuple and left[0] is right[0] is CONS:
        # Python's own comparison has a level for each element of an open list.
        if left[1] != right[1]:
            return False
        left, right = left[2], right[2]
    return left.__class__ is right.__class__ and bool(left == right)


_KEY_DEPTH = 300


def is_key(term: Term, depth: int = 0) -> bool:
    """Return whether a resolved term can be looked up by equality.

    It must be ground, without annotations, and not nested too deeply for Python to compare or hash it.
    """
    while True:
        kind = term.__class__
        if kind is Var or kind is Annotated or depth > _KEY_DEPTH:
            return False
        if kind is List:
            if term.settled != term.size:
                _settle(term)
            return bool(term.settled == term.size and depth + term.depth <= _KEY_DEPTH)
        if kind is not tuple:
            return True
        depth += 1
        for argument in term[1:-1]:
            if argument.__class__ not in ATOMIC and not is_key(argument, depth):
                return False
        term = term[-1]


_HASHABLE = 10_000
"""Maximum depth of a term that Python can hash without overflowing its stack; each element of an open list is a level."""


def as_key(term: Term) -> Term:
    """Return the resolved term, which becomes an element of a set or a key of a map.

    Raises:
        RecursionError: it is nested too deeply for that.
    """
    todo = [(term, 0)] if term.__class__ in HOLDERS else []
    while todo:
        item, depth = todo.pop()
        if depth > _HASHABLE:
            raise RecursionError(f"elements of sets and keys of maps have {_HASHABLE} levels at most")
        parts: Any = item.from_bottom() if item.__class__ is List else item
        if item.__class__ is Annotated:
            parts = (item.term, *item.annotations)
        todo += [(part, depth + 1) for part in parts if part.__class__ in HOLDERS]
    return term
