"""The plans of one program, made and compiled once for all agents that run it."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import islice
from typing import Any

from jacaros.asl import nodes
from jacaros.asl.walk import walk
from jacaros.bdi.actions.internal_action import InternalAction
from jacaros.bdi.fast.generated.unit import Select, compile_select
from jacaros.bdi.state.belief_base import MANY_NAMES
from jacaros.bdi.state.plan import Plan, label_of, with_subplans
from jacaros.bdi.state.triggers import Trigger
from jacaros.bdi.state.triggers import trigger as trigger_of_kind
from jacaros.terms.values import functor


class ProgramPlans:
    """Plans in the order of the program, and the select functions made from them so far.

    A plan changes no more once it is made; what an agent adds or removes at run time is its own library's business.

    Args:
        plan_nodes: the syntax.
        actions: the internal actions that the plans may call.

    Attributes:
        rule_functions: what is generated for the rules of the program, see `jacaros.bdi.state.rule`.
        has_subplans: whether any plan has plans of its own.
        has_goal_conditions: whether any plan, or plan of a plan, has a goal condition.
        has_meta_plans: whether any plan reacts to changes of goal states (``^!g``).
        selects: the select functions.
        report: told what cannot be compiled; the first agent of the program puts itself here.
    """

    def __init__(self, plan_nodes: Sequence[nodes.Plan], actions: Mapping[str, InternalAction]) -> None:
        self.actions = actions
        self.nodes = plan_nodes  # held, so that nothing else can be at its place in memory
        self.plans = [
            with_subplans(Plan(node, label_of(node, number)), number)
            for number, node in enumerate(plan_nodes, start=1)
        ]
        self._by_head: dict[tuple[str, str, Any], list[Plan]] = {}
        for plan in self.plans:
            head = plan.node.trigger
            self._by_head.setdefault((head.operator, head.kind, plan.trigger_functor()), []).append(plan)
        self.has_subplans = any(plan.subplans for plan in self.plans)
        self.has_goal_conditions = any(has_goal_condition(plan) for plan in self.plans)
        self.has_meta_plans = any(plan.node.trigger.operator == "^" for plan in self.plans)
        self.rule_functions: dict[Any, Any] = {}
        self.selects = ProgramSelects(self)
        self.report: Callable[[str], None] | None = None

    def relevant(self, trigger: Trigger) -> Sequence[Plan]:
        """The candidate plans of an event kind, found without a look at each of a thousand plans."""
        if (trigger.operator, trigger.kind, None) in self._by_head:
            return relevant(self.plans, trigger)
        return self._by_head.get((trigger.operator, trigger.kind, trigger.functor), ())


class Selects(dict[Trigger, Select | None]):
    """The select function of each event kind, made at its first event; None when no plan concerns it."""

    __slots__ = ("_general", "_unnamed")

    def __init__(self) -> None:
        super().__init__()
        self._general: dict[tuple[Any, ...], Select | None] = {}
        self._unnamed: list[Trigger] = []

    def made(
        self,
        trigger: Trigger,
        plans: Sequence[Plan],
        actions: Mapping[str, InternalAction],
        report: Callable[[str], None],
    ) -> Select | None:
        """Return the function of an event kind; those that no plan names share one for their number of arguments."""
        if _name(plans, trigger):
            return made(trigger, plans, actions, report)
        key = (trigger.functor.arity, *plans)
        if key not in self._general:
            self._general[key] = made(trigger, plans, actions, report)
        return self._general[key]

    def keep(self, trigger: Trigger, select: Select | None, plans: Sequence[Plan]) -> Select | None:
        """Keep the function of an event kind, for ever if a plan names it; of others, only MANY_NAMES are kept."""
        if not _name(plans, trigger):
            if len(self._unnamed) >= MANY_NAMES:
                for unnamed in self._unnamed:
                    self.pop(unnamed, None)
                self._unnamed = []
            self._unnamed.append(trigger)
        self[trigger] = select
        return select


class ProgramSelects(Selects):
    """The select functions of a program."""

    __slots__ = ("_program",)

    def __init__(self, program: ProgramPlans) -> None:
        super().__init__()
        self._program = program

    def __missing__(self, trigger: Trigger) -> Select | None:
        program = self._program
        plans = program.relevant(trigger)
        select = self.made(trigger, plans, program.actions, program.report or _ignore)
        return self.keep(trigger, select, plans)


def _name(plans: Sequence[Plan], trigger: Trigger) -> bool:
    """Whether one of the plans names the functor of an event kind: others have a variable there."""
    return trigger.functor in [plan.trigger_functor() for plan in plans]


def _ignore(text: str) -> None:
    del text


def has_goal_condition(plan: Plan) -> bool:
    """Whether a plan, or a plan of it, has a goal condition."""
    return plan.node.goal_condition is not None or any(has_goal_condition(inner) for inner in plan.subplans)


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


def made(
    trigger: Trigger,
    plans: Sequence[Plan],
    actions: Mapping[str, InternalAction],
    report: Callable[[str], None],
) -> Select | None:
    """Compile the select function of an event kind; what is wrong goes to *report*."""
    if not plans:
        return None
    try:
        return compile_select(trigger, plans, actions)[0]
    except TOO_LARGE:
        small = [plan for plan in plans if not _told(plan, actions, report)]
        if len(small) == len(plans) and not any(plan.searched for plan in plans):
            report(f"the plans for {trigger!r} are too large together to be compiled")
            return None
        return made(trigger, small, actions, report)


def _told(plan: Plan, actions: Mapping[str, InternalAction], report: Callable[[str], None]) -> bool:
    """Report a plan that has to be left out, once."""
    if plan.fault is None and too_large(plan, actions):
        report(f"{plan.fault}; it is left out")
    return plan.fault is not None


TOO_LARGE = (SyntaxError, RecursionError, MemoryError)
"""What Python says of code that is beyond its limits for one function."""
_LARGE = 100
"""Parts of a plan from which on it is compiled at the start, to see whether it can be."""


def look_at_large_plans(
    plans: Sequence[Plan], actions: Mapping[str, InternalAction]
) -> Iterator[tuple[Plan, str]]:
    """The plans that are too large to be compiled, each with what is to be said of it."""
    for plan in plans:
        if sum(1 for _ in islice(walk(plan.node), _LARGE)) == _LARGE and too_large(plan, actions):
            yield plan, plan.fault or ""


def too_large(plan: Plan, actions: Mapping[str, InternalAction]) -> bool:
    """Whether a plan cannot be compiled.  A context that cannot be is searched, which takes longer."""
    for searched in (False, True):
        plan.searched = plan.searched or searched
        try:
            compile_select(_trigger_of(plan), [plan], actions)
        except TOO_LARGE as fault:
            why = str(fault)
        else:
            return False
    plan.fault = f"the plan {plan_name(plan)} is too large to be compiled ({why})"
    return True


def _trigger_of(plan: Plan) -> Trigger:
    head = plan.node.trigger
    return trigger_of_kind(head.operator, head.kind, plan.trigger_functor() or functor("plan", 0))


def plan_name(plan: Plan) -> str:
    """The trigger of a plan and its place, for people."""
    head, span = plan.node.trigger, plan.node.span
    symbol = plan.trigger_functor()
    name = f"{head.operator}{head.kind}{'_' if symbol is None else repr(symbol)}"
    return name if span is None else f"{name} ({span.file.name}:{span.line})"
