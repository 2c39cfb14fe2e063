"""A belief base with a limit (agent option ``belief_limit``).

Agents have a plain `BeliefTables`, whose tables count nothing, until half of the limit is reached (`watch`); unless the
limit is small.
"""

from typing import Any

from jacaros.bdi.state.belief_base import BeliefTables, Table
from jacaros.bdi.state.budget import Holder
from jacaros.bdi.state.engine import Engine
from jacaros.terms.values import Functor, Term

SMALL = 100_000
"""Limits up to this one are kept from the beginning."""
INTERVAL = 1_000
"""Reasoning cycles between two counts of the beliefs; more when there are more names."""


class BoundedBeliefs(BeliefTables):
    """Refuses beliefs beyond a limit: the step that adds one fails, one from outside is refused.

    Args:
        holder: whose beliefs they are.
        limit: how many there may be, rules included.
    """

    def __init__(self, holder: Holder, limit: int, engine: Engine | None = None) -> None:
        super().__init__(engine)
        self.bind(holder, limit)

    def bind(self, holder: Holder, limit: int) -> None:
        """Count from now on."""
        self._limit = limit
        self._held = sum(map(len, self.values()))
        self._budget = holder.budgets["belief_limit"]

    @property
    def refusals(self) -> int:  # type: ignore[override]
        """How many beliefs from outside were refused."""
        return self._budget.refusals

    def __missing__(self, functor: Functor) -> Table:
        table = self[functor] = _BoundedTable(functor, self)
        return table

    def admits(self) -> bool:
        """Whether there is room for one more.

        Raises:
            Failure: there is none, and it is a step that adds it.
        """
        if self._held < self._limit:
            return True
        largest = max(self.values(), key=len)
        name = f"{largest.functor.name}/{largest.functor.arity}"
        self._budget.refuse(self._held, f", most of them {name} ({len(largest)})")
        return False

    def count(self, change: int) -> None:
        """Take note of a belief that came or went."""
        self._held += change


class _BoundedTable(Table):
    __slots__ = ()

    _base: BoundedBeliefs

    def add(self, row: Any, annotations: tuple[Term, ...], last: bool = False) -> tuple[Term, ...] | None:
        if not self._base.admits():
            return None
        self._base.count(1)
        return super().add(row, annotations, last)

    def remove(self, row: Any) -> bool:
        removed = super().remove(row)
        self._base.count(-1)
        return removed


def watch(beliefs: BeliefTables, holder: Holder, limit: int) -> bool:
    """Bound a plain base from now on when half of the limit is reached; True when it is bounded."""
    if beliefs.__class__ is not BeliefTables:
        return True
    if 2 * sum(map(len, beliefs.values())) < limit:
        return False
    for table in beliefs.values():
        if table.__class__ is Table:
            table.__class__ = _BoundedTable
    beliefs.__class__ = BoundedBeliefs
    assert isinstance(beliefs, BoundedBeliefs)
    beliefs.bind(holder, limit)
    return True
