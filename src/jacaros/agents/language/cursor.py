"""The parser's position in the tokens, and its error reporting.

>>> is_slip_of("improt", "import"), is_slip_of("export", "import")
(True, False)
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Final, NamedTuple, NoReturn

from jacaros.agents.language.diagnostics import Diagnostic, SourceFile, Span, fix
from jacaros.agents.language.lexer import RESERVED, Token
from jacaros.agents.language.nodes import Declaration, Section
from jacaros.agents.terms.functions import is_function
from jacaros.agents.terms.operators import WORDS, symbols_of
from jacaros.agents.terms.values import ARITHMETIC
from jacaros.runtime.files.texts import did_you_mean

# Similarity of words, and mistakes known from other languages, for better messages than "expected X, found Y".


_FUSED: Final = {
    "&&": "write one `&` for 'and', one `|` for 'or'",
    "||": "write one `&` for 'and', one `|` for 'or'",
    "=<": "write `<=`",
    "=>": "write >=",
    "->": "begin the body of a plan with `<-`",
    "!=": r"write `\==` for 'not equal'",
    "!==": r"write `\==` for 'not equal'",
    "~=": r"write `\==` for 'not equal'",
    "<>": r"write `\==` for 'not equal'",
    ":=": "bind a variable with `=`, as in `X = 3`",
    "=:=": "write `==` for 'equal'",
    "===": "write `==` for 'equal'",
    "+=": "variables keep their value: write `Y = X + 1`, or change a belief with `-+b(Y)`",
    "-=": "variables keep their value: write `Y = X - 1`, or change a belief with `-+b(Y)`",
    "*=": "variables keep their value: write `Y = X * 2`",
    "/=": "variables keep their value: write `Y = X / 2`",
}
"""Operators of other languages, which the lexer reads as several tokens."""

_SIGNS: Final = {"and": "&", "or": "|"}
_WORDS: Final = {
    "and": "write `&` for 'and'",
    "or": "write `|` for 'or'",
    "is": "bind a variable with `=`, as in `X = Y + 1`",
    "in": "find elements of a list with `.member`, as in `for (.member(X, L)) { steps }`",
    "then": "put the steps in braces: `if (condition) { steps }`",
    "do": "put the steps in braces: `while (condition) { steps }`",
    "elsif": "write `elif (condition) { steps }`",
    "elseif": "write `elif (condition) { steps }`",
}
"""Keywords of other languages."""

_PYTHON: Final = frozenset({"class", "def", "from", "import"})
_CONTROL: Final = ("if", "while", "for", "elif")
_ENDS_OPERAND: Final = frozenset({"atom", "variable", "number", "string", ")", "]", "}"})
_BEGINS_OPERAND: Final = frozenset({"atom", "variable", "number", "string", "(", "[", "~", "-"})


class Slip(NamedTuple):
    """A likely mistake; ``token`` is the one at fault, None for the current one."""

    code: str
    message: str
    help: str
    token: Token | None = None


_START: Final = Token("end", "", 0, 0, False)
"""Stands before the first token."""


def known_slip(tokens: Sequence[Token], index: int) -> Slip | None:
    """Return the likely mistake where the token at *index* does not fit, if it is a known one."""
    before = tokens[index - 1] if index else _START
    return (
        _misspelt(tokens, index, before)
        or _bare_goal(tokens, index)
        or _by_kind(tokens, index, before)
        or _counting(tokens, index)
        or _fused(tokens, index)
        or _missing_blank(tokens[index], before)
    )


def _bare_goal(tokens: Sequence[Token], index: int) -> Slip | None:
    """``!start <- steps.``: a plan without the `+` of its trigger."""
    if tokens[index].kind not in ("<-", ":"):
        return None
    start = next((at for at in range(index, 0, -1) if tokens[at - 1].kind == "."), 0)
    if tokens[start].kind not in ("!", "?") or tokens[start + 1].kind != "atom":
        return None
    goal = f"{tokens[start].kind}{tokens[start + 1].text}"
    help = fix(f"write `+{goal}`", f"+{tokens[start].kind}")
    return Slip("missing-trigger", f"`{goal}` is a goal, not the trigger of a plan", help, tokens[start])


def _by_kind(tokens: Sequence[Token], index: int, before: Token) -> Slip | None:
    """``f"at {X}"``, ``a and b``, ``def go(): pass``, ``if (c) { a else { b }``, ``p :- q & !``, and reserved words."""
    token = tokens[index]
    text = token.text
    match token.kind:
        case "string" if _joined(before, token) and before.text.lower() in ("f", "r", "b", "u"):
            help = 'write values between strings, as in `.print("at ", X)`, or join them with `.concat("at ", X, Text)`'
            return Slip(
                "foreign-word", f"strings have no prefix such as `{before.text}` in Python", help, before
            )
        case "atom" if text in _WORDS and before.kind in _ENDS_OPERAND:
            help = _WORDS[text]
            if text in _SIGNS:
                help = fix(help, _SIGNS[text])
            return Slip("foreign-word", f"unknown keyword `{text}`", help)
        case "atom" | "variable" if before.text in _PYTHON and (
            index < 2 or tokens[index - 2].kind in (".", "}")
        ):
            help = "this is an agent program; put Python code into a .py file, such as artifacts.py"
            return Slip("foreign-word", f"Python keyword `{before.text}` in an agent program", help, before)
        case "else" | "elif" if (opener := _open_block(tokens[:index])) is not None:
            help = f"close the block that was opened at line {opener.line}, column {opener.column}"
            return Slip("unclosed-bracket", f"missing `}}` before `{text}`", help)
        case kind if kind in RESERVED:
            help = fix(f"quote it as an atom: '{text}'", f"'{text}'")
            return Slip("reserved-word", f"reserved word `{text}` used as a name", help)
        case "!" if before.kind in ("&", ":-"):
            help = "a plan takes the first solution of its context; give rules conditions that exclude each other"
            return Slip("wrong-operator", "unknown operator `!` (cut)", help)
    return None


def _open_block(tokens: Sequence[Token]) -> Token | None:
    """Return the ``{`` of this clause that is still open."""
    depth = 0
    for token in reversed(tokens):
        depth += (token.kind == "}") - (token.kind == "{")
        if depth < 0 or token.kind == ".":
            return token if depth < 0 else None
    return None


def _fused(tokens: Sequence[Token], index: int) -> Slip | None:
    """Find the longest run of adjacent signs around *index* that is an operator of another language."""
    for length in (3, 2, 1):
        for start in range(max(index - length + 1, 0), index + 1):
            run = tokens[start : start + length]
            text = "".join(token.text for token in run)
            if text in _FUSED and len(run) == length and all(map(_joined, run, run[1:])):
                return Slip("wrong-operator", f"unknown operator `{text}`", _FUSED[text])
    return None


def _joined(one: Token, other: Token) -> bool:
    """Return whether nothing is between two tokens."""
    return one.line == other.line and one.end == other.column


def _counting(tokens: Sequence[Token], index: int) -> Slip | None:
    """``X++``."""
    run = tokens[max(index - 3, 0) : index]
    if len(run) < 3 or run[0].kind != "variable" or run[1].kind not in ("+", "-"):
        return None
    if run[2].kind != run[1].kind or run[1].end != run[2].column:
        return None
    sign = run[1].kind
    help = f"variables keep their value: write `Y = X {sign} 1`, or change a belief with `-+b(Y)`"
    return Slip("wrong-operator", f"unknown operator `{sign}{sign}`", help, run[1])


def _missing_blank(token: Token, before: Token) -> Slip | None:
    """``p.q``: the final dot of a clause and the next word, read as one."""
    is_word = token.kind == "atom" and token.text.startswith(".")
    if not is_word or not _joined(before, token) or before.kind not in (")", "]", "atom"):
        return None
    help = fix("put a blank or a line end after the final `.`", f". {token.text[1:]}")
    return Slip("missing-blank", f"`{token.text}` is read as one word", help)


def _misspelt(tokens: Sequence[Token], index: int, before: Token) -> Slip | None:
    token, behind = tokens[index], tokens[min(index + 1, len(tokens) - 1)]
    if token.kind == "{":
        word = tokens[max(_opening(tokens, index - 1) - 1, 0)] if before.kind == ")" else before
        return _meant(word, _CONTROL if before.kind == ")" else ("else",))
    if before.kind == "atom" and token.kind in ("atom", "variable", "~") and before.line == token.line:
        slip = _meant(before, ("not",))
        if slip is not None:
            return slip
    between = before.kind in _ENDS_OPERAND and behind.kind in _BEGINS_OPERAND and behind.line == token.line
    if token.kind != "atom" or not between:
        return None
    return _meant(token, [word for word in symbols_of(ARITHMETIC) if word in WORDS])


def _meant(word: Token, wanted: Sequence[str]) -> Slip | None:
    if word.kind != "atom":
        return None
    for each in wanted:
        if is_slip_of(word.text, each):
            return Slip("misspelt-word", f"unexpected `{word.text}`", did_you_mean([each]), word)
    return None


def _opening(tokens: Sequence[Token], index: int) -> int:
    """Return the index of the bracket that the ``)`` at *index* closes."""
    depth = 0
    while index > 0:
        depth += (tokens[index].kind == ")") - (tokens[index].kind == "(")
        if depth == 0:
            break
        index -= 1
    return index


MOST_ASKED: Final = 25
"""Mistakes of one kind for which a similar word is searched: comparing words is slow."""


def is_slip_of(written: str, meant: str) -> bool:
    """Return whether *written* is *meant* with one letter added, missing, wrong or swapped (not *meant* itself)."""
    if written == meant or abs(len(written) - len(meant)) > 1:
        return False
    at = next(
        (i for i, (one, two) in enumerate(zip(written, meant, strict=False)) if one != two),
        min(len(written), len(meant)),
    )
    rest, wanted = written[at:], meant[at:]
    return (
        rest[1:] == wanted[1:]
        or rest[1:] == wanted
        or rest == wanted[1:]
        or (rest[:2] == wanted[:2][::-1] and rest[2:] == wanted[2:])
    )


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
class ProgramNames:
    """State shared by all files of one program: counters for unique names, and registered functions.

    Attributes:
        functions: the functions that the program registers, with their numbers of arguments.
        known: the functions of the project, with their minimum and maximum numbers of arguments.
        actions: internal actions by name.
        library: the clauses of library files that have been parsed; programs that are read with the same names share them.
    """

    unnamed: Iterator[int]
    labels: Iterator[int]
    local_namespaces: Iterator[int]
    functions: dict[str, int] = field(default_factory=dict)
    known: Mapping[str, tuple[int, int | None]] = field(default_factory=dict)
    actions: Mapping[str, Declaration] = field(default_factory=dict)
    library: dict[str, Section] = field(default_factory=dict)

    def for_program(self) -> "ProgramNames":
        """Return the names of a further program: the same, but for the functions that it registers."""
        return replace(self, functions={})

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

    def behind(self, token: Token) -> Span:
        """Return the empty range after a token, where an editor can insert what is missing."""
        return Span(self.file, token.line, token.end, token.line, token.end)

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
                help=fix(f"close it with `{closer}`; it was {where}", closer),
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
                help=fix(f"close it with `{closer}`; it was {where}", closer, self.behind(self.previous())),
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
