"""Beliefs and rules, indexed by functor and, where programs ask for it, by arguments."""

import itertools
from collections import OrderedDict
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from math import inf
from typing import Any, TypeVar

from jacaros.agents.mind.state.budget import Budget, SearchBudget
from jacaros.agents.mind.state.plan import Answers, Engine, Entry, OpenFact
from jacaros.agents.mind.state.triggers import Trigger, trigger
from jacaros.agents.terms import values
from jacaros.agents.terms.order import annotation_set
from jacaros.agents.terms.substitution import ATOMIC, equal, free_variables, is_key, resolve
from jacaros.agents.terms.unifier import Trail
from jacaros.agents.terms.values import (
    BY_SELF,
    SOURCE,
    Annotated,
    Functor,
    Term,
    Var,
    annotations_of,
    arguments_of,
    bare,
    deref,
    functor_of,
)

Row = tuple[Term, ...]
Item = tuple[Entry, tuple[Term, ...]]
"""An entry of a table with its annotations."""
Index = dict[Term, Any]
"""By key the row, or a dictionary of the rows, newest last."""
MANY_NAMES = 1_000
"""Names of which an agent keeps what it found out about them, although it has no such belief or plan."""
SELECT_OPTION = values.functor("select__option", 4)
"""The predicate that filters applicable plans; the mind holds its table."""
FEW = 8
"""Fewer entries are looked through one by one."""
_NO_LATE: OrderedDict[Entry, tuple[Term, ...]] = OrderedDict()
"""Of all tables without any: most never have one."""
_ONE = ((),)
_NONE: tuple[Row, ...] = ()
_NOTHING: tuple[Item, ...] = ()


