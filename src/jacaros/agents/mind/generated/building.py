"""Code that builds terms: an expression for the value of a piece of syntax."""

import math
from collections.abc import Callable

from jacaros.agents.language import nodes
from jacaros.agents.language.lowering import lower, step_parts
from jacaros.agents.language.nodes import variables_in
from jacaros.agents.mind.generated.function import FunctionBuilder
from jacaros.agents.terms.operators import named
from jacaros.agents.terms.order import annotation_set
from jacaros.agents.terms.plans import BODY_END, BODY_SEQUENCE, BODY_TERM, NO_LABEL, PLAN, RULE, TRIGGER
from jacaros.agents.terms.substitution import resolve
from jacaros.agents.terms.values import ACTION, FUNCTION, Functor, Term, atom, functor
from jacaros.agents.terms.values import PLAN as PLAN_KIND

_STATIC = (nodes.Literal, nodes.ListTerm, nodes.String)
_LONG_LIST = 12


def build(fn: FunctionBuilder, node: nodes.Node) -> str:
    """An expression (a name or a small literal) for the value of a term; variables without value get a `Var`."""
    if isinstance(node, nodes.Number):
        return (
            repr(node.value)
            if node.value.__class__ is float and math.isfinite(node.value)
            else _const(fn, node)
        )
    if isinstance(node, nodes.Constant):
        return fn.constant(node.value)
    if isinstance(node, nodes.Variable):
        return _variable(fn, node)
    if isinstance(node, _STATIC) and is_static(node):
        return _const(fn, node)
    return _COMPOUND[type(node)](fn, node)


def written(node: nodes.Node) -> Term | None:
    """The value of a term that is the same at every evaluation; None for others."""
    return resolve(lower(node, _no_variable)) if isinstance(node, _STATIC) and is_static(node) else None


def is_static(node: object) -> bool:
    """Whether a term is the same at every evaluation."""
    if any(True for _ in variables_in(node)):
        return False
    return not _has_calls(node)


def _has_calls(node: object) -> bool:
    if isinstance(node, (nodes.FunctionCall, nodes.Constant)):
        return True
    if isinstance(node, nodes.Arithmetic):
        # A division may have no result, which is for the plan to see when it comes to it.
        return named(node.operator, len(node.operands)).partial or _has_calls(node.operands)
    if isinstance(node, tuple):
        return any(_has_calls(item) for item in node)
    if isinstance(node, nodes.Literal):
        return _has_calls(node.arguments) or (
            node.annotations is not None and _has_calls(node.annotations.items)
        )
    if isinstance(node, nodes.ListTerm):
        return _has_calls(node.items) or (node.tail is not None and _has_calls(node.tail))
    return not isinstance(node, (nodes.Number, nodes.String))


def _const(fn: FunctionBuilder, node: nodes.Node) -> str:
    return fn.constant(constant_value(node))


def constant_value(node: nodes.Node) -> Term:
    """The value of a term that is the same at every evaluation."""
    return resolve(lower(node, _no_variable))


def _no_variable(name: str) -> object:
    raise KeyError(name)


def variable(fn: FunctionBuilder, name: str) -> str:
    """The value of a variable; one without value gets a `Var` of its own."""
    value = fn.values.get(name)
    return value if value is not None else fn.bind(name, f'Var("{name}")')


def _variable(fn: FunctionBuilder, node: nodes.Variable) -> str:
    value = f'Var("{node.name}")' if node.unnamed else variable(fn, node.name)
    if node.namespace is not None or node.negated:
        value = f"qualify({value}, {namespace(fn, node.namespace)}, {node.negated})"
    return _annotated(fn, value, node.annotations)


def functor_of_literal(literal: nodes.Literal) -> Functor:
    """The functor of a literal whose namespace is known when the plan is compiled."""
    assert not isinstance(literal.namespace, nodes.Variable)
    return functor(literal.functor, len(literal.arguments), literal.negated, literal.namespace)


def namespace(fn: FunctionBuilder, value: str | nodes.Variable | None) -> str:
    """An expression for a namespace."""
    if isinstance(value, nodes.Variable):
        return f"namespace_name({variable(fn, value.name)})"
    return repr(value)


def _annotated(fn: FunctionBuilder, value: str, annotations: nodes.Annotations | None) -> str:
    if annotations is None:
        return value
    items, tail = annotation_parts(fn, annotations)
    return f"Annotated({value}, {items}, {tail})"


def annotation_parts(fn: FunctionBuilder, annotations: nodes.Annotations) -> tuple[str, str]:
    """Expressions for the sorted annotations and for the tail."""
    tail = "None" if annotations.tail is None else build(fn, annotations.tail)
    if all(is_static(item) for item in annotations.items):
        from_terms = tuple(map(constant_value, annotations.items))
        return fn.constant(annotation_set(from_terms)), tail
    items = tuple_of([build(fn, item) for item in annotations.items])
    return (f"annotation_set({items})" if len(annotations.items) > 1 else items), tail


def tuple_of(items: list[str]) -> str:
    """A tuple display."""
    return f"({', '.join(items)}{',' if len(items) == 1 else ''})"


def _literal(fn: FunctionBuilder, node: nodes.Literal) -> str:
    arguments = [build(fn, a) for a in node.arguments]
    if isinstance(node.namespace, nodes.Variable):
        parts = ", ".join([repr(node.functor), repr(node.negated), namespace(fn, node.namespace), *arguments])
        value = f"literal_in({parts})"
    else:
        symbol = fn.constant(functor_of_literal(node))
        value = tuple_of([symbol, *arguments]) if arguments else symbol
    return _annotated(fn, value, node.annotations)


