"""Names and comments of AgentSpeak programs."""

from collections.abc import Iterator

from jacaros.agents.checks.formulas import conditions
from jacaros.agents.language import nodes
from jacaros.agents.language.diagnostics import SourceFile
from jacaros.agents.language.lexer import Comment, tokenize
from jacaros.agents.language.nodes import parts_of, walk
from jacaros.metrics.comments import Stretch, line_starts


def identifiers_of(clause: nodes.Node, is_goal: bool = False) -> frozenset[str]:
    """Names of goals, events and operations in a clause of a program.

    Args:
        clause: a plan, rule, belief or initial goal.
        is_goal: the clause is an initial goal.
    """
    return frozenset(_goals_events_operations(clause, is_goal))


def names_of(clause: nodes.Node, is_goal: bool = False) -> frozenset[str]:
    """Return the `identifiers_of` a clause, and its names of beliefs, rules, labels and variables."""
    return frozenset((*_goals_events_operations(clause, is_goal), *_other_names(clause)))


def _goals_events_operations(clause: nodes.Node, is_goal: bool) -> Iterator[str]:
    if is_goal:
        yield from _functor(clause)
    for node in walk(clause):
        if isinstance(node, nodes.Trigger):
            yield from _functor(node.literal)
        elif isinstance(node, nodes.Achieve):
            yield from _functor(node.goal)
        elif isinstance(node, nodes.Test):
            # The test of a compound condition posts no goal.
            yield from _functor(node.formula)
        elif isinstance(node, nodes.ExternalAction):
            yield from _functor(node.action)


def _other_names(clause: nodes.Node) -> Iterator[str]:
    if isinstance(clause, nodes.Literal):
        yield from _functor(clause)
    for node in walk(clause):
        for condition in conditions(node):
            for part in parts_of(condition):
                yield from _functor(part)
        if isinstance(node, nodes.Variable) and not node.unnamed:
            yield node.name
        elif isinstance(node, nodes.BeliefChange):
            yield from _functor(node.operand)
        elif isinstance(node, nodes.Rule):
            yield from _functor(node.head)
        elif isinstance(node, nodes.Plan) and node.label is not None:
            yield from _functor(node.label)


def _functor(node: object) -> Iterator[str]:
    """Return the name of a literal; none for a variable, a relation, or ``true``."""
    if isinstance(node, nodes.Literal) and node.functor not in ("true", "false"):
        yield node.functor.strip("'")


def clauses_of(program: nodes.Program) -> Iterator[tuple[nodes.Node, bool]]:
    """Yield all clauses of a program, each with whether it is an initial goal."""
    for clause in (*program.beliefs, *program.plans):
        yield clause, False
    for goal in program.goals:
        yield goal, True


def comments_of(file: SourceFile) -> list[Stretch]:
    """Return the comments of a program, as pairs of offsets in its text."""
    comments: list[Comment] = []
    tokenize(file, lambda _: None, comments)  # a program with invalid characters is not counted
    starts = line_starts(file.text)
    return [
        (start, start + len(each.text))
        for each in comments
        for start in (starts[each.line - 1] + each.column - 1,)
    ]
