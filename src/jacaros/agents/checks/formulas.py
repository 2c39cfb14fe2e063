"""Find the conditions in a program, variables that occur once, and comparisons that never hold."""

import re
from collections import Counter
from collections.abc import Iterable, Iterator
from typing import Any, Final

from jacaros.agents.language import nodes
from jacaros.agents.language.cursor import MOST_ASKED
from jacaros.agents.language.diagnostics import Diagnostic, problem
from jacaros.agents.language.nodes import children, names_in, nodes_in, variables_in, walk
from jacaros.runtime.files.texts import did_you_mean, suggestion

Clause = nodes.Plan | nodes.Rule


def clauses(program: nodes.Program) -> Iterator[Clause]:
    """Yield the plans, then the rules."""
    yield from program.plans
    for belief in program.beliefs:
        if isinstance(belief, nodes.Rule):
            yield belief


CONDITIONED: Final[tuple[type[Any], ...]] = (
    nodes.Plan,
    nodes.Rule,
    nodes.If,
    nodes.While,
    nodes.For,
    nodes.Test,
)
"""The kinds of nodes that have conditions, besides labels and goals with ``while`` and ``achieves``."""


def conditions(node: nodes.Node) -> Iterator[nodes.Term]:
    """Yield the conditions of *node* itself: contexts, tests, conditions of statements, rules, annotations."""
    if isinstance(node, nodes.Plan):
        if node.context is not None:
            yield node.context
        if node.goal_condition is not None:
            yield node.goal_condition
    elif isinstance(node, nodes.If | nodes.While | nodes.For):
        yield node.condition
    elif isinstance(node, nodes.Test):
        yield node.formula
    elif isinstance(node, nodes.Rule):
        yield node.body
    elif isinstance(node, nodes.Literal) and node.functor in ("while", "achieves"):
        yield from node.arguments[:1]


def labelled(plan: nodes.Plan) -> list[nodes.Literal]:
    """Return the annotations of a plan's label that are literals."""
    return annotations_of(plan.label) if isinstance(plan.label, nodes.Literal) else []


def annotations_of(term: nodes.Node) -> list[nodes.Literal]:
    """Return the annotations of a literal or variable that are literals."""
    annotations = term.annotations if isinstance(term, nodes.Literal | nodes.Variable) else None
    return (
        [] if annotations is None else [item for item in annotations.items if isinstance(item, nodes.Literal)]
    )


def in_order(root: nodes.Node) -> Iterator[tuple[nodes.Node, bool]]:
    """Yield all nodes below *root* in source order, each with whether it is used as a condition."""
    stack: list[tuple[nodes.Node, bool]] = [(root, False)]
    while stack:
        node, asked = stack.pop()
        yield node, asked
        below = list(children(node))
        roots = [id(condition) for condition in conditions(node)]
        inherits = asked and isinstance(node, nodes.Connective)
        step = isinstance(node, nodes.Constraint)
        stack.extend((child, inherits or step or id(child) in roots) for child in reversed(below))


def is_true(formula: nodes.Term | None) -> bool:
    """Return whether *formula* always holds: it is missing or ``true``."""
    return formula is None or (
        isinstance(formula, nodes.Literal) and formula.functor == "true" and not formula.arguments
    )


# Check for variables that occur once, and comparisons with variables that have no value.


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
    """Warn of comparisons that never hold: ``X == 3`` with an unbound X, ``X = X + 1``."""
    met: set[str] = set()
    for node, asked in in_order(clause):
        if isinstance(node, nodes.Variable):
            met.add(node.name)
        elif asked and isinstance(node, nodes.Relation) and isinstance(node.left, nodes.Variable):
            yield from _vain(node, node.left, met)


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
