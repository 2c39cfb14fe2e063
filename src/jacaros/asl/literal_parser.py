"""Literals, variables, lists and annotations, and the namespaces that a file gives them."""

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Final

from jacaros.asl import nodes
from jacaros.asl.cursor import Cursor, Names
from jacaros.asl.diagnostics import Diagnostic
from jacaros.asl.lexer import Token, tokenize
from jacaros.asl.source import SourceFile

KEYWORDS: Final = frozenset(
    {"true", "false", "default", "source", "self", "percept", "atomic", "breakpoint", "all_unifs"}
    | {
        "tell",
        "untell",
        "achieve",
        "unachieve",
        "askOne",
        "askAll",
        "askHow",
        "tellHow",
        "untellHow",
        "signal",
    }
)
"""Names that stay in the default namespace wherever they are written."""


@dataclass
class Namespaces:
    """The namespace in force (None: the default one) and the private names of local namespaces.

    Attributes:
        in_term: what is read is the argument of something; its literals, also those of plans in braces, stay in the
            default namespace.
    """

    current: str | None = None
    local: dict[str, str] = field(default_factory=dict)
    in_term: bool = False

    def resolve(self, written: str) -> str | None:
        """The namespace that *written* means here (``default`` and ``this_ns`` have their meaning)."""
        if written == "default":
            return None
        if written == "this_ns":
            return self.current
        return self.local.get(written, written)

    def of_literal(self, functor: str) -> str | None:
        """The namespace of a belief, goal or condition that is written without one."""
        return None if self.in_term or functor in KEYWORDS else self.current


_UNSET: Final = "(unset)"
"""No namespace is written; compared by identity."""


class LiteralParser(Cursor, ABC):
    """Reads literals; the expressions inside are read by the parser of terms.

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
    def expression(self, loosest: int = 1, formula: bool = False) -> nodes.Term:
        """An expression whose operators bind at least as tightly as *loosest*."""

    @abstractmethod
    def element(self) -> nodes.Term:
        """An element of a list: an expression that ends before ``|``."""

    @abstractmethod
    def operand(self, formula: bool = False) -> nodes.Term:
        """What stands between binary operators."""

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
                "prefixed-action",
                f"'{name}' is an internal action: it can be neither negated by '~' nor put into a namespace",
                self.span_from(start),
                "to ask that it does not hold write 'not'",
            )
        if self.token.kind == "[":
            self.report(
                "annotated-action",
                f"'{name}' is an internal action, which cannot have annotations",
                help="a plan ends with a '.' followed by a blank" if name[0] == "." and start.first else None,
            )
            self._annotations()
        span = self.span_from(start)
        if self.names.is_function(name, len(arguments)):
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
        if self.token.kind == "(" and self.token.line == token.line and self.token.column == token.end:
            name = token.text.lstrip("_")
            self.report(
                "upper-case-functor",
                f"'{token.text}' is a variable and cannot have arguments",
                self.span_of(token),
                f"names of beliefs, goals and actions begin with a lower-case letter: {name[:1].lower()}{name[1:]}(...)",
            )
            self._arguments()
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
                "the brackets are empty",
                self.span_of(opener),
                "without arguments leave them out: p, not p()",
            )
            self.advance()
            return ()
        outside = self._enter_term()
        arguments = [self.expression()]
        while self.accept(","):
            arguments.append(self.expression())
        self._leave_term(outside)
        self.close(opener)
        return tuple(arguments)

    def _enter_term(self) -> bool:
        """What follows is part of a term; returns whether that was so before."""
        self.enter()
        outside, self.namespaces.in_term = self.namespaces.in_term, True
        return outside

    def _leave_term(self, outside: bool) -> None:
        self.leave()
        self.namespaces.in_term = outside

    def begin_clause(self) -> None:
        """A clause begins here, at the outermost level."""
        super().begin_clause()
        self.namespaces.in_term = False

    # lists and annotations

    def list_term(self) -> nodes.ListTerm:
        """``[a, b | T]``."""
        start = self.token
        items, tail = self._elements()
        if tail is not None and not isinstance(tail, nodes.Variable):
            self.report(
                "wrong-tail",
                "the tail of a list is a variable or a list",
                tail.span,
                "as in [H|T] or [a|[b,c]]",
            )
            tail = None
        return nodes.ListTerm(tuple(items), tail, span=self.span_from(start))

    def _annotations(self) -> nodes.Annotations | None:
        if self.token.kind != "[":
            return None
        start = self.token
        items, tail = self._elements(self._annotation)
        if not items and tail is None:
            return None
        if tail is not None and not isinstance(tail, nodes.Variable):
            self.report(
                "wrong-tail", "the tail of annotations is a variable", tail.span, "as in p(X)[source(S)|R]"
            )
            tail = None
        return nodes.Annotations(tuple(items), tail, span=self.span_from(start))

    def _annotation(self) -> nodes.Term:
        """An annotation: an element, or ``while(Condition)`` of a label."""
        start = self.token
        if start.kind != "while" or self.peek().kind != "(":
            return self.element()
        self.advance()
        return nodes.Literal("while", self._arguments(), span=self.span_from(start))

    def _elements(
        self, element: Callable[[], nodes.Term] | None = None
    ) -> tuple[list[nodes.Term], nodes.Term | None]:
        """The elements and the tail of what stands in brackets; a tail that is a list is spliced in."""
        element = element or self.element
        opener = self.advance()
        items: list[nodes.Term] = []
        tail: nodes.Term | None = None
        outside = self._enter_term()
        if self.token.kind not in ("]", "|"):
            items.append(element())
            while self.accept(","):
                items.append(element())
        if self.accept("|"):
            tail = self.operand()
            if isinstance(tail, nodes.ListTerm):
                items.extend(tail.items)
                tail = tail.tail
        self._leave_term(outside)
        self.close(opener)
        return items, tail
