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
from collections.abc import Iterable, Iterator
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


_Sources = dict[str, list[Argument]]
"""By variable: the arguments that bind it."""


def thresholds(found: Iterable[Clause]) -> Iterator[Threshold]:
    """Yield the comparisons of beliefs in plans and rules. Variables are traced through rules to beliefs."""
    all_clauses = list(found)
    rules = _Rules(all_clauses)
    for clause in all_clauses:
        for node, asked in in_order(clause):
            if asked and isinstance(node, nodes.Relation) and BINARY[node.operator].orders:
                yield from _of_relation(node, rules, clause)


def _of_relation(relation: nodes.Relation, rules: "_Rules", clause: Clause) -> Iterator[Threshold]:
    left, right = rules.values(relation.left, clause), rules.values(relation.right, clause)
    for one in left:
        for other in right:
            if isinstance(one, Argument):
                yield Threshold(one, relation.operator, other, clause)
            elif isinstance(other, Argument):
                yield Threshold(other, _MIRRORED[relation.operator], one, clause)


class _Rules:
    """Finds the beliefs behind variables."""

    def __init__(self, found: Iterable[Clause]) -> None:
        self._by_head: dict[tuple[str, int], list[nodes.Rule]] = defaultdict(list)
        for clause in found:
            if isinstance(clause, nodes.Rule):
                self._by_head[clause.head.functor, len(clause.head.arguments)].append(clause)
        self._sources: dict[int, _Sources] = {}

    def values(self, term: nodes.Term, clause: Clause) -> list[Argument | float]:
        """Return the number, or the beliefs that bind the variable; nothing for other terms."""
        if isinstance(term, nodes.Number):
            return [term.value]
        return (
            [*self._beliefs(self._bound(clause).get(term.name, []))]
            if isinstance(term, nodes.Variable)
            else []
        )

    def _beliefs(self, arguments: list[Argument]) -> Iterator[Argument]:
        seen, pending = set(arguments), list(arguments)
        while pending:
            argument = pending.pop(0)
            heads = self._by_head.get(argument[:2])
            if heads is None:
                yield argument
            for rule in heads or ():
                given = rule.head.arguments[argument.place]
                deeper = self._bound(rule).get(given.name, []) if isinstance(given, nodes.Variable) else []
                pending += [each for each in deeper if each not in seen]
                seen.update(deeper)

    def _bound(self, clause: Clause) -> _Sources:
        known = self._sources.get(id(clause))
        if known is None:
            known = self._sources[id(clause)] = defaultdict(list)
            for literal in _asked(clause):
                for index, argument in enumerate(literal.arguments):
                    if isinstance(argument, nodes.Variable):
                        known[argument.name].append(Argument(literal.functor, len(literal.arguments), index))
        return known


def _asked(clause: Clause) -> Iterator[nodes.Literal]:
    """Yield the beliefs that a clause queries, and the one that triggers it."""
    if isinstance(clause, nodes.Plan):
        trigger = clause.trigger
        if not trigger.kind and isinstance(trigger.literal, nodes.Literal):
            yield trigger.literal
    for node, asked in in_order(clause):
        if asked and isinstance(node, nodes.Literal):
            yield node
