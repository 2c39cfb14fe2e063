"""Find the conditions in a program, and those that never hold.

>>> from jacaros.asl.loader import parse_formula
>>> contradiction(parse_formula("X < 3 & X > 5"))
'X cannot be both above 5 and below 3'
"""

from collections.abc import Iterator, Sequence
from math import inf
from typing import Any, Final, cast

from jacaros.asl import nodes
from jacaros.asl.formatter import format_term
from jacaros.asl.walk import children, operands, variables_in
from jacaros.terms.operators import BINARY

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
"""The kinds of nodes that have conditions, besides labels with ``while``."""


def conditions(node: nodes.Node) -> Iterator[nodes.Term]:
    """Yield the conditions of *node* itself: contexts, tests, conditions of statements, rules, ``while`` of labels."""
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
    elif isinstance(node, nodes.Literal) and node.functor == "while" and len(node.arguments) == 1:
        yield node.arguments[0]


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


def contradiction(formula: nodes.Term) -> str | None:
    """Explain why *formula* never holds, or return None if that is not evident."""
    parts = cast("list[nodes.Term]", operands(formula)) if isinstance(formula, nodes.And) else [formula]
    return _constant(parts) or _both_ways(parts) or _two_values(parts) or _empty_range(parts)


def _constant(parts: Sequence[nodes.Term]) -> str | None:
    """``false``, ``not true`` or ``2 > 3``."""
    for part in parts:
        if isinstance(part, nodes.Literal) and part.functor == "false" and not part.arguments:
            return "its condition is false"
        if isinstance(part, nodes.Not) and is_true(part.operand):
            return "`not true` never holds"
        if (
            isinstance(part, nodes.Relation)
            and isinstance(part.left, nodes.Number)
            and isinstance(part.right, nodes.Number)
            and (holds := BINARY[part.operator].numbers) is not None
            and not holds(part.left.value, part.right.value)
        ):
            return f"`{format_term(part)}` never holds"
    return None


def _both_ways(parts: Sequence[nodes.Term]) -> str | None:
    """``p(X) & not p(X)``."""
    plain = [part for part in parts if isinstance(part, nodes.Literal) and _is_fixed(part)]
    for part in parts:
        if isinstance(part, nodes.Not) and part.operand in plain:
            text = format_term(part.operand)
            return f"`{text}` and `not {text}` cannot both hold"
    return None


def _is_fixed(term: nodes.Term) -> bool:
    """Return whether two occurrences of *term* mean the same."""
    return not any(variable.unnamed for variable in variables_in(term))


def _two_values(parts: Sequence[nodes.Term]) -> str | None:
    """``X == 1 & X == 2``."""
    values: dict[str, nodes.Term] = {}
    for part in parts:
        found = _variable_and_constant(part)
        if found is None or found[1] not in ("=", "=="):
            continue
        name, _, value = found
        if values.setdefault(name, value) != value:
            return f"{name} cannot be both {format_term(values[name])} and {format_term(value)}"
    return None


def _empty_range(parts: Sequence[nodes.Term]) -> str | None:
    """``X < 3 & X > 5``."""
    below: dict[str, float] = {}
    above: dict[str, float] = {}
    for part in parts:
        found = _variable_and_constant(part)
        if found is None or not isinstance(found[2], nodes.Number):
            continue
        name, operator, number = found[0], found[1], found[2].value
        if operator in ("<", "<="):
            below[name] = min(below.get(name, inf), number)
        elif operator in (">", ">="):
            above[name] = max(above.get(name, -inf), number)
    for name, most in below.items():
        if above.get(name, -inf) > most:
            return f"{name} cannot be both above {above[name]:g} and below {most:g}"
    return None


def _variable_and_constant(part: nodes.Term) -> tuple[str, str, nodes.Term] | None:
    """Return the variable, the operator and the constant of ``X op constant``."""
    if not isinstance(part, nodes.Relation) or not isinstance(part.left, nodes.Variable):
        return None
    left, right = part.left, part.right
    plain = left.annotations is None and not left.unnamed
    atom = isinstance(right, nodes.Literal) and not right.arguments and right.annotations is None
    if not plain or not (atom or isinstance(right, nodes.Number | nodes.String)):
        return None
    return left.name, part.operator, right
