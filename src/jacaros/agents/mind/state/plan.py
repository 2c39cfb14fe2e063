"""Plans, and what answers besides facts (rules, beliefs with variables); and the port to the engine that runs them."""

from collections.abc import Callable, Generator, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol

from jacaros.agents.language import nodes
from jacaros.agents.language.diagnostics import TEXT
from jacaros.agents.language.lowering import fresh_names, lower, lower_value
from jacaros.agents.language.nodes import names_in, nodes_in, occurrences
from jacaros.agents.mind.actions.internal_action import InternalAction
from jacaros.agents.mind.state.intention import FIRST_SLOT, Frame, NextStep
from jacaros.agents.mind.state.pending import Wanted, wanted_in
from jacaros.agents.mind.state.triggers import EventAnnotations, Goal, Trigger
from jacaros.agents.terms.order import annotation_set
from jacaros.agents.terms.substitution import rename
from jacaros.agents.terms.unifier import Trail, unify
from jacaros.agents.terms.values import (
    BY_SELF,
    SOURCE,
    Annotated,
    Functor,
    String,
    Term,
    annotations_of,
    arguments_of,
    atom,
    bare,
    functor,
    functor_of,
)

# What answers in a belief base besides facts: rules, and beliefs with variables.


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

    def __reduce__(self) -> tuple[Any, ...]:
        return Rule, (self.written, self.of_program)

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

    def __reduce__(self) -> tuple[Any, ...]:
        return OpenFact, (self.literal, self.annotations, self.written)

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


ALL_UNIFIERS, ATOMIC_LABEL = atom("all_unifs"), atom("atomic")
URL = functor("url", 1)
URGENCY = functor("urgency", 1)
ACHIEVES = "achieves"
GUARDS = frozenset({"while", "within", "cleanup", ACHIEVES})


@dataclass
class StepInfo:
    """What is known of a step: for failure events, inspection and copies of running plans.

    Attributes:
        node: the formula.
        next: name of the step that follows, ``"None"`` at the end.
        failure: the terms of its plain failure, once it has failed so.
    """

    node: nodes.Node
    next: str
    failure: tuple[Term, ...] | None = None