def _list(fn: FunctionBuilder, node: nodes.ListTerm) -> str:
    if node.tail is None:
        return f"make_list({tuple_of([build(fn, i) for i in node.items])})"
    tail = build(fn, node.tail)
    items = [build(fn, i) for i in node.items]
    if len(items) > _LONG_LIST:
        return f"make_list({tuple_of(items)}, {tail})"
    for item in reversed(items):
        tail = f"(CONS, {item}, {tail})"
    return tail


def _arithmetic(fn: FunctionBuilder, node: nodes.Arithmetic) -> str:
    operands = [as_name(fn, build(fn, o)) for o in node.operands]
    result = fn.local()
    value = named(node.operator, len(operands)).code_for(*operands)
    tests = [f"{o}.__class__ is float" for o in dict.fromkeys(operands) if not is_number(o)]
    if tests:
        value += f' if {" and ".join(tests)} else calculated("{node.operator}", {", ".join(operands)})'
    fn.line(f"{result} = {value}")
    return result


def is_number(expression: str) -> bool:
    """Whether the expression is a number literal."""
    return expression[0].isdigit() or expression[0] == "-"


def as_name(fn: FunctionBuilder, expression: str) -> str:
    """The expression as something that may be written twice."""
    if expression.isidentifier() or is_number(expression):
        return expression
    name = fn.local()
    fn.line(f"{name} = {expression}")
    return name


def resolved(fn: FunctionBuilder, expression: str) -> str:
    """The expression with all bindings applied."""
    if is_number(expression):
        return expression
    name = as_name(fn, expression)
    return f"{name} if {name}.__class__ in ATOMIC else resolve({name})"


def _function(fn: FunctionBuilder, node: nodes.FunctionCall) -> str:
    arguments = [build(fn, a) for a in node.arguments]
    symbol = fn.constant(functor(node.name, len(arguments), kind=FUNCTION))
    result = fn.local()
    fn.line(f"{result} = agent.call_function({tuple_of([symbol, *arguments])})")
    return result


def _condition(fn: FunctionBuilder, node: nodes.Relation | nodes.Connective) -> str:
    """A formula as a term."""
    symbol = fn.constant(named(node.operator, len(node.operands)).functor)
    return tuple_of([symbol, *(build(fn, o) for o in node.operands)])


def _internal_action(fn: FunctionBuilder, node: nodes.InternalAction) -> str:
    symbol = fn.constant(functor(node.name, len(node.arguments), kind=ACTION))
    return tuple_of([symbol, *(build(fn, a) for a in node.arguments)]) if node.arguments else symbol


def _plan(fn: FunctionBuilder, plan: nodes.Plan) -> str:
    label = fn.constant(NO_LABEL) if plan.label is None else build(fn, plan.label)
    context = fn.constant(atom("true")) if plan.context is None else build(fn, plan.context)
    return f"({fn.constant(PLAN)}, {label}, {_trigger(fn, plan.trigger)}, {context}, {build(fn, plan.body)})"


def _trigger(fn: FunctionBuilder, trigger: nodes.Trigger) -> str:
    operator = fn.constant(atom(trigger.operator + trigger.kind))
    return f"({fn.constant(TRIGGER)}, {operator}, {build(fn, trigger.literal)})"


def _rule(fn: FunctionBuilder, node: nodes.RuleTerm) -> str:
    return f"({fn.constant(RULE)}, {build(fn, node.rule.head)}, {build(fn, node.rule.body)})"


def _body(fn: FunctionBuilder, body: nodes.Body, symbol: Functor = BODY_SEQUENCE) -> str:
    result = fn.constant(BODY_END)
    written = list(body.steps)
    last = written[-1] if len(written) > 1 else None
    if isinstance(last, nodes.ExternalAction) and isinstance(last.action, nodes.Variable):
        # A variable at the end stands for all that follows.
        result = build(fn, last.action)
        written.pop()
    steps = [_step(fn, s) for s in written]
    for step in reversed(steps):
        result = f"({fn.constant(symbol)}, {step}, {result})"
    return result


def _step(fn: FunctionBuilder, step: nodes.Step) -> str:
    operator, operands = step_parts(step)
    if not operator and isinstance(operands[0], (nodes.Variable, nodes.Relation, nodes.InternalAction)):
        return build(fn, operands[0])
    symbol = fn.constant(functor(operator, len(operands), kind=PLAN_KIND))
    return tuple_of([symbol, *(build(fn, o) for o in operands)])


_COMPOUND: dict[type, Callable[..., str]] = {
    nodes.String: _const,
    nodes.Literal: _literal,
    nodes.ListTerm: _list,
    nodes.Arithmetic: _arithmetic,
    nodes.FunctionCall: _function,
    nodes.Relation: _condition,
    nodes.Not: _condition,
    nodes.And: _condition,
    nodes.Or: _condition,
    nodes.InternalAction: _internal_action,
    nodes.PlanTerm: lambda fn, n: _plan(fn, n.plan),
    nodes.TriggerTerm: lambda fn, n: _trigger(fn, n.trigger),
    nodes.RuleTerm: _rule,
    nodes.BodyTerm: lambda fn, n: _body(fn, n.body, BODY_TERM),
    nodes.Body: _body,
}
