"""Syntax tree to terms: for beliefs, messages, and formulae shown to people."""

from collections.abc import Callable

from jacaros.asl import nodes
from jacaros.asl.constant import Constant
from jacaros.terms import plans
from jacaros.terms.arithmetic import settle
from jacaros.terms.negation import qualify
from jacaros.terms.operators import named
from jacaros.terms.order import annotation_set
from jacaros.terms.substitution import resolve
from jacaros.terms.values import (
    ACTION,
    FUNCTION,
    Annotated,
    Functor,
    String,
    Term,
    Var,
    atom,
    bare,
    functor,
    make_list,
)

Lookup = Callable[[str], Term]
"""Value of the variable of that name."""


class Names(dict[str, Term]):
    """Variables by name, made when first asked for."""

    def __missing__(self, name: str) -> Var:
        variable = self[name] = Var(name)
        return variable


def fresh_names() -> Lookup:
    """A look-up that makes a new variable for every name."""
    return Names().__getitem__


def lower(node: nodes.Node, lookup: Lookup) -> Term:
    """The term of a syntax tree; variables are given by *lookup*, nothing is evaluated."""
    return _LOWER[type(node)](node, lookup)


def lower_value(node: nodes.Node, lookup: Lookup | None = None) -> Term:
    """The term with bindings applied and arithmetic evaluated."""
    return resolve(lower(node, lookup or fresh_names()))


def _number(node: nodes.Number, _: Lookup) -> Term:
    return float(node.value)


def _string(node: nodes.String, _: Lookup) -> Term:
    return String(node.value)


def _variable(node: nodes.Variable, lookup: Lookup) -> Term:
    value = lookup(node.name)
    if node.namespace is not None or node.negated:
        value = qualify(value, _namespace(node.namespace, lookup), node.negated)
    return _annotate(value, node.annotations, lookup)


def _namespace(namespace: str | nodes.Variable | None, lookup: Lookup) -> str | None:
    if isinstance(namespace, nodes.Variable):
        value = bare(lookup(namespace.name))
        name = getattr(value, "name", None)
        return None if name == "default" else name
    return namespace


def _literal(node: nodes.Literal, lookup: Lookup) -> Term:
    symbol = functor(node.functor, len(node.arguments), node.negated, _namespace(node.namespace, lookup))
    term: Term = symbol
    if node.arguments:
        term = (symbol, *(lower(a, lookup) for a in node.arguments))
    return _annotate(term, node.annotations, lookup)


def _annotate(term: Term, annotations: nodes.Annotations | None, lookup: Lookup) -> Term:
    if annotations is None:
        return term
    items = annotation_set(tuple(lower(a, lookup) for a in annotations.items))
    tail = None if annotations.tail is None else lookup(annotations.tail.name)
    return Annotated(term, items, tail) if items or tail is not None else term


def _list(node: nodes.ListTerm, lookup: Lookup) -> Term:
    items = [lower(i, lookup) for i in node.items]
    return make_list(items, lower(node.tail, lookup)) if node.tail is not None else make_list(items)


def _operation(node: nodes.Arithmetic | nodes.Relation | nodes.Connective, lookup: Lookup) -> Term:
    operands = [lower(o, lookup) for o in node.operands]
    return (named(node.operator, len(operands)).functor, *operands)


def _function(node: nodes.FunctionCall, lookup: Lookup) -> Term:
    symbol = functor(node.name, len(node.arguments), kind=FUNCTION)
    return (symbol, *(lower(a, lookup) for a in node.arguments))


def _internal_action(node: nodes.InternalAction, lookup: Lookup) -> Term:
    symbol = functor(node.name, len(node.arguments), kind=ACTION)
    return (symbol, *(lower(a, lookup) for a in node.arguments)) if node.arguments else symbol


def _plan_term(node: nodes.PlanTerm, lookup: Lookup) -> Term:
    return lower_plan(node.plan, lookup)


def lower_plan(plan: nodes.Plan, lookup: Lookup) -> Term:
    """The term of a plan."""
    label = plans.NO_LABEL if plan.label is None else lower(plan.label, lookup)
    context = atom("true") if plan.context is None else lower(plan.context, lookup)
    return (plans.PLAN, label, lower_trigger(plan.trigger, lookup), context, lower(plan.body, lookup))


