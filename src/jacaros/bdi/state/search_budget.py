"""How much an agent may search in one reasoning cycle (agent option ``search_limit``).

A search without end would leave nobody a turn.
Agents without that option have no budget, and nothing is counted.
"""

from collections.abc import Callable, Iterable, Iterator
from typing import Any

from jacaros.terms.values import Term


class SearchLimit(Exception):
    """A search has used the budget up."""


class SearchBudget:
    """Counts what searches do: calls of rules, and answers of internal actions.

    Args:
        limit: how many there may be in one cycle.
    """

    __slots__ = ("_left", "limit")

    def __init__(self, limit: int) -> None:
        self.limit = self._left = limit

    def renew(self) -> None:
        """A cycle begins."""
        self._left = self.limit

    def spend(self) -> None:
        """A rule is called, or an internal action gives an answer.

        Raises:
            SearchLimit: that is one too many.  What deals with the failure may search as much again.
        """
        self._left -= 1
        if self._left < 0:
            self._left = self.limit
            raise SearchLimit(
                f"the search takes more than {self.limit} rules and answers (option search_limit)"
            )

    def counting_answers(self, values: Iterable[Term]) -> Iterator[Term]:
        """The answers of an internal action, each at the expense of this budget."""
        for value in values:
            self.spend()
            yield value

    def counting(
        self, search: Callable[..., Iterator[tuple[Term, ...]]]
    ) -> Callable[..., Iterator[tuple[Term, ...]]]:
        """The function of a rule that searches at the expense of this budget."""

        def counted(*arguments: Any) -> Iterator[tuple[Term, ...]]:
            self.spend()
            return search(*arguments)

        return counted
