"""Convert terms back to syntax trees, so that plans and bodies made at run time are compiled like any other.

An unbound variable either stands for itself (a body that shares variables with the plan that created it: `Shared`), or
becomes a variable of the new plan (`Closing`), for plans added to the library.

>>> from jacaros.asl.formatter import format_plan
>>> from jacaros.asl.loader import parse_plans
>>> from jacaros.asl.lowering import fresh_names, lower_plan
>>> term = lower_plan(parse_plans("+!go(X) <- move(X)")[0], fresh_names())
>>> format_plan(Reflection(shared=False).plan(term))
'+!go(X) <- move(X).'
"""

from typing import cast

from jacaros.asl import nodes
from jacaros.terms import plans
from jacaros.terms.plans import body_steps, is_body, step_parts, trigger_parts
from jacaros.terms.text import text
from jacaros.terms.values import (
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
    deref,
    parted,
)


class NotAPlan(Exception):
    """Raised when the term is not a plan, body or formula."""


class Reflection:
    """Convert terms to syntax; *shared* selects what unbound variables become."""

    def __init__(self, shared: bool) -> None:
        self.shared = shared
        self._names: dict[int, str] = {}
        self._kept: list[Var] = []

    def term(self, term: Term) -> nodes.Term:
        """Convert any term."""
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
        match step_parts(step):
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
