"""The values of the language, chosen for speed: most are plain Python objects.

>>> structure("at", atom("kitchen"), 1.0)
(at/2, kitchen/0, 1.0)
>>> plan = make_list([atom("lift"), atom("drop")])
>>> parts_of_list(plan)[0]
lift/0
>>> place = Var("Place")
>>> place.ref = atom("kitchen")
>>> deref(place) is atom("kitchen")
True

==================  ==================================================================================
number              `float`, a double as in Jason; `int` only for an integer that no double is equal to (`number`)
string              `String`, a `str` without arithmetic
atom                an interned `Functor` of arity 0, compared by identity
structure           a tuple ``(functor, argument, ...)``
list                `List`; the empty one is the atom `NIL`
open list           cons tuples ``(CONS, head, tail)`` ending in a `Var`
annotated term      `Annotated`, around a term that has annotations; others have no cost
variable            `Var`; bound ones refer to their value
set, map, queue     the mutable classes of `jacaros.agents.terms.collections`
anything else       `Reference`, opaque
==================  ==================================================================================

A cons tuple may also end in a list: code builds ``[H|T]`` so, and `jacaros.agents.terms.substitution.resolve` makes a
`List` of it.  Terms that are stored or compared by ``==`` are resolved, and so each of them has one form.

Formulae, plans and triggers are terms too (a program may pass them around): structures whose functor has another
`Functor.kind` than `PLAIN`.
"""

# What `x.__class__ is C` says of x is not known to
# pyright: reportAttributeAccessIssue=false

import itertools
import math
from _weakref import _remove_dead_weakref  # type: ignore[attr-defined]
from collections.abc import Callable, Iterable, Iterator
from operator import is_
from typing import Any, NoReturn, TypeVar
from weakref import ref

Term = Any
"""Any value of the table above."""
Annotations = tuple[Term, ...]

NUMBERS: frozenset[Any] = frozenset({float, int})
"""Classes of numbers. One of each is never equal to one of the other."""


def number(value: float) -> float | int:
    """Return the term for a Python number: a double, or the integer itself if no double is equal to it.

    So identifiers and nanoseconds pass through an agent unchanged, and all other numbers are Jason's. Beyond all doubles it
    is infinite, so that no product grows without limit.
    """
    nearest = double(value)
    return int(value) if nearest != value and math.isfinite(nearest) else nearest


def double(value: float) -> float:
    """Return the double nearest to a number, which is infinite beyond all doubles."""
    try:
        return float(value)
    except OverflowError:
        return math.copysign(math.inf, value > 0 or -1)


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

    __slots__ = ("__weakref__", "_atom", "arity", "kind", "name", "namespace", "negated")

    _atom: "Functor"

    def __init__(self, name: str, arity: int, negated: bool, namespace: str | None, kind: int) -> None:
        self.name, self.arity, self.negated, self.namespace, self.kind = name, arity, negated, namespace, kind

    def __repr__(self) -> str:
        prefix = f"{self.namespace}::" if self.namespace else ""
        return f"{prefix}{'~' if self.negated else ''}{self.name}/{self.arity}"

    def as_atom(self) -> "Functor":
        """The atom of that name in the default namespace, negated if this is; it lives as long as this does."""
        if not (self.arity or self.namespace or self.kind):
            return self
        try:
            return self._atom
        except AttributeError:
            self._atom = functor(self.name, 0, self.negated)
            return self._atom

    def __reduce__(self) -> tuple[Any, ...]:
        return functor, (self.name, self.arity, self.negated, self.namespace, self.kind)


T = TypeVar("T")
_Key = tuple[str, int, bool, str | None, int]


class InternedRef(ref[Any]):
    """A weak reference to an object that is in a table of names once: the table forgets one that is no longer used."""

    __slots__ = ("key", "table")

    key: Any
    table: "dict[Any, InternedRef]"


_functors: dict[_Key, InternedRef] = {}


def functor(
    name: str, arity: int, negated: bool = False, namespace: str | None = None, kind: int = PLAIN
) -> Functor:
    """The functor of that name and arity."""
    key = (name, arity, negated, namespace, kind)
    held = _functors.get(key)
    found = None if held is None else held()
    return enter(_functors, key, Functor(*key)) if found is None else found


def enter(table: dict[Any, InternedRef], key: Any, made: T) -> T:
    """Put a new object into a table of names; return the object with the key, as another thread may have been faster."""
    new = InternedRef(made, _release)
    new.key, new.table = key, table
    while True:
        found: T | None = table.setdefault(key, new)()
        if found is not None:
            return found
        _remove_dead_weakref(table, key)


def _release(
    held: InternedRef, remove: Callable[[dict[Any, InternedRef], Any], None] = _remove_dead_weakref
) -> None:
    """Remove an object that is gone, unless there is another one of its name by now.

    The default outlives the module when the interpreter ends.
    """
    remove(held.table, held.key)


