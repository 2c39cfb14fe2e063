"""Shared parts of goal patterns: their arguments, and the plans they are built of.

A pattern is a function from the clauses of its block to the clauses that replace them. Where patterns are known to
misbehave in Jason, ours follow the intent of the pattern; each such function says so.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

from jacaros.asl import nodes
from jacaros.asl.source import Span

TRUE = nodes.Literal("true")


class PatternError(Exception):
    """Raised when a pattern is used wrongly; with a message and help for the user."""

    def __init__(self, message: str, help: str | None = None) -> None:
        super().__init__(message)
        self.help = help


@dataclass(frozen=True)
class PatternCall:
    """One use of a pattern.

    ``arguments`` belong to the namespace of the block. Their unnamed variables have names, so that one argument may be
    put into several places of one plan. ``number`` differs for each use in a program; ``parse_trigger`` and
    ``parse_formula`` parse arguments given as text; ``apply`` applies another pattern by name.
    """

    name: str
    arguments: tuple[nodes.Term, ...]
    span: Span | None
    number: int
    apply: "Callable[[PatternCall, nodes.Section], nodes.Section]"
    parse_trigger: Callable[[str], nodes.Trigger]
    parse_formula: Callable[[str], nodes.Term]

    def literal(self, index: int, what: str) -> nodes.Literal:
        """Return the argument *index*, which has to be a literal."""
        if index >= len(self.arguments):
            raise PatternError(f"`{self.name}` expects {what} as argument {index + 1}")
        argument = self.arguments[index]
        if not isinstance(argument, nodes.Literal):
            raise PatternError(f"argument {index + 1} of `{self.name}` ({what}) is not a literal")
        return argument

    def nested(self, section: nodes.Section, index: int) -> nodes.Section:
        """Apply the pattern that argument *index* names, to the same goal unless it names another one."""
        written = self.literal(index, "a pattern")
        arguments = written.arguments or self.arguments[:1]
        return self.apply(replace(self, name=written.functor, arguments=arguments), section)

    def at_most(self, count: int) -> None:
        """Reject more than *count* arguments."""
        if len(self.arguments) > count:
            raise PatternError(
                f"`{self.name}` expects at most {count} argument{'s' if count > 1 else ''}, found {len(self.arguments)}"
            )

    # parts of the plans that a pattern adds; all have the place of the directive

    def plan(
        self,
        trigger: nodes.Trigger,
        *steps: nodes.Step,
        context: nodes.Term | None = None,
        atomic: str | None = None,
    ) -> nodes.Plan:
        """Return a plan without a label, or an atomic one whose label ends with *atomic*."""
        label = None
        if atomic is not None:
            annotations = nodes.Annotations((nodes.Literal("atomic"),))
            label = nodes.Literal(
                f"p__{self.name}{self.number}_{atomic}", annotations=annotations, span=self.span
            )
        return nodes.Plan(label, trigger, context, nodes.Body(steps, span=self.span), span=self.span)

    def achieve(self, goal: nodes.Literal, separate: bool = False) -> nodes.Step:
        """Return ``!goal`` or ``!!goal``."""
        return nodes.Achieve(goal, separate, span=self.span)

    def internal(self, name: str, *arguments: nodes.Term) -> nodes.Step:
        """Return an internal action as a step."""
        return nodes.Constraint(nodes.InternalAction(name, arguments, span=self.span), span=self.span)

    def change(self, operator: str, belief: nodes.Literal) -> nodes.Step:
        """Return ``+belief``, ``-belief`` or ``+>belief``."""
        return nodes.BeliefChange(operator, belief, span=self.span)


def on(event: str, literal: nodes.Literal) -> nodes.Trigger:
    """Return a trigger: *event* is ``+!``, ``-!``, ``+`` or ``-``."""
    return nodes.Trigger(event[0], event[1:], literal, span=literal.span)


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


def with_plans(
    section: nodes.Section, before: list[nodes.Plan], plans: list[nodes.Plan], after: list[nodes.Plan]
) -> nodes.Section:
    """Return *section* with other plans."""
    return replace(section, plans=[*before, *plans, *after])
