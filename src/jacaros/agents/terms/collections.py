"""The mutable values of the language: sets, maps and queues, shared by reference as in Jason.

>>> from jacaros.agents.terms.text import text
>>> shared = SetValue({2.0: None, 1.0: None})
>>> text(shared)
'{1,2}'
>>> own = detached(shared)
>>> own.items[3.0] = None
>>> len(shared)
2

Another agent gets copies of its own (`detached`).
"""

import heapq
import itertools
from collections import deque
from collections.abc import Container, Iterable, Iterator
from typing import Any

from jacaros.agents.terms.order import SortKey, sorted_terms
from jacaros.agents.terms.substitution import as_key, resolve, with_parts
from jacaros.agents.terms.values import ATOMIC, Annotated, List, Term, deref, make_list


class SetValue:
    """``{a, b}``: each element once, read in the standard order.  Sets with the same elements are equal."""

    __slots__ = ("items",)

    def __init__(self, items: dict[Term, None] | None = None) -> None:
        self.items: dict[Term, None] = {} if items is None else items

    def add(self, item: Term) -> None:
        """Add an element."""
        self.items[as_key(item)] = None

    def remove(self, item: Term) -> None:
        """Remove an element, if it is in the set."""
        self.items.pop(as_key(item), None)

    def keep(self, others: Container[Term]) -> None:
        """Keep only the elements that are among others."""
        self.items = {item: None for item in self.items if item in others}

    def clear(self) -> None:
        """Remove all elements."""
        self.items.clear()

    def copy(self) -> "SetValue":
        """Return a new set with the same elements."""
        return SetValue(dict(self.items))

    def as_list(self) -> Term:
        """The elements as a list term."""
        return make_list(list(self))

    def __iter__(self) -> Iterator[Term]:
        return iter(sorted_terms(self.items))

    def __len__(self) -> int:
        return len(self.items)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, SetValue) and self.items.keys() == other.items.keys()

    def __hash__(self) -> int:
        return hash(SetValue)  # the elements change while the set is an argument of a belief

    def __reduce__(self) -> tuple[Any, ...]:
        return SetValue, (self.items,)


class MapValue:
    """``{k->v}``: a value per key, read in the standard order of the keys."""

    __slots__ = ("items",)

    def __init__(self, items: dict[Term, Term] | None = None) -> None:
        self.items: dict[Term, Term] = {} if items is None else items

    def clear(self) -> None:
        """Remove all keys."""
        self.items.clear()

    def copy(self) -> "MapValue":
        """Return a new map with the same keys and values."""
        return MapValue(dict(self.items))

    def as_list(self) -> Term:
        """Keys and values in turn as a list term."""
        return make_list([part for key in self for part in (key, self.items[key])])

    def __reduce__(self) -> tuple[Any, ...]:
        return MapValue, (self.items,)

    def __iter__(self) -> Iterator[Term]:
        return iter(sorted_terms(self.items))

    def __len__(self) -> int:
        return len(self.items)


class QueueValue:
    """``[a, b]``: first in, first out; or, with *priority*, smallest first."""

    __slots__ = ("_heap", "_items", "_numbers", "priority")

    def __init__(self, priority: bool = False, items: Iterable[Term] = ()) -> None:
        self.priority = priority
        self._items: deque[Term] = deque()
        self._heap: list[tuple[Any, int, Term]] = []  # ordered by SortKey
        self._numbers = itertools.count()
        for item in items:
            self.add(item)

    def __reduce__(self) -> tuple[Any, ...]:
        return QueueValue, (self.priority, list(self))

    def add(self, item: Term) -> None:
        """Add an element."""
        if self.priority:
            heapq.heappush(self._heap, (SortKey(item), next(self._numbers), item))
        else:
            self._items.append(item)

    def head(self) -> Term | None:
        """Return the next element, or None."""
        if self.priority:
            return self._heap[0][2] if self._heap else None
        return self._items[0] if self._items else None

    def remove(self) -> Term | None:
        """Remove and return the next element, or None."""
        if self.priority:
            return heapq.heappop(self._heap)[2] if self._heap else None
        return self._items.popleft() if self._items else None

    def clear(self) -> None:
        """Remove all elements."""
        self._items.clear()
        self._heap.clear()

    def copy(self) -> "QueueValue":
        """Return a new queue with the same elements."""
        return QueueValue(self.priority, self)

    def as_list(self) -> Term:
        """Return the elements in order as a list term."""
        return make_list(list(self))

    def __iter__(self) -> Iterator[Term]:
        return iter([entry[2] for entry in sorted(self._heap)] if self.priority else list(self._items))

    def __len__(self) -> int:
        return len(self._heap) if self.priority else len(self._items)


_COLLECTIONS = (SetValue, MapValue, QueueValue)


def detached(term: Term) -> Term:
    """Return the term with its own copies of collections; a term without collections is returned unchanged."""
    return _copy(resolve(term), {}) if holds_collection(term) else term


def holds_collection(term: Term) -> bool:
    """Return whether a term contains a set, map or queue."""
    stack = [term]
    while stack:
        part = deref(stack.pop())
        kind = part.__class__
        if kind is tuple:
            stack.extend(part[1:])
        elif kind is List:
            items = part.from_bottom()
            if not ATOMIC.issuperset(map(type, items)):
                stack.extend(items)
        elif kind is Annotated:
            stack.append(part.term)
            stack.extend(part.annotations)
        elif kind in _COLLECTIONS:
            return True
    return False


def _copy(term: Term, copies: dict[int, Term]) -> Term:
    def own(part: Term) -> Term:
        if part.__class__ not in _COLLECTIONS:
            return part
        known = copies.get(id(part))
        return known if known is not None else _copy_collection(part, copies)

    return with_parts(term, own, lambda items: not holds_collection(items))


def _copy_collection(term: Term, copies: dict[int, Term]) -> Term:
    made: SetValue | MapValue | QueueValue
    if isinstance(term, SetValue):
        made = copies[id(term)] = SetValue()
        made.items.update((_copy(item, copies), None) for item in term.items)
    elif isinstance(term, MapValue):
        made = copies[id(term)] = MapValue()
        made.items.update((_copy(key, copies), _copy(value, copies)) for key, value in term.items.items())
    else:
        made = copies[id(term)] = QueueValue(term.priority)
        for item in term:
            made.add(_copy(item, copies))
    return made
