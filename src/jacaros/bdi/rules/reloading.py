"""The plans and rules of a changed program replace those of the program that an agent runs."""

from collections.abc import Iterator, Sequence

from jacaros.asl import nodes
from jacaros.asl.lowering import fresh_names, lower
from jacaros.asl.walk import shape
from jacaros.bdi.rules import belief_update
from jacaros.bdi.rules.plan_changes import look_at_plans, same_plan
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.intention import PLAN
from jacaros.bdi.state.plan import Plan
from jacaros.bdi.state.plan_library import PlanLibrary, ProgramPlans
from jacaros.bdi.state.rule import Rule
from jacaros.terms.values import functor_of


def replace_plans(agent: Circumstance, plans: ProgramPlans) -> None:
    """Give an agent the plans of a changed program.

    Plans that were added at run time stay, before or behind those of the program as they were.  A plan of the program that
    was removed at run time stays away, unless it has changed.  Intentions keep the plans that they run.
    """
    old = agent.library
    new = PlanLibrary(plans)
    new.bodies, new.blamed = old.bodies, old.blamed
    new.plans_made = max(old.plans_made, new.plans_made)
    for removed in old.removed:
        for plan in [plan for plan in new.plans if same_plan(plan.node, removed.node)]:
            new.remove(plan)
    first, last = _own_plans(old)
    for plan in reversed(first):
        new.add(plan, first=True)
    for plan in last:
        new.add(plan)
    for plan in (*first, *last):
        new.set_sources(plan, old.sources(plan))
    agent.library = new
    look_at_plans(agent)


def _own_plans(library: PlanLibrary) -> tuple[list[Plan], list[Plan]]:
    """The plans that were added at run time: those before the first plan of the program, and all others."""
    of_program = [place for place, plan in enumerate(library.plans) if plan not in library.own]
    begin = of_program[0] if of_program else 0
    return library.plans[:begin], [plan for plan in library.plans[begin:] if plan in library.own]


def replace_rules(agent: Circumstance, old: Sequence[nodes.Node], new: Sequence[nodes.Node]) -> None:
    """Give an agent the rules of a changed program in place of those of the old one.

    Args:
        agent: the agent.
        old, new: the initial beliefs and rules of both programs.
    """
    gone = {shape(rule) for rule in _rules(old) if not _remove(agent, rule)}
    for node in reversed(list(_rules(new))):
        if shape(node) not in gone:
            rule = Rule(node, of_program=True)
            head = functor_of(rule.head())
            assert head is not None
            belief_update.add_rule(agent, rule, head, last=False)


def _rules(beliefs: Sequence[nodes.Node]) -> Iterator[nodes.Rule]:
    return (each for each in beliefs if isinstance(each, nodes.Rule))


def _remove(agent: Circumstance, rule: nodes.Rule) -> bool:
    """Remove a rule of the program; False when it was removed at run time."""
    head = functor_of(lower(rule.head, fresh_names()))
    assert head is not None
    table, wanted = agent.beliefs[head], shape(rule)
    for entry, _ in table.entries():
        if isinstance(entry, Rule) and entry.of_program and shape(entry.written) == wanted:
            table.remove(entry)
            return True
    return False


def outdated_plans(agent: Circumstance, plans: Sequence[nodes.Plan]) -> list[tuple[int, Plan]]:
    """The plans of the program that intentions run and that are not among *plans*, with the numbers of the intentions."""
    known = {shape(plan) for plan in plans}
    return [
        (intention.id, plan)
        for intention in agent.alive.values()
        for plan in dict.fromkeys(frame[PLAN] for frame in intention.frames)
        if plan.of_program and plan.scope is None and shape(plan.node) not in known
    ]
