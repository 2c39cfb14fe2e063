"""The place of the parser in the tokens, and how it reports what is wrong there."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Final, NoReturn

from jacaros.asl.declaration import Declaration
from jacaros.asl.diagnostics import Diagnostic
from jacaros.asl.lexer import Token
from jacaros.asl.slips import Slip, known_slip
from jacaros.asl.source import SourceFile, Span
from jacaros.terms.functions import is_function

MAX_NESTING: Final = 150
"""How deep brackets and statements may be nested: far more than people write, and safe for the call stack."""

CLOSERS: Final = {"(": ")", "[": "]", "{": "}"}
_MATCHING: Final = {closer: opener for opener, closer in CLOSERS.items()}


_AFTER_TEAR: Final = frozenset(
    {"missing-dot", "missing-semicolon", "unclosed-bracket", "unopened-bracket", "mismatched-bracket"}
)
"""What need not be wrong in a clause of which a string without an end has taken a piece."""

_THESIS = "jason.architecture."
"""Package of the artifact classes in the programs of the JaCaROS thesis."""


class SyntaxPanic(Exception):
    """The clause cannot be read any further; what is wrong has been reported."""


@dataclass
class Names:
    """What all files of one program share: the numbers given out, and the functions that are registered.

    Attributes:
        functions: those that the program registers, with their numbers of arguments.
        known: those of the project, with their least and greatest numbers of arguments.
        actions: internal actions by name.
    """

    unnamed: Iterator[int]
    labels: Iterator[int]
    local_namespaces: Iterator[int]
    functions: dict[str, int] = field(default_factory=dict)
    known: Mapping[str, tuple[int, int | None]] = field(default_factory=dict)
    actions: Mapping[str, Declaration] = field(default_factory=dict)

    def is_function(self, name: str, arity: int) -> bool:
        """Whether *name* with so many arguments is an arithmetic function: of the language, program or project."""
        if is_function(name, arity, self.functions):
            return True
        limits = self.known.get(name)
        return limits is not None and limits[0] <= arity and (limits[1] is None or arity <= limits[1])


class Cursor:
    """The tokens of one file and a place in them; collects the diagnostics."""

    def __init__(self, file: SourceFile, tokens: list[Token], diagnostics: list[Diagnostic]) -> None:
        self.file = file
        self.tokens = tokens
        self.diagnostics = diagnostics
        self.index = 0
        self.token = tokens[0]
        self.nesting = 0
        self.torn = False
        self._clause_start = 0
        # One error for a place is enough; what follows from it would only confuse.
        self._blamed = {
            (diagnostic.span.line, diagnostic.span.column)
            for diagnostic in diagnostics
            if diagnostic.span is not None and diagnostic.span.file is file
        }

    # places

    def advance(self) -> Token:
        """Take the current token (the last one, of kind ``end``, is never passed)."""
        token = self.token
        if token.kind != "end":
            self.index = index = self.index + 1
            self.token = self.tokens[index]
        return token

    def peek(self) -> Token:
        """The token behind the current one."""
        return self.tokens[self.index + 1]

    def previous(self) -> Token:
        """The token before the current one."""
        return self.tokens[max(self.index - 1, 0)]

    def accept(self, kind: str) -> bool:
        """Take the current token if it is of that *kind*."""
        if self.token.kind != kind:
            return False
        self.advance()
        return True

    def span_of(self, token: Token) -> Span:
        """The place of one token."""
        return Span(self.file, token.line, token.column, token.line, token.end)

    def span_from(self, start: Token) -> Span:
        """The stretch from *start* to the token taken last."""
        last = self.tokens[self.index - 1] if self.index else start
        return Span(self.file, start.line, start.column, last.line, last.end)

    # nesting

    def enter(self) -> None:
        """Go one level deeper into brackets or statements; a clause that is given up does not come back."""
        self.nesting += 1
        if self.nesting > MAX_NESTING:
            self.fail(
                "nested-too-deeply",
                "this is nested too deeply",
                help=f"at most {MAX_NESTING} levels of brackets are read",
            )

    def leave(self) -> None:
        """Come back from one level."""
        self.nesting -= 1

    def begin_clause(self) -> None:
        """A clause begins here, at the outermost level."""
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
        """Record an error, unless there is one for the same place; reading goes on."""
        if self.torn and code in _AFTER_TEAR:
            return
        span = span or self.span_of(self.token)
        place = (span.line, span.column)
        if place not in self._blamed:
            self._blamed.add(place)
            self.diagnostics.append(Diagnostic("error", message, span, help, code, opened))

    def forgive(self, code: str, message: str, span: Span, help: str | None = None) -> None:
        """Record what Jason refuses and the JaCaROS thesis prints: a warning in programs that name the artifact
        classes of the thesis, an error in all others."""
        if any(_THESIS in token.text for token in self.tokens):
            self.warn(code, message, span, help)
        else:
            self.report(code, message, span, help)

    def warn(self, code: str, message: str, span: Span, help: str | None = None) -> None:
        """Record a warning."""
        self.diagnostics.append(Diagnostic("warning", message, span, help, code))

    def fail(self, code: str, message: str, span: Span | None = None, help: str | None = None) -> NoReturn:
        """Record an error, unless the lexer already reported this token, and give up the statement."""
        if self.token.kind != "error":
            self.report(code, message, span, help)
        raise SyntaxPanic

    def unexpected(self, wanted: str, code: str = "unexpected-token") -> NoReturn:
        """The current token does not fit."""
        token = self.token
        if token.kind == "end":
            self.fail("unexpected-end", f"the file ends where {wanted} is expected")
        slip = self.slip()
        if slip is not None:
            self.fail(slip.code, slip.message, self._blame(slip), slip.help)
        self.fail(code, f"{wanted} is expected, not '{token.text}'")

    def slip(self) -> Slip | None:
        """What is probably meant, when the current token does not fit."""
        return known_slip(self.tokens, self.index)

    def _blame(self, slip: Slip) -> Span:
        return self.span_of(slip.token or self.token)

    def close(self, opener: Token) -> None:
        """Take the bracket that closes *opener*.  A wrong bracket is reported and taken for the right one."""
        closer = CLOSERS[opener.kind]
        token = self.token
        if token.kind == closer:
            self.advance()
            return
        where = f"it was opened at line {opener.line}, column {opener.column}"
        if token.kind in _MATCHING:
            self.report(
                "mismatched-bracket",
                f"'{opener.kind}' is closed by '{token.kind}'",
                help=f"{where}; close it with '{closer}'",
                opened=self.span_of(opener),
            )
            if not self._closes_outer(opener) or self.peek().kind == token.kind:
                self.advance()
            return
        found = "the end of the file" if token.kind == "end" else f"'{token.text}'"
        slip = self.slip()
        if slip is not None:
            self.fail(slip.code, slip.message, self._blame(slip), slip.help)
        if token.kind != "error":
            self.report(
                "unclosed-bracket",
                f"'{opener.kind}' is not closed: '{closer}' is expected before {found}",
                help=where,
                opened=self.span_of(opener),
            )
        raise SyntaxPanic

    def _closes_outer(self, opener: Token) -> bool:
        """Whether the bracket here closes one that was opened before *opener* in this clause."""
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
        """How many ``{`` of this clause are open here."""
        kinds = [token.kind for token in self.tokens[self._clause_start : self.index]]
        return kinds.count("{") - kinds.count("}")

    # looking ahead

    def after_brackets(self, index: int) -> int:
        """The index behind the bracket that closes the one at *index* (or of the end of the file)."""
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
        """The index behind the literal or variable at *index*, or *index* itself if there is none."""
        tokens, start = self.tokens, index
        if tokens[index].kind == "::":
            index += 1
        elif tokens[index].kind in ("atom", "variable") and tokens[index + 1].kind == "::":
            index += 2
        if tokens[index].kind == "~":
            index += 1
        if tokens[index].kind not in ("atom", "variable"):
            return start
        index += 1
        for bracket in ("(", "["):
            if tokens[index].kind == bracket:
                index = self.after_brackets(index)
        return index

    def at_plan(self, index: int | None = None) -> bool:
        """Whether a plan begins at *index*: a label, a goal trigger that begins a line, or any trigger with a
        context, a goal condition or a body behind it (a belief trigger alone looks like a step, ``+b(X)``).
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
