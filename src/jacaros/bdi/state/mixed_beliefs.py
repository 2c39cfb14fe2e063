"""What a table of beliefs needs when it holds more than facts, each newer than those behind it."""

from collections import OrderedDict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from heapq import merge
from types import MappingProxyType
from typing import TypeGuard, TypeVar

from jacaros.bdi.state.rule import Entry, OpenFact
from jacaros.terms.substitution import ATOMIC
from jacaros.terms.values import Term, arguments_of

FEW = 8
"""Fewer entries are looked through one by one."""
Row = tuple[Term, ...]
Key = TypeVar("Key")
Value = TypeVar("Value")
Group = dict[Entry, None]
"""Entries, newest last."""


class Late(OrderedDict[Entry, tuple[Term, ...]]):
    """Entries that answer behind all others, oldest first, with their annotations.

    Attributes:
        others: how many are rules and beliefs with variables.
    """

    # Ordered, since it is read from the side on which a queue is emptied: a dictionary would keep gaps there.

    def __init__(self, items: Mapping[Entry, tuple[Term, ...]] = MappingProxyType({})) -> None:
        super().__init__(items)
        self.others = sum(not isinstance(entry, tuple) for entry in items)
        self._indexes: dict[tuple[int, ...], dict[Term, OrderedDict[Row, None]]] = {}

    def put(self, entry: Entry, annotations: tuple[Term, ...]) -> None:
        """Put an entry behind all others."""
        self[entry] = annotations
        if not isinstance(entry, tuple):
            self.others += 1
            return
        for places, index in self._indexes.items():
            index.setdefault(key_of(entry, places), OrderedDict())[entry] = None

    def take(self, entry: Entry) -> None:
        """Take an entry out."""
        del self[entry]
        if not isinstance(entry, tuple):
            self.others -= 1
            return
        for places, index in self._indexes.items():
            key = key_of(entry, places)
            del index[key][entry]
            if not index[key]:
                del index[key]

    def like(self, places: list[int], keys: list[Term]) -> Iterable[tuple[Entry, tuple[Term, ...]]]:
        """The entries that may have *keys* at *places*, in order."""
        if not keys or self.others or len(self) < FEW:
            return self.items()
        index = self._indexes.get(tuple(places))
        if index is None:
            index = self._indexes[tuple(places)] = {}
            for row in filter(is_fact, self):
                index.setdefault(key_of(row, tuple(places)), OrderedDict())[row] = None
        found = index.get(keys[0] if len(keys) == 1 else tuple(keys), ())
        return ((row, self[row]) for row in found)


class Mixed:
    """The order of the entries of a table, and its rules and beliefs with variables by each of their arguments.

    Args:
        rows: the entries, newest last.  A tuple is a fact.
        arity: how many arguments each has.
    """

    __slots__ = ("_count", "_numbers", "_open_at", "_values_at")

    def __init__(self, rows: Iterable[Entry], arity: int) -> None:
        self._count = 0
        self._numbers: dict[Entry, int] = {}
        self._values_at: list[dict[Term, Group]] = [{} for _ in range(arity)]
        self._open_at: list[Group] = [{} for _ in range(arity)]
        for entry in rows:
            self.add(entry)

    def add(self, entry: Entry) -> None:
        """Take in the newest entry."""
        self._count += 1
        self._numbers[entry] = self._count
        if not isinstance(entry, tuple):
            for place, value in enumerate(_values(entry, len(self._open_at))):
                if value is None:
                    self._open_at[place][entry] = None
                else:
                    self._values_at[place].setdefault(value, {})[entry] = None

    def remove(self, entry: Entry) -> None:
        """Forget an entry."""
        del self._numbers[entry]
        if not isinstance(entry, tuple):
            for place, value in enumerate(_values(entry, len(self._open_at))):
                if value is None:
                    discard(self._open_at[place], entry)
                    continue
                group = self._values_at[place][value]
                discard(group, entry)
                if not group:
                    del self._values_at[place][value]

    def like(self, places: Sequence[int], keys: Sequence[Term], facts: Iterator[Entry]) -> Iterator[Entry]:
        """The entries that may have *keys* at *places*, newest first; *facts* are those among them that are facts."""
        groups = [
            (self._values_at[place].get(key, {}), self._open_at[place])
            for place, key in zip(places, keys, strict=True)
            if key.__class__ in ATOMIC
        ]
        if groups:
            chosen: Sequence[Group] = min(groups, key=lambda pair: len(pair[0]) + len(pair[1]))
        else:
            chosen = ({entry: None for entry in self._numbers if not isinstance(entry, tuple)},)
        newest_first = [facts, *(reversed(group) for group in chosen)]
        return merge(*newest_first, key=self._age)

    def _age(self, entry: Entry) -> int:
        return -self._numbers[entry]


def _values(entry: Entry, arity: int) -> list[Term | None]:
    """The arguments of an entry that are numbers, strings or atoms; None for others, which may unify with more."""
    if not isinstance(entry, OpenFact):
        return [None] * arity
    return [value if value.__class__ in ATOMIC else None for value in arguments_of(entry.literal)]


def is_fact(entry: Entry) -> TypeGuard[Row]:
    """Whether an entry is the arguments of a fact."""
    return entry.__class__ is tuple


def discard(rows: dict[Key, Value], row: Key) -> None:
    """Take a key out of a dictionary that is read backwards: at its end no gaps are left, which would have to be passed
    over at every reading."""
    last, value = rows.popitem()
    if last is not row and last != row:
        rows[last] = value
        del rows[row]


def key_of(row: Row, positions: tuple[int, ...]) -> Term:
    """The arguments of a row at these positions, by which an index finds it."""
    return row[positions[0]] if len(positions) == 1 else tuple(row[i] for i in positions)
