"""The parser's position in the tokens, and its error reporting."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Final, NoReturn

from jacaros.asl.declaration import Declaration
from jacaros.asl.diagnostics import Diagnostic
from jacaros.asl.lexer import Token
from jacaros.asl.slips import known_slip
from jacaros.asl.source import SourceFile, Span
from jacaros.terms.functions import is_function

MAX_NESTING: Final = 150
"""Maximum nesting of brackets and statements: far deeper than real programs, and safe for the call stack."""

CLOSERS: Final = {"(": ")", "[": "]", "{": "}"}
_MATCHING: Final = {closer: opener for opener, closer in CLOSERS.items()}


_AFTER_TEAR: Final = frozenset(
    {"missing-dot", "missing-semicolon", "unclosed-bracket", "unopened-bracket", "mismatched-bracket"}
)
"""Errors that an unterminated string may cause in the rest of its clause; they are not reported."""

_THESIS = "jason.architecture."
"""Package of the artifact classes in the programs of the JaCaROS thesis."""


class SyntaxPanic(Exception):
    """Raised when the rest of a clause cannot be parsed; the error has been reported."""


@dataclass
class Names:
    """State shared by all files of one program: counters for unique names, and registered functions.

    Attributes:
        functions: the functions that the program registers, with their numbers of arguments.
        known: the functions of the project, with their minimum and maximum numbers of arguments.
        actions: internal actions by name.
    """

    unnamed: Iterator[int]
    labels: Iterator[int]
    local_namespaces: Iterator[int]
    functions: dict[str, int] = field(default_factory=dict)
    known: Mapping[str, tuple[int, int | None]] = field(default_factory=dict)
    actions: Mapping[str, Declaration] = field(default_factory=dict)

    def is_function(self, name: str, arity: int) -> bool:
        """Return whether *name* is an arithmetic function of the language, program or project with that
        *arity*.
        """
        if is_function(name, arity, self.functions):
            return True
        limits = self.known.get(name)
        return limits is not None and limits[0] <= arity and (limits[1] is None or arity <= limits[1])


class Cursor:
    """The tokens of one file and a position in them; collects diagnostics."""

    def __init__(self, file: SourceFile, tokens: list[Token], diagnostics: list[Diagnostic]) -> None:
        self.file = file
        self.tokens = tokens
        self.diagnostics = diagnostics
        self.index = 0
        self.token = tokens[0]
        self.nesting = 0
        self.torn = False
        self._clause_start = 0
        # One error per position is enough: further ones follow from the first and would only confuse.
        self._blamed = {
            (diagnostic.span.line, diagnostic.span.column)
            for diagnostic in diagnostics
            if diagnostic.span is not None and diagnostic.span.file is file
        }

    # positions

    def advance(self) -> Token:
        """Consume and return the current token; the final ``end`` token is never passed."""
        token = self.token
        if token.kind != "end":
            self.index = index = self.index + 1
            self.token = self.tokens[index]
        return token

    def peek(self) -> Token:
        """Return the token after the current one."""
        return self.tokens[self.index + 1]

    def previous(self) -> Token:
        """Return the token before the current one."""
        return self.tokens[max(self.index - 1, 0)]

    def accept(self, kind: str) -> bool:
        """Consume the current token if it is of that *kind*; return whether it was."""
        if self.token.kind != kind:
            return False
        self.advance()
        return True

    def span_of(self, token: Token) -> Span:
        """Return the span of one token."""
        return Span(self.file, token.line, token.column, token.line, token.end)

    def span_from(self, start: Token) -> Span:
        """Return the span from *start* to the last consumed token."""
        last = self.tokens[self.index - 1] if self.index else start
        return Span(self.file, start.line, start.column, last.line, last.end)

    # nesting

    def enter(self) -> None:
        """Enter a bracket or statement; raises SyntaxPanic if they are nested too deeply."""
        self.nesting += 1
        if self.nesting > MAX_NESTING:
            self.fail(
                "nested-too-deeply",
                "nested too deeply",
                help=f"use at most {MAX_NESTING} levels of brackets",
            )

    def leave(self) -> None:
        """Leave a bracket or statement."""
        self.nesting -= 1

    def begin_clause(self) -> None:
        """Start a clause at the outermost level."""
        self.nesting = 0
        self.torn = False
        self._clause_start = self.index

    # reports

    def report(
        self,
        code: str,
        message: str,
        span: Span | None = None,
        help: str | None = None,
        opened: Span | None = None,
    ) -> None:
        """Record an error, unless one is recorded for the same position; parsing continues."""
        if self.torn and code in _AFTER_TEAR:
            return
        span = span or self.span_of(self.token)
        place = (span.line, span.column)
        if place not in self._blamed:
            self._blamed.add(place)
            self.diagnostics.append(Diagnostic("error", message, span, help, code, opened))

    def forgive(self, code: str, message: str, span: Span, help: str | None = None) -> None:
        """Record syntax that Jason rejects but the JaCaROS thesis prints.

        It is a warning in programs that name artifact classes of the thesis, and an error in all others.
        """
        if any(_THESIS in token.text for token in self.tokens):
            self.warn(code, message, span, help)
        else:
            self.report(code, message, span, help)

    def warn(self, code: str, message: str, span: Span, help: str | None = None) -> None:
        """Record a warning."""
        self.diagnostics.append(Diagnostic("warning", message, span, help, code))

    def fail(self, code: str, message: str, span: Span | None = None, help: str | None = None) -> NoReturn:
        """Record an error, unless the lexer has already reported this token, and abandon the statement."""
        if self.token.kind != "error":
            self.report(code, message, span, help)
        raise SyntaxPanic

    def unexpected(self, wanted: str, code: str = "unexpected-token") -> NoReturn:
        """Fail at the current token; *wanted* describes what was expected."""
        token = self.token
        if token.kind == "end":
            self.fail("unexpected-end", f"expected {wanted}, found {self.found()}")
        self.fail_on_slip()
        self.fail(code, f"expected {wanted}, found {self.found()}")

    def found(self) -> str:
        """Describe the current token in a message."""
        return "the end of the file" if self.token.kind == "end" else f"`{self.token.text}`"

    def is_slip(self) -> bool:
        """Return whether the current token is a likely mistake that is known."""
        return known_slip(self.tokens, self.index) is not None

    def fail_on_slip(self) -> None:
        """Fail if the current token is a likely mistake that is known."""
        slip = known_slip(self.tokens, self.index)
        if slip is not None:
            self.fail(slip.code, slip.message, self.span_of(slip.token or self.token), slip.help)

    def close(self, opener: Token) -> None:
        """Consume the bracket that closes *opener*. A bracket of another kind is reported and accepted."""
        closer = CLOSERS[opener.kind]
        token = self.token
        if token.kind == closer:
            self.advance()
            return
        where = f"opened at line {opener.line}, column {opener.column}"
        if token.kind in _MATCHING:
            self.report(
                "mismatched-bracket",
                f"`{opener.kind}` is closed by `{token.kind}`",
                help=f"close it with `{closer}`; it was {where}",
                opened=self.span_of(opener),
            )
            if not self._closes_outer(opener) or self.peek().kind == token.kind:
                self.advance()
            return
        self.fail_on_slip()
        if token.kind != "error":
            self.report(
                "unclosed-bracket",
                f"unclosed `{opener.kind}`: expected `{closer}`, found {self.found()}",
                help=f"close it with `{closer}`; it was {where}",
                opened=self.span_of(opener),
            )
        raise SyntaxPanic

    def _closes_outer(self, opener: Token) -> bool:
        """Return whether this bracket closes one that was opened before *opener* in this clause."""
        wanted = _MATCHING[self.token.kind]
        open_brackets: list[str] = []
        for token in self.tokens[self._clause_start : self.index]:
            if token is opener:
                break
            if token.kind in CLOSERS:
                open_brackets.append(token.kind)
            elif token.kind in _MATCHING and open_brackets:
                open_brackets.pop()
        return wanted in open_brackets

    def unclosed_braces(self) -> int:
        """Return the number of unclosed ``{`` in this clause."""
        kinds = [token.kind for token in self.tokens[self._clause_start : self.index]]
        return kinds.count("{") - kinds.count("}")

    # lookahead

    def after_brackets(self, index: int) -> int:
        """Return the index after the bracket that closes the one at *index* (or the end of the file)."""
        depth = 0
        tokens = self.tokens
        while tokens[index].kind != "end":
            kind = tokens[index].kind
            if kind in CLOSERS:
                depth += 1
            elif kind in _MATCHING:
                depth -= 1
                if depth == 0:
                    return index + 1
            index += 1
        return index

    def after_literal(self, index: int) -> int:
        """Return the index after the literal or variable at *index*, or *index* if there is neither."""
        tokens, start = self.tokens, index
        negated = tokens[index].kind == "~"  # before a namespace, or behind it
        index += negated
        if tokens[index].kind == "::":
            index += 1
        elif tokens[index].kind in ("atom", "variable") and tokens[index + 1].kind == "::":
            index += 2
        if tokens[index].kind == "~" and not negated:
            index += 1
        if tokens[index].kind not in ("atom", "variable"):
            return start
        index += 1
        for bracket in ("(", "["):
            if tokens[index].kind == bracket:
                index = self.after_brackets(index)
        return index

    def at_plan(self, index: int | None = None) -> bool:
        """Return whether a plan begins at *index*.

        A plan begins with a label, with a goal trigger at the start of a line, or with any trigger followed by a
        context, a goal condition or a body. A belief trigger alone looks like a step (``+b(X)``).
        """
        at = self.index if index is None else index
        token = self.tokens[at]
        if token.kind == "@":
            return True
        if token.kind not in ("+", "-", "^"):
            return False
        following = self.tokens[at + 1]
        goal = following.kind in ("!", "?")
        if goal and token.first:
            return not self._spells_unequal(following, at + 1)
        literal = at + 2 if goal else at + 1
        behind = self.after_literal(literal)
        return behind > literal and self.tokens[behind].kind in (":", "<-", "<:")

    def _spells_unequal(self, token: Token, index: int) -> bool:
        return token.kind == "!" and self.tokens[index + 1].kind == "="
