"""Syntax trees as terms, terms as syntax trees, and both as text.

>>> from jacaros.agents.language.loader import parse_term
>>> lower_value(parse_term("1 + 2"))
3.0
"""

import math
from collections.abc import Callable, Iterable
from typing import Any, Final, cast

from jacaros.agents.language import nodes
from jacaros.agents.terms import plans
from jacaros.agents.terms.operators import BINARY, named, qualify
from jacaros.agents.terms.order import annotation_set
from jacaros.agents.terms.plans import body_steps, is_body, trigger_parts
from jacaros.agents.terms.plans import step_parts as parts_of_step
from jacaros.agents.terms.substitution import resolve
from jacaros.agents.terms.text import number_text, quoted, text
from jacaros.agents.terms.values import (
    ACTION,
    ARITHMETIC,
    CONS,
    FUNCTION,
    LOGIC,
    NIL,
    NUMBERS,
    RELATION,
    Annotated,
    Functor,
    List,
    String,
    Term,
    Var,
    atom,
    bare,
    deref,
    functor,
    make_list,
    parted,
)

Lookup = Callable[[str], Term]
"""Return the value of the variable of that name."""


class Variables(dict[str, Term]):
    """Variables by name, created on first use."""

    def __missing__(self, name: str) -> Var:
        variable = self[name] = Var(name)
        return variable


def fresh_names() -> Lookup:
    """Return a lookup that creates a new variable for every name."""
    return Variables().__getitem__


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
    """Return the operator and operands of a step, as in its term (see `jacaros.agents.terms.plans`)."""
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


# Convert terms back to syntax trees, so that plans and bodies made at run time are compiled like any other.
#
# An unbound variable either stands for itself (a body that shares variables with the plan that created it: `Shared`), or
# becomes a variable of the new plan (`Closing`), for plans added to the library.


MOST_TERMS: Final = 50_000
"""Terms in a plan that is added at run time. A plan that contains itself twice doubles: terms share, syntax does not."""


class NotAPlan(Exception):
    """Raised when the term is not a plan, body or formula, or is too large for a plan."""


