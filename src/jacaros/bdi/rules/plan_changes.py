"""Change the plan library and rules at run time, and load plans."""

from jacaros.asl import nodes
from jacaros.asl.loader import parse_plans
from jacaros.asl.lowering import fresh_names, lower
from jacaros.asl.reflection import Reflection
from jacaros.asl.walk import shape
from jacaros.bdi.actions.internal_action import ActionError
from jacaros.bdi.rules import belief_update, urgency
from jacaros.bdi.rules.functions import known_names
from jacaros.bdi.rules.meta_events import AWAKING, SLEEPING
from jacaros.bdi.state.belief_base import is_source
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.plan import Failure, Plan, label_of, with_subplans
from jacaros.bdi.state.rule import Rule
from jacaros.terms.plans import PLAN, RULE, TRIGGERS, is_body
from jacaros.terms.substitution import resolve
from jacaros.terms.text import text
from jacaros.terms.values import (
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
    agent.incoming.called = True
    agent.features.edges = agent.may_handle(SLEEPING) or agent.may_handle(AWAKING)
    if not agent.features.edges:
        # No plan would notice; an agent that gets such a plan later is awake then.
        agent.sleep = "awake"
    urgency.plans_changed(agent)
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
        written = str(term).strip()
        if not written.endswith("."):
            written += "."
        for node in parse_plans(written, functions=known_names(agent), actions=agent.engine.actions):
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
