"""The plans of a program, made once for all agents that run it, and those of one agent."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

from jacaros.agents.language import nodes
from jacaros.agents.mind.state.belief_base import MANY_NAMES
from jacaros.agents.mind.state.plan import Engine, Every, Plan, Select, every_plan, label_of, with_subplans
from jacaros.agents.mind.state.triggers import EventAnnotations, Goal, Trigger
from jacaros.agents.mind.state.triggers import trigger as trigger_of_kind
from jacaros.agents.terms.values import SELF, Term, bare

_BY_SELF = (SELF,)


class ProgramPlans:
    """Plans in the order of the program, and the select functions made from them so far.

    A plan does not change once it is made; what an agent adds or removes at run time is kept in its own library.

    Args:
        plan_nodes: the syntax.
        engine: runs them.

    Attributes:
        by_name: internal actions that access variables by name.
        reactions: its plans with sub-plans, by event kind.
        has_meta_plans: whether any plan reacts to changes of goal states (``^!g``).
        selects: the select functions.
    """

    def __init__(self, plan_nodes: Sequence[nodes.Plan], engine: Engine) -> None:
        self.engine = engine
        self.nodes = plan_nodes  # held, so that nothing else can be at its place in memory
        self.by_name = frozenset(action.name for action in engine.actions.values() if action.by_name)
        self.plans = [
            with_subplans(Plan(node, label_of(node, number), self.by_name), number)
            for number, node in enumerate(plan_nodes, start=1)
        ]
        self._by_head: dict[tuple[str, str, Any], list[Plan]] = {}
        for plan in self.plans:
            plan.of_program = True
            head = plan.node.trigger
            self._by_head.setdefault((head.operator, head.kind, plan.trigger_functor()), []).append(plan)
        self.reactions = Reactions(self.plans)
        self.has_meta_plans = any(plan.node.trigger.operator == "^" for plan in self.plans)
        self.selects = Selects(self, self)

    def kinds(self) -> Iterator[Trigger]:
        """The kinds of events that plans are for, in the order of the program."""
        for operator, kind, symbol in self._by_head:
            if symbol is not None:
                yield trigger_of_kind(operator, kind, symbol)

    def relevant(self, trigger: Trigger) -> Sequence[Plan]:
        """The candidate plans of an event kind, found without a look at each of a thousand plans."""
        if (trigger.operator, trigger.kind, None) in self._by_head:
            return relevant(self.plans, trigger)
        return self._by_head.get((trigger.operator, trigger.kind, trigger.functor), ())


class Reactions(dict[Trigger, Sequence[Plan]]):
    """The plans with a sub-plan for each kind of event.

    Args:
        plans: of which, or of whose sub-plans, these are.

    Attributes:
        of: all plans with sub-plans.
    """

    __slots__ = ("of",)

    def __init__(self, plans: Iterable[Plan]) -> None:
        super().__init__()
        self.of = [plan for plan in every_plan(plans) if plan.subplans]

    def __missing__(self, kind: Trigger) -> Sequence[Plan]:
        if len(self) >= MANY_NAMES:
            self.clear()
        self[kind] = [plan for plan in self.of if any(concerns(inner, kind) for inner in plan.subplans)]
        return self[kind]


def _of_subplans(agent: Any, goal: Goal, annotations: EventAnnotations) -> None:
    """None: only sub-plans are for a kind of event, and they are tried before all other plans."""


class Selects(dict[Trigger, Select | None]):
    """What chooses a plan for each kind of event, made at its first event; None when no plan concerns it.

    Args:
        plans: those of a program, or of one agent.
        program: those of the program, which an agent shares for events that none of its own plans concerns.
    """

    __slots__ = ("_general", "_plans", "_program", "_unnamed")

    def __init__(self, plans: "ProgramPlans | PlanLibrary", program: "ProgramPlans") -> None:
        super().__init__()
        self._plans, self._program = plans, program
        self._general: dict[tuple[Any, ...], Select | None] = {}
        self._unnamed: list[Trigger] = []

    def __missing__(self, trigger: Trigger) -> Select | None:
        if isinstance(self._plans, PlanLibrary) and self._plans.is_as_written(trigger):
            return self._keep(trigger, self._program.selects[trigger], self._program.relevant(trigger))
        plans = self._plans.relevant(trigger)
        return self._keep(trigger, self._made(trigger, plans), plans)

    def _made(self, trigger: Trigger, plans: Sequence[Plan]) -> Select | None:
        """Make what chooses for a kind of event; kinds that no plan names share it for their number of arguments."""
        engine = self._program.engine
        if not plans:
            # Changes of beliefs are external events, to which sub-plans react whatever goal they are part of.
            return _of_subplans if trigger.kind == "" and self._plans.reactions[trigger] else None
        if _name(plans, trigger):
            return engine.select(trigger, plans)
        key = (trigger.functor.arity, *plans)
        if key not in self._general:
            self._general[key] = engine.select(trigger, plans)
        return self._general[key]

    def _keep(self, trigger: Trigger, select: Select | None, plans: Sequence[Plan]) -> Select | None:
        """Keep the function of an event kind, for ever if a plan names it; of others, only MANY_NAMES are kept."""
        if not _name(plans, trigger):
            if len(self._unnamed) >= MANY_NAMES:
                for unnamed in self._unnamed:
                    self.pop(unnamed, None)
                self._unnamed = []
            self._unnamed.append(trigger)
        self[trigger] = select
        return select

    def forget(self, plan: Plan) -> None:
        """A plan came or went: the functions it concerns are made anew."""
        self._general.clear()
        for trigger in [each for each in self if any(concerns(one, each) for one in every_plan([plan]))]:
            del self[trigger]


def _name(plans: Sequence[Plan], trigger: Trigger) -> bool:
    """Whether one of the plans names the functor of an event kind: others have a variable there."""
    return trigger.functor in [plan.trigger_functor() for plan in plans]


def relevant(plans: Sequence[Plan], trigger: Trigger) -> list[Plan]:
    """The candidate plans of an event kind, those with a variable as trigger among them."""
    return [plan for plan in plans if concerns(plan, trigger)]


def concerns(plan: Plan, trigger: Trigger) -> bool:
    """Whether a plan is a candidate for an event kind."""
    head = plan.node.trigger
    return (
        head.operator == trigger.operator
        and head.kind == trigger.kind
        and (plan.has_variable_trigger() or plan.trigger_functor() is trigger.functor)
    )


@dataclass(slots=True, eq=False, repr=False)
class PlanLibrary:
    """The plans of one agent, in the order in which they are tried.

    Attributes:
        program: the plans that it began with; as long as no other plan concerns an event, their select function is shared
            with all agents of the program.
        selects: the select functions; as long as no plan has been added or removed they are those of the program.
        plans_made: number of plans so far, for the labels of plans without one.
        bodies: plan bodies held by variables, as plans.
        reactions: the plans with sub-plans by event kind, with those that were removed: they may still run.
        blamed: plans whose goal condition could not be evaluated, and has been reported.
    """

    program: ProgramPlans
    plans: list[Plan] = field(init=False)
    plans_made: int = field(init=False)
    selects: Selects = field(init=False)
    reactions: Reactions = field(init=False)
    bodies: dict[int, tuple[Term, Plan]] = field(default_factory=dict)
    blamed: set[Plan] = field(default_factory=set)
    own: list[Plan] = field(default_factory=list)
    removed: list[Plan] = field(default_factory=list)
    _sources: dict[Plan, tuple[Term, ...]] = field(default_factory=dict)
    _every: dict[Trigger, Every] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.plans, self.selects = self.program.plans, self.program.selects
        self.plans_made, self.reactions = len(self.plans), self.program.reactions

    @property
    def by_name(self) -> frozenset[str]:
        """Internal actions that reach variables by their names."""
        return self.program.by_name

    def add(self, plan: Plan, first: bool = False) -> None:
        """Add a plan at the end, or before all others."""
        self._differ_from_program()
        self.plans.insert(0 if first else len(self.plans), plan)
        self.own.append(plan)
        if plan.subplans:
            self.reactions = Reactions((*self.reactions.of, plan))
        self._forget_selects(plan)

    def remove(self, plan: Plan) -> None:
        """Take a plan out."""
        self._differ_from_program()
        self.plans.remove(plan)
        if plan in self.own:
            self.own.remove(plan)
        else:
            self.removed.append(plan)
        self._sources.pop(plan, None)
        self._forget_selects(plan)

    def _differ_from_program(self) -> None:
        """The list of plans and the select functions are those of the program, as of all its agents, until they change."""
        if self.plans is self.program.plans:
            self.plans = list(self.plans)
        if self.selects is self.program.selects:
            self.selects = Selects(self, self.program)

    def _forget_selects(self, plan: Plan) -> None:
        """A plan came or went: the functions it concerns are made anew."""
        self._every.clear()
        self.selects.forget(plan)

    def parts(self) -> tuple[Any, ...] | None:
        """What makes it differ from the plans of the program, for `take_parts`; None when it does not."""
        if self.plans is self.program.plans and not self._sources:
            return None
        return self.plans, self.own, self.removed, self._sources

    def take_parts(
        self, plans: list[Plan], own: list[Plan], removed: list[Plan], sources: dict[Plan, tuple[Term, ...]]
    ) -> None:
        """Hold these plans."""
        self._differ_from_program()
        self.plans, self.own, self.removed, self._sources = (
            list(plans),
            list(own),
            list(removed),
            dict(sources),
        )
        self.reactions = Reactions((*self.program.plans, *own))

    def sources(self, plan: Plan) -> tuple[Term, ...]:
        """Return the sources of a plan; it is removed when none is left."""
        return self._sources.get(plan, _BY_SELF)

    def set_sources(self, plan: Plan, sources: Sequence[Term]) -> None:
        """Set the sources of a plan."""
        self._sources[plan] = tuple(sources)

    def label(self, plan: Plan) -> Term:
        """The label of a plan with its annotations, sources among them."""
        return plan.annotated_label(self.sources(plan))

    def by_label(self, label: Term) -> Plan | None:
        """The plan of that label."""
        wanted = bare(label)
        return next((p for p in self.plans if p.label == wanted), None)

    def relevant(self, trigger: Trigger) -> list[Plan]:
        """The candidate plans of an event kind, those with a variable as trigger among them."""
        return relevant(self.plans, trigger)

    def is_as_written(self, trigger: Trigger) -> bool:
        """Whether the plans of an event kind are those of the program."""
        if not self.own and not self.removed:
            return True
        return not any(concerns(plan, trigger) for plan in every_plan((*self.own, *self.removed)))

    def every_option(self, trigger: Trigger) -> Every | None:
        """A generator function of the frames of all applicable plans of an event kind; None without relevant plans."""
        every = self._every.get(trigger)
        if every is None and (plans := self.relevant(trigger)):
            if len(self._every) >= MANY_NAMES:
                self._every.clear()
            every = self._every[trigger] = self.program.engine.every(trigger, plans)
        return every

    def has_meta_plans(self) -> bool:
        """Whether any plan reacts to changes of goal states (``^!g``)."""
        if not self.own and not self.removed:
            return self.program.has_meta_plans
        return any(plan.node.trigger.operator == "^" for plan in self.plans)