@dataclass(slots=True, eq=False, repr=False)
class Table:
    """All beliefs and rules of one functor, newest first.

    Facts are found by the arguments that a question gives: an index by their places is made at the first such question, and
    follows every change from then on.  The rules and what is faster look beliefs up by the same indexes.

    Attributes:
        added: the event kind of beliefs that come.
        deleted: that of beliefs that go.
        rows: annotations by row; newest last.  Keys that are not tuples are rules and beliefs with variables.
        late: those added behind all others, in order; ordered, since a queue is emptied from the side on which a dictionary
            would keep gaps.
        others: how many of `rows` are rules and beliefs with variables.
        late_facts: how many of `late` are neither.
        unwritten: how many of `rows` and `late` are beliefs with variables that are not in the program.
        indexes: the rows by the arguments at some places.
        plain: holds only facts without variables, in `rows` alone: compiled queries may read it directly.
        searches: generator functions for a table that is not plain, by pattern of use.
        deep: those that need no Python recursion.
    """

    functor: Functor
    _base: "BeliefTables" = field(default_factory=lambda: BeliefTables())  # noqa: PLW0108 - it is defined below
    added: Trigger = field(init=False)
    deleted: Trigger = field(init=False)
    rows: dict[Any, tuple[Term, ...]] = field(default_factory=dict)
    late: OrderedDict[Entry, tuple[Term, ...]] = field(default_factory=lambda: _NO_LATE)
    late_facts: int = 0
    others: int = 0
    unwritten: int = 0
    plain: bool = True
    searches: Any = None
    deep: Any = None
    indexes: dict[tuple[int, ...], Index] = field(default_factory=dict)
    _parted: int = 0

    def __post_init__(self) -> None:
        self.added, self.deleted = trigger("+", "", self.functor), trigger("-", "", self.functor)

    def search(self, pattern: int, agent: Any, trail: Trail) -> Callable[..., Answers]:
        """The generator function for a search that begins here; *pattern* tells which arguments are given."""
        trail.room = agent.options.rule_depth
        assert self.searches is not None
        found: Callable[..., Answers] = self.searches[pattern]
        return found

    def exact(self, row: Row) -> Iterable[tuple[()]]:
        """One empty answer when the row is held."""
        return _ONE if row in self.rows else _NONE

    def exact_item(self, row: Row) -> Iterable[Item]:
        """The row with its annotations when it is held."""
        held = self.rows.get(row)
        return _NOTHING if held is None else ((row, held),)

    def find(self, positions: tuple[int, ...], key: Term) -> Iterable[Row]:
        """The rows whose arguments at *positions* are *key* (one value, or a tuple), newest first."""
        index = self.indexes.get(positions)
        if index is None:
            index = self._build_index(positions)
        bucket = index.get(key)
        if bucket is None:
            return _NONE
        return (bucket,) if bucket.__class__ is tuple else reversed(bucket)

    def find_items(self, positions: tuple[int, ...], key: Term) -> Iterable[Item]:
        """What `find` finds, each row with its annotations."""
        held = self.rows.__getitem__
        return zip(self.find(positions, key), map(held, self.find(positions, key)), strict=True)

    def _build_index(self, positions: tuple[int, ...]) -> Index:
        index: Index = {}
        for row in self.rows:
            if row.__class__ is tuple:
                _put(index, key_of(row, positions), row)
        self.indexes[positions] = index
        return index

    def aside(self, row: Row) -> "OpenFact | None":
        """Return the ground belief with these arguments, which cannot be keys."""
        if self.plain or free_variables(row):
            return None
        wanted = literal(self.functor, row)
        for entry, _ in self.candidates(row):
            if isinstance(entry, OpenFact) and equal(entry.literal, wanted):
                return entry
        return None

    def holds_facts_only(self) -> bool:
        """Whether nothing but a change of this table changes its answers.  False may be wrong."""
        return self.others + len(self.late) - self.late_facts == self.unwritten

    def get(self, row: Entry) -> tuple[Term, ...] | None:
        """The annotations of a row, None when it is not held."""
        held = self.rows.get(row)
        return self.late.get(row) if held is None and self.late else held

    def still_holds(self, entry: Entry) -> bool:
        """Whether an entry that a search found has not been deleted meanwhile."""
        return entry in self.rows or entry in self.late

    def set(self, row: Entry, annotations: tuple[Term, ...]) -> None:
        """Replace the annotations of a row that is held."""
        (self.rows if row in self.rows else self.late)[row] = annotations

    def add(self, row: Any, annotations: tuple[Term, ...], last: bool = False) -> tuple[Term, ...] | None:
        """Put in a row that is not held; *last* puts it behind all others.

        Gives the annotations back, None when the base refuses.
        """
        base = self._base
        if base.room < 1 and not base.admits():
            return None
        base.room -= 1
        if base.searching:
            self._part(base.searching)
        if last:
            if not self.late:
                self.late = OrderedDict()
            self.late[row] = annotations
            self._note_late(row, 1)
            return annotations
        self.rows[row] = annotations
        if not self.plain or row.__class__ is not tuple:
            self._add_among_others(row)
        if self.indexes and row.__class__ is tuple:
            self._add_to_indexes(row)
        return annotations

    def _add_among_others(self, row: Any) -> None:
        """The newest entry is not a fact, or there are entries that are not facts."""
        if row.__class__ is not tuple:
            self.others += 1
            self._note(row, 1)
        elif (
            self.searches is not None and self.deep is not None and (self.searches.before or self.deep.before)
        ):
            self._changed()  # no rule answers before the newest fact

    def _note(self, entry: Entry, change: int) -> None:
        """A rule or a belief with variables came (*change* is 1) or went (-1)."""
        if not isinstance(entry, tuple) and entry.node is None:
            self.unwritten += change
            if self.unwritten > (change > 0):
                return  # searches take the general way as long as there are some that are not in the program
        self._changed()

    def _note_late(self, entry: Entry, change: int) -> None:
        """An entry of `late` came (*change* is 1) or went (-1)."""
        if not isinstance(entry, tuple):
            self._note(entry, change)
            return
        self.late_facts += change
        if self.late_facts == (change > 0):  # else searches take the general way, as before
            self._changed()

    def _add_to_indexes(self, row: Row) -> None:
        for positions, index in self.indexes.items():
            _put(index, row[positions[0]] if len(positions) == 1 else key_of(row, positions), row)

    def remove(self, row: Any) -> None:
        """Take out a row, rule or open belief that is held."""
        searching = self._base.searching
        if searching:
            self._part(searching)
        if not self.plain and row in self.late:
            del self.late[row]
            self._note_late(row, -1)
            return
        # The rows are read backwards: at their end no gaps are left, which every reading would have to skip.
        rows = self.rows
        last, value = rows.popitem()
        if last is not row and last != row:
            rows[last] = value
            del rows[row]
        if self.indexes and row.__class__ is tuple:
            self._remove_from_indexes(row)
        elif not self.plain and row.__class__ is not tuple:
            self.others -= 1
            self._note(row, -1)

    def _remove_from_indexes(self, row: Row) -> None:
        for positions, index in self.indexes.items():
            key = key_of(row, positions)
            bucket = index[key]
            if bucket.__class__ is tuple or len(bucket) == 1:
                del index[key]
            else:
                discard(bucket, row)

    def _changed(self) -> None:
        """Rules, or facts among them, came or went: another function searches for them from now on."""
        self.plain = not self.others and not self.late
        engine = None if self.plain else self._base.engine
        made = None if engine is None else engine.searches(self)
        self.searches, self.deep = (None, None) if made is None else made

    def _part(self, serial: int) -> None:
        """An internal action in a condition changes beliefs: what the search is reading stays as it is."""
        if self._parted != serial:
            self._parted = serial
            self.rows, self.late = dict(self.rows), OrderedDict(self.late) if self.late else _NO_LATE
            self.indexes = {}

    def around(self) -> tuple[list[Any], list[Any]] | None:
        """The rules and beliefs with variables that answer before all facts, and those behind all facts.

        None when they are mixed, or when there is a belief with variables that no function can be written for.
        """
        if self.unwritten or self.late_facts:
            return None
        sides = self._sides()
        return None if sides is None else (sides[0], [*sides[1], *self.late])

    def _sides(self) -> tuple[list[Any], list[Any]] | None:
        """What `around` tells, of `rows` alone."""
        before = list(itertools.islice(reversed(self.rows), self.others))
        while before and before[-1].__class__ is tuple:
            before.pop()
        after = list(itertools.islice(self.rows, self.others - len(before)))
        if any(entry.__class__ is tuple for entry in (*before, *after)):
            return None
        after.reverse()
        return ([], before) if self.others == len(self.rows) else (before, after)

    def entries(self) -> list[Item]:
        """All entries with their annotations, in the order in which they answer."""
        found = list(self.rows.items())
        found.reverse()
        found.extend(self.late.items())
        return found

    def candidates(self, arguments: Row) -> Iterable[Item]:
        """The entries that may unify with the arguments, in order, until something changes; an index is used where one
        helps."""
        if self.plain:
            held = self.rows
            return ((row, held[row]) for row in self.rows_like(arguments))
        if len(self) < FEW or (sides := self._sides()) is None:
            return self.entries()
        known = list(zip(*_known(arguments), strict=True))
        before, after = ([entry for entry in side if _may_match(entry, known)] for side in sides)
        facts = (row for row in self.rows_like(arguments) if row.__class__ is tuple)
        held = self.rows
        entries = ((entry, held[entry]) for entry in itertools.chain(before, facts, after))
        return itertools.chain(entries, self.late.items())

    def rows_like(self, arguments: Row) -> Iterable[Row]:
        """The rows that may unify with the arguments, newest first, until something changes."""
        places, keys = _known(arguments)
        if len(keys) == len(arguments):
            row = tuple(keys)
            return (row,) if row in self.rows else _NONE
        if not keys or len(self.rows) < FEW:
            newest_first: Iterator[Row] = reversed(self.rows)
            return newest_first
        return self.find(tuple(places), keys[0] if len(keys) == 1 else tuple(keys))

    def __len__(self) -> int:
        return len(self.rows) + len(self.late)


