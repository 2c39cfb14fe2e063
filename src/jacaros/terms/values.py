"""The values of the language, chosen for speed: most are plain Python objects.

==================  ==================================================================================
number              `float` (all numbers are doubles, as in Jason); never `int`, never `bool`
string              `String`, a `str` without arithmetic
atom                an interned `Functor` of arity 0, compared by identity
structure           a tuple ``(functor, argument, ...)``
list                cons tuples ``(CONS, head, tail)`` ending in the atom `NIL`
annotated term      `Annotated`, around a term that has annotations; nobody else pays for them
variable            `Var`; bound ones refer to their value
set, map, queue     the mutable classes of `jacaros.terms.collections`
anything else       `Reference`, opaque
==================  ==================================================================================

Formulae, plans and triggers are terms too (a program may pass them around): structures whose functor has
another `Functor.kind` than `PLAIN`.
"""

from _weakref import _remove_dead_weakref  # type: ignore[attr-defined]
from collections.abc import Callable, Iterable, Iterator
from typing import Any, NoReturn
from weakref import ref

Term = Any
"""Any value of the table above."""

PLAIN, ARITHMETIC, FUNCTION, RELATION, LOGIC, ACTION, PLAN, NEGATION = range(8)
"""Kinds of functors: ordinary; ``+``; ``math.max``; ``<``; ``&``; ``.print``; pieces of plans; ``~X`` with X unknown."""


class Functor:
    """The name of an atom or structure; there is one object for each that is in use, so identity is equality.

    Attributes:
        name: as written, with the quotes of a quoted atom.
        arity: number of arguments, 0 for an atom.
        negated: True for ``~name``.
        namespace: None for the default namespace.
        kind: what the structure is, see the constants above.
    """

    __slots__ = ("__weakref__", "arity", "kind", "name", "namespace", "negated")

    def __init__(self, name: str, arity: int, negated: bool, namespace: str | None, kind: int) -> None:
        self.name, self.arity, self.negated, self.namespace, self.kind = name, arity, negated, namespace, kind

    def __repr__(self) -> str:
        prefix = f"{self.namespace}::" if self.namespace else ""
        return f"{prefix}{'~' if self.negated else ''}{self.name}/{self.arity}"

    def __reduce__(self) -> tuple[Any, ...]:
        return functor, (self.name, self.arity, self.negated, self.namespace, self.kind)


_Key = tuple[str, int, bool, str | None, int]


class _Held(ref[Functor]):
    """A functor that others hold, with its key: a name that nobody uses is released."""

    __slots__ = ("key",)

    key: _Key


_functors: dict[_Key, _Held] = {}


def functor(
    name: str, arity: int, negated: bool = False, namespace: str | None = None, kind: int = PLAIN
) -> Functor:
    """The functor of that name and arity."""
    key = (name, arity, negated, namespace, kind)
    held = _functors.get(key)
    found = None if held is None else held()
    return _new_functor(key) if found is None else found


def _new_functor(key: _Key) -> Functor:
    made = Functor(*key)
    new = _Held(made, _release)
    new.key = key
    while True:
        # At once: another thread may be making it, and there must be one object only.
        found = _functors.setdefault(key, new)()
        if found is not None:
            return found
        _remove_dead_weakref(_functors, key)


def _release(
    held: _Held,
    functors: dict[_Key, _Held] = _functors,
    remove: Callable[[dict[_Key, _Held], _Key], None] = _remove_dead_weakref,
) -> None:
    """Forget a functor that is gone, unless there is another one of its name by now; at once, as above.

    The defaults outlive the module when the interpreter ends.
    """
    remove(functors, held.key)


def atom(name: str, namespace: str | None = None) -> Functor:
    """The atom of that name."""
    return functor(name, 0, False, namespace)


class String(str):
    """A string of the language.  It compares as `str`, but cannot be added or multiplied."""

    __slots__ = ()

    def __add__(self, other: object) -> NoReturn:
        raise TypeError("strings are joined with .concat")

    __radd__ = __mul__ = __rmul__ = __mod__ = __add__

    def __repr__(self) -> str:
        return f"String({str.__repr__(self)})"


class Var:
    """A variable that has met the outside of its plan.

    Attributes:
        ref: its value, or None while it has none.
        at: number of the goal posting after which it was bound (see `Trail.serial`); unset before.
        name: for people; names of unnamed variables begin with ``_``.
        number: place among the variables of that name in the standard order; unset until it is asked for.
    """

    __slots__ = ("at", "name", "number", "ref")

    number: int
    at: int

    def __init__(self, name: str = "_") -> None:
        self.ref: Term = None
        self.name = name

    def __repr__(self) -> str:
        return f"Var({self.name!r})" if self.ref is None else f"Var({self.name!r}={self.ref!r})"


