"""Parse terms and conditions: expressions with their operators."""

from abc import abstractmethod
from typing import Final

from jacaros.asl import nodes
from jacaros.asl.lexer import Token
from jacaros.asl.literal_parser import LiteralParser
from jacaros.asl.source import Span
from jacaros.suggestions import close_matches, did_you_mean
from jacaros.terms.functions import ARITIES
from jacaros.terms.operators import AND, BINARY, NOT, OR, PREFIX, SUM, Operator
from jacaros.terms.text import unquoted
from jacaros.terms.values import ARITHMETIC, RELATION, number

MAX_CHAIN: Final = 250
"""Maximum number of operators in a row: each adds a level of recursion for code that walks the term."""

_MOST_DIGITS: Final = 400
"""Longer numbers are infinite, as all doubles of their size."""
_NUMERIC: Final = (nodes.Number, nodes.Variable, nodes.Arithmetic, nodes.FunctionCall)


class TermParser(LiteralParser):
    """Parse terms; the plan parser reads what is in braces (plans, bodies, rules)."""

    @abstractmethod
    def braces(self) -> nodes.Term:
        """Parse a term in braces: plan, trigger, rule or body."""

    # expressions

    def condition(self) -> nodes.Term:
        """Parse a formula: in contexts, tests and statements, and after ``:-``."""
        return self.expression(formula=True)

    def expression(self, loosest: int = OR, formula: bool = False) -> nodes.Term:
        """Parse an expression whose operators bind at least as tightly as *loosest*."""
        left = self.operand(formula)
        chained = 0
        while True:
            operator = self.token
            found = BINARY.get(operator.kind)
            if found is None or found.level < loosest:
                return left
            if found.kind == ARITHMETIC:
                if found.level == SUM and not self._continues_sum(left):
                    return left
                chained += 1
                if chained > MAX_CHAIN:
                    self.fail(
                        "nested-too-deeply",
                        "expression with too many operators",
                        help=f"put brackets around parts of it: at most {MAX_CHAIN} operators may follow each other",
                    )
                left = self._arithmetic(left, found)
            elif found.kind == RELATION:
                left = self._relation(left)
            else:
                left = self._connective(left, found, formula)

    def element(self) -> nodes.Term:
        """Parse an element of a list or an annotation: formulae need brackets, as ``|`` begins the tail."""
        start = self.token
        element = self.expression(SUM)
        wrong = "formula-in-list", "expected brackets around a formula in a list"
        if isinstance(element, nodes.Not) and start.kind == "not":
            self.report(*wrong, element.span, "write `[(not a)]`")
        elif self.token.kind in BINARY and self.token.kind != "|":
            self.report(*wrong, self.span_of(self.token), "write `[(X < 2)]`")
            self.advance()
            self.expression(AND)
        return element

    def operand(self, formula: bool = False) -> nodes.Term:
        """Parse an operand of a binary operator."""
        token = self.token
        kind = token.kind
        if kind in ("atom", "~", "::"):
            return self.literal(formula)
        if kind == "variable":
            return self.variable(formula)
        if kind == "number":
            self.advance()
            return nodes.Number(_value(token.text), span=self.span_of(token))
        if kind == "string":
            self.advance()
            return nodes.String(unquoted(token.text), span=self.span_of(token))
        if kind == "[":
            return self.list_term()
        if kind == "(":
            return self._parenthesised(formula)
        if kind == "{":
            return self.braces()
        if kind in ("true", "false"):
            self.advance()
            return nodes.Literal(kind, span=self.span_of(token))
        return self._prefixed(formula)

    def _prefixed(self, formula: bool) -> nodes.Term:
        token = self.token
        if token.kind not in PREFIX:
            self.unexpected("a term")
        self.advance()
        self.enter()
        if token.kind == "not":
            negated = self.expression(NOT, formula)
            self.leave()
            return nodes.Not(negated, span=self.span_from(token))
        operand = self.operand()
        self.leave()
        self._require_number(token, operand)
        span = self.span_from(token)
        if isinstance(operand, nodes.Number):
            return nodes.Number(-operand.value if token.kind == "-" else operand.value, span=span)
        return nodes.Arithmetic(token.kind, (operand,), span=span)

    def _parenthesised(self, formula: bool) -> nodes.Term:
        opener = self.advance()
        self.enter()
        inner = self.expression(formula=formula)
        self.leave()
        self.close(opener)
        return inner

    def _continues_sum(self, left: nodes.Term) -> bool:
        """Return whether ``+`` or ``-`` after *left* is arithmetic: after a forgotten ';' or '.' it is not."""
        number = isinstance(left, _NUMERIC)
        if number and not self.token.first:
            return True  # X-Y <- ...: the end of a context, not a deletion of Y
        return not self.at_plan() and (number or not self.token.first)

    def _arithmetic(self, left: nodes.Term, found: Operator) -> nodes.Term:
        operator = self.advance()
        if found.right:
            self.enter()
            right = self.expression(found.level)
            self.leave()
        else:
            right = self.expression(found.level + 1)
        if self._require_number(operator, left):
            self._require_number(operator, right)
        return nodes.Arithmetic(operator.kind, (left, right), span=_across(left, right))

    def _require_number(self, operator: Token, operand: nodes.Term) -> bool:
        """Return whether *operand* may be a number; report it otherwise."""
        if isinstance(operand, _NUMERIC):
            return True
        help = None
        if isinstance(operand, nodes.InternalAction):
            what = f"unknown function `{operand.name}/{len(operand.arguments)}`"
            close = close_matches(operand.name, [*ARITIES, *self.names.functions])
            if close and close[0] != operand.name:
                help = did_you_mean(close)
            elif close:
                help = f"{close[0]} takes {_arity_text(close[0])}"
        else:
            what = f"operand of `{operator.text}` is not a number"
            if isinstance(operand, nodes.String | nodes.ListTerm):
                help = "join strings and lists with `.concat(A, B, Result)`"
            elif operator.first:
                help = "if this is a new step, put `;` before this line"
            elif isinstance(operand, nodes.Literal):
                help = "ask for the value first with `?b(X)`, then calculate with X"
        self.report("not-a-number", what, operand.span or self.span_of(operator), help)
        return False

    def _relation(self, left: nodes.Term) -> nodes.Term:
        operator = self.advance()
        if isinstance(left, nodes.Relation):
            self.report(
                "chained-relation",
                "relations cannot be chained",
                self.span_of(operator),
                "join two of them with `&`, as in `1 < X & X < 5`",
            )
        elif left is self._placed and isinstance(left, nodes.Literal | nodes.Variable):
            left = nodes.replace(left, namespace=None)
        right = self.expression(SUM)
        return nodes.Relation(operator.kind, left, right, span=_across(left, right))

    def _connective(self, left: nodes.Term, found: Operator, formula: bool) -> nodes.Term:
        """Parse a chain of ``&`` or ``|``, which is right associative; in a loop, as it may be long."""
        parts = [left]
        while self.accept(found.symbol):
            parts.append(self.expression(found.level + 1, formula))
        result = parts.pop()
        while parts:
            first = parts.pop()
            result = nodes.CONNECTIVES[found.symbol](first, result, span=_across(first, result))
        return result


def _across(left: nodes.Term, right: nodes.Term) -> Span | None:
    """Return the span from the beginning of *left* to the end of *right*."""
    if left.span is None or right.span is None:
        return None
    return left.span.to(right.span)


def _arity_text(name: str) -> str:
    fewest, most = ARITIES[name]
    if fewest == most:
        return "no argument" if fewest == 0 else f"{fewest} argument{'s' if fewest > 1 else ''}"
    return f"{fewest} or more arguments"


def _value(written: str) -> float:
    """Return the value of a number as written; whole numbers of any size are exact."""
    return number(int(written)) if written.isdecimal() and len(written) < _MOST_DIGITS else float(written)
