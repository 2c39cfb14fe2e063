"""A belief base with a limit (agent option ``belief_limit``)."""

from typing import Any

from jacaros.bdi.state.belief_base import BeliefTables, Table
from jacaros.bdi.state.budget import Holder
from jacaros.bdi.state.engine import Engine
from jacaros.terms.values import Functor, Term


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
        table = self[functor] = BoundedTable(functor, self)
        return table

    def admits(self) -> bool:
        """Return whether there is room for one more.

        Raises:
            Failure: there is no room, and a step adds the belief.
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


class BoundedTable(Table):
    """A table that asks the base before it grows."""

    __slots__ = ()

    _base: BoundedBeliefs

    def add(self, row: Any, annotations: tuple[Term, ...], last: bool = False) -> tuple[Term, ...] | None:
        if not self._base.admits():
            return None
        self._base.count(1)
        return super().add(row, annotations, last)

    def remove(self, row: Any) -> None:
        super().remove(row)
        self._base.count(-1)
