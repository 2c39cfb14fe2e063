"""Terms and conditions: literals, lists, variables, and expressions with their operators."""

from abc import ABC, abstractmethod
from dataclasses import replace
from difflib import get_close_matches
from typing import Final

from jacaros.asl import nodes
from jacaros.asl.cursor import Cursor, Names
from jacaros.asl.diagnostics import Diagnostic
from jacaros.asl.functions import ARITIES, is_function
from jacaros.asl.lexer import Token, tokenize
from jacaros.asl.namespaces import Namespaces
from jacaros.asl.source import SourceFile, Span

_OR, _AND, _NOT, _RELATION, _SUM, _POWER = 1, 2, 3, 4, 5, 7
_LEVELS: Final = {
    "|": _OR,
    "&": _AND,
    **dict.fromkeys(("<", "<=", ">", ">=", "==", "\\==", "=", "=.."), _RELATION),
    "+": _SUM,
    "-": _SUM,
    "*": 6,
    "/": 6,
    "div": 6,
    "mod": 6,
    "**": _POWER,
}
"""The binary operators, loosest first.  Unary minus binds tighter than all of them."""

_UNSET: Final = "(unset)"
"""No namespace is written; compared by identity."""

_NUMERIC: Final = (nodes.Number, nodes.Variable, nodes.Arithmetic, nodes.FunctionCall)