class Reflection:
    """Convert terms to syntax; *shared* selects what unbound variables become."""

    def __init__(self, shared: bool) -> None:
        self.shared = shared
        self._names: dict[int, str] = {}
        self._kept: list[Var] = []
        self._left: float = math.inf if shared else MOST_TERMS

    def term(self, term: Term) -> nodes.Term:
        """Convert any term."""
        self._left -= 1
        if self._left < 0:
            raise NotAPlan(f"not a plan: more than {MOST_TERMS} terms")
        term = deref(term)
        kind = term.__class__
        if kind in NUMBERS:
            return nodes.Number(term)
        if kind is String:
            return nodes.String(str(term))
        if kind is Var:
            return self._variable(term)
        if term is plans.BODY_END:
            return nodes.BodyTerm(nodes.Body())
        if kind is List or term is NIL:
            return self._list(term)
        if kind is Functor:
            return self._structure(term, ())
        if kind is Annotated:
            return self._annotated(term)
        if kind is tuple:
            return self._list(term) if term[0] is CONS else self._structure(term[0], term[1:])
        return cast("nodes.Term", nodes.Constant(term))

    def _variable(self, variable: Var) -> nodes.Term:
        if self.shared:
            return cast("nodes.Term", nodes.Constant(variable))
        name = self._names.get(id(variable))
        if name is None:
            self._kept.append(variable)
            name = self._names[id(variable)] = self._free_name(variable.name)
        return nodes.Variable(name)

    def _free_name(self, written: str) -> str:
        """Return the name of a variable, with a number if the name is taken or the variable is unnamed."""
        if written[0] != "_" and written not in self._names.values():
            return written
        return f"{written.lstrip('_') or 'V'}_{len(self._names) + 1}".title()

    def _annotated(self, term: Annotated) -> nodes.Term:
        tail = None if term.tail is None else self.term(term.tail)
        annotations = nodes.Annotations(
            tuple(self.term(a) for a in term.annotations), tail if isinstance(tail, nodes.Variable) else None
        )
        inner = self.term(term.term)
        if isinstance(inner, nodes.Literal):
            return nodes.Literal(inner.functor, inner.arguments, inner.negated, annotations, inner.namespace)
        if isinstance(inner, nodes.Variable):
            return nodes.Variable(inner.name, annotations)
        return inner

    def _structure(self, symbol: Functor, arguments: tuple[Term, ...]) -> nodes.Term:
        term = (symbol, *arguments)
        if symbol is plans.PLAN:
            return nodes.PlanTerm(self.plan(term))
        if symbol in plans.TRIGGERS:
            return nodes.TriggerTerm(self.trigger(term))
        if symbol is plans.RULE:
            return nodes.RuleTerm(self.rule(term))
        if symbol in plans.BODIES:
            return nodes.BodyTerm(self.body(term))
        name, built = symbol.name, tuple(map(self.term, arguments))
        if symbol.kind == LOGIC:
            return cast("nodes.Term", nodes.CONNECTIVES[name](*built))
        if symbol.kind == RELATION:
            return nodes.Relation(name, *built)
        kind = {FUNCTION: nodes.FunctionCall, ACTION: nodes.InternalAction, ARITHMETIC: nodes.Arithmetic}.get(
            symbol.kind
        )
        return (
            kind(name, built) if kind else nodes.Literal(name, built, symbol.negated, None, symbol.namespace)
        )

    def _list(self, term: Term) -> nodes.ListTerm:
        items, end = parted(term)
        return nodes.ListTerm(tuple(map(self.term, items)), None if end is NIL else self.term(end))

    def plan(self, term: Term) -> nodes.Plan:
        """Convert a plan term.

        Raises:
            NotAPlan: the term is not a plan.
        """
        term = deref(term)
        if term.__class__ is not tuple or term[0] is not plans.PLAN:
            raise NotAPlan(f"not a plan: {text(term)}")
        label = self.term(term[1])
        if not isinstance(label, nodes.Literal) or label.functor == "nolabel":
            label = None  # type: ignore[assignment]
        context = deref(term[3])
        context_node = None if context.__class__ is Functor and context.name == "true" else self.term(context)
        return nodes.Plan(label, self.trigger(deref(term[2])), context_node, self.body(term[4]))  # type: ignore[arg-type]

    def trigger(self, term: Term) -> nodes.Trigger:
        """Convert a trigger term."""
        operator, literal = trigger_parts(deref(term))
        return nodes.Trigger(operator[:1], operator[1:], self._goal(literal))

    def rule(self, term: Term) -> nodes.Rule:
        """Convert a rule term."""
        head = self.term(term[1])
        if not isinstance(head, nodes.Literal):
            raise NotAPlan(f"not the head of a rule: {text(term[1])}")
        return nodes.Rule(head, self.term(term[2]))

    def _goal(self, term: Term) -> nodes.Literal | nodes.Variable:
        return cast("nodes.Literal | nodes.Variable", self.term(term))

    def body(self, term: Term) -> nodes.Body:
        """Convert a body term; a single step counts as a body."""
        return nodes.Body(tuple(self._step(s) for s in body_steps(term)))

    def _step(self, step: Term) -> nodes.Step:
        if is_body(step):
            return nodes.If(nodes.Literal("true"), self.body(step))
        match parts_of_step(step):
            case ("!" | "!!") as operator, (goal,):
                return nodes.Achieve(self._goal(goal), operator == "!!")
            case "?", (formula,):
                return nodes.Test(self.term(formula))
            case "if", (condition, *blocks):
                return nodes.If(self.term(condition), *map(self.body, blocks))
            case "while", (condition, body):
                return nodes.While(self.term(condition), self.body(body))
            case "for", (condition, body):
                return nodes.For(self.term(condition), self.body(body))
            case ("|&|" | "|||") as operator, branches:
                return nodes.Fork("and" if operator == "|&|" else "or", tuple(map(self.body, branches)))
            case "", (action,):
                made = self.term(action)
                if isinstance(made, nodes.Relation | nodes.InternalAction):
                    return nodes.Constraint(made)
                return nodes.ExternalAction(cast("nodes.Literal | nodes.Variable", made))
            case operator, operands:
                return nodes.BeliefChange(operator, self.term(operands[0]))


# Syntax trees as AgentSpeak text, in the style in which `.print` shows terms.
#
# Expressions are fully bracketed (``(X > 3)``, ``(A & (B | C))``), so the text parses to the same tree. It differs from
# the text of the tree's term (`jacaros.agents.terms.text`), which `.print` shows: strings are escaped, control statements
# have their own syntax, annotations keep their order and nothing is evaluated.


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


def _operation_text(node: nodes.Arithmetic | nodes.Relation | nodes.And | nodes.Or) -> str:
    if len(node.operands) == 1:
        return f"({node.operator}{format_term(node.operands[0])})"
    left, right = node.operands
    return f"({format_term(left)}{BINARY[node.operator].between}{format_term(right)})"


def _block(body: Any) -> str:
    return f"{{ {format_body(body)} }}" if body.steps else "{ }"


def _named(node: nodes.Variable | nodes.Literal, name: str) -> str:
    namespace = format_term(node.namespace) if isinstance(node.namespace, nodes.Variable) else node.namespace
    return f"{'' if namespace is None else f'{namespace}::'}{'~' if node.negated else ''}{name}"


def _arguments(arguments: tuple[nodes.Term, ...]) -> str:
    return f"({_joined(arguments)})" if arguments else ""


def _elements(node: nodes.ListTerm | nodes.Annotations | None) -> str:
    if node is None:
        return ""
    return f"[{_joined(node.items)}{'' if node.tail is None else f'|{format_term(node.tail)}'}]"


def _step_text(node: nodes.Step) -> str:
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
    **dict.fromkeys((nodes.Arithmetic, nodes.Relation, nodes.And, nodes.Or), _operation_text),
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
        (nodes.Achieve, nodes.Test, nodes.BeliefChange, nodes.ExternalAction, nodes.Constraint), _step_text
    ),
    **dict.fromkeys((nodes.If, nodes.While, nodes.For), _statement),
    nodes.Fork: _fork,
    nodes.Body: format_body,
    nodes.Plan: format_plan,
}
