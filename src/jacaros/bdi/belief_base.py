"""Beliefs and rules, indexed by functor and, where programs ask for it, by arguments."""

from collections.abc import Generator, Iterable, Iterator, Mapping
from typing import Any

from jacaros.asl import nodes
from jacaros.compiler.function import ActionInfo
from jacaros.compiler.lowering import fresh_names, lower, lower_value
from jacaros.compiler.unit import compile_rule_function
from jacaros.terms.order import annotation_set
from jacaros.terms.text import text
from jacaros.terms.unifier import Trail, equal, is_key, rename, resolve, unify
from jacaros.terms.values import (
    BY_SELF,
    SOURCE,
    Annotated,
    Functor,
    Term,
    annotations_of,
    arguments_of,
    bare,
    functor_of,
)

Row = tuple[Term, ...]
_ONE = ((),)
_NONE: tuple[Row, ...] = ()
_NOTHING: tuple[tuple[Row, tuple[Term, ...]], ...] = ()
_FLAT = frozenset({float, Functor})


class Rule:
    """A rule in the base; its function is generated when it is first used."""

    __slots__ = ("_actions", "_function", "node", "term")

    def __init__(self, node: nodes.Rule, actions: Mapping[str, ActionInfo]) -> None:
        self.node = _with_source(node)
        self._actions = actions
        self._function: Any = None

    def search(self, agent: Any, arguments: Row, trail: Trail) -> Generator[Any, Any, None]:
        """A generator of the answers, see `jacaros.compiler.runtime.run`."""
        if self._function is None:
            self._function = compile_rule_function(self.node, self._actions)
        found: Generator[Any, Any, None] = self._function(agent, arguments, trail)
        return found

    def head_annotations(self) -> tuple[Term, ...]:
        """The annotations of the head, ``source(self)`` when it names no source."""
        annotations = self.node.head.annotations
        return BY_SELF if annotations is None else annotations_of(lower_value(self.node.head))

    def text(self) -> str:
        """The rule as Jason prints it."""
        lookup = fresh_names()
        head = lower(self.node.head, lookup)
        if self.node.head.annotations is None:
            head = Annotated(head, BY_SELF)
        return f"{text(head)} :- {text(lower(self.node.body, lookup))}"

    def head(self) -> Term:
        """The head as a term with fresh variables."""
        return lower(self.node.head, fresh_names())


_SOURCE_SELF = nodes.Literal("source", (nodes.Literal("self"),))


def _with_source(rule: nodes.Rule) -> nodes.Rule:
    """The rule with ``source(self)`` among the annotations of its head, when there are some and none is a source."""
    annotations = rule.head.annotations
    if annotations is None:
        return rule
    if any(isinstance(item, nodes.Literal) and item.functor == "source" for item in annotations.items):
        return rule
    more = nodes.replace(annotations, items=(*annotations.items, _SOURCE_SELF))
    return nodes.replace(rule, head=nodes.replace(rule.head, annotations=more))


class OpenFact:
    """A belief with variables: every use takes a copy."""

    __slots__ = ("annotations", "literal")

    def __init__(self, literal: Term, annotations: tuple[Term, ...]) -> None:
        self.literal, self.annotations = literal, annotations

    def search(self, agent: Any, arguments: Row, trail: Trail) -> Generator[Any, Any, None]:
        """One answer when the arguments unify with a copy."""
        del agent
        own = arguments_of(rename(self.literal))
        if all(unify(a, b, trail) for a, b in zip(arguments, own, strict=True)):
            yield ()

    def head_annotations(self) -> tuple[Term, ...]:
        """The annotations of the belief."""
        return self.annotations

    def head(self) -> Term:
        """A copy of the literal."""
        return rename(self.literal)