def atom(name: str, namespace: str | None = None) -> Functor:
    """The atom of that name."""
    return functor(name, 0, False, namespace)


class String(str):
    """A string of the language.  It compares as `str`, but cannot be added or multiplied."""

    __slots__ = ()

    def __add__(self, other: object) -> NoReturn:
        raise TypeError("strings are joined with .concat")

    __radd__ = __mul__ = __rmul__ = __mod__ = __add__  # pyright: ignore[reportAssignmentType]

    def __repr__(self) -> str:
        return f"String({str.__repr__(self)})"


class Var:
    """A variable that is visible outside its plan.

    Attributes:
        ref: its value, or None while it has none.
        at: number of the goal posting after which it was bound (see `Trail.serial`); unset before.
        name: for output; names of unnamed variables begin with ``_``.
        number: position among the variables of that name in the standard order; unset until it is needed.
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

    def __reduce__(self) -> tuple[Any, ...]:
        return Annotated, (self.term, self.annotations, self.tail)

    def __repr__(self) -> str:
        return f"Annotated({self.term!r}, {self.annotations!r})"


_reference_numbers = itertools.count(1)


class Reference:
    """An opaque object; printed as ``cobj_N``.

    Attributes:
        value: the object; two references are equal when their objects are the same, or can be hashed and are equal.
        number: for printing.
    """

    __slots__ = ("__weakref__", "number", "value")

    def __init__(self, value: object) -> None:
        self.value, self.number = value, next(_reference_numbers)

    def __eq__(self, other: object) -> bool:
        if other.__class__ is not Reference:
            return False
        left, right = self.value, other.value
        if left is right:
            return True
        # Classes of projects may raise anything in __eq__ or __hash__; the mind continues.
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


_CELLS = 16
"""Elements that are taken off a list at a time."""


class List:
    """A closed list of at least one element.

    Lists share their elements: a tail is a shorter view of the same stack, and an element put in front is pushed on it.

    Attributes:
        stack: the elements, the last one first; elements above *size* belong to other lists.
        size: number of elements.
        settled: number of elements from the bottom of the stack that are known to contain no variable and nothing to
            evaluate; they are not checked again.
        depth: maximum nesting of the settled elements, counting the list itself; `NO_KEY` with annotations among them.
        hashed: the hash value, or None before it is needed.
    """

    __slots__ = ("depth", "hashed", "settled", "size", "stack")

    def __init__(self, stack: list[Term], size: int, settled: int = 0, depth: int = 1) -> None:
        self.stack, self.size, self.settled, self.depth = stack, size, settled, depth
        self.hashed: int | None = None

    def rest(self) -> Term:
        """The list without its first element.

        Its next elements are cons tuples, so that a loop over the list makes a view only once in a while.
        """
        size = self.size - 1
        bottom = size - _CELLS
        stack = self.stack
        tail: Term = NIL
        if bottom > 0:
            tail = self._without_first(bottom)
        else:
            bottom = 0
        for item in stack[bottom:size]:
            tail = (CONS, item, tail)
        return tail

    def _without_first(self, size: int) -> "List":
        """The last *size* elements."""
        stack = self.stack
        if size * 4 < len(stack):
            stack = stack[:size]  # a short tail does not keep a long list in memory
        return List(stack, size, min(self.settled, size), self.depth)

    def with_first(self, head: Term) -> "List":
        """The list with one element more in front."""
        size, stack = self.size, self.stack
        if len(stack) > size and stack[size] is head:
            pass  # it was there before
        elif len(stack) == size and (size < 32 or size & (size - 1)):
            # At powers of two a new stack begins, so that a short list does not keep all that grew from it in memory.
            stack.append(head)
            if stack[size] is not head:  # another thread was faster
                stack = [*stack[:size], head]
        else:
            stack = [*stack[:size], head]
        return List(stack, size + 1, self.settled, self.depth)

    def preceded_by(self, heads: list[Term]) -> "List":
        """The list with more elements in front."""
        if len(heads) == 1:
            return self.with_first(heads[0])
        size, stack = self.size, self.stack
        more = heads[::-1]
        above = stack[size : size + len(heads)]
        if len(above) < len(more) or not all(map(is_, above, more)):
            stack = stack[:size] + more
        return List(stack, size + len(heads), self.settled, self.depth)

    def elements(self) -> list[Term]:
        """The elements in their order, in a list of the caller's own."""
        return self.stack[self.size - 1 :: -1]

    def from_bottom(self) -> list[Term]:
        """The elements, the last one first; not to be changed."""
        return self.stack if len(self.stack) == self.size else self.stack[: self.size]

    def is_settled(self) -> bool:
        """Whether nothing in the list can change, as far as that is known, or all its elements are atomic."""
        if self.settled == self.size:
            return True
        if ATOMIC.issuperset(map(type, self.stack[self.settled : self.size])):
            self.settled = self.size
            return True
        return False

    def of_these(self, stack: list[Term]) -> Term:
        """The list of some elements of this one, the last one first."""
        return List(stack, len(stack), len(stack) if self.is_settled() else 0, self.depth) if stack else NIL

    def followed_by(self, other: "List") -> "List":
        """The list of the elements of both."""
        settled, depth = other.settled, other.depth
        if other.is_settled() and self.is_settled():
            settled, depth = self.size + other.size, max(depth, self.depth)
        return List(other.from_bottom() + self.from_bottom(), self.size + other.size, settled, depth)

    def __eq__(self, other: object) -> bool:
        if self is other:
            return True
        if other.__class__ is not List or self.size != other.size:
            return False
        if self.stack is other.stack:
            return True
        if self.hashed is not None and other.hashed is not None and self.hashed != other.hashed:
            return False
        return self.from_bottom() == other.from_bottom()

    def __hash__(self) -> int:
        if self.hashed is None:
            self.hashed = hash(tuple(self.from_bottom()))
        return self.hashed

    def __reduce__(self) -> tuple[Any, ...]:
        return listed, tuple(self.elements())

    def __repr__(self) -> str:
        return f"make_list({self.elements()!r})"


