"""Belief bases of projects: changes of an agent's beliefs go through an object of the project's class.

The tables of the mind are unchanged, so compiled queries are as fast as ever. Only changes call the object, and
questions if the class provides beliefs of its own (`BeliefBase.candidates`).
"""

from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any, Protocol

from jacaros.bdi.mind import Mind
from jacaros.bdi.state import belief_base
from jacaros.bdi.state.belief_base import SELECT_OPTION, Row, Table, parts
from jacaros.bdi.state.rule import OpenFact, Rule
from jacaros.extension.agent import Agent, agent_of
from jacaros.extension.calling import FAULTS, crash_text
from jacaros.extension.literal import Literal, literal_from, literal_of, literal_term
from jacaros.terms.order import annotation_set
from jacaros.terms.substitution import is_key
from jacaros.terms.values import Functor, Term

Annotations = tuple[Term, ...]
Entry = Row | OpenFact | Rule
"""An entry of a table: the arguments of a belief, a belief with variables, or a rule."""


class Keeper(Protocol):
    """Where beliefs are finally stored."""

    def keep(self, belief: Literal) -> bool:
        """Store a belief, or update its annotations."""

    def discard(self, belief: Literal) -> bool:
        """Remove a belief; return False if it is not stored."""

    def literals(self) -> Iterator[Term]:
        """Iterate over all beliefs."""


class BeliefBase:
    """Where an agent keeps its beliefs; to be subclassed.

    A subclass is named in the project file: ``agents: bob beliefBaseClass my.LoudBB(3);`` in a ``.mas2j`` file, ``agent
    bob { ag-bb-class: my.LoudBB(3) }`` in a ``.jcm`` file. Rules and beliefs with variables are kept by the mind alone.
    An exception in an overridden method is logged, and the default is used instead.

    Attributes:
        agent: the agent that the beliefs belong to.
        folder: the project's folder, for files.
    """

    agent: Agent
    folder: Path
    _tables: Keeper

    # --- what may be overridden ----------------------------------------------------------------------------

    def init(self, *arguments: Any) -> None:
        """Called before the agent adds its initial beliefs, with the arguments of ``my.LoudBB(3)``."""

    def add(self, belief: Literal) -> bool:
        """Store a new belief, or one with new annotations (then with all its annotations).

        Returns:
            Whether it was stored: if not, there is no event.
        """
        return self._tables.keep(belief)

    def remove(self, belief: Literal) -> bool:
        """Remove a belief that has lost its last source.

        Returns:
            Whether it was removed: if not, there is no event.
        """
        return self._tables.discard(belief)

    def candidates(self, pattern: Literal) -> Iterable[Literal]:
        """Return beliefs that are not stored here but looked up on demand, such as rows of a database.

        They answer after the stored ones. The mind ignores beliefs that do not match the pattern.

        Args:
            pattern: the question; unknown arguments are unset `Out` objects.
        """
        return ()

    def stop(self) -> None:
        """Called when the agent ends."""

    # --- what a belief base provides -----------------------------------------------------------------------

    def __iter__(self) -> Iterator[Literal]:
        """Iterate over all stored beliefs, with their annotations."""
        for term in list(self._tables.literals()):
            yield literal_of(term)

    def __len__(self) -> int:
        return sum(1 for _ in self._tables.literals())

    def __bool__(self) -> bool:
        return True

    def beliefs(self, functor: str, arity: int | None = None) -> list[Literal]:
        """Return the beliefs of a name, and optionally number of arguments, newest first."""
        return [b for b in self if b.functor == functor and arity in (None, b.arity)]


