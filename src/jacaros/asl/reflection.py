"""Convert terms back to syntax trees, so that plans and bodies made at run time are compiled like any other.

An unbound variable either stands for itself (a body that shares variables with the plan that created it: `Shared`), or
becomes a variable of the new plan (`Closing`), for plans added to the library.
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
        if kind is Functor:
            if term is plans.BODY_END:
                return nodes.BodyTerm(nodes.Body())
            return nodes.ListTerm(()) if term is NIL else self._literal(term, ())
        if kind is Annotated:
            return self._annotated(term)
        if kind is List:
            return self._list(term)
        if kind is tuple:
            return self._structure(term)
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

    def _literal(self, symbol: Functor, arguments: tuple[Term, ...]) -> nodes.Literal | nodes.InternalAction:
        built = tuple(self.term(a) for a in arguments)
        if symbol.kind == ACTION:
            return nodes.InternalAction(symbol.name, built)
        return nodes.Literal(symbol.name, built, symbol.negated, None, symbol.namespace)

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

    def _structure(self, term: tuple[Term, ...]) -> nodes.Term:
        symbol = term[0]
        if symbol is CONS:
            return self._list(term)
        if symbol.kind == FUNCTION:
            return nodes.FunctionCall(symbol.name, tuple(self.term(a) for a in term[1:]))
        if symbol.kind in (ARITHMETIC, RELATION, LOGIC):
            return self._operation(symbol, term)
        if symbol is plans.PLAN:
            return nodes.PlanTerm(self.plan(term))
        if symbol in plans.TRIGGERS:
            return nodes.TriggerTerm(self.trigger(term))
        if symbol is plans.RULE:
            return nodes.RuleTerm(self.rule(term))
        if symbol in plans.BODIES:
            return nodes.BodyTerm(self.body(term))
        return self._literal(symbol, term[1:])

    def _operation(self, symbol: Functor, term: tuple[Term, ...]) -> nodes.Term:
        operands = tuple(self.term(a) for a in term[1:])
        if symbol.kind == ARITHMETIC:
            return nodes.Arithmetic(symbol.name, operands)
        if symbol.kind == RELATION:
            return nodes.Relation(symbol.name, *operands)
        return cast("nodes.Term", nodes.CONNECTIVES[symbol.name](*operands))

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
        operator, operands = step_parts(step)
        if operator in ("!", "!!"):
            return nodes.Achieve(self._goal(operands[0]), operator == "!!")
        if operator == "?":
            return nodes.Test(self.term(operands[0]))
        if operator == "if":
            otherwise = self.body(operands[2]) if operands[2:] else None
            return nodes.If(self.term(operands[0]), self.body(operands[1]), otherwise)
        if operator in ("while", "for"):
            loop = nodes.While if operator == "while" else nodes.For
            return loop(self.term(operands[0]), self.body(operands[1]))
        if operator in ("|&|", "|||"):
            return nodes.Fork("and" if operator == "|&|" else "or", tuple(self.body(b) for b in operands))
        if operator:
            return nodes.BeliefChange(operator, self.term(operands[0]))
        formula = self.term(operands[0])
        if isinstance(formula, (nodes.Relation, nodes.InternalAction)):
            return nodes.Constraint(formula)
        return nodes.ExternalAction(cast("nodes.Literal | nodes.Variable", formula))