class Annotated:
    """A term with annotations: ``p(1)[a, b | T]``.

    Attributes:
        term: the bare term, an atom, structure or `Var`.
        annotations: sorted, without duplicates.
        tail: `Var` of the rest in a pattern, else None.
    """

    __slots__ = ("annotations", "tail", "term")

    def __init__(self, term: Term, annotations: tuple[Term, ...], tail: Term = None) -> None:
        self.term, self.annotations, self.tail = term, annotations, tail

    def __eq__(self, other: object) -> bool:
        return (
            other.__class__ is Annotated
            and self.term == other.term
            and self.annotations == other.annotations
            and self.tail is other.tail
        )

    def __hash__(self) -> int:
        return hash((self.term, self.annotations))

    def __repr__(self) -> str:
        return f"Annotated({self.term!r}, {self.annotations!r})"


class Reference:
    """An opaque object; printed as ``cobj_N``.

    Attributes:
        value: the object; two references are equal when their objects are the same, or can be hashed and are equal.
        number: for printing.
    """

    __slots__ = ("__weakref__", "number", "value")
    _count = 0

    def __init__(self, value: object) -> None:
        Reference._count += 1
        self.value, self.number = value, Reference._count

    def __eq__(self, other: object) -> bool:
        if other.__class__ is not Reference:
            return False
        left, right = self.value, other.value
        if left is right:
            return True
        # What the classes of projects do when they are asked is their affair: the mind goes on.
        try:
            return hash(left) == hash(right) and bool(left == right)
        except Exception:
            return False

    def __hash__(self) -> int:
        try:
            return hash(self.value)
        except Exception:
            return id(self.value)

    def __repr__(self) -> str:
        return f"Reference({self.value!r})"


CONS = functor("[|]", 2)
NIL = functor("[]", 0)
NEGATED = functor("~", 1, kind=NEGATION)
"""Functor of ``~X`` while X has no value."""
TRUE, FALSE = atom("true"), atom("false")
SELF, PERCEPT = atom("self"), atom("percept")
SOURCE = functor("source", 1)
SOURCE_SELF = (SOURCE, SELF)
SOURCE_PERCEPT = (SOURCE, PERCEPT)
BY_SELF = (SOURCE_SELF,)
"""The annotations of most beliefs and goals, one shared object."""
NO_ANNOTATIONS: tuple[Term, ...] = ()


def make_list(items: Iterable[Term], tail: Term = NIL) -> Term:
    """The list term of *items*."""
    result = tail
    for item in reversed(items if isinstance(items, (list, tuple)) else list(items)):
        result = (CONS, item, result)
    return result


def deref(term: Term) -> Term:
    """The value behind a bound variable; an unbound one itself."""
    while term.__class__ is Var and term.ref is not None:
        term = term.ref
    return term


def list_items(term: Term) -> Iterator[Term]:
    """The elements of a list term; ends at a tail that is no list, or where the list would begin again."""
    term = deref(term)
    mark, count, limit = None, 0, 1
    while term.__class__ is tuple and term[0] is CONS:
        yield term[1]
        term = term[2]
        if term.__class__ is Var:
            if term is mark:
                return
            count += 1
            if count == limit:
                mark, limit = term, limit * 2
            term = deref(term)


def is_list(term: Term) -> bool:
    """Whether the (dereferenced) term is a list."""
    return term is NIL or (term.__class__ is tuple and term[0] is CONS)


def bare(term: Term) -> Term:
    """The term without its annotations."""
    term = deref(term)
    return deref(term.term) if term.__class__ is Annotated else term


def functor_of(term: Term) -> Functor | None:
    """The functor of an atom, structure or annotated one; None for other terms and for lists."""
    term = bare(term)
    if term.__class__ is tuple:
        return None if term[0] is CONS else term[0]
    return term if term.__class__ is Functor and term is not NIL else None


def arguments_of(term: Term) -> tuple[Term, ...]:
    """The arguments of an atom or structure."""
    term = bare(term)
    return term[1:] if term.__class__ is tuple else ()


def annotations_of(term: Term) -> tuple[Term, ...]:
    """The annotations of a term, sorted."""
    term = deref(term)
    return term.annotations if term.__class__ is Annotated else ()


def structure(name: str, *arguments: Term, namespace: str | None = None) -> Term:
    """The structure (or, without arguments, the atom) of that name."""
    symbol = functor(name, len(arguments), False, namespace)
    return (symbol, *arguments) if arguments else symbol
