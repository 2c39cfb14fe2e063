"""What answers in a belief base besides facts: rules, and beliefs with variables."""

from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from typing import Any, Protocol

from jacaros.asl import nodes
from jacaros.asl.lowering import fresh_names, lower, lower_value
from jacaros.bdi.actions.internal_action import InternalAction
from jacaros.bdi.fast.generated.predicates import given_positions
from jacaros.bdi.fast.generated.unit import compile_rule_function, compile_search_function
from jacaros.bdi.rules.searching import run, solve
from jacaros.bdi.state.search_budget import SearchBudget
from jacaros.terms.substitution import rename
from jacaros.terms.text import text
from jacaros.terms.unifier import Trail, unify
from jacaros.terms.values import BY_SELF, Annotated, Functor, Term, Var, annotations_of, arguments_of

Search = Callable[..., Iterator[tuple[Term, ...]]]
"""``search(agent, trail, depth, *given)``, see `jacaros.bdi.fast.generated.predicates`."""


class Rule:
    """A rule in the base; its function is generated when it is first used.

    Args:
        node: the syntax.
        actions: the internal actions that it may call.
        shared: where functions are kept that all agents of a program share, None for a rule of this agent alone.
    """

    __slots__ = ("_function", "actions", "node", "shared", "written")

    def __init__(
        self, node: nodes.Rule, actions: Mapping[str, InternalAction], shared: dict[Any, Any] | None = None
    ) -> None:
        self.written = node
        self.node = _with_source(node)
        self.actions = actions
        self.shared = shared
        self._function: Any = None

    def search(self, agent: Any, arguments: tuple[Term, ...], trail: Trail) -> Generator[Any, Any, None]:
        """A generator of the answers, see `jacaros.bdi.rules.searching.run`."""
        if self._function is None:
            self._function = self._shared_function()
        budget = agent.beliefs.budget
        if budget is not None:
            budget.spend()
        found: Generator[Any, Any, None] = self._function(agent, arguments, trail)
        return found

    def _shared_function(self) -> Any:
        shared = {} if self.shared is None else self.shared
        key = (id(self.written),)
        if key not in shared:
            # The node is held, so that nothing else can be at its place in memory.
            shared[key] = (compile_rule_function(self.node, self.actions), self.written)
        return shared[key][0]

    def head_annotations(self) -> tuple[Term, ...]:
        """The annotations of the head, ``source(self)`` when it names no source."""
        annotations = self.node.head.annotations
        return BY_SELF if annotations is None else annotations_of(lower_value(self.node.head))

    def text(self) -> str:
        """The rule as Jason prints it."""
        lookup = fresh_names()
        head = lower(self.node.head, lookup)
        if self.node.head.annotations is None:
            head = Annotated(head, BY_SELF)
        return f"{text(head)} :- {text(lower(self.node.body, lookup))}"

    def head(self) -> Term:
        """The head as a term with fresh variables."""
        return lower(self.node.head, fresh_names())


_TIMES_ASKED = 10
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
        written: the belief of the program that it stems from; it is compiled as a rule without conditions.
        actions: the internal actions of the agent.
        shared: see `Rule`.
    """

    __slots__ = ("actions", "annotations", "literal", "node", "shared", "written")

    def __init__(
        self,
        literal: Term,
        annotations: tuple[Term, ...],
        written: nodes.Literal | None = None,
        actions: Mapping[str, InternalAction] | None = None,
        shared: dict[Any, Any] | None = None,
    ) -> None:
        self.literal, self.annotations = literal, annotations
        self.written, self.actions, self.shared = written, actions, shared
        self.node = None
        if written is not None:
            self.node = nodes.Rule(nodes.replace(written, annotations=None), _ALWAYS, span=written.span)

    def search(self, agent: Any, arguments: tuple[Term, ...], trail: Trail) -> Generator[Any, Any, None]:
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


class Predicate(Protocol):
    """What is searched: a table of the belief base."""

    @property
    def functor(self) -> Functor:
        """The name of the predicate."""

    @property
    def budget(self) -> SearchBudget | None:
        """How much may be searched; None for any amount."""

    def around(self) -> tuple[list[Any], list[Any]] | None:
        """What answers before all facts, and what behind all facts; None when they are mixed."""


class Searches(dict[int, Search]):
    """The generator functions of a predicate with rules, by pattern of use, each made when it is first wanted.

    Attributes:
        deep: they are driven by `run`.
        before: functions were made of which some rule answers before the facts.
    """

    def __init__(self, predicate: Predicate, deep: bool = False) -> None:
        super().__init__()
        self.predicate = predicate
        self.deep = deep
        self.before = False

    def __missing__(self, pattern: int) -> Search:
        new = self._new_rules()
        search = None if new else self._compiled(pattern)
        self[pattern] = search = search or self._by_unification(pattern, _TIMES_ASKED * new)
        return search

    def _new_rules(self) -> int:
        """How many rules do not stem from the program: they came at run time, and others may follow."""
        around = self.predicate.around()
        return 0 if around is None else sum(entry.shared is None for side in around for entry in side)

    def _by_unification(self, pattern: int, patience: int) -> Search:
        """The general way: facts, rules and beliefs with variables in any order.

        Rules that came at run time are worth a function of their own when it has been gone *patience* times.
        """
        predicate, deep = self.predicate, self.deep
        arity = predicate.functor.arity
        places = given_positions(pattern, arity)

        def search(agent: Any, trail: Trail, depth: int, *given: Term) -> Iterator[tuple[Term, ...]]:
            nonlocal patience
            del depth
            patience -= 1
            if patience == 0:
                self[pattern] = self._compiled(pattern) or search
            arguments: list[Term] = [Var() for _ in range(arity)]
            for place, value in zip(places, given, strict=True):
                arguments[place] = value
            found = solve(agent, predicate, tuple(arguments), trail, lasting=deep)
            return found if deep else run(found, agent.rule_depth)

        return search

    def _compiled(self, pattern: int) -> Search | None:
        """The function written for these rules; None when it takes the general way."""
        around = self.predicate.around()
        if around is None or any(entry.node is None for side in around for entry in side):
            return None
        before, after = around
        if not before and not after:
            return None
        self.before = bool(before)
        first = (*before, *after)[0]
        shared = first.shared
        if shared is None or any(rule.shared is not shared for rule in (*before, *after)):
            shared = {}
        symbol = self.predicate.functor
        names = tuple(id(r.written) for r in before), tuple(id(r.written) for r in after)
        key = (symbol, pattern, names, self.deep)
        if key not in shared:
            try:
                search = compile_search_function(
                    symbol, pattern, _nodes(before), _nodes(after), first.actions, self.deep
                )
            except (SyntaxError, RecursionError):
                return None  # Python's limits for one function
            shared[key] = (search, [rule.written for rule in (*before, *after)])
        found: Search = shared[key][0]
        budget = self.predicate.budget
        return found if budget is None else budget.counting(found)


def _nodes(rules: Sequence[Any]) -> list[nodes.Rule]:
    return [rule.node for rule in rules]