def _known(arguments: Row) -> tuple[list[int], list[Term]]:
    """The places of the arguments that can be looked up, and their values."""
    places: list[int] = []
    keys: list[Term] = []
    for place, argument in enumerate(arguments):
        if argument.__class__ not in ATOMIC:
            argument = deref(argument)
            if argument.__class__ is Var:
                continue
            argument = resolve(argument)
            if not is_key(argument):
                continue
        places.append(place)
        keys.append(argument)
    return places, keys


def _may_match(entry: Entry, known: list[tuple[int, Term]]) -> bool:
    """Whether a rule or a belief with variables may unify with the *known* arguments, by their places."""
    if isinstance(entry, OpenFact):
        own = arguments_of(entry.literal)
        for place, value in known:
            if own[place].__class__ in ATOMIC and own[place] != value:
                return False
    return True


K = TypeVar("K")
V = TypeVar("V")


def discard(rows: dict[K, V], row: K) -> None:
    """Take a key out of a dictionary that is read backwards: at its end no gaps are left, which would have to be passed
    over at every reading."""
    last, value = rows.popitem()
    if last is not row and last != row:
        rows[last] = value
        del rows[row]


def key_of(row: Row, positions: tuple[int, ...]) -> Term:
    """The arguments of a row at these positions, by which an index finds it."""
    return row[positions[0]] if len(positions) == 1 else tuple(row[i] for i in positions)


def _put(index: Index, key: Term, row: Row) -> None:
    """Put a row into an index.  Most keys have one row: it is its own bucket until there is a second."""
    bucket = index.get(key)
    if bucket is None:
        index[key] = row
    elif bucket.__class__ is tuple:
        index[key] = {bucket: None, row: None}
    else:
        bucket[row] = None