ATOMIC = frozenset({float, int, String, Functor})
"""Classes of values that hold no variables and evaluate to themselves."""
NO_KEY = 1_000_000
"""Depth of a list whose elements have annotations."""
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


def make_list(items: Iterable[Term], tail: Term = NIL) -> Term:
    """The list term of *items*, followed by the elements of *tail*."""
    stack = list(items)
    if not stack:
        return tail
    stack.reverse()
    if tail is NIL:
        return List(stack, len(stack))
    if tail.__class__ is List:
        return tail.preceded_by(stack[::-1])
    for item in stack:
        tail = (CONS, item, tail)
    return tail


def listed(*items: Term) -> Term:
    """The list term of *items*."""
    return make_list(items)


def deref(term: Term) -> Term:
    """Return the value of a bound variable; an unbound one is returned as it is."""
    while term.__class__ is Var and term.ref is not None:
        term = term.ref
    return term


def list_items(term: Term) -> Iterator[Term]:
    """Return an iterator over the elements of a list term; it ends at a tail that is not a list."""
    return iter(parted(deref(term))[0])


MOST_CELLS = 1_000_000
"""Maximum number of cells of an open list, or of structures in each other's last arguments: a walk along a term that
contains itself ends there.
"""
TOO_LONG = f"a term has more than {MOST_CELLS} levels, or contains itself"


def parted(term: Term) -> tuple[list[Term], Term]:
    """Return the elements of a list term, and its tail: `NIL` if it is closed.

    Raises:
        RecursionError: it contains itself.
    """
    if term.__class__ is List:
        return term.elements(), NIL
    items = []
    while term.__class__ is tuple and term[0] is CONS:
        items.append(term[1])
        term = deref(term[2])
        if len(items) > MOST_CELLS:
            raise RecursionError(TOO_LONG)
    if term.__class__ is List:
        return items + term.elements(), NIL
    return items, term


def parts_of_list(term: Term) -> tuple[Term, Term]:
    """Return the first element of a non-empty list term, and the rest."""
    if term.__class__ is List:
        return term.stack[term.size - 1], term.rest()
    return term[1], term[2]


def list_length(term: Term) -> int:
    """The number of elements of a list term."""
    if term.__class__ is List:
        return int(term.size)
    return sum(1 for _ in list_items(term))


def is_list(term: Term) -> bool:
    """Return whether the (dereferenced) term is a list."""
    return term is NIL or term.__class__ is List or (term.__class__ is tuple and term[0] is CONS)


def bare(term: Term) -> Term:
    """Return the term without its annotations."""
    term = deref(term)
    return deref(term.term) if term.__class__ is Annotated else term


def functor_of(term: Term) -> Functor | None:
    """Return the functor of an atom, structure or annotated one; None for other terms and for lists."""
    term = bare(term)
    if term.__class__ is tuple:
        return None if term[0] is CONS else term[0]
    return term if term.__class__ is Functor and term is not NIL else None


def arguments_of(term: Term) -> tuple[Term, ...]:
    """Return the arguments of an atom or structure."""
    term = bare(term)
    return term[1:] if term.__class__ is tuple else ()


def annotations_of(term: Term) -> tuple[Term, ...]:
    """Return the annotations of a term, sorted."""
    term = deref(term)
    return term.annotations if term.__class__ is Annotated else ()


def structure(name: str, *arguments: Term, namespace: str | None = None) -> Term:
    """Return the structure (or, without arguments, the atom) of that name."""
    symbol = functor(name, len(arguments), False, namespace)
    return (symbol, *arguments) if arguments else symbol
