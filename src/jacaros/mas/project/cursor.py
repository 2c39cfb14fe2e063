"""Tokens of project files, and a place in them."""

import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Final, NoReturn

from jacaros.asl.diagnostics import Diagnostic
from jacaros.asl.source import SourceFile, Span
from jacaros.terms.text import unquoted

_TOKEN: Final = re.compile(
    r"""
    [^\S\n]*
    (?: (?P<lines>\n\s*)
      | (?P<comment>//[^\n]*|/\*(?s:.*?)\*/)
      | (?P<open_comment>/\*(?s:.*))
      | (?P<string>"(?:[^"\\\n]|\\[^\n])*")
      | (?P<number>-?[0-9]+(?:\.[0-9]+)?(?:[eE][+-]?[0-9]+)?(?![\w.]))
      | (?P<word>(?:[\w$.]|/(?![/*]))(?:[\w$.]|-(?=\w)|/(?![/*]))*)
      | (?P<quoted>'[^'\n]*')
      | (?P<sign>::|[^\w\s"])
      | (?P<wrong>\S[^\n]*)
    )
    """,
    re.VERBOSE,
)
OPENERS: Final = {"(": ")", "[": "]", "{": "}"}
_DEEPEST: Final = 50
_LONGEST: Final = 1000


@dataclass(frozen=True, slots=True)
class Token:
    """``kind`` is ``word``, ``string``, ``number``, ``quoted``, ``end``, or the sign itself.

    ``start`` and ``stop`` are offsets in the text; ``first`` tells the first token of a line.
    """

    kind: str
    text: str
    line: int
    column: int
    start: int
    stop: int
    first: bool

    def __str__(self) -> str:
        """The token as messages show it."""
        return (
            "the end of the file"
            if self.kind == "end"
            else self.text
            if self.kind == "string"
            else f"'{self.text}'"
        )


class ProjectPanic(Exception):
    """The declaration cannot be read any further; what is wrong has been reported."""


class UnclosedPanic(ProjectPanic):
    """A bracket is not closed: the blocks around it cannot be read any further either."""


class ProjectCursor:
    """The tokens of one project file and a place in them; collects the diagnostics."""

    def __init__(self, file: SourceFile, diagnostics: list[Diagnostic]) -> None:
        self.file = file
        self.diagnostics = diagnostics
        self.tokens = _tokenize(file, self.report)
        self.index = 0
        self._depth = 0

    @property
    def token(self) -> Token:
        """The current token."""
        return self.tokens[self.index]

    def peek(self, further: int = 1) -> Token:
        """The token behind the current one, or further on."""
        return self.tokens[min(self.index + further, len(self.tokens) - 1)]

    def before(self) -> Token:
        """The token that was taken last."""
        return self.tokens[self.index - 1]

    def advance(self) -> Token:
        """Take the current token; the one of kind ``end`` is never passed."""
        token = self.token
        if token.kind != "end":
            self.index += 1
        return token

    def accept(self, text: str) -> bool:
        """Take the current token if it is this sign or word."""
        if self.token.text != text or self.token.kind in ("string", "end"):
            return False
        self.advance()
        return True

    def expect(self, text: str, help: str | None = None) -> Token:
        """Take this sign or word."""
        token = self.token
        if not self.accept(text):
            self.fail(f"'{text}' is expected, not {token}", help=help)
        return token

    def name(self, what: str) -> Token:
        """Take a name."""
        if self.token.kind != "word":
            self.fail(f"{what} is expected, not {self.token}")
        return self.advance()

    def lower_name(self, what: str) -> Token:
        """Take a name, which begins with a lower-case letter."""
        token = self.name(what)
        if not token.text[0].islower():
            first = token.text[0].lower() + token.text[1:]
            self.report(f"{what} begins with a lower-case letter", self.span_of(token), f"write {first}")
        return token

    def span_of(self, token: Token) -> Span:
        """The place of one token."""
        return Span(self.file, token.line, token.column, token.line, token.column + len(token.text))

    def report(self, message: str, span: Span | None = None, help: str | None = None) -> None:
        """Record an error; reading goes on."""
        self.diagnostics.append(Diagnostic("error", message, span or self.span_of(self.token), help))

    def warn(self, message: str, span: Span, help: str | None = None) -> None:
        """Record something that is read and has no effect."""
        self.diagnostics.append(Diagnostic("warning", message, span, help))

    def fail(self, message: str, span: Span | None = None, help: str | None = None) -> NoReturn:
        """Record an error and give up the declaration."""
        self.report(message, span, help)
        raise ProjectPanic

    def fail_unclosed(self, opener: Token, help: str | None = None) -> NoReturn:
        """Blame a bracket that is not closed."""
        self.report(f"'{opener.kind}' is not closed", self.span_of(opener), help)
        raise UnclosedPanic

    @contextmanager
    def nested(self) -> Iterator[None]:
        """Read something inside of something of its kind, as deep as people write it."""
        if self._depth >= _DEEPEST:
            self.fail("this is nested too deeply")
        self._depth += 1
        try:
            yield
        finally:
            self._depth -= 1

    def number(self, token: Token) -> int | float:
        """The value of a number."""
        if token.text.lstrip("-").isdigit():
            if len(token.text) > _LONGEST:
                self.fail("the number has too many digits", self.span_of(token))
            return int(token.text)
        return float(token.text)

    def at_key(self) -> bool:
        """Whether ``key:`` stands here."""
        return self.token.kind == "word" and self.peek().kind == ":"

    def raw(self, ends: Callable[[], bool]) -> str:
        """The text up to where *ends* holds outside brackets, or a bracket closes that was opened before."""
        start = stop = self.token.start
        closers: list[str] = []
        while self.token.kind != "end":
            kind = self.token.kind
            if kind in OPENERS.values():
                if not closers or closers.pop() != kind:
                    break
            elif not closers and ends():
                break
            elif kind in OPENERS:
                closers.append(OPENERS[kind])
            stop = self.advance().stop
        return self.file.text[start:stop]

    def skip_block(self) -> None:
        """Behind the bracket that closes the one here."""
        opener = self.advance()
        depth = 1
        while depth:
            token = self.advance()
            if token.kind == "end":
                self.fail_unclosed(opener)
            depth += (token.kind in OPENERS) - (token.kind in OPENERS.values())


def text_of(token: Token) -> str:
    """The content of a string, the text of any other token."""
    if token.kind != "string":
        return token.text
    return unquoted(token.text)


def _tokenize(file: SourceFile, report: Callable[[str, Span], None]) -> list[Token]:
    tokens: list[Token] = []
    line, begin, last_line = 1, 0, 0
    for found in _TOKEN.finditer(file.text):
        kind = found.lastgroup
        assert kind is not None
        text = found[kind]
        stop = found.end()
        start = stop - len(text)
        column = start - begin + 1
        if kind in ("lines", "comment"):
            if "\n" in text:
                line += text.count("\n")
                begin = start + text.rfind("\n") + 1
            continue
        if kind in ("wrong", "open_comment"):
            what = (
                "the string does not end on its line"
                if text[0] == '"'
                else f"'{text[0]}' does not belong here"
            )
            what = "the comment is not closed" if kind == "open_comment" else what
            report(what, Span(file, line, column, line, column + len(text.splitlines()[0].rstrip())))
            continue
        tokens.append(
            Token(text if kind == "sign" else kind, text, line, column, start, stop, line != last_line)
        )
        last_line = line
    end = (tokens[-1].line, tokens[-1].column + len(tokens[-1].text)) if tokens else (1, 1)
    tokens.append(Token("end", "", *end, len(file.text), len(file.text), False))
    return tokens
