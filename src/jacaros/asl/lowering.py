"""Syntax trees to terms: for beliefs, messages, and formulae shown to users.

>>> from jacaros.asl.loader import parse_term
>>> lower_value(parse_term("1 + 2"))
3.0
"""

from collections.abc import Callable

from jacaros.asl import nodes
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
"""Return the value of the variable of that name."""


class Names(dict[str, Term]):
    """Variables by name, created on first use."""

    def __missing__(self, name: str) -> Var:
        variable = self[name] = Var(name)
        return variable


def fresh_names() -> Lookup:
    """Return a lookup that creates a new variable for every name."""
    return Names().__getitem__


def lower(node: nodes.Node, lookup: Lookup) -> Term:
    """Return the term of a syntax tree; *lookup* gives the variables, nothing is evaluated."""
    return _LOWER[type(node)](node, lookup)


def lower_value(node: nodes.Node, lookup: Lookup | None = None) -> Term:
    """Return the term with bindings applied and arithmetic evaluated."""
    return resolve(lower(node, lookup or fresh_names()))


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


def _call(node: nodes.FunctionCall | nodes.InternalAction, lookup: Lookup) -> Term:
    kind = FUNCTION if isinstance(node, nodes.FunctionCall) else ACTION
    symbol = functor(node.name, len(node.arguments), kind=kind)
    if kind == ACTION and not node.arguments:
        return symbol
    return (symbol, *(lower(a, lookup) for a in node.arguments))


def lower_plan(plan: nodes.Plan, lookup: Lookup) -> Term:
    """Return the term of a plan."""
    label = plans.NO_LABEL if plan.label is None else lower(plan.label, lookup)
    context = atom("true") if plan.context is None else lower(plan.context, lookup)
    return (plans.PLAN, label, lower_trigger(plan.trigger, lookup), context, lower(plan.body, lookup))


def lower_trigger(trigger: nodes.Trigger, lookup: Lookup) -> Term:
    """Return the term of a trigger."""
    return plans.trigger(trigger.operator + trigger.kind, lower(trigger.literal, lookup))


def _rule_term(node: nodes.RuleTerm, lookup: Lookup) -> Term:
    return (plans.RULE, lower(node.rule.head, lookup), lower(node.rule.body, lookup))


def _body(node: nodes.Body, lookup: Lookup, symbol: Functor = plans.BODY_SEQUENCE) -> Term:
    *steps, last = node.steps or (None,)
    if steps and isinstance(last, nodes.ExternalAction) and isinstance(last.action, nodes.Variable):
        # A variable at the end stands for the rest of the body.
        return plans.make_body([lower(s, lookup) for s in steps], lower(last.action, lookup), symbol)
    return plans.make_body([lower(s, lookup) for s in node.steps], symbol=symbol)


def _step(node: nodes.Step, lookup: Lookup) -> Term:
    operator, operands = step_parts(node)
    return plans.step(operator, *(lower(each, lookup) for each in operands))


def step_parts(node: nodes.Step) -> tuple[str, tuple[nodes.Node, ...]]:
    """Return the operator and operands of a step, as in its term (see `jacaros.terms.plans`)."""
    match node:
        case nodes.Achieve(goal, separate):
            return "!!" if separate else "!", (goal,)
        case nodes.Test(formula):
            return "?", (formula,)
        case nodes.BeliefChange(operator, operand):
            return operator, (operand,)
        case nodes.If(condition, then, otherwise):
            return "if", (condition, then) if otherwise is None else (condition, then, otherwise)
        case nodes.While(condition, body):
            return "while", (condition, body)
        case nodes.For(condition, body):
            return "for", (condition, body)
        case nodes.Fork(operator, branches):
            return ("|&|" if operator == "and" else "|||"), branches
        case nodes.ExternalAction(action):
            return "", (action,)
        case nodes.Constraint(formula):
            return "", (formula,)


def _external(node: nodes.ExternalAction, lookup: Lookup) -> Term:
    return lower(node.action, lookup) if isinstance(node.action, nodes.Variable) else _step(node, lookup)


_LOWER: dict[type, Callable[..., Term]] = {
    nodes.Constant: lambda node, _: node.value,
    nodes.Number: lambda node, _: node.value,
    nodes.String: lambda node, _: String(node.value),
    nodes.Variable: _variable,
    nodes.Literal: _literal,
    nodes.ListTerm: _list,
    **dict.fromkeys((nodes.Arithmetic, nodes.Relation, nodes.Not, nodes.And, nodes.Or), _operation),
    nodes.FunctionCall: _call,
    nodes.InternalAction: _call,
    nodes.PlanTerm: lambda node, lookup: lower_plan(node.plan, lookup),
    nodes.RuleTerm: _rule_term,
    nodes.TriggerTerm: lambda node, lookup: lower_trigger(node.trigger, lookup),
    nodes.BodyTerm: lambda node, lookup: _body(node.body, lookup, plans.BODY_TERM),
    nodes.Body: _body,
    nodes.ExternalAction: _external,
    nodes.Constraint: lambda node, lookup: lower(node.formula, lookup),
    **dict.fromkeys(
        (nodes.Achieve, nodes.Test, nodes.BeliefChange, nodes.If, nodes.While, nodes.For, nodes.Fork), _step
    ),
}


def settled(node: nodes.Node, lookup: Lookup) -> Term:
    """Return the term, evaluated at its top level only."""
    return settle(lower(node, lookup))