class Table:
    """All beliefs and rules of one functor, newest first.

    Attributes:
        rows: annotations by row; newest last.  Keys that are no tuples are rules and beliefs with variables.
        late: those added behind all others, in order.
        plain: holds only facts without variables, in `rows` alone: compiled queries may read it directly.
    """

    __slots__ = ("_indexes", "functor", "late", "plain", "rows")

    def __init__(self, functor: Functor) -> None:
        self.functor = functor
        self.rows: dict[Any, tuple[Term, ...]] = {}
        self.late: dict[Any, tuple[Term, ...]] = {}
        self.plain = True
        self._indexes: dict[tuple[int, ...], dict[Any, dict[Row, None]]] = {}

    def exact(self, row: Row) -> Iterable[tuple[()]]:
        """One empty answer when the row is held."""
        return _ONE if row in self.rows else _NONE

    def exact_item(self, row: Row) -> Iterable[tuple[Row, tuple[Term, ...]]]:
        """The row with its annotations when it is held."""
        held = self.rows.get(row)
        return _NOTHING if held is None else ((row, held),)

    def find_items(self, positions: tuple[int, ...], key: Any) -> Iterable[tuple[Row, tuple[Term, ...]]]:
        """What `find` finds, each row with its annotations."""
        rows = self.rows
        return [(row, rows[row]) for row in self.find(positions, key)]

    def find(self, positions: tuple[int, ...], key: Any) -> Iterable[Row]:
        """The rows whose arguments at *positions* are *key* (one value, or a tuple), newest first."""
        index = self._indexes.get(positions)
        if index is None:
            index = self._build_index(positions)
        bucket = index.get(key)
        return _NONE if bucket is None else reversed(bucket)

    def _build_index(self, positions: tuple[int, ...]) -> dict[Any, dict[Row, None]]:
        index = self._indexes[positions] = {}
        for row in self.rows:
            if row.__class__ is tuple:
                index.setdefault(_key(row, positions), {})[row] = None
        return index

    def aside(self, row: Row) -> "OpenFact | None":
        """The ground belief with these arguments among those that are no keys."""
        for entry in (*self.rows, *self.late):
            if isinstance(entry, OpenFact) and equal(entry.literal, literal(self.functor, row)):
                return entry
        return None

    def get(self, row: Any) -> tuple[Term, ...] | None:
        """The annotations of a row, None when it is not held."""
        held = self.rows.get(row)
        return self.late.get(row) if held is None and self.late else held

    def set(self, row: Any, annotations: tuple[Term, ...]) -> bool:
        """Replace the annotations of a row that is held; False when the base refuses."""
        (self.rows if row in self.rows else self.late)[row] = annotations
        return True

    def add(self, row: Any, annotations: tuple[Term, ...], last: bool = False) -> tuple[Term, ...] | None:
        """Put in a row that is not held; *last* puts it behind all others.

        Gives the annotations back, None when the base refuses: those of projects may.
        """
        if last:
            self.late[row] = annotations
            self.plain = False
            return annotations
        self.rows[row] = annotations
        if row.__class__ is not tuple:
            self.plain = False
            return annotations
        if self._indexes:
            self._add_to_indexes(row)
        return annotations

    def _add_to_indexes(self, row: Row) -> None:
        for positions, index in self._indexes.items():
            key = _key(row, positions)
            bucket = index.get(key)
            if bucket is None:
                index[key] = {row: None}
            else:
                bucket[row] = None

    def begin(self, row: Row, annotations: tuple[Term, ...]) -> bool:
        """Put in a row of numbers, strings and atoms; False when it is held already."""
        if row in self.rows or (self.late and row in self.late):
            return False
        self.rows[row] = annotations
        if self._indexes:
            self._add_to_indexes(row)
        return True

    def end(self, row: Row, annotations: tuple[Term, ...]) -> bool:
        """Take out a row; False when it is not held with this very tuple of annotations."""
        if self.rows.get(row) is not annotations:
            return False
        del self.rows[row]
        if self._indexes:
            self._remove_from_indexes(row)
        return True

    def remove(self, row: Any) -> bool:
        """Take out a row, rule or open belief that is held; False when the base refuses."""
        if row in self.late:
            del self.late[row]
        else:
            del self.rows[row]
            if self._indexes and row.__class__ is tuple:
                self._remove_from_indexes(row)
        if not self.plain:
            self.plain = not self.late and all(r.__class__ is tuple for r in self.rows)
        return True

    def _remove_from_indexes(self, row: Row) -> None:
        for positions, index in self._indexes.items():
            key = _key(row, positions)
            bucket = index[key]
            del bucket[row]
            if not bucket:
                del index[key]

    def entries(self) -> list[tuple[Any, tuple[Term, ...]]]:
        """All entries with their annotations, in the order in which they answer."""
        found = list(self.rows.items())
        found.reverse()
        found.extend(self.late.items())
        return found

    def in_order(self) -> Iterator[tuple[Any, tuple[Term, ...]]]:
        """The entries one by one in the order in which they answer, for who stops when something changes."""
        yield from reversed(self.rows.items())
        yield from self.late.items()

    def candidates(self, arguments: Row) -> Iterable[tuple[Any, tuple[Term, ...]]]:
        """The entries that may unify with the arguments, in order; an index is used where one helps."""
        if not self.plain:
            return self.entries()
        ground = [(i, a) for i, a in enumerate(map(resolve, arguments)) if is_key(a)]
        if len(ground) == len(arguments):
            row = tuple(a for _, a in ground)
            held = self.rows.get(row)
            return () if held is None else ((row, held),)
        if not ground or len(self.rows) < 8:
            return self.entries()
        position, key = ground[0]
        return [(row, self.rows[row]) for row in self.find((position,), key)]

    def __len__(self) -> int:
        return len(self.rows) + len(self.late)


def _key(row: Row, positions: tuple[int, ...]) -> Any:
    return row[positions[0]] if len(positions) == 1 else tuple(row[i] for i in positions)


class BeliefBase(dict[Functor, Table]):
    """Tables by functor, made when first asked for."""

    def __missing__(self, functor: Functor) -> Table:
        table = self[functor] = Table(functor)
        return table

    def literals(self) -> Iterator[Term]:
        """All beliefs with their annotations, predicate by predicate."""
        for functor, table in list(self.items()):
            for entry, annotations in table.entries():
                if entry.__class__ is tuple:
                    yield literal(functor, entry, annotations)
                elif isinstance(entry, OpenFact):
                    yield Annotated(entry.head(), annotations)


def literal(functor: Functor, row: Row, annotations: tuple[Term, ...] = ()) -> Term:
    """The literal of a row."""
    term: Term = (functor, *row) if row else functor
    return Annotated(term, annotations) if annotations else term


def parts(term: Term) -> tuple[Functor | None, Row, tuple[Term, ...]]:
    """Functor, arguments and annotations of a literal; the functor is None when it is no literal."""
    term = resolve(term)
    return functor_of(term), arguments_of(term), annotations_of(term)


def with_source(annotations: tuple[Term, ...]) -> tuple[Term, ...]:
    """The annotations, with ``source(self)`` when no source is named."""
    if not annotations:
        return BY_SELF
    return annotations if has_source(annotations) else annotation_set((*annotations, *BY_SELF))


def has_source(annotations: tuple[Term, ...]) -> bool:
    """Whether a source is among the annotations."""
    for annotation in annotations:
        inner = bare(annotation)
        if inner.__class__ is tuple and inner[0] is SOURCE:
            return True
    return False