@dataclass(slots=True, eq=False, repr=False)
class Plan:
    """A plan of the library.

    Attributes:
        node: the syntax.
        label: term of the label, without annotations.
        annotations: those of the label, without its sources.
        atomic: whether the label says ``atomic``.
        body_term: the body that a variable held, for whose sake the plan was made; or None.
        by_name: internal actions that reach variables by their names: all variables of the plan are kept for them.
        of_program: whether it stands in the program, so that the next run has it too.
        urgency: the number of ``urgency(N)`` in the label, 0 without.
        needs: the resources of ``needs(R1, R2)`` in the label, None without.
        first: the first step, None for an empty body; set when the plan is first needed.
        size: number of places of a frame behind the fixed ones.
        steps: what is known of each step, by its name.
        interpreted: its steps as the rules of the language carry them out, once they have been needed.
        scope: the plan that this one is a sub-plan of, or None.
        special: more is to be done when it begins than to make a frame: it is atomic, needs resources, or has a goal
            condition or sub-plans.
        nested: its goals may be for sub-plans: its own, or those around it.
        replaceable: nothing is left to do once its last formula has called a goal: it has neither goal condition nor
            sub-plans, it holds no resources, and it is not checked at its end.
        guards: what its label says of the time while it runs and of its end: ``while(Condition)``, ``within(Ms)``,
            ``cleanup(Goal)``, ``achieves(Condition, Ms)``.
        goal_condition: tells of a frame whether its goal is achieved though the body has not ended; or None.
        subplans: plans for what happens while this one is pursued.
        subselects: their select functions by event kind, made at the first event.
    """

    node: nodes.Plan
    label: Term
    by_name: frozenset[str] = frozenset()
    annotations: tuple[Term, ...] = ()
    atomic: bool = False
    urgency: int = 0
    guards: tuple[nodes.Literal, ...] = ()
    needs: Wanted | None = None
    of_program: bool = False
    body_term: Term = None
    replaceable: bool = True
    special: bool = False
    nested: bool = False
    interpreted: Any = None
    size: int = 0
    first: Callable[[Any, list[Any]], Any] | None = None
    steps: dict[str, StepInfo] = field(default_factory=dict)
    scope: "Plan | None" = None
    goal_condition: Callable[[Any, list[Any]], bool] | None = None
    subplans: list["Plan"] = field(default_factory=list)
    subselects: dict[Trigger, Any] = field(default_factory=dict)
    _slots: dict[str, int] | None = None

    def __post_init__(self) -> None:
        node, label = self.node, self.label
        self.label = bare(label)
        self.annotations = tuple(a for a in annotations_of(label) if not _is_source(a))
        if self.annotations:
            self.atomic = ATOMIC_LABEL in self.annotations
            self.urgency = _urgency(self.annotations)
            self.guards = guards_of(node)
            self.needs = wanted_in(self.annotations)
        is_checked = any(guard.functor == ACHIEVES for guard in self.guards)
        self.replaceable = not (node.goal_condition or node.subplans or self.needs or is_checked)
        self.special = self.atomic or not self.replaceable
        self.nested = bool(node.subplans)

    def __repr__(self) -> str:
        return f"Plan({self.label!r})"

    @property
    def slots(self) -> dict[str, int]:
        """Index in the frame by variable name. A variable that is mentioned once has none: its value is never read."""
        if self._slots is None:
            node = self.node
            own = occurrences(node.trigger, node.context, node.body, node.goal_condition, self.guards)
            inner = occurrences(node.subplans)
            outer = {} if self.scope is None else self.scope.slots
            calls = nodes_in(nodes.InternalAction, node.body) if self.by_name else ()
            by_name = any(call.name in self.by_name for call in calls)
            kept = [n for n, count in own.items() if by_name or count + inner.get(n, 0) + (n in outer) > 1]
            kept += [n for n in inner if n in outer and n not in own]  # taken over, to be passed on
            self._slots = {name: FIRST_SLOT + index for index, name in enumerate(kept)}
        return self._slots

    def keep_all_variables(self) -> None:
        """Have a place in the frame for every variable, also for those that are mentioned once."""
        self._slots = {name: FIRST_SLOT + index for index, name in enumerate(names_in(self.node))}

    @property
    def file(self) -> str:
        """Name of the file the plan stands in."""
        span = self.node.span
        return span.file.name if span is not None else "<run time>"

    def annotated_label(self, sources: Iterable[Term]) -> Term:
        """The label as programs see it: its own annotations, a ``source`` for each source, and the ``url`` of the file, if
        there is one."""
        span = self.node.span
        written = span is not None and span.file.name != TEXT
        place = ((URL, String(f"file:{self.file}")),) if written else ()
        told_by = tuple((SOURCE, source) for source in sources)
        return Annotated(self.label, annotation_set((*self.annotations, *told_by, *place)))

    def has_variable_trigger(self) -> bool:
        """Whether the plan is a candidate for all literals: its trigger is a variable, or the namespace of it is."""
        return self.trigger_functor() is None

    def trigger_functor(self) -> Term:
        """Functor of the trigger; None when it is a variable or its namespace is."""
        literal = self.node.trigger.literal
        if isinstance(literal, nodes.Variable) or isinstance(literal.namespace, nodes.Variable):
            return None
        return functor(literal.functor, len(literal.arguments), literal.negated, literal.namespace)


def hidden_plan(label: Functor) -> Plan:
    """Make a plan without a body, for frames that stand for something else on the stack of an intention."""
    return Plan(
        nodes.Plan(None, nodes.Trigger("+", "!", nodes.Literal(label.name)), None, nodes.Body()), label
    )


def position_of(step: Any) -> str:
    """Where a step is in its plan: "g" for generated code or "i" for an interpreted step, and its number."""
    return ("g" if hasattr(step, "__globals__") else "i") + str(step.__name__.rpartition("_")[2])


def _urgency(annotations: tuple[Term, ...]) -> int:
    """Return the greatest non-negative integer in an annotation ``urgency(N)``; the checker warns of invalid ones."""
    found = [
        a[1] for a in annotations if a.__class__ is tuple and a[0] is URGENCY and a[1].__class__ is float
    ]
    return int(max((number for number in found if number > 0 and number.is_integer()), default=0))


