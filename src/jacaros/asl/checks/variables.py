"""Variables that occur once, and comparisons with variables that have no value."""

import re
from collections import Counter
from collections.abc import Iterable, Iterator
from typing import Final

from jacaros.asl import nodes
from jacaros.asl.checks.formulas import Clause, in_order
from jacaros.asl.diagnostics import Diagnostic
from jacaros.asl.slips import MOST_ASKED, close_matches
from jacaros.asl.walk import walk
from jacaros.terms.operators import BINARY

_WORD: Final = re.compile(r"\b[A-Z]\w*")
_CONSTANTS: Final = {
    "True": "true is written in lower case",
    "TRUE": "true is written in lower case",
    "False": "false is written in lower case",
    "FALSE": "false is written in lower case",
    "None": "there is no empty value; use an atom such as none",
    "Null": "there is no empty value; use an atom such as null",
    "NULL": "there is no empty value; use an atom such as null",
    "Nil": "the empty list is []",
}
"""Variables that are values in other languages."""


def singletons(clause: Clause) -> Iterator[Diagnostic]:
    """Variables that occur once in *clause*.

    One that stands in a trigger (or in the head of a rule) may be there for the reader only: such a variable
    is no reason for a warning, but may be what was meant by another one.
    """
    occurrences: Counter[str] = Counter()
    first: dict[str, nodes.Variable] = {}
    in_texts: set[str] = set()
    for node in walk(clause):
        if isinstance(node, nodes.Variable) and not node.unnamed and not node.name.startswith("_"):
            occurrences[node.name] += 1
            first.setdefault(node.name, node)
        elif isinstance(node, nodes.String):
            # .puts and .term2string find variables in their texts.
            in_texts.update(_WORD.findall(node.value))
    in_head = _in_head(clause)
    what = "plan" if isinstance(clause, nodes.Plan) else "rule"
    once = [name for name, count in occurrences.items() if count == 1 and name not in in_texts]
    for number, name in enumerate(once):
        if name in _CONSTANTS:
            yield Diagnostic(
                "warning",
                f"{name} is a variable that occurs only once, and no value",
                first[name].span,
                _CONSTANTS[name],
                "capital-constant",
            )
        elif name not in in_head:
            yield Diagnostic(
                "warning",
                f"the variable {name} occurs only once in this {what}",
                first[name].span,
                _meant_variable(name, occurrences) if number < MOST_ASKED else None,
                "singleton-variable",
            )


def singletons_of_facts(facts: Iterable[nodes.Literal], what: str) -> Iterator[Diagnostic]:
    """Variables that occur once in a belief or a goal of the beginning: most often a name is meant.

    Args:
        facts: all of one kind.
        what: the kind, for people.
    """
    for fact in facts:
        named = [
            node for node in walk(fact) if isinstance(node, nodes.Variable) and not node.name.startswith("_")
        ]
        counted = Counter(node.name for node in named)
        for node in named:
            if counted[node.name] == 1 and not node.unnamed:
                name = node.name
                lower = name[0].lower() + name[1:]
                yield Diagnostic(
                    "warning",
                    f"the variable {name} occurs only once in this {what}, which so is about any value",
                    node.span,
                    f"names begin with a lower-case letter: {lower}; if any value is meant write _{name}",
                    "singleton-variable",
                )


def _in_head(clause: Clause) -> set[str]:
    triggers = [node for node in walk(clause) if isinstance(node, nodes.Trigger)]
    heads = triggers if isinstance(clause, nodes.Plan) else [clause.head]
    return {node.name for node in walk(*heads) if isinstance(node, nodes.Variable)}


def _meant_variable(name: str, occurrences: Counter[str]) -> str:
    close = close_matches(name, (other for other in occurrences if other != name), 0.7)
    return f"did you mean {close[0]}? Otherwise write _{name}" if close else f"if that is meant write _{name}"


def vain_comparisons(clause: Clause) -> Iterator[Diagnostic]:
    """``X == 3`` where X has no value yet, ``X = X + 1``, which never hold; ``x > 3``, which does not depend on x."""
    met: set[str] = set()
    for node, asked in in_order(clause):
        if isinstance(node, nodes.Relation) and BINARY[node.operator].orders:
            yield from _ordered_atom(node)
        if isinstance(node, nodes.Variable):
            met.add(node.name)
        elif asked and isinstance(node, nodes.Relation) and isinstance(node.left, nodes.Variable):
            yield from _vain(node, node.left, met)


def _ordered_atom(relation: nodes.Relation) -> Iterator[Diagnostic]:
    for atom, other in ((relation.left, relation.right), (relation.right, relation.left)):
        if (
            isinstance(atom, nodes.Literal)
            and not atom.arguments
            and isinstance(other, nodes.Number | nodes.Arithmetic)
        ):
            yield Diagnostic(
                "warning",
                f"{atom.functor} is an atom, and an atom is greater than any number",
                atom.span,
                f"a variable begins with a capital: {atom.functor[:1].upper()}{atom.functor[1:]}",
                "ordered-atom",
            )


def _vain(relation: nodes.Relation, variable: nodes.Variable, met: set[str]) -> Iterator[Diagnostic]:
    name, right = variable.name, relation.right
    if variable.unnamed:
        return
    if relation.operator == "==" and name not in met:
        yield Diagnostic(
            "warning",
            f"{name} has no value here, so that this comparison never holds",
            relation.span,
            f"to give {name} a value write {name} = ...",
            "comparison-without-value",
        )
    elif (
        relation.operator == "="
        and isinstance(right, nodes.Arithmetic)
        and any(isinstance(node, nodes.Variable) and node.name == name for node in walk(right))
    ):
        yield Diagnostic(
            "warning",
            f"a variable keeps its value: {name} cannot be equal to a sum with {name}",
            relation.span,
            f"use another variable, as in New{name} = {name} + 1",
            "changed-variable",
        )
