"""Change the plan library and rules at run time, and load plans."""

from collections.abc import Iterator, Sequence

from jacaros.agents.language import nodes
from jacaros.agents.language.loader import parse_plans
from jacaros.agents.language.lowering import Reflection, fresh_names, lower
from jacaros.agents.language.nodes import shape
from jacaros.agents.mind.actions.internal_action import ActionError
from jacaros.agents.mind.rules import belief_update, urgency
from jacaros.agents.mind.rules.context import known_names
from jacaros.agents.mind.rules.meta_events import AWAKING, SLEEPING
from jacaros.agents.mind.state.belief_base import is_source
from jacaros.agents.mind.state.circumstance import Circumstance
from jacaros.agents.mind.state.intention import PLAN as PLAN_OF_FRAME
from jacaros.agents.mind.state.plan import Failure, Plan, Rule, label_of, with_subplans
from jacaros.agents.mind.state.plan_library import PlanLibrary, ProgramPlans
from jacaros.agents.terms.plans import PLAN, RULE, TRIGGERS, is_body
from jacaros.agents.terms.substitution import resolve
from jacaros.agents.terms.text import text
from jacaros.agents.terms.values import (
    SELF,
    Annotated,
    String,
    Term,
    annotations_of,
    arguments_of,
    atom,
    bare,
    functor,
    functor_of,
    is_list,
    list_items,
)

ERROR = functor("error", 1)


def same_plan(left: nodes.Plan, right: nodes.Plan) -> bool:
    """Return whether two plans are equal, labels aside."""
    return left.trigger.operator == right.trigger.operator and shape(
        (left.trigger, left.context, left.body, left.goal_condition, left.subplans)
    ) == shape((right.trigger, right.context, right.body, right.goal_condition, right.subplans))


def look_at_plans(agent: Circumstance) -> None:
    """Update what the mind needs to know of all its plans."""
    agent.features.meta_plans = agent.library.has_meta_plans()
    agent.features.meta = agent.observers.goal is not None or agent.features.meta_plans
    agent.features.ends = agent.features.ends or agent.features.meta
    agent.incoming.called = True
    agent.features.edges = agent.may_handle(SLEEPING) or agent.may_handle(AWAKING)
    if not agent.features.edges:
        # No plan would notice; an agent that gets such a plan later is awake then.
        agent.sleep = "awake"
    urgency.plans_changed(agent)
    agent.look_at_observers()
    if agent.observers.mind is not None:
        agent.observers.mind.plans_changed()


def add_plan(agent: Circumstance, term: Term, source: Term = SELF, first: bool = False) -> None:
    """Add a plan given as a term or as text; a plan that is already held only gains a source.

    Raises:
        NotAPlan: the term is not a plan.
        AslError: the text is not a plan.
    """
    term = resolve(term)
    if term.__class__ is String:
        for node in parse_plans(str(term), functions=known_names(agent), actions=agent.engine.actions):
            _add_node(agent, node, source, first)
        return
    if is_list(term):
        for item in list_items(term):
            add_plan(agent, item, source, first)
        return
    _add_node(agent, Reflection(shared=False).plan(term), source, first)


def include_plans(agent: Circumstance, plan_nodes: tuple[nodes.Plan, ...]) -> None:
    """Add the plans of a program that is included at run time; those that are already held are unchanged.

    Raises:
        ActionError: another plan has the same label; nothing has been added then.
    """
    for node in plan_nodes:
        if node.label is not None:
            held = agent.library.by_label(label_of(node, 0))
            if held is not None and not same_plan(held.node, node):
                raise _label_taken(held.label)
    for node in plan_nodes:
        _add_node(agent, node, SELF, first=False)


def _label_taken(label: Term) -> ActionError:
    return ActionError(f"another plan has the label {text(label)} already")


def _add_node(agent: Circumstance, node: nodes.Plan, source: Term, first: bool) -> None:
    for held in agent.library.plans:
        if same_plan(held.node, node):
            sources = agent.library.sources(held)
            if source not in sources:
                agent.library.set_sources(held, (*sources, source))
            return
    agent.library.plans_made += 1
    plan = Plan(node, label_of(node, agent.library.plans_made), agent.library.by_name)
    if agent.library.by_label(plan.label) is not None:
        raise _label_taken(plan.label)
    agent.library.add(with_subplans(plan, agent.library.plans_made), first)
    agent.library.set_sources(plan, (source,))
    look_at_plans(agent)


def remove_plan(agent: Circumstance, wanted: Term, source: Term = SELF) -> None:
    """Remove a source of the plan with that label, or equal to that plan term, if any; without sources the plan is
    removed.
    """
    term = resolve(wanted)
    if term.__class__ is tuple and term[0] is PLAN:
        node = Reflection(shared=False).plan(term)
        found = next((p for p in agent.library.plans if same_plan(p.node, node)), None)
    else:
        found = agent.library.by_label(term)
    if found is None:
        return
    left = tuple(held for held in agent.library.sources(found) if held != source)
    if left:
        agent.library.set_sources(found, left)
    else:
        agent.library.remove(found)
        look_at_plans(agent)


def change_plans(agent: Circumstance, operator: str, term: Term) -> bool:
    """``+{plan}``, ``-{plan}``, ``+{rule}`` …; return False if the operand is neither a plan nor a rule.

    Annotations of the operand, such as sources, are given to the rule, and their sources to the plan.
    """
    annotated = resolve(term)
    term = bare(annotated)
    if term.__class__ is not tuple:
        return False
    if term[0] is PLAN:
        for source in [arguments_of(a)[0] for a in annotations_of(annotated) if is_source(a)] or [SELF]:
            if operator in ("-", "--"):
                remove_plan(agent, term, source)
            else:
                add_plan(agent, term, source, first=operator != "+>")
        return True
    if term[0] is RULE:
        head, annotations = term[1], annotations_of(annotated)
        change_rule(agent, operator, (RULE, Annotated(head, annotations) if annotations else head, term[2]))
        return True
    if term[0] in TRIGGERS or is_body(term):
        raise Failure((ERROR, atom("body_var_with_op")))
    return False


def change_rule(agent: Circumstance, operator: str, term: Term) -> None:
    """Add or remove a rule given as a term."""
    node = Reflection(shared=False).rule(resolve(term))
    head = functor_of(lower(node.head, fresh_names()))
    assert head is not None
    table = agent.beliefs[head]
    rule = Rule(node)
    if operator in ("-", "--"):
        for entry, _ in table.entries():
            if isinstance(entry, Rule) and shape(entry.node) == shape(rule.node):
                table.remove(entry)
                return
        return
    belief_update.add_rule(agent, rule, head, last=operator == "+>")


# The plans and rules of a changed program replace those of the program that an agent runs.


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
        for plan in dict.fromkeys(frame[PLAN_OF_FRAME] for frame in intention.frames)
        if plan.of_program and plan.scope is None and shape(plan.node) not in known
    ]