def lower_trigger(trigger: nodes.Trigger, lookup: Lookup) -> Term:
    """The term of a trigger."""
    return plans.trigger(trigger.operator + trigger.kind, lower(trigger.literal, lookup))


def _rule_term(node: nodes.RuleTerm, lookup: Lookup) -> Term:
    return (plans.RULE, lower(node.rule.head, lookup), lower(node.rule.body, lookup))


def _trigger_term(node: nodes.TriggerTerm, lookup: Lookup) -> Term:
    return lower_trigger(node.trigger, lookup)


def _body_term(node: nodes.BodyTerm, lookup: Lookup) -> Term:
    return _body(node.body, lookup, plans.BODY_TERM)


def _body(node: nodes.Body, lookup: Lookup, symbol: Functor = plans.BODY_SEQUENCE) -> Term:
    *steps, last = node.steps or (None,)
    if steps and isinstance(last, nodes.ExternalAction) and isinstance(last.action, nodes.Variable):
        # A variable at the end stands for all that follows.
        return plans.make_body([lower(s, lookup) for s in steps], lower(last.action, lookup), symbol)
    return plans.make_body([lower(s, lookup) for s in node.steps], symbol=symbol)


def _achieve(node: nodes.Achieve, lookup: Lookup) -> Term:
    return plans.step("!!" if node.separate else "!", lower(node.goal, lookup))


def _test(node: nodes.Test, lookup: Lookup) -> Term:
    return plans.step("?", lower(node.formula, lookup))


def _belief_change(node: nodes.BeliefChange, lookup: Lookup) -> Term:
    return plans.step(node.operator, lower(node.operand, lookup))


def _external(node: nodes.ExternalAction, lookup: Lookup) -> Term:
    action = lower(node.action, lookup)
    return action if isinstance(node.action, nodes.Variable) else plans.step("", action)


def _constraint(node: nodes.Constraint, lookup: Lookup) -> Term:
    return lower(node.formula, lookup)


def _if(node: nodes.If, lookup: Lookup) -> Term:
    parts = [lower(node.condition, lookup), lower(node.then, lookup)]
    if node.otherwise is not None:
        parts.append(lower(node.otherwise, lookup))
    return plans.step("if", *parts)


def _while(node: nodes.While, lookup: Lookup) -> Term:
    return plans.step("while", lower(node.condition, lookup), lower(node.body, lookup))


def _for(node: nodes.For, lookup: Lookup) -> Term:
    return plans.step("for", lower(node.condition, lookup), lower(node.body, lookup))


def _fork(node: nodes.Fork, lookup: Lookup) -> Term:
    return plans.step("|&|" if node.operator == "and" else "|||", *(lower(b, lookup) for b in node.branches))


_LOWER: dict[type, Callable[..., Term]] = {
    Constant: lambda node, _: node.value,
    nodes.Number: _number,
    nodes.String: _string,
    nodes.Variable: _variable,
    nodes.Literal: _literal,
    nodes.ListTerm: _list,
    nodes.Arithmetic: _operation,
    nodes.FunctionCall: _function,
    nodes.Relation: _operation,
    nodes.Not: _operation,
    nodes.And: _operation,
    nodes.Or: _operation,
    nodes.InternalAction: _internal_action,
    nodes.PlanTerm: _plan_term,
    nodes.RuleTerm: _rule_term,
    nodes.TriggerTerm: _trigger_term,
    nodes.BodyTerm: _body_term,
    nodes.Body: _body,
    nodes.Achieve: _achieve,
    nodes.Test: _test,
    nodes.BeliefChange: _belief_change,
    nodes.ExternalAction: _external,
    nodes.Constraint: _constraint,
    nodes.If: _if,
    nodes.While: _while,
    nodes.For: _for,
    nodes.Fork: _fork,
}


def settled(node: nodes.Node, lookup: Lookup) -> Term:
    """The term, evaluated at its top only."""
    return settle(lower(node, lookup))