class TermParser(Cursor, ABC):
    """Reads terms; what stands in braces (plans, bodies, rules) is read by the parser of plans.

    *formula* says that a literal is a condition, so that it belongs to the namespace of the block; literals
    that are arguments or operands of relations stay in the default namespace.
    """

    def __init__(self, file: SourceFile, names: Names, diagnostics: list[Diagnostic]) -> None:
        super().__init__(file, tokenize(file, diagnostics.append), diagnostics)
        self.names = names
        self.namespaces = Namespaces()
        # The condition that got its namespace last: taken back if it is an operand of a relation.
        self._placed: nodes.Term | None = None

    @abstractmethod
    def braces(self) -> nodes.Term:
        """A term in braces: plan, trigger, rule or body."""

    # expressions

    def condition(self) -> nodes.Term:
        """A formula: what stands in contexts, tests and statements, and behind ``:-``."""
        return self.expression(formula=True)

    def expression(self, loosest: int = _OR, formula: bool = False) -> nodes.Term:
        """An expression whose operators bind at least as tightly as *loosest*."""
        left = self.operand(formula)
        while True:
            operator = self.token
            level = _LEVELS.get(operator.kind)
            if level is None or level < loosest:
                return left
            if level >= _SUM:
                if level == _SUM and not self._continues_sum(left):
                    return left
                left = self._arithmetic(left, level)
            elif level == _RELATION:
                left = self._relation(left)
            else:
                left = self._connective(left, level, formula)

    def operand(self, formula: bool = False) -> nodes.Term:
        """What stands between binary operators."""
        token = self.token
        kind = token.kind
        if kind in ("atom", "~", "::"):
            return self.literal(formula)
        if kind == "variable":
            return self.variable(formula)
        if kind == "number":
            self.advance()
            return nodes.Number(float(token.text), span=self.span_of(token))
        if kind == "string":
            self.advance()
            return nodes.String(_unescape(token.text), span=self.span_of(token))
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
        if token.kind not in ("-", "+", "not"):
            self.unexpected("a term")
        self.advance()
        self.enter()
        if token.kind == "not":
            negated = self.expression(_NOT, formula)
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
        """Whether ``+`` or ``-`` behind *left* is arithmetic: after a forgotten ';' or '.' it is not."""
        if self.at_plan():
            return False
        return isinstance(left, _NUMERIC) or not self.token.first

    def _arithmetic(self, left: nodes.Term, level: int) -> nodes.Term:
        operator = self.advance()
        # All are left associative but **.
        right = self.expression(level if level == _POWER else level + 1)
        self._require_number(operator, left)
        self._require_number(operator, right)
        return nodes.Arithmetic(operator.kind, (left, right), span=_across(left, right))

    def _require_number(self, operator: Token, operand: nodes.Term) -> None:
        if isinstance(operand, _NUMERIC):
            return
        hint = None
        if isinstance(operand, nodes.InternalAction):
            what = f"'{operand.name}' with {len(operand.arguments)} arguments is not a function"
            close = get_close_matches(operand.name, [*ARITIES, *self.names.functions], 1)
            if close and close[0] != operand.name:
                hint = f"did you mean {close[0]}?"
            elif close:
                hint = f"{close[0]} takes {_arity_text(close[0])}"
        else:
            what = f"'{operator.text}' needs numbers"
            if isinstance(operand, nodes.String | nodes.ListTerm):
                hint = "strings and lists are joined by .concat(A, B, Result)"
            elif operator.first:
                hint = "or is a ';' missing before this line?"
            elif isinstance(operand, nodes.Literal):
                hint = "a belief gives its value through a variable: ask ?b(X) first, then count with X"
        self.report(what, operand.span or self.span_of(operator), hint)

    def _relation(self, left: nodes.Term) -> nodes.Term:
        operator = self.advance()
        if isinstance(left, nodes.Relation):
            self.report(
                "relations cannot be chained",
                self.span_of(operator),
                "join two of them with &, as in 1 < X & X < 5",
            )
        elif left is self._placed and isinstance(left, nodes.Literal | nodes.Variable):
            left = replace(left, namespace=None)
        right = self.expression(_SUM)
        return nodes.Relation(operator.kind, left, right, span=_across(left, right))

    def _connective(self, left: nodes.Term, level: int, formula: bool) -> nodes.Term:
        """A chain of ``&`` or ``|``, which is right associative; read in a loop, as it may be long."""
        operator = self.token.kind
        parts = [left]
        while self.accept(operator):
            parts.append(self.expression(level + 1, formula))
        combine = nodes.And if level == _AND else nodes.Or
        result = parts.pop()
        while parts:
            first = parts.pop()
            result = combine(first, result, span=_across(first, result))
        return result

    # literals and variables

    def literal(self, formula: bool = False) -> nodes.Term:
        """A literal, or what a name with a dot means: internal action or arithmetic function."""
        start = self.token
        namespace = self._namespace()
        negated = self.accept("~")
        if negated and namespace is _UNSET:
            namespace = self._namespace()
        token = self.token
        if token.kind == "variable":
            return self._variable(start, namespace, negated, formula)
        if token.kind != "atom":
            self.unexpected("a name")
        self.advance()
        functor = token.text
        arguments = self._arguments()
        if "." in functor and functor[0] != "'":
            return self._dotted(start, functor, arguments, negated or namespace is not _UNSET)
        annotations = self._annotations()
        placed = formula and namespace is _UNSET
        if namespace is _UNSET:
            namespace = self.namespaces.of_literal(functor) if formula else None
        span = self.span_from(start)
        literal = nodes.Literal(functor, arguments, negated, annotations, namespace, span=span)
        self._placed = literal if placed else None
        return literal

    def _dotted(
        self, start: Token, name: str, arguments: tuple[nodes.Term, ...], prefixed: bool
    ) -> nodes.InternalAction | nodes.FunctionCall:
        if prefixed:
            self.report(
                f"'{name}' is an internal action: it can be neither negated by '~' nor put into a namespace",
                self.span_from(start),
                "to ask that it does not hold write 'not'",
            )
        if self.token.kind == "[":
            self.report(
                f"'{name}' is an internal action, which cannot have annotations",
                hint="a plan ends with a '.' followed by a blank" if name[0] == "." and start.first else None,
            )
            self._annotations()
        span = self.span_from(start)
        if is_function(name, len(arguments), self.names.functions):
            return nodes.FunctionCall(name, arguments, span=span)
        return nodes.InternalAction(name, arguments, span=span)

    def variable(self, formula: bool = False) -> nodes.Term:
        """A variable, or a literal in a namespace given by a variable (``N::p``)."""
        if self.peek().kind == "::":
            return self.literal(formula)
        return self._variable(self.token, _UNSET, False, formula)

    def _variable(
        self, start: Token, namespace: "str | nodes.Variable | None", negated: bool, formula: bool
    ) -> nodes.Variable:
        token = self.advance()
        name, unnamed = self._variable_name(token.text)
        annotations = self._annotations()
        if namespace is _UNSET:
            namespace = None
        return nodes.Variable(name, annotations, namespace, negated, unnamed, span=self.span_from(start))

    def _variable_name(self, text: str) -> tuple[str, bool]:
        """The name, and whether the variable is unnamed; ``_12Any`` is the variable of the name ``_12``."""
        if text[0] != "_":
            return text, False
        digits = len(text) - 1 - len(text[1:].lstrip("0123456789"))
        if digits:
            return text[: digits + 1], False
        return f"_{next(self.names.unnamed)}", True

    def _namespace(self) -> "str | nodes.Variable | None":
        """A namespace prefix, if there is one, and `_UNSET` otherwise."""
        token = self.token
        if token.kind == "::":
            self.advance()
            return None
        if self.peek().kind != "::" or token.kind not in ("atom", "variable"):
            return _UNSET
        self.advance()
        self.advance()
        if token.kind == "atom":
            return self.namespaces.resolve(token.text)
        name, unnamed = self._variable_name(token.text)
        return nodes.Variable(name, unnamed=unnamed, span=self.span_of(token))

    def _arguments(self) -> tuple[nodes.Term, ...]:
        if self.token.kind != "(":
            return ()
        opener = self.advance()
        if self.token.kind == ")":
            self.report(
                "the brackets are empty", self.span_of(opener), "without arguments leave them out: p, not p()"
            )
            self.advance()
            return ()
        self.enter()
        arguments = [self.expression()]
        while self.accept(","):
            arguments.append(self.expression())
        self.leave()
        self.close(opener)
        return tuple(arguments)

    # lists and annotations

    def list_term(self) -> nodes.ListTerm:
        """``[a, b | T]``."""
        start = self.token
        items, tail = self._elements()
        if tail is not None and not isinstance(tail, nodes.Variable):
            self.report("the tail of a list is a variable or a list", tail.span, "as in [H|T] or [a|[b,c]]")
            tail = None
        return nodes.ListTerm(tuple(items), tail, span=self.span_from(start))

    def _annotations(self) -> nodes.Annotations | None:
        if self.token.kind != "[":
            return None
        start = self.token
        items, tail = self._elements()
        if not items and tail is None:
            return None
        if tail is not None and not isinstance(tail, nodes.Variable):
            self.report("the tail of annotations is a variable", tail.span, "as in p(X)[source(S)|R]")
            tail = None
        return nodes.Annotations(tuple(items), tail, span=self.span_from(start))

    def _elements(self) -> tuple[list[nodes.Term], nodes.Term | None]:
        """The elements and the tail of what stands in brackets; a tail that is a list is spliced in."""
        opener = self.advance()
        items: list[nodes.Term] = []
        tail: nodes.Term | None = None
        self.enter()
        if self.token.kind not in ("]", "|"):
            # Elements bind tighter than |, which begins the tail.
            items.append(self.expression(_AND))
            while self.accept(","):
                items.append(self.expression(_AND))
        if self.accept("|"):
            tail = self.operand()
            if isinstance(tail, nodes.ListTerm):
                items.extend(tail.items)
                tail = tail.tail
        self.leave()
        self.close(opener)
        return items, tail


def _across(left: nodes.Term, right: nodes.Term) -> Span | None:
    """The stretch from the beginning of *left* to the end of *right*."""
    if left.span is None or right.span is None:
        return None
    return left.span.to(right.span)


def _unescape(text: str) -> str:
    r"""The value of a string token: ``\n`` and ``\"`` are converted, every other backslash stays."""
    inner = text[1:-1]
    if "\\" not in inner:
        return inner
    return inner.replace("\\n", "\n").replace('\\"', '"')


def _arity_text(name: str) -> str:
    fewest, most = ARITIES[name]
    if fewest == most:
        return "no argument" if fewest == 0 else f"{fewest} argument{'s' if fewest > 1 else ''}"
    return f"{fewest} or more arguments"
