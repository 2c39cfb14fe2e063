"""The values that conditions compare beliefs with, such as 20 in ``battery(B) & B < 20``.

>>> from jacaros.agents.checks.formulas import clauses
>>> from jacaros.agents.language.loader import load_program
>>> text = "low :- battery(B) & limit(L) & B < L. +!go : charge(C) & C >= 15 <- act. charge(C) :- battery(C)."
>>> for each in thresholds(clauses(load_program("robot.asl", text)[0])):
...     print(each.belief.name, each.operator, each.value)
battery >= 15.0
battery < Argument(name='limit', arity=1, place=0)
"""

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from itertools import product
from typing import NamedTuple

from jacaros.agents.checks.formulas import Clause, in_order
from jacaros.agents.language import nodes
from jacaros.agents.terms.operators import BINARY

_MIRRORED = {"<": ">", ">": "<", "<=": ">=", ">=": "<="}


class Argument(NamedTuple):
    """An argument of a belief or rule; `place` counts from 0."""

    name: str
    arity: int
    place: int


class Threshold(NamedTuple):
    """A comparison `belief` `operator` `value`, in the plan or rule `clause`."""

    belief: Argument
    operator: str
    value: Argument | float
    clause: Clause


def thresholds(found: Iterable[Clause]) -> Iterator[Threshold]:
    """Yield the comparisons of beliefs in plans and rules. Variables are traced through rules to beliefs."""
    all_clauses = list(found)
    sources = _Sources(all_clauses)
    for clause in all_clauses:
        for node, asked in in_order(clause):
            if asked and isinstance(node, nodes.Relation) and BINARY[node.operator].orders:
                sides = (sources.values(each, clause) for each in (node.left, node.right))
                for one, other in product(*sides):
                    if isinstance(one, Argument):
                        yield Threshold(one, node.operator, other, clause)
                    elif isinstance(other, Argument):
                        yield Threshold(other, _MIRRORED[node.operator], one, clause)


class _Sources:
    """Finds the beliefs behind variables."""

    def __init__(self, found: Iterable[Clause]) -> None:
        self._rules: dict[tuple[str, int], list[nodes.Rule]] = defaultdict(list)
        self._known: dict[int, dict[str, list[Argument]]] = {}
        for clause in found:
            if isinstance(clause, nodes.Rule):
                self._rules[clause.head.functor, len(clause.head.arguments)].append(clause)

    def values(self, term: nodes.Term, clause: Clause) -> Sequence[Argument | float]:
        """Return the number, or the beliefs that bind the variable; nothing for other terms."""
        return [term.value] if isinstance(term, nodes.Number) else [*self._beliefs(self._of(term, clause))]

    def _beliefs(self, arguments: Sequence[Argument]) -> Iterator[Argument]:
        seen, pending = set(arguments), list(arguments)
        while pending:
            argument = pending.pop(0)
            heads = self._rules.get(argument[:2])
            if heads is None:
                yield argument
            for rule in heads or ():
                deeper = self._of(rule.head.arguments[argument.place], rule)
                pending += [each for each in deeper if each not in seen]
                seen.update(deeper)

    def _of(self, term: nodes.Term, clause: Clause) -> Sequence[Argument]:
        """Return the arguments that bind a variable in a clause; nothing for other terms."""
        if not isinstance(term, nodes.Variable):
            return ()
        known = self._known.get(id(clause))
        if known is None:
            known = self._known[id(clause)] = defaultdict(list)
            for literal in _asked(clause):
                for place, each in enumerate(literal.arguments):
                    if isinstance(each, nodes.Variable):
                        known[each.name].append(Argument(literal.functor, len(literal.arguments), place))
        return known.get(term.name, ())


def _asked(clause: Clause) -> Iterator[nodes.Literal]:
    """Yield the beliefs that a clause queries, and the one that triggers it."""
    if isinstance(clause, nodes.Plan):
        trigger = clause.trigger
        if not trigger.kind and isinstance(trigger.literal, nodes.Literal):
            yield trigger.literal
    for node, asked in in_order(clause):
        if asked and isinstance(node, nodes.Literal):
            yield node
