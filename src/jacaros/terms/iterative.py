"""Operations on terms that are nested too deeply for Python's stack, or contain themselves.

The functions on terms are recursive. When Python's stack ends, they continue with the loops here, which keep a list of
their own, so only memory limits the depth of a term. A cycle always leads through a bound variable: a term that contains
itself is recognised by a variable that occurs inside its own value.

Logs show an `excerpt` of a long term.
"""

from collections.abc import Callable

from jacaros.terms.values import (
    CONS,
    NIL,
    PLAN,
    Annotated,
    List,
    Term,
    Var,
    deref,
    is_list,
    make_list,
    parts_of_list,
)

_COMPOUND = frozenset({tuple, List, Annotated})
MANY_TURNS = 100_000
"""Number of list elements after which a loop begins to check for cycles."""


class CyclicTerm(Exception):
    """A term contains itself, so it cannot be printed, sent or stored."""

    def __init__(self) -> None:
        super().__init__("a term contains itself")


def rebuild(
    term: Term,
    free: Callable[[Var], Term],
    structure: Callable[[Term], Term],
    annotated: Callable[[Term, tuple[Term, ...], Term], Term],
) -> Term:
    """Return a copy of a term with the values of its variables; unchanged structures are shared.

    Args:
        term: any term.
        free: returns the replacement of an unbound variable.
        structure: finishes a structure.
        annotated: combines a term with its annotations and tail.

    Raises:
        CyclicTerm: the term contains itself.
    """
    todo: list[Term] = [term]
    done: list[Term] = []
    inside: set[int] = set()
    while todo:
        item = todo.pop()
        if item.__class__ is _Open:
            if item.term.__class__ is tuple:
                done.append(structure(_structure(item.term, done)))
            elif item.term.__class__ is List:
                done.append(_list(item.term, done))
            else:
                done.append(_annotated(item.term, done, annotated))
            inside.difference_update(item.variables)
            continue
        through: list[int] = []
        while item.__class__ is Var and item.ref is not None:
            if id(item) in inside:
                raise CyclicTerm
            through.append(id(item))
            item = item.ref
        if item.__class__ in _COMPOUND and not (item.__class__ is List and item.is_settled()):
            inside.update(through)
            todo.append(_Open(item, through))
            todo.extend(reversed(_parts(item)))
        else:
            done.append(free(item) if item.__class__ is Var else item)
    return done[0]


class _Open:
    """A term whose parts are being rebuilt, and the variables that led to it."""

    __slots__ = ("term", "variables")

    def __init__(self, term: Term, variables: list[int]) -> None:
        self.term, self.variables = term, variables


def _parts(term: Term) -> tuple[Term, ...]:
    if term.__class__ is tuple:
        return term[1:]
    if term.__class__ is List:
        return tuple(term.elements())
    return (term.term, *term.annotations, *(() if term.tail is None else (term.tail,)))


def _structure(term: Term, done: list[Term]) -> Term:
    """Return the structure of the rebuilt arguments at the end of *done*, which are removed."""
    arguments = done[1 - len(term) :]
    del done[1 - len(term) :]
    same = all(new is old for new, old in zip(arguments, term[1:], strict=True))
    if term[0] is CONS and (arguments[1] is NIL or arguments[1].__class__ is List):
        return make_list(arguments[:1], arguments[1])
    return term if same else (term[0], *arguments)


def _list(term: List, done: list[Term]) -> Term:
    """The same for a list."""
    items = done[-term.size :]
    del done[-term.size :]
    same = all(new is old for new, old in zip(items, term.elements(), strict=True))
    return term if same else make_list(items)


def _annotated(
    term: Annotated, done: list[Term], annotated: Callable[[Term, tuple[Term, ...], Term], Term]
) -> Term:
    """The same for a term with annotations."""
    tail = None if term.tail is None else done.pop()
    count = len(term.annotations)
    annotations = tuple(done[len(done) - count :])
    del done[len(done) - count :]
    return annotated(done.pop(), annotations, tail)


_HASHABLE = 10_000
"""Maximum depth of a term (each element of a list is a level) that Python can hash without overflowing its stack."""


def as_key(term: Term) -> Term:
    """Return the term, which becomes an element of a set or a key of a map.

    Raises:
        RecursionError: it is nested too deeply for that.
    """
    todo = [(term, 0)]
    while todo:
        item, depth = todo.pop()
        if item.__class__ is Annotated:
            todo += ((part, depth + 1) for part in _parts(item))
        elif item.__class__ is tuple or item.__class__ is List:
            if depth > _HASHABLE:
                raise RecursionError(f"elements of sets and keys of maps have {_HASHABLE} levels at most")
            todo += [(part, depth + 1) for part in _parts(item) if part.__class__ in _COMPOUND]
    return term


class Turns:
    """Watches a walk along bound variables, and detects cycles (Brent's algorithm)."""

    __slots__ = ("_count", "_limit", "_mark")

    def __init__(self) -> None:
        self._mark: Var | None = None
        self._count, self._limit = 0, 1

    def pass_by(self, variable: Var) -> None:
        """Note a variable on the way.

        Raises:
            CyclicTerm: the walk has passed it before.
        """
        if variable is self._mark:
            raise CyclicTerm
        self._count += 1
        if self._count == self._limit:
            self._mark, self._limit = variable, self._limit * 2


MOST_PARTS = 150
"""Maximum number of names, numbers and brackets in an excerpt: more than fit into a line."""
REST = Var("...")
"""Stands for the rest that was left out."""


def excerpt(term: Term, parts: int = MOST_PARTS) -> Term:
    """Return the term, with dots in place of what follows its first *parts* parts.

    Variables are replaced by their values; arithmetic is unchanged. A term that contains itself has an excerpt, too.
    Plans and their bodies stay whole.

    The text of a small term with shared parts, as in ``f(T,T)`` with such a ``T``, can exceed any memory, and a list of
    all ranges of a laser is longer than a reader needs.
    """
    return _Excerpt(parts).of(term)


class _Excerpt:
    """Takes parts until there are enough; each level takes one, which limits the depth."""

    def __init__(self, parts: int) -> None:
        self._left = parts

    def of(self, term: Term) -> Term:
        term = deref(term)
        kind = term.__class__
        if kind is not tuple and kind is not Annotated and kind is not List:
            self._left -= 1
            return term
        if self._left <= 0:
            return REST
        self._left -= 1
        if kind is Annotated:
            annotations = tuple(self.of(each) for each in term.annotations)
            return Annotated(self.of(term.term), annotations, term.tail)
        if is_list(term):
            return self._list(term)
        if term[0].kind == PLAN:
            return term
        return (term[0], *(self.of(argument) for argument in term[1:]))

    def _list(self, cell: Term) -> Term:
        elements: list[Term] = []
        while is_list(cell) and cell is not NIL:
            if self._left <= 0:
                return make_list(elements, REST)
            first, cell = parts_of_list(cell)
            elements.append(self.of(first))
            cell = deref(cell)
        return make_list(elements, self.of(cell))
