"""A belief base that holds so many beliefs and no more (agent option ``belief_limit``).

Agents without that option have a plain `BeliefBase`, whose tables ask nobody.
"""

from typing import Any, Protocol

from jacaros.bdi.architecture import Architecture
from jacaros.bdi.belief_base import BeliefBase, Table
from jacaros.compiler.outcomes import Failure
from jacaros.terms.values import Functor, String, Term, atom, functor

_ERROR, _ERROR_MSG = functor("error", 1), functor("error_msg", 1)


class Holder(Protocol):
    """The mind that the beliefs belong to."""

    architecture: Architecture
    current: Any


class BoundedBeliefs(BeliefBase):
    """Refuses beliefs beyond a limit: the step that adds one fails, one from outside is passed over.

    Args:
        holder: whose beliefs they are.
        limit: how many there may be, rules included.

    Attributes:
        refusals: how many from outside were refused; people are told of the first.
    """

    def __init__(self, holder: Holder, limit: int) -> None:
        super().__init__()
        self._holder = holder
        self._limit = limit
        self._held = 0
        self.refusals = 0

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
        message = self._message()
        if self._holder.current is not None:
            raise Failure((_ERROR, atom("belief_limit")), (_ERROR_MSG, String(message)))
        self.refusals += 1
        if self.refusals == 1:
            self._holder.architecture.log("error", f"beliefs from outside are refused: {message}")
        return False

    def count(self, change: int) -> None:
        """Take note of a belief that came or went."""
        self._held += change

    def _message(self) -> str:
        largest = max(self.values(), key=len)
        name = f"{largest.functor.name}/{largest.functor.arity}"
        return f"there are {self._held} beliefs (option belief_limit), most of them {name} ({len(largest)})"


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