class BeliefTables(dict[Functor, Table]):
    """Tables by functor, made on first use.

    Args:
        engine: runs the rules.
        limit: how many beliefs there may be, rules included.
        refusing: refuses those beyond it: the step that adds one fails, one from outside is logged.

    Attributes:
        searching: number of the internal action that a search is calling, 0 while none is.
        next_call: returns the number of the next one.
        room: number of beliefs that can be added without a look at the limit: deleted ones are counted when it is used up.
        budget: how much the present question may search; None between questions.
        engine: runs the rules.
        held_percepts: for each perceived literal the annotations of the property that shows it, or a list with the
            entries and annotations if several do (decision 22).
        namespace_properties: properties that programs give to namespaces.
    """

    __slots__ = (
        "_limit",
        "_refusing",
        "budget",
        "engine",
        "held_percepts",
        "namespace_properties",
        "next_call",
        "room",
        "searching",
    )

    def __init__(
        self, engine: Engine | None = None, limit: float = inf, refusing: Budget | None = None
    ) -> None:
        super().__init__()
        self.engine = engine
        self.budget: SearchBudget | None = None
        self.room = self._limit = limit
        self._refusing = refusing
        self.searching = 0
        self.held_percepts: dict[Term, Any] = {}
        self.namespace_properties: dict[str, dict[Term, Term]] = {}
        self.next_call = itertools.count(1).__next__

    def __missing__(self, functor: Functor) -> Table:
        table = self[functor] = Table(functor, self)
        return table

    def admits(self) -> bool:
        """Count the beliefs, and return whether there is room for one more.

        Raises:
            Failure: there is no room, and a step adds the belief.
        """
        held = sum(map(len, self.values()))
        self.room = self._limit - held
        if self.room < 1 and self._refusing is not None:
            largest = max(self.values(), key=len)
            name = f"{largest.functor.name}/{largest.functor.arity}"
            self._refusing.refuse(held, f", most of them {name} ({len(largest)})")
        return self.room >= 1

    def forget_names(self) -> None:
        """Drop the empty tables when there are many tables: their names may never be used again.

        Only while the agent is between two steps, since a step may hold a table.
        """
        if len(self) > MANY_NAMES:
            kept = {
                functor: table
                for functor, table in self.items()
                if table.rows or table.late or functor is SELECT_OPTION
            }
            self.clear()  # a dictionary shrinks only so
            self.update(kept)

    def literals(self) -> Iterator[Term]:
        """All beliefs with their annotations, predicate by predicate."""
        for functor, table in list(self.items()):
            for entry, annotations in table.entries():
                if isinstance(entry, tuple):
                    yield literal(functor, entry, annotations)
                elif isinstance(entry, OpenFact):
                    yield Annotated(entry.head(), annotations)


def literal(functor: Functor, row: Row, annotations: tuple[Term, ...] = ()) -> Term:
    """The literal of a row."""
    term: Term = (functor, *row) if row else functor
    return Annotated(term, annotations) if annotations else term


def parts(term: Term) -> tuple[Functor | None, Row, tuple[Term, ...]]:
    """Return functor, arguments and annotations of a literal; the functor is None for other terms."""
    term = resolve(term)
    return functor_of(term), arguments_of(term), annotations_of(term)


def with_source(annotations: tuple[Term, ...]) -> tuple[Term, ...]:
    """The annotations, with ``source(self)`` when no source is named."""
    if not annotations:
        return BY_SELF
    return annotations if has_source(annotations) else annotation_set((*annotations, *BY_SELF))


def is_source(annotation: Term) -> bool:
    """Whether an annotation is ``source(Name)``."""
    inner = bare(annotation)
    return inner.__class__ is tuple and inner[0] is SOURCE


def has_source(annotations: tuple[Term, ...]) -> bool:
    """Whether a source is among the annotations."""
    for annotation in annotations:  # noqa: SIM110 - twice as fast as `any`
        if is_source(annotation):
            return True
    return False


def without_sources(term: Term) -> Term:
    """The literal without its sources."""
    if term.__class__ is not Annotated:
        return term
    kept = tuple(a for a in term.annotations if not is_source(a))
    return Annotated(term.term, kept, term.tail) if kept or term.tail is not None else term.term


def take_away(table: Table, entry: Entry, held: tuple[Term, ...], annotations: tuple[Term, ...]) -> None:
    """Take annotations off a belief; it goes when no source is left."""
    rest = tuple(a for a in held if a not in annotations)
    if has_source(rest):
        table.set(entry, rest)
    else:
        table.remove(entry)
