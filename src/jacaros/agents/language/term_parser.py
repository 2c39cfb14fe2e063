"""Parse terms and conditions: expressions with their operators, literals, variables, lists and annotations.

Literals get their namespaces here.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Final

from jacaros.agents.language import nodes
from jacaros.agents.language.cursor import Cursor, ProgramNames
from jacaros.agents.language.diagnostics import Diagnostic, SourceFile, Span
from jacaros.agents.language.lexer import Token, tokenize
from jacaros.agents.terms.functions import ARITIES
from jacaros.agents.terms.operators import AND, BINARY, NOT, OR, PREFIX, SUM, Operator
from jacaros.agents.terms.text import unquoted
from jacaros.agents.terms.values import ARITHMETIC, RELATION, number
from jacaros.runtime.files.texts import close_matches, did_you_mean

DEFAULT_NAMESPACE: Final = "default"
THIS_NAMESPACE: Final = "this_ns"
"""The namespace of the module: that of the block, or the one that the module is included into."""

PERFORMATIVES: Final = (
    *("tell", "untell", "achieve", "unachieve", "askOne", "askAll", "askHow"),
    *("tellHow", "untellHow", "signal"),
)
KEYWORDS: Final = {
    *("true", "false", DEFAULT_NAMESPACE, THIS_NAMESPACE, "source", "self", "percept"),
    *("atomic", "breakpoint", "all_unifs", *PERFORMATIVES),
}
"""Names that stay in the default namespace wherever they are written."""


@dataclass
class Namespaces:
    """The current namespace (None: the default one) and the unique names of local namespaces.

    Attributes:
        in_term: the parser is inside an argument. Literals there, also those of plans in braces, stay in the
            default namespace.
    """

    current: str | None = None
    local: dict[str, str] = field(default_factory=dict)
    in_term: bool = False

    def resolve(self, written: str) -> str | None:
        """Return the namespace that *written* names here, resolving ``default`` and ``this_ns``."""
        if written == DEFAULT_NAMESPACE:
            return None
        if written == THIS_NAMESPACE:
            return self.current
        return self.local.get(written, written)

    def of_literal(self, functor: str) -> str | None:
        """Return the namespace of a belief, goal or condition that is written without one."""
        return None if self.in_term or functor in KEYWORDS else self.current


_UNSET: Final = "(unset)"
"""Marks that no namespace is written; compared by identity."""


MAX_CHAIN: Final = 250
"""Maximum number of operators in a row: each adds a level of recursion for code that walks the term."""

_MOST_DIGITS: Final = 400
"""Longer numbers are infinite, as all doubles of their size."""
_NUMERIC: Final = (nodes.Number, nodes.Variable, nodes.Arithmetic, nodes.FunctionCall)


class TermParser(Cursor, ABC):
    """Parse terms and conditions; the plan parser reads what is in braces (plans, bodies, rules).

    *formula* marks a literal as a condition, which belongs to the namespace of the block. Literals that are
    arguments or operands of relations stay in the default namespace.
    """

    def __init__(self, file: SourceFile, names: ProgramNames, diagnostics: list[Diagnostic]) -> None:
        super().__init__(file, tokenize(file, diagnostics.append), diagnostics)
        self.names = names
        self.namespaces = Namespaces()
        # The last condition that got a namespace: undone if it turns out to be an operand of a relation.
        self._placed: nodes.Term | None = None

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

    # literals and variables

    def literal(self, formula: bool = False) -> nodes.Term:
        """Parse a literal, or the internal action or arithmetic function that a name with a dot denotes."""
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
                "prefixed-action",
                f"internal action `{name}` cannot be negated with `~` or put into a namespace",
                self.span_from(start),
                "to ask whether it does not hold, write `not`",
            )
        if self.token.kind == "[":
            self.report(
                "annotated-action",
                f"internal action `{name}` cannot have annotations",
                help="if the `.` ends a plan, put a blank after it"
                if name[0] == "." and start.first
                else None,
            )
            self._annotations()
        span = self.span_from(start)
        if self.names.is_function(name, len(arguments)):
            return nodes.FunctionCall(name, arguments, span=span)
        return nodes.InternalAction(name, arguments, span=span)

    def variable(self, formula: bool = False) -> nodes.Term:
        """Parse a variable, or a literal whose namespace is a variable (``N::p``)."""
        if self.peek().kind == "::":
            return self.literal(formula)
        return self._variable(self.token, _UNSET, False, formula)

    def _variable(
        self, start: Token, namespace: "str | nodes.Variable | None", negated: bool, formula: bool
    ) -> nodes.Variable:
        token = self.advance()
        if self.token.kind == "(" and self.token.line == token.line and self.token.column == token.end:
            name = token.text.lstrip("_")
            self.report(
                "upper-case-functor",
                f"variable `{token.text}` cannot have arguments",
                self.span_of(token),
                f"begin names of beliefs, goals and actions with a lower-case letter: `{name[:1].lower()}{name[1:]}(...)`",
            )
            self._arguments()
        name, unnamed = self._variable_name(token.text)
        annotations = self._annotations()
        if namespace is _UNSET:
            namespace = None
        return nodes.Variable(name, annotations, namespace, negated, unnamed, span=self.span_from(start))

    def _variable_name(self, text: str) -> tuple[str, bool]:
        """Return the name, and whether the variable is unnamed; ``_12Any`` is the variable named ``_12``."""
        if text[0] != "_":
            return text, False
        digits = len(text) - 1 - len(text[1:].lstrip("0123456789"))
        if digits:
            return text[: digits + 1], False
        return f"_{next(self.names.unnamed)}", True

    def _namespace(self) -> "str | nodes.Variable | None":
        """Parse a namespace prefix; return `_UNSET` without one."""
        token = self.token
        if token.kind == "::":
            self.advance()
            return self.namespaces.current
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
            self.forgive(
                "empty-brackets",
                "empty brackets",
                self.span_of(opener),
                "write `p`, not `p()`",
            )
            self.advance()
            return ()
        outside = self._enter_term()
        arguments = [self._named(self.expression())]
        while self.accept(","):
            arguments.append(self._named(self.expression()))
        self._leave_term(outside)
        self.close(opener)
        return tuple(arguments)

    def _named(self, term: nodes.Term) -> nodes.Term:
        """Replace the atom ``this_ns`` by the name of the namespace of the module.

        As in Jason, only where it is an argument or an element, not in ``X = this_ns``.
        """
        if isinstance(term, nodes.Literal) and term.functor == THIS_NAMESPACE and not term.arguments:
            return nodes.replace(term, functor=self.namespaces.current or DEFAULT_NAMESPACE)
        return term

    def _enter_term(self) -> bool:
        """Mark the following tokens as part of a term; return whether they already were."""
        self.enter()
        outside, self.namespaces.in_term = self.namespaces.in_term, True
        return outside

    def _leave_term(self, outside: bool) -> None:
        self.leave()
        self.namespaces.in_term = outside

    def begin_clause(self) -> None:
        """Start a clause at the outermost level."""
        super().begin_clause()
        self.namespaces.in_term = False

    # lists and annotations

    def list_term(self) -> nodes.ListTerm:
        """Parse ``[a, b | T]``."""
        start = self.token
        wanted = "expected a variable or a list as the tail of a list", "write `[H|T]` or `[a|[b,c]]`"
        items, tail = self._elements(self.element, *wanted)
        return nodes.ListTerm(items, tail, span=self.span_from(start))

    def _annotations(self) -> nodes.Annotations | None:
        if self.token.kind != "[":
            return None
        start = self.token
        wanted = "expected a variable as the tail of annotations", "write `p(X)[source(S)|R]`"
        items, tail = self._elements(self._annotation, *wanted)
        if not items and tail is None:
            return None
        return nodes.Annotations(items, tail, span=self.span_from(start))

    def _annotation(self) -> nodes.Term:
        """Parse an annotation: an element, or ``while(Condition)`` of a label."""
        start = self.token
        if start.kind != "while" or self.peek().kind != "(":
            return self.element()
        self.advance()
        return nodes.Literal("while", self._arguments(), span=self.span_from(start))

    def _elements(
        self, element: Callable[[], nodes.Term], wanted: str, help: str
    ) -> tuple[tuple[nodes.Term, ...], nodes.Variable | None]:
        """Parse the elements and the tail of bracketed contents; a tail that is a list is spliced in."""
        opener = self.advance()
        items: list[nodes.Term] = []
        tail: nodes.Term | None = None
        outside = self._enter_term()
        if self.token.kind not in ("]", "|"):
            items.append(self._named(element()))
            while self.accept(","):
                items.append(self._named(element()))
        if self.accept("|"):
            tail = self.operand()
            if isinstance(tail, nodes.ListTerm):
                items.extend(tail.items)
                tail = tail.tail
        self._leave_term(outside)
        self.close(opener)
        if tail is None or isinstance(tail, nodes.Variable):
            return tuple(items), tail
        self.report("wrong-tail", wanted, tail.span, help)
        return tuple(items), None


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
