"""The plans of one program, made and compiled once for all agents that run it."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from jacaros.asl import nodes
from jacaros.compiler.function import ActionInfo
from jacaros.compiler.plan import Plan, label_of, with_subplans
from jacaros.compiler.triggers import Trigger
from jacaros.compiler.unit import Select, compile_select


class ProgramPlans:
    """Plans in the order of the program, and the select functions made from them so far.

    A plan changes no more once it is made; what an agent adds or removes at run time is its own library's business.

    Args:
        plan_nodes: the syntax.
        actions: the internal actions that the plans may call.

    Attributes:
        rule_functions: what is generated for the rules of the program, see `jacaros.bdi.rules`.
        has_subplans: whether any plan has plans of its own.
        has_goal_conditions: whether any plan, or plan of a plan, has a goal condition.
        has_meta_plans: whether any plan reacts to changes of goal states (``^!g``).
        selects: the select functions.
        report: told what cannot be compiled; the first agent of the program puts itself here.
    """

    def __init__(self, plan_nodes: Sequence[nodes.Plan], actions: Mapping[str, ActionInfo]) -> None:
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


class ProgramSelects(dict[Trigger, Select | None]):
    """The select function of each event kind, made at its first event; None when no plan concerns it.

    Attributes:
        sources: the text of those made, by event kind.
    """

    __slots__ = ("_program", "sources")

    def __init__(self, program: ProgramPlans) -> None:
        super().__init__()
        self._program = program
        self.sources: dict[Trigger, str] = {}

    def __missing__(self, trigger: Trigger) -> Select | None:
        program = self._program
        report = program.report or _ignore
        select = made(trigger, program.relevant(trigger), program.actions, self.sources, report)
        self[trigger] = select
        return select


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
    actions: Mapping[str, ActionInfo],
    sources: dict[Trigger, str],
    report: Callable[[str], None],
) -> Select | None:
    """Compile the select function of an event kind; its text goes to *sources*, what is wrong to *report*."""
    if not plans:
        return None
    try:
        select, sources[trigger] = compile_select(trigger, plans, actions)
    except (SyntaxError, RecursionError) as fault:
        # Python's limits for one function; a program meets them with formulae of some hundred operators.
        report(f"the plans for {trigger!r} are too large to be compiled: {fault}")
        return None
    return select
