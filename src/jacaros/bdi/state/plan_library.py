"""The plans of one agent by trigger, and their select functions."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import cast

from jacaros.bdi.actions.internal_action import InternalAction
from jacaros.bdi.fast.generated.unit import Select, compile_select
from jacaros.bdi.state.belief_base import MANY_NAMES
from jacaros.bdi.state.intention import Frame
from jacaros.bdi.state.plan import Plan
from jacaros.bdi.state.program_plans import (
    ProgramPlans,
    Selects,
    concerns,
    has_goal_condition,
    look_at_large_plans,
    relevant,
)
from jacaros.bdi.state.triggers import Trigger
from jacaros.terms.values import SELF, Term, bare

_BY_SELF = (SELF,)


class PlanLibrary:
    """The plans of one agent, in the order in which they are tried.

    Attributes:
        program: the plans that it began with; as long as no other plan concerns an event, their select function is shared
            with all agents of the program.
        selects: the select functions; as long as no plan has come or gone they are those of the program.
        report: told what cannot be compiled.
    """

    __slots__ = ("_every", "_sources", "actions", "own", "plans", "program", "removed", "report", "selects")

    def __init__(self, program: ProgramPlans, report: Callable[[str], None]) -> None:
        self.program = program
        if program.report is None:
            program.report = report
            for _, fault in look_at_large_plans(program.plans, program.actions):
                report(f"{fault}; it is left out")
        self.actions: Mapping[str, InternalAction] = program.actions
        self.report = report
        self.plans: list[Plan] = program.plans
        self.own: list[Plan] = []
        self.removed: list[Plan] = []
        self.selects: Selects = program.selects
        self._sources: dict[Plan, tuple[Term, ...]] = {}
        self._every: dict[Trigger, Callable[..., Iterator[Frame]]] = {}

    def add(self, plan: Plan, first: bool = False) -> None:
        """Add a plan at the end, or before all others."""
        self._differ_from_program()
        self.plans.insert(0 if first else len(self.plans), plan)
        self.own.append(plan)
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
            self.selects = OwnSelects(self)

    def _forget_selects(self, plan: Plan) -> None:
        """A plan came or went: the functions it concerns are made anew."""
        self._every.clear()
        if isinstance(self.selects, OwnSelects):
            self.selects.forget(plan)

    def take_over(self, other: "PlanLibrary") -> None:
        """Have the plans of the library of another agent that runs the same program."""
        self._differ_from_program()
        self.plans, self.own, self.removed = list(other.plans), list(other.own), list(other.removed)
        self._sources = dict(other._sources)

    def sources(self, plan: Plan) -> tuple[Term, ...]:
        """Who told a plan; it goes when nobody is left."""
        return self._sources.get(plan, _BY_SELF)

    def set_sources(self, plan: Plan, sources: Sequence[Term]) -> None:
        """Note who told a plan."""
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
        changed = (*self.own, *self.removed)
        return not any(concerns(plan, trigger) for plan in changed)

    def every_option(self, trigger: Trigger) -> Callable[..., Iterator[Frame]] | None:
        """A generator function of the frames of all applicable plans of an event kind; None without relevant plans."""
        every = self._every.get(trigger)
        if every is None and (plans := self.relevant(trigger)):
            if len(self._every) >= MANY_NAMES:
                self._every.clear()
            select = compile_select(trigger, plans, self.actions, every=True)[0]
            every = self._every[trigger] = cast("Callable[..., Iterator[Frame]]", select)
        return every

    def has_subplans(self) -> bool:
        """Whether any plan has plans of its own."""
        return self.program.has_subplans or any(plan.subplans for plan in self.own)

    def has_goal_conditions(self) -> bool:
        """Whether any plan, or plan of a plan, has a goal condition."""
        return self.program.has_goal_conditions or any(has_goal_condition(plan) for plan in self.own)

    def has_meta_plans(self) -> bool:
        """Whether any plan reacts to changes of goal states (``^!g``)."""
        if not self.own and not self.removed:
            return self.program.has_meta_plans
        return any(plan.node.trigger.operator == "^" for plan in self.plans)


class OwnSelects(Selects):
    """The same for an agent whose plans are not all those of its program; or one that chooses among them itself."""

    __slots__ = ("library",)

    def __init__(self, library: PlanLibrary) -> None:
        super().__init__()
        self.library = library

    def __missing__(self, trigger: Trigger) -> Select | None:
        library = self.library
        if library.is_as_written(trigger):
            return self.keep(trigger, library.program.selects[trigger], library.program.relevant(trigger))
        plans = library.relevant(trigger)
        return self.keep(trigger, self.made(trigger, plans, library.actions, library.report), plans)

    def forget(self, plan: Plan) -> None:
        """A plan came or went: the functions it concerns are made anew."""
        self._general.clear()
        head = plan.node.trigger
        functor = plan.trigger_functor()
        for trigger in list(self):
            if (
                trigger.operator == head.operator
                and trigger.kind == head.kind
                and functor in (None, trigger.functor)
            ):
                del self[trigger]
