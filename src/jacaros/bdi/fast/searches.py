"""Functions that answer questions for a predicate with rules, in the place of its rules asked one by one.

Stands for `jacaros.bdi.rules.searching.solve`.
"""

from collections.abc import Callable, Iterator
from typing import Any, Protocol

from jacaros.bdi.fast.generated.predicates import given_positions
from jacaros.bdi.fast.units import Units
from jacaros.bdi.rules.searching import run, solve
from jacaros.bdi.state.budget import SearchBudget
from jacaros.terms.unifier import Trail
from jacaros.terms.values import Functor, Term, Var

Search = Callable[..., Iterator[tuple[Term, ...]]]
"""``search(agent, trail, depth, *given)``, see `jacaros.bdi.fast.generated.predicates`."""
_TIMES_ASKED = 10


class Predicate(Protocol):
    """What is searched: a table of the belief base."""

    @property
    def functor(self) -> Functor:
        """The name of the predicate."""

    @property
    def budget(self) -> SearchBudget | None:
        """How much may be searched; None for any amount."""

    def around(self) -> tuple[list[Any], list[Any]] | None:
        """What answers before all facts, and what behind all facts; None when they are mixed."""


class Searches(dict[int, Search]):
    """The generator functions of a predicate with rules, by pattern of use, each made when it is first wanted.

    Args:
        units: makes them.
        functions: where functions are kept that all agents of a program share.

    Attributes:
        deep: they are driven by `run`.
        before: functions were made of which some rule answers before the facts.
    """

    def __init__(
        self,
        predicate: Predicate,
        units: Units,
        functions: dict[Any, Any],
        deep: bool = False,
    ) -> None:
        super().__init__()
        self.predicate = predicate
        self._units, self._functions = units, functions
        self.deep = deep
        self.before = False

    def __missing__(self, pattern: int) -> Search:
        new = self._new_rules()
        search = None if new else self._compiled(pattern)
        self[pattern] = search = search or self._by_unification(pattern, _TIMES_ASKED * new)
        return search

    def _new_rules(self) -> int:
        """How many rules do not stem from the program: they came at run time, and others may follow."""
        around = self.predicate.around()
        return 0 if around is None else sum(not entry.of_program for side in around for entry in side)

    def _by_unification(self, pattern: int, patience: int) -> Search:
        """The general way: facts, rules and beliefs with variables in any order.

        Rules that came at run time are worth a function of their own when it has been gone *patience* times.
        """
        predicate, deep = self.predicate, self.deep
        arity = predicate.functor.arity
        places = given_positions(pattern, arity)

        def search(agent: Any, trail: Trail, depth: int, *given: Term) -> Iterator[tuple[Term, ...]]:
            nonlocal patience
            del depth
            patience -= 1
            if patience == 0:
                self[pattern] = self._compiled(pattern) or search
            arguments: list[Term] = [Var() for _ in range(arity)]
            for place, value in zip(places, given, strict=True):
                arguments[place] = value
            found = solve(agent, predicate, tuple(arguments), trail, lasting=deep)
            return found if deep else run(found, agent.options.rule_depth)

        return search

    def _compiled(self, pattern: int) -> Search | None:
        """The function written for these rules; None when it takes the general way."""
        around = self.predicate.around()
        if around is None or any(entry.node is None for side in around for entry in side):
            return None
        before, after = around
        if not before and not after:
            return None
        self.before = bool(before)
        entries = (*before, *after)
        functions = self._functions if all(entry.of_program for entry in entries) else {}
        symbol = self.predicate.functor
        names = tuple(id(r.written) for r in before), tuple(id(r.written) for r in after)
        key = (symbol, pattern, names, self.deep)
        if key not in functions:
            try:
                search = self._units.search(symbol, pattern, before, after, self.deep)
            except (SyntaxError, RecursionError):
                return None  # Python's limits for one function
            # What was written is held, so that nothing else can be at its place in memory.
            functions[key] = (search, [entry.written for entry in entries])
        found: Search = functions[key][0]
        budget = self.predicate.budget
        return found if budget is None else budget.counting(found)