class Tables(belief_base.BeliefTables):
    """The tables of a mind whose changes go through a `BeliefBase`."""

    def __init__(self, base: BeliefBase, mind: Mind) -> None:
        super().__init__(mind.engine)
        self.base, self.mind = base, mind
        self.budget = mind.beliefs.budget
        # The current change in the mind's representation, so that the same literal is not converted back to
        # terms.
        self._change: tuple[Literal, AskingTable, Row, Annotations, bool] | None = None
        looked_up = type(base).candidates is not BeliefBase.candidates
        self._kind = LookingTable if looked_up else AskingTable

    def __missing__(self, functor: Functor) -> Table:
        table = self[functor] = self._kind(functor, self)
        return table

    def ask_add(self, table: "AskingTable", row: Row, annotations: Annotations, last: bool) -> bool:
        """Let the class store a belief; return whether it did."""
        literal = literal_from(table.functor, row, annotations)
        self._change = (literal, table, row, annotations, last)
        return self._ask("add", literal, lambda: table.put(row, annotations, last))

    def ask_remove(self, table: "AskingTable", row: Row) -> bool:
        """Let the class remove a belief; return whether it did."""
        literal = literal_from(table.functor, row, table.get(row) or ())
        self._change = (literal, table, row, (), False)
        return self._ask("remove", literal, lambda: table.take(row))

    def _ask(self, method: str, literal: Literal, default: Callable[[], None]) -> bool:
        try:
            return bool(getattr(self.base, method)(literal))
        except FAULTS as error:
            self._crashed(method, error)
            default()
            return True
        finally:
            self._change = None

    def ask_candidates(self, functor: Functor, arguments: Row) -> list[tuple[Entry, Annotations]]:
        """Return the beliefs that the class looks up for a question."""
        try:
            found = [
                parts(literal_term(each))
                for each in self.base.candidates(literal_from(functor, arguments, ()))
            ]
        except FAULTS as error:
            self._crashed("candidates", error)
            return []
        return [
            (row, belief_base.with_source(annotations))
            for symbol, row, annotations in found
            if symbol is functor and all(map(is_key, row))
        ]

    def keep(self, belief: Literal) -> bool:
        change = self._change
        if change is not None and belief is change[0]:
            _, table, row, annotations, last = change
        else:
            symbol, row, annotations = parts(literal_term(belief))
            assert symbol is not None
            table, last = self._table(symbol), False
            annotations = annotation_set(belief_base.with_source(annotations))
        table.put(row, annotations, last)
        return True

    def discard(self, belief: Literal) -> bool:
        change = self._change
        if change is not None and belief is change[0]:
            _, table, row, _, _ = change
        else:
            symbol, row, _ = parts(literal_term(belief))
            assert symbol is not None
            table = self._table(symbol)
        if table.get(row) is None:
            return False
        table.take(row)
        return True

    def _table(self, functor: Functor) -> "AskingTable":
        table = self[functor]
        assert isinstance(table, AskingTable)
        return table

    def _crashed(self, method: str, error: BaseException) -> None:
        told = crash_text(f"{type(self.base).__name__}.{method}", getattr(self.base, method), error)
        self.mind.architecture.log("error", told)


class AskingTable(Table):
    """A table that asks a `BeliefBase` before it changes."""

    __slots__ = ("_tables",)

    def __init__(self, functor: Functor, tables: Tables) -> None:
        super().__init__(functor, tables)
        self._tables = tables

    def add(self, row: Entry, annotations: Annotations, last: bool = False) -> Annotations | None:
        if not isinstance(row, tuple):
            return super().add(row, annotations, last)
        return annotations if self._tables.ask_add(self, row, annotations, last) else None

    def set(self, row: Entry, annotations: Annotations) -> bool:
        if not isinstance(row, tuple):
            return super().set(row, annotations)
        return self._tables.ask_add(self, row, annotations, False)

    def remove(self, row: Entry) -> bool:
        if not isinstance(row, tuple):
            return super().remove(row)
        return self._tables.ask_remove(self, row)

    def holds_facts_only(self) -> bool:
        """False: the class may store and look up beliefs at any time."""
        return False

    def put(self, row: Row, annotations: Annotations, last: bool) -> None:
        """Store a row without asking."""
        if self.get(row) is None:
            super().add(row, annotations, last)
        else:
            super().set(row, annotations)

    def take(self, row: Row) -> None:
        """Remove a row without asking."""
        super().remove(row)


class LookingTable(AskingTable):
    """A table with additional beliefs, which the class looks up for each question."""

    __slots__ = ()

    def __init__(self, functor: Functor, tables: Tables) -> None:
        super().__init__(functor, tables)
        self._changed()

    def around(self) -> None:
        """None: looked-up beliefs may belong between the others, so questions use the general search."""
        return

    @property
    def plain(self) -> bool:
        """False: compiled queries must not read the rows directly."""
        return False

    @plain.setter
    def plain(self, value: bool) -> None:
        pass

    def still_holds(self, entry: Entry) -> bool:
        """True: looked-up beliefs are not among the entries."""
        return True

    def candidates(self, arguments: Row) -> Iterable[tuple[Entry, Annotations]]:
        """Return the stored entries, then the looked-up ones."""
        return [*super().candidates(arguments), *self._tables.ask_candidates(self.functor, arguments)]


def install(mind: Mind, base: BeliefBase, folder: Path, arguments: Iterable[object]) -> None:
    """Let a mind keep its beliefs in a base of the project's class; to be called before it has any."""
    base.agent, base.folder = agent_of(mind), folder
    mind.beliefs = base._tables = Tables(base, mind)
    mind.selections.option_filter = mind.beliefs[SELECT_OPTION]
    base.init(*arguments)
