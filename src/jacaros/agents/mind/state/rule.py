"""What answers in a belief base besides facts: rules, and beliefs with variables."""

from collections.abc import Generator
from typing import Any

from jacaros.agents.language import nodes
from jacaros.agents.language.lowering import fresh_names, lower, lower_value
from jacaros.agents.terms.substitution import rename
from jacaros.agents.terms.unifier import Trail, unify
from jacaros.agents.terms.values import BY_SELF, Term, annotations_of, arguments_of

Answers = Generator[Any, Any, None]
"""Yields a tuple for each answer, or a generator that is to be run for it (`jacaros.agents.mind.rules.searching.run`)."""


class Rule:
    """A rule in the base.

    Args:
        node: the syntax.
        of_program: whether it stands in the program, so that other agents have it too.

    Attributes:
        written: the syntax as it was given.
        made: what the agent's engine has made of it.
    """

    __slots__ = ("made", "node", "of_program", "written")

    def __init__(self, node: nodes.Rule, of_program: bool = False) -> None:
        self.written = node
        self.node = _with_source(node)
        self.of_program = of_program
        self.made: Any = None

    def search(self, agent: Any, arguments: tuple[Term, ...], trail: Trail) -> Answers:
        """A generator of the answers, see `jacaros.agents.mind.rules.searching.run`."""
        budget = agent.beliefs.budget
        if budget is not None:
            budget.spend()
        found: Answers = agent.engine.answers(agent, self, arguments, trail)
        return found

    def head_annotations(self) -> tuple[Term, ...]:
        """The annotations of the head, ``source(self)`` when it names no source."""
        annotations = self.node.head.annotations
        return BY_SELF if annotations is None else annotations_of(lower_value(self.node.head))

    def head(self) -> Term:
        """The head as a term with fresh variables."""
        return lower(self.node.head, fresh_names())


_ALWAYS = nodes.Literal("true")
_SOURCE_SELF = nodes.Literal("source", (nodes.Literal("self"),))


def _with_source(rule: nodes.Rule) -> nodes.Rule:
    """The rule with ``source(self)`` among the annotations of its head, when there are some and none is a source."""
    annotations = rule.head.annotations
    if annotations is None:
        return rule
    if any(isinstance(item, nodes.Literal) and item.functor == "source" for item in annotations.items):
        return rule
    more = nodes.replace(annotations, items=(*annotations.items, _SOURCE_SELF))
    return nodes.replace(rule, head=nodes.replace(rule.head, annotations=more))


class OpenFact:
    """A belief with variables: every use takes a copy.

    Args:
        literal: the belief.
        annotations: its annotations.
        written: the belief of the program that it stems from; it is a rule without conditions.
    """

    __slots__ = ("annotations", "literal", "node", "of_program", "written")

    def __init__(
        self, literal: Term, annotations: tuple[Term, ...], written: nodes.Literal | None = None
    ) -> None:
        self.literal, self.annotations = literal, annotations
        self.written = written
        self.of_program = written is not None
        self.node = None
        if written is not None:
            self.node = nodes.Rule(nodes.replace(written, annotations=None), _ALWAYS, span=written.span)

    def search(self, agent: Any, arguments: tuple[Term, ...], trail: Trail) -> Answers:
        """One answer when the arguments unify with a copy."""
        del agent
        own = arguments_of(rename(self.literal))
        if all(unify(a, b, trail) for a, b in zip(arguments, own, strict=True)):
            yield ()

    def head_annotations(self) -> tuple[Term, ...]:
        """The annotations of the belief."""
        return self.annotations

    def head(self) -> Term:
        """A copy of the literal."""
        return rename(self.literal)


Entry = tuple[Term, ...] | Rule | OpenFact
"""What a table of beliefs holds: the arguments of a fact, or what answers like one."""
