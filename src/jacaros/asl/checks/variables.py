"""Check for variables that occur once, and comparisons with variables that have no value.

>>> from jacaros.asl.loader import parse_plans
>>> [each.message for each in singletons(parse_plans("+!go <- move(X)")[0])]
['variable `X` occurs only once in this plan']
"""

import re
from collections import Counter
from collections.abc import Iterable, Iterator
from typing import Final

from jacaros.asl import nodes
from jacaros.asl.checks.formulas import Clause, in_order
from jacaros.asl.diagnostics import Diagnostic, problem
from jacaros.asl.slips import MOST_ASKED
from jacaros.asl.walk import names_in, nodes_in, variables_in, walk
from jacaros.suggestions import did_you_mean, suggestion
from jacaros.terms.operators import BINARY

_WORD: Final = re.compile(r"\b[A-Z]\w*")
_CONSTANTS: Final = {
    "True": "write `true` in lower case",
    "TRUE": "write `true` in lower case",
    "False": "write `false` in lower case",
    "FALSE": "write `false` in lower case",
    "None": "use an atom such as `none`; the language has no null value",
    "Null": "use an atom such as `null`; the language has no null value",
    "NULL": "use an atom such as `null`; the language has no null value",
    "Nil": "write the empty list as `[]`",
}
"""Variables that are constants in other languages."""


def singletons(clause: Clause) -> Iterator[Diagnostic]:
    """Warn of variables that occur once in *clause*.

    One in a trigger (or in the head of a rule) may only document the argument: it causes no warning, but may be the name
    that a misspelt variable was meant to have.
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
            yield problem(
                "capital-constant",
                f"`{name}` is a variable here, not a value",
                first[name].span,
                _CONSTANTS[name],
            )
        elif name not in in_head:
            yield problem(
                "singleton-variable",
                f"variable `{name}` occurs only once in this {what}",
                first[name].span,
                _meant_variable(name, occurrences) if number < MOST_ASKED else None,
            )


def singletons_of_facts(facts: Iterable[nodes.Literal], what: str) -> Iterator[Diagnostic]:
    """Warn of variables that occur once in an initial belief or goal: most often a name is meant.

    Args:
        facts: all of one kind.
        what: the kind, for the message.
    """
    for fact in facts:
        named = [node for node in variables_in(fact) if not node.name.startswith("_")]
        counted = Counter(node.name for node in named)
        for node in named:
            if counted[node.name] == 1 and not node.unnamed:
                name = node.name
                lower = name[0].lower() + name[1:]
                yield problem(
                    "singleton-variable",
                    f"`{name}` is a variable (capital {name[0]}), so this {what} matches any value",
                    node.span,
                    f"{did_you_mean([lower])} If any value is meant, write `_{name}`",
                )


def _in_head(clause: Clause) -> list[str]:
    return (
        names_in(*nodes_in(nodes.Trigger, clause))
        if isinstance(clause, nodes.Plan)
        else names_in(clause.head)
    )


def _meant_variable(name: str, occurrences: Counter[str]) -> str:
    meant = suggestion(name, (other for other in occurrences if other != name))
    return f"{meant} Otherwise write `_{name}`" if meant else f"if this is intended, write `_{name}`"


def vain_comparisons(clause: Clause) -> Iterator[Diagnostic]:
    """Warn of comparisons that never hold (``X == 3`` with an unbound X, ``X = X + 1``) or ignore x (``x > 3``)."""
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
            yield problem(
                "ordered-atom",
                f"`{atom.functor}` is an atom, and an atom is greater than any number",
                atom.span,
                f"begin a variable with a capital letter: `{atom.functor[:1].upper()}{atom.functor[1:]}`",
            )


def _vain(relation: nodes.Relation, variable: nodes.Variable, met: set[str]) -> Iterator[Diagnostic]:
    name, right = variable.name, relation.right
    if variable.unnamed:
        return
    if relation.operator == "==" and name not in met:
        yield problem(
            "comparison-without-value",
            f"`{name}` has no value here, so this comparison never holds",
            relation.span,
            f"to give {name} a value, write `{name} = ...`",
        )
    elif relation.operator == "=" and isinstance(right, nodes.Arithmetic) and name in names_in(right):
        yield problem(
            "changed-variable",
            f"`{name}` cannot be equal to a sum that contains it: variables keep their value",
            relation.span,
            f"use another variable, as in `New{name} = {name} + 1`",
        )
