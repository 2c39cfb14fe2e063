"""Syntax trees as AgentSpeak text, in the style in which `.print` shows terms.

Expressions are fully bracketed (``(X > 3)``, ``(A & (B | C))``), so the text parses to the same tree. It differs from
the text of the tree's term (`jacaros.terms.text`), which `.print` shows: strings are escaped, control statements have
their own syntax, annotations keep their order and nothing is evaluated.

>>> from jacaros.asl.loader import parse_plans
>>> format_plan(parse_plans("+!go(X) : X > 3 <- move(X)")[0])
'+!go(X) : X > 3 <- move(X).'
"""

from collections.abc import Callable, Iterable
from typing import Any, Final

from jacaros.asl import nodes
from jacaros.asl.lowering import step_parts
from jacaros.terms.operators import BINARY
from jacaros.terms.text import number_text, quoted, text


def format_term(node: nodes.Node) -> str:
    """Format a term, formula, trigger, step or rule.

    Raises:
        TypeError: the node is of another kind.
    """
    write = _WRITERS.get(type(node))
    if write is None:
        raise TypeError(f"{type(node).__name__} is not a term")
    return write(node)


def format_body(body: nodes.Body | nodes.Variable) -> str:
    """Format the steps of a body, separated by ``; ``; an empty body gives an empty string."""
    if isinstance(body, nodes.Variable):
        return format_term(body)
    return _joined(body.steps, "; ")


def format_plan(plan: nodes.Plan) -> str:
    """Format a plan with its final '.' and its sub-plans, on one line."""
    parts = [] if plan.label is None else [f"@{format_term(plan.label)}"]
    parts.append(format_term(plan.trigger))
    if plan.context is not None:
        parts.append(f": {_bare(plan.context)}")
    if plan.goal_condition is not None:
        parts.append(f"<: {_bare(plan.goal_condition)}")
    if isinstance(plan.body, nodes.Variable) or plan.body.steps:
        parts.append(f"<- {format_body(plan.body)}")
    line = " ".join(parts) + "."
    return f"{line} {{ {_joined(plan.subplans, ' ')} }}" if plan.subplans else line


def _joined(parts: Iterable[nodes.Node], separator: str = ",") -> str:
    return separator.join(map(format_term, parts))


def _bare(formula: Any) -> str:
    """Format a formula without its outermost brackets."""
    written = format_term(formula)
    return written[1:-1] if isinstance(formula, nodes.Relation | nodes.And | nodes.Or) else written


def _operation(node: nodes.Arithmetic | nodes.Relation | nodes.And | nodes.Or) -> str:
    if len(node.operands) == 1:
        return f"({node.operator}{format_term(node.operands[0])})"
    left, right = node.operands
    return f"({format_term(left)}{BINARY[node.operator].between}{format_term(right)})"


def _block(body: Any) -> str:
    return f"{{ {format_body(body)} }}" if body.steps else "{ }"


def _named(node: nodes.Variable | nodes.Literal, name: str) -> str:
    """Format a name with its namespace and negation."""
    namespace = format_term(node.namespace) if isinstance(node.namespace, nodes.Variable) else node.namespace
    return f"{'' if namespace is None else f'{namespace}::'}{'~' if node.negated else ''}{name}"


def _arguments(arguments: tuple[nodes.Term, ...]) -> str:
    return f"({_joined(arguments)})" if arguments else ""


def _elements(node: nodes.ListTerm | nodes.Annotations | None) -> str:
    if node is None:
        return ""
    return f"[{_joined(node.items)}{'' if node.tail is None else f'|{format_term(node.tail)}'}]"


def _step(node: nodes.Step) -> str:
    operator, (operand,) = step_parts(node)
    return operator + format_term(operand)


def _statement(node: nodes.If | nodes.While | nodes.For) -> str:
    word, (condition, *blocks) = step_parts(node)
    return f"{word} ({_bare(condition)}) {' else '.join(map(_block, blocks))}"


def _fork(node: nodes.Fork) -> str:
    symbol, branches = step_parts(node)
    return f"({f' {symbol} '.join(f'({format_term(branch)})' for branch in branches)})"


_WRITERS: Final[dict[type, Callable[[Any], str]]] = {
    nodes.Number: lambda node: number_text(node.value),
    nodes.String: lambda node: quoted(node.value),
    nodes.Constant: lambda node: text(node.value),
    nodes.Variable: lambda node: _named(node, node.name) + _elements(node.annotations),
    nodes.Literal: lambda node: (
        _named(node, node.functor) + _arguments(node.arguments) + _elements(node.annotations)
    ),
    **dict.fromkeys((nodes.Annotations, nodes.ListTerm), _elements),
    **dict.fromkeys((nodes.Arithmetic, nodes.Relation, nodes.And, nodes.Or), _operation),
    **dict.fromkeys(
        (nodes.FunctionCall, nodes.InternalAction), lambda node: node.name + _arguments(node.arguments)
    ),
    nodes.Not: lambda node: f"not ({format_term(node.operand)})",
    nodes.PlanTerm: lambda node: f"{{ {format_plan(node.plan).removesuffix('.')} }}",
    nodes.RuleTerm: lambda node: f"{{ {format_term(node.rule)} }}",
    nodes.TriggerTerm: lambda node: f"{{ {format_term(node.trigger)} }}",
    nodes.BodyTerm: lambda node: _block(node.body),
    nodes.Rule: lambda node: f"{format_term(node.head)} :- {format_term(node.body)}",
    nodes.Trigger: lambda node: f"{node.operator}{node.kind}{format_term(node.literal)}",
    **dict.fromkeys(
        (nodes.Achieve, nodes.Test, nodes.BeliefChange, nodes.ExternalAction, nodes.Constraint), _step
    ),
    **dict.fromkeys((nodes.If, nodes.While, nodes.For), _statement),
    nodes.Fork: _fork,
    nodes.Body: format_body,
    nodes.Plan: format_plan,
}
