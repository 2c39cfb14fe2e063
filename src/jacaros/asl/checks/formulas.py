"""Where conditions stand in a program."""

from collections.abc import Iterator

from jacaros.asl import nodes
from jacaros.asl.walk import children

Clause = nodes.Plan | nodes.Rule


def clauses(program: nodes.Program) -> Iterator[Clause]:
    """The plans and the rules, in this order."""
    yield from program.plans
    for belief in program.beliefs:
        if isinstance(belief, nodes.Rule):
            yield belief


def conditions(node: nodes.Node) -> Iterator[nodes.Term]:
    """The conditions that *node* itself has: contexts, tests, conditions of statements, bodies of rules."""
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


def parts_of(formula: nodes.Term) -> Iterator[nodes.Term]:
    """The conditions that *formula* is made of by ``&``, ``|`` and ``not``, in the order of the text."""
    stack = [formula]
    while stack:
        term = stack.pop()
        if isinstance(term, nodes.Connective):
            stack += reversed(term.operands)
        else:
            yield term


def conjuncts(formula: nodes.Term) -> Iterator[nodes.Term]:
    """The conditions that must hold together for *formula* to hold, in the order of the text."""
    stack = [formula]
    while stack:
        term = stack.pop()
        if isinstance(term, nodes.And):
            stack += [term.right, term.left]
        else:
            yield term


def in_order(root: nodes.Node) -> Iterator[tuple[nodes.Node, bool]]:
    """Everything below *root* in the order of the text, each node with whether it is asked as a condition."""
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
    """Whether *formula* holds in any case: it is missing or ``true``."""
    return formula is None or (
        isinstance(formula, nodes.Literal) and formula.functor == "true" and not formula.arguments
    )
