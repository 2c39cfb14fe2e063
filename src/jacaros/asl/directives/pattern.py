"""Shared parts of goal patterns: their arguments, and the plans they add.

A pattern is a function from the clauses of its block to the clauses that replace them. Where patterns are known to
misbehave in Jason, ours follow the intent of the pattern; each such function says so.

>>> parse_nothing = lambda text, read, what: None
>>> call = PatternCall("dg", (nodes.Literal("at_home"),), None, 1, parse_nothing)
>>> from jacaros.asl.formatter import format_plan
>>> [format_plan(plan) for plan in call.plans("+Goal <- .succeed_goal(Goal). -!Goal : Possible <- !Goal.", Possible=TRUE)]
['+at_home <- .succeed_goal(at_home).', '-!at_home <- !at_home.']
"""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import count
from typing import Any

from jacaros.asl import nodes
from jacaros.asl.cursor import Names
from jacaros.asl.plan_parser import PlanParser
from jacaros.asl.program_parser import WrongDirective
from jacaros.asl.source import SourceFile, Span
from jacaros.asl.walk import rebuilt

TRUE = nodes.Literal("true")


@dataclass(frozen=True)
class PatternCall:
    """One use of a pattern.

    ``arguments`` belong to the namespace of the block. Their unnamed variables have names, so that one argument may be
    put into several places of one plan. ``number`` differs for each use in a program; ``parse`` parses an argument given
    as text (a trigger or a condition, as its last argument says).
    """

    name: str
    arguments: tuple[nodes.Term, ...]
    span: Span | None
    number: int
    parse: Callable[[str, Callable[[PlanParser], Any], str], Any]

    def literal(self, index: int, what: str) -> nodes.Literal:
        """Return the argument *index*, which has to be a literal."""
        if index >= len(self.arguments):
            raise WrongDirective(f"`{self.name}` expects {what} as argument {index + 1}")
        argument = self.arguments[index]
        if not isinstance(argument, nodes.Literal):
            raise WrongDirective(f"argument {index + 1} of `{self.name}` ({what}) is not a literal")
        return argument

    def at_most(self, count: int) -> None:
        """Reject more than *count* arguments."""
        if len(self.arguments) > count:
            raise WrongDirective(
                f"`{self.name}` expects at most {count} argument{'s' if count > 1 else ''}, found {len(self.arguments)}"
            )

    def plans(self, text: str, **parts: nodes.Node) -> list[nodes.Plan]:
        """Return the plans written in *text*, with *parts* in place of its variables; ``Goal`` is the first argument.

        They have the place of the directive. A part that is ``true`` is left out of a context. A label is the end of the
        name that the plan gets.
        """
        if "Goal" not in parts:
            parts["Goal"] = self.literal(0, "the goal")
        return [rebuilt(plan, lambda node: self._filled(node, parts)) for plan in _template(text)]

    def _filled(self, node: nodes.Node, parts: dict[str, nodes.Node]) -> nodes.Node:
        """Return the part that a variable of a template stands for; other nodes get the place of the directive."""
        match node:
            case nodes.Variable(name, annotations) if name in parts:
                part = parts[name]
                return nodes.replace(part, annotations=annotations) if annotations else part
            case nodes.And(left, right) if right == TRUE:
                return left
            case nodes.Trigger(literal=nodes.Trigger() as given):
                return given
            case nodes.Trigger(literal=literal):
                return nodes.replace(node, span=literal.span)
            case nodes.Plan(label, context=context):
                if isinstance(label, nodes.Literal):
                    label = nodes.replace(label, functor=f"p__{self.name}{self.number}_{label.functor}")
                context = None if context == TRUE else context
                return nodes.replace(node, label=label, context=context, span=self.span)
        return nodes.replace(node, span=self.span)


def _template(text: str) -> tuple[nodes.Plan, ...]:
    parser = PlanParser(SourceFile("a goal pattern", text), Names(count(1), count(1), count(1)), [])
    plans = []
    while parser.token.kind != "end":
        plans.append(parser.plan())
        parser.advance()
    assert not parser.diagnostics, parser.diagnostics
    return tuple(plans)


def is_about(plan: nodes.Plan, goal: nodes.Literal) -> bool:
    """Return whether *plan* achieves *goal* or handles its failure: both literals may unify."""
    literal = plan.trigger.literal
    return plan.trigger.kind == "!" and isinstance(literal, nodes.Literal) and _may_unify(literal, goal)


def achieves(plan: nodes.Plan, goal: nodes.Literal) -> bool:
    """Return whether *plan* is one for ``+!goal``."""
    return plan.trigger.operator == "+" and is_about(plan, goal)


def _may_unify(left: nodes.Term, right: nodes.Term) -> bool:
    """Return whether two terms may unify, without following variables."""
    if isinstance(left, nodes.Variable) or isinstance(right, nodes.Variable):
        return True
    if isinstance(left, nodes.Literal) and isinstance(right, nodes.Literal):
        return (
            left.functor == right.functor
            and len(left.arguments) == len(right.arguments)
            and left.negated == right.negated
            and (left.namespace == right.namespace or isinstance(left.namespace, nodes.Variable))
            and all(map(_may_unify, left.arguments, right.arguments))
        )
    if isinstance(left, nodes.Number) and isinstance(right, nodes.Number):
        return left.value == right.value
    if isinstance(left, nodes.String) and isinstance(right, nodes.String):
        return left.value == right.value
    # Lists and expressions may turn out to be equal; a list and a number do not.
    return type(left) is type(right) or not isinstance(left, nodes.Number | nodes.String | nodes.Literal)
