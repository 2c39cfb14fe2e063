"""Plans by trigger, and the select functions made from them."""

from collections.abc import Callable, Mapping

from jacaros.compiler.function import ActionInfo
from jacaros.compiler.plan import Plan
from jacaros.compiler.triggers import Trigger
from jacaros.compiler.unit import Select, compile_select
from jacaros.terms.values import Term, bare


class PlanLibrary:
    """The plans of one agent, in the order in which they are tried."""

    def __init__(self, actions: Mapping[str, ActionInfo]) -> None:
        self.actions = actions
        self.report: Callable[[str], None] = _ignore
        self.plans: list[Plan] = []
        self.selects = Selects(self)
        self._count = 0

    def add(self, plan: Plan, first: bool = False) -> None:
        """Add a plan at the end, or before all others."""
        self._count += 1
        plan.order = -self._count if first else self._count
        self.plans.append(plan)
        self.plans.sort(key=lambda p: p.order)
        self.selects.forget(plan)

    def extend(self, plans: list[Plan]) -> None:
        """Add many plans at the end."""
        for plan in plans:
            self._count += 1
            plan.order = self._count
        self.plans.extend(plans)
        self.selects.clear()

    def remove(self, plan: Plan) -> None:
        """Take a plan out."""
        self.plans.remove(plan)
        self.selects.forget(plan)

    def by_label(self, label: Term) -> Plan | None:
        """The plan of that label."""
        wanted = bare(label)
        return next((p for p in self.plans if p.label == wanted), None)

    def relevant(self, trigger: Trigger) -> list[Plan]:
        """The candidate plans of an event kind, those with a variable as trigger among them."""
        return [plan for plan in self.plans if concerns(plan, trigger)]

    def has_subplans(self) -> bool:
        """Whether any plan has plans of its own."""
        return any(plan.subplans for plan in self.plans)

    def has_goal_conditions(self) -> bool:
        """Whether any plan, or plan of a plan, has a goal condition."""
        return any(_has_goal_condition(plan) for plan in self.plans)

    def has_meta_plans(self) -> bool:
        """Whether any plan reacts to changes of goal states (``^!g``)."""
        return any(plan.node.trigger.operator == "^" for plan in self.plans)


def _ignore(text: str) -> None:
    del text


def _has_goal_condition(plan: Plan) -> bool:
    return plan.node.goal_condition is not None or any(_has_goal_condition(inner) for inner in plan.subplans)


def concerns(plan: Plan, trigger: Trigger) -> bool:
    """Whether a plan is a candidate for an event kind."""
    head = plan.node.trigger
    return head.operator == trigger.operator and head.kind == trigger.kind and _concerns(plan, trigger)


def _concerns(plan: Plan, trigger: Trigger) -> bool:
    return plan.has_variable_trigger() or plan.trigger_functor() is trigger.functor


class Selects(dict[Trigger, Select | None]):
    """The select function of each event kind, made at its first event; None when there is no relevant plan."""

    def __init__(self, library: PlanLibrary) -> None:
        super().__init__()
        self.library = library
        self.sources: dict[Trigger, str] = {}

    def __missing__(self, trigger: Trigger) -> Select | None:
        plans = self.library.relevant(trigger)
        select: Select | None = None
        if plans:
            try:
                select, self.sources[trigger] = compile_select(trigger, plans, self.library.actions)
            except (SyntaxError, RecursionError) as fault:
                # Python's limits for one function; a program meets them with formulae of some hundred operators.
                self.library.report(f"the plans for {trigger!r} are too large to be compiled: {fault}")
        self[trigger] = select
        return select

    def forget(self, plan: Plan) -> None:
        """A plan came or went: the functions it concerns are made anew."""
        head = plan.node.trigger
        functor = plan.trigger_functor()
        for trigger in list(self):
            if (
                trigger.operator == head.operator
                and trigger.kind == head.kind
                and functor in (None, trigger.functor)
            ):
                del self[trigger]