def guards_of(node: nodes.Plan) -> tuple[nodes.Literal, ...]:
    """Return the annotations of a label that must hold while the plan runs."""
    annotations = node.label.annotations if isinstance(node.label, nodes.Literal) else None
    return tuple(
        item
        for item in (() if annotations is None else annotations.items)
        if isinstance(item, nodes.Literal)
        and item.functor in GUARDS
        and 1 <= len(item.arguments) <= 1 + (item.functor == ACHIEVES)
    )


def _is_source(annotation: Term) -> bool:
    return functor_of(annotation) is SOURCE


def with_subplans(plan: Plan, number: int) -> Plan:
    """Give a plan its sub-plans, and those theirs."""
    for node in plan.node.subplans:
        inner = Plan(node, label_of(node, number), plan.by_name)
        inner.scope, inner.nested = plan, True
        plan.subplans.append(with_subplans(inner, number))
    return plan


def every_plan(plans: Iterable[Plan]) -> Iterator[Plan]:
    """Yield plans and their sub-plans, in a fixed order."""
    for plan in plans:
        yield plan
        yield from every_plan(plan.subplans)


def label_of(node: nodes.Plan, number: int) -> Term:
    """The label of a plan; plans without one are given ``p__N``."""
    if node.label is None or isinstance(node.label, nodes.Variable):
        return atom(f"p__{number}")
    return lower_value(node.label)


class Fail(Exception):
    """A formula does not hold: the step fails with the error that goes with its kind."""


class Failure(Fail):
    """A step fails with given annotations.

    Attributes:
        annotations: terms for the failure event, ``error(..)`` among them.
    """

    def __init__(self, *annotations: Term) -> None:
        super().__init__(*annotations)
        self.annotations = annotations


class NextPlan(Exception):
    """Among all applicable plans, one answer of a plan's context is enough."""


SUSPENDED = object()
"""What a step returns when its intention has to wait."""
FAILED = object()
"""What a step returns when its formula does not hold; the same as raising `Fail`, at a tenth of the price."""


# The port of plans and rules to the engine that runs them.


Select = Callable[[Any, Goal, EventAnnotations], Frame | None]
"""``select(agent, goal, annotations)``: the frame of the first applicable plan."""
Every = Callable[[Any, Goal, EventAnnotations], Iterator[Frame]]
"""The same for the frames of all applicable plans."""


class Engine(Protocol):
    """Runs the plans and rules of a program, for all agents with that program.

    `jacaros.agents.mind.rules.add_im.Interpreter` does it as the rules of the language say,
    `jacaros.agents.mind.generated.compiler.Compiler` with code that it generates.
    """

    actions: Mapping[str, InternalAction]
    """The internal actions that plans may call."""

    def begin(self, agent: Any) -> None:
        """An agent is about to begin: prepare what cannot wait until it is asked for."""
        del agent

    def compile_ahead(self, program: Any) -> bool:
        """Prepare a little more of the plans of a program, while there is time; False when nothing is left to prepare."""
        del program
        return False

    def select(self, trigger: Trigger, plans: Sequence[Plan], outer: Plan | None = None) -> Select:
        """What chooses among plans for one kind of event; *outer* is the plan that they are sub-plans of."""

    def every(self, trigger: Trigger, plans: Sequence[Plan]) -> Every:
        """The same for all applicable plans."""

    def give_steps(self, plan: Plan) -> None:
        """Give a plan that stands for a body made at run time its steps."""

    def step_at(self, plan: Plan, position: str) -> NextStep:
        """The step at a position (`plan.position_of`) of a plan, which is compiled if necessary."""

    def answers(self, agent: Any, rule: Rule, arguments: tuple[Term, ...], trail: Trail) -> Answers:
        """The answers of a rule, see `jacaros.agents.mind.rules.searching.run`."""

    def searches(self, predicate: Any) -> tuple[Any, Any] | None:
        """Functions that answer questions for a predicate with rules, and those for deep searches; None without any."""
        del predicate
        return None
