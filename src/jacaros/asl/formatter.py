"""The tree as AgentSpeak text, in the style in which `.print` shows terms.

Expressions are fully bracketed (``(X > 3)``, ``(A & (B | C))``), so the text reads back as the same tree.
"""

from functools import singledispatch

from jacaros.asl import nodes
from jacaros.terms.operators import BINARY
from jacaros.terms.text import number_text, quoted


@singledispatch
def format_term(node: nodes.Node) -> str:
    """A term (or formula, trigger, step, rule) as text."""
    raise TypeError(f"{type(node).__name__} is no term")


@format_term.register
def _(node: nodes.Number) -> str:
    return number_text(node.value)


@format_term.register
def _(node: nodes.String) -> str:
    return quoted(node.value)


@format_term.register
def _(node: nodes.Variable) -> str:
    name = f"{_namespace(node.namespace)}{'~' if node.negated else ''}{node.name}"
    return name + _annotations(node.annotations)


@format_term.register
def _(node: nodes.Literal) -> str:
    name = f"{_namespace(node.namespace)}{'~' if node.negated else ''}{node.functor}"
    return f"{name}{_arguments(node.arguments)}{_annotations(node.annotations)}"


@format_term.register
def _(node: nodes.Annotations) -> str:
    return _elements(node.items, node.tail)


@format_term.register
def _(node: nodes.ListTerm) -> str:
    return _elements(node.items, node.tail)


@format_term.register
def _(node: nodes.Arithmetic) -> str:
    if len(node.operands) == 1:
        return f"({node.operator}{format_term(node.operands[0])})"
    left, right = node.operands
    return f"({format_term(left)}{BINARY[node.operator].between}{format_term(right)})"


@format_term.register(nodes.FunctionCall)
@format_term.register(nodes.InternalAction)
def _(node: nodes.FunctionCall | nodes.InternalAction) -> str:
    return node.name + _arguments(node.arguments)


@format_term.register
def _(node: nodes.Relation) -> str:
    return f"({format_term(node.left)} {node.operator} {format_term(node.right)})"


@format_term.register
def _(node: nodes.Not) -> str:
    return f"not ({format_term(node.operand)})"


@format_term.register
def _(node: nodes.And) -> str:
    return f"({format_term(node.left)} & {format_term(node.right)})"


@format_term.register
def _(node: nodes.Or) -> str:
    return f"({format_term(node.left)} | {format_term(node.right)})"


@format_term.register
def _(node: nodes.PlanTerm) -> str:
    return f"{{ {format_plan(node.plan).removesuffix('.')} }}"


@format_term.register
def _(node: nodes.RuleTerm) -> str:
    return f"{{ {format_term(node.rule)} }}"


@format_term.register
def _(node: nodes.TriggerTerm) -> str:
    return f"{{ {format_term(node.trigger)} }}"


@format_term.register
def _(node: nodes.BodyTerm) -> str:
    return _block(node.body)


@format_term.register
def _(node: nodes.Rule) -> str:
    return f"{format_term(node.head)} :- {format_term(node.body)}"


@format_term.register
def _(node: nodes.Trigger) -> str:
    return f"{node.operator}{node.kind}{format_term(node.literal)}"


@format_term.register
def _(node: nodes.Achieve) -> str:
    return ("!!" if node.separate else "!") + format_term(node.goal)


@format_term.register
def _(node: nodes.Test) -> str:
    return f"?{format_term(node.formula)}"


@format_term.register
def _(node: nodes.BeliefChange) -> str:
    return node.operator + format_term(node.operand)


@format_term.register
def _(node: nodes.ExternalAction) -> str:
    return format_term(node.action)


@format_term.register
def _(node: nodes.Constraint) -> str:
    return format_term(node.formula)


@format_term.register
def _(node: nodes.If) -> str:
    text = f"if ({_bare(node.condition)}) {_block(node.then)}"
    return text if node.otherwise is None else f"{text} else {_block(node.otherwise)}"


@format_term.register
def _(node: nodes.While) -> str:
    return f"while ({_bare(node.condition)}) {_block(node.body)}"


@format_term.register
def _(node: nodes.For) -> str:
    return f"for ({_bare(node.condition)}) {_block(node.body)}"


@format_term.register
def _(node: nodes.Fork) -> str:
    symbol = " |&| " if node.operator == "and" else " ||| "
    return f"({symbol.join(f'({format_body(branch)})' for branch in node.branches)})"


@format_term.register
def _(node: nodes.Body) -> str:
    return format_body(node)


@format_term.register
def _(node: nodes.Plan) -> str:
    return format_plan(node)


def format_body(body: nodes.Body | nodes.Variable) -> str:
    """The steps of a body, ``; `` between them; nothing for an empty body."""
    if isinstance(body, nodes.Variable):
        return format_term(body)
    return "; ".join(format_term(step) for step in body.steps)


def format_plan(plan: nodes.Plan) -> str:
    """A plan with its final '.' and its sub-plans, on one line."""
    parts = [] if plan.label is None else [f"@{format_term(plan.label)}"]
    parts.append(format_term(plan.trigger))
    if plan.context is not None:
        parts.append(f": {_bare(plan.context)}")
    if plan.goal_condition is not None:
        parts.append(f"<: {_bare(plan.goal_condition)}")
    if isinstance(plan.body, nodes.Variable) or plan.body.steps:
        parts.append(f"<- {format_body(plan.body)}")
    text = " ".join(parts) + "."
    if plan.subplans:
        text += f" {{ {' '.join(format_plan(inner) for inner in plan.subplans)} }}"
    return text


def _bare(formula: nodes.Term) -> str:
    """A formula without the outermost pair of brackets."""
    text = format_term(formula)
    if isinstance(formula, nodes.Relation | nodes.And | nodes.Or):
        return text[1:-1]
    return text


def _block(body: nodes.Body) -> str:
    return f"{{ {format_body(body)} }}" if body.steps else "{ }"


def _namespace(namespace: str | nodes.Variable | None) -> str:
    if namespace is None:
        return ""
    return f"{namespace if isinstance(namespace, str) else format_term(namespace)}::"


def _arguments(arguments: tuple[nodes.Term, ...]) -> str:
    return f"({','.join(format_term(argument) for argument in arguments)})" if arguments else ""


def _annotations(annotations: nodes.Annotations | None) -> str:
    return "" if annotations is None else _elements(annotations.items, annotations.tail)


def _elements(items: tuple[nodes.Term, ...], tail: nodes.Term | None) -> str:
    inner = ",".join(format_term(item) for item in items)
    return f"[{inner}]" if tail is None else f"[{inner}|{format_term(tail)}]"
