"""Tokens of project files, and a cursor over them."""

import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Final, NoReturn

from jacaros.agents.language.diagnostics import Diagnostic, SourceFile, Span
from jacaros.agents.terms.text import unquoted

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
class ProjectToken:
    """A token of a project file.

    Attributes:
        kind: ``word``, ``string``, ``number``, ``quoted``, ``end``, or the sign itself.
        start, stop: offsets in the text.
        first: whether it is the first token of its line.
    """

    kind: str
    text: str
    line: int
    column: int
    start: int
    stop: int
    first: bool

    def __str__(self) -> str:
        return (
            "end of file" if self.kind == "end" else self.text if self.kind == "string" else f"`{self.text}`"
        )


class ProjectPanic(Exception):
    """Abandon a declaration after an error that has been reported."""


class UnclosedPanic(ProjectPanic):
    """Abandon the enclosing blocks, too: a bracket is not closed."""


class ProjectCursor:
    """A position in the tokens of one project file. Collects diagnostics."""

    def __init__(self, file: SourceFile, diagnostics: list[Diagnostic]) -> None:
        self.file = file
        self.diagnostics = diagnostics
        self.tokens = _tokenize(file, self.report)
        self.index = 0
        self._depth = 0

    @property
    def token(self) -> ProjectToken:
        return self.tokens[self.index]

    def peek(self, further: int = 1) -> ProjectToken:
        """Return the token *further* positions ahead."""
        return self.tokens[min(self.index + further, len(self.tokens) - 1)]

    def before(self) -> ProjectToken:
        """Return the token before the current one."""
        return self.tokens[self.index - 1]

    def advance(self) -> ProjectToken:
        """Consume the current token and return it. The ``end`` token is never consumed."""
        token = self.token
        if token.kind != "end":
            self.index += 1
        return token

    def accept(self, text: str) -> bool:
        """Consume the current token if it is this sign or word. Return whether it was."""
        if self.token.text != text or self.token.kind in ("string", "end"):
            return False
        self.advance()
        return True

    def expect(self, text: str, help: str | None = None) -> ProjectToken:
        """Consume this sign or word, or fail."""
        token = self.token
        if not self.accept(text):
            self.fail(f"expected `{text}`, found {token}", help=help)
        return token

    def take(self, what: str, *kinds: str, help: str | None = None) -> ProjectToken:
        """Consume a token of one of these kinds, or fail. *what* says in messages what it is."""
        if self.token.kind not in kinds:
            self.fail(f"expected {what}, found {self.token}", help=help)
        return self.advance()

    def name(self, what: str) -> ProjectToken:
        """Consume a name, or fail."""
        return self.take(what, "word")

    def lower_name(self, what: str) -> ProjectToken:
        """Consume a name. Report one that does not begin with a lower-case letter."""
        token = self.name(what)
        if not token.text[0].islower():
            first = token.text[0].lower() + token.text[1:]
            self.report(
                f"{what} must begin with a lower-case letter", self.span_of(token), f"write `{first}`"
            )
        return token

    def span_of(self, token: ProjectToken) -> Span:
        return Span(self.file, token.line, token.column, token.line, token.column + len(token.text))

    def report(self, message: str, span: Span | None = None, help: str | None = None) -> None:
        """Report an error and continue."""
        self.diagnostics.append(Diagnostic("error", message, span or self.span_of(self.token), help))

    def warn(self, message: str, span: Span, help: str | None = None) -> None:
        """Report a declaration that has no effect."""
        self.diagnostics.append(Diagnostic("warning", message, span, help))

    def fail(self, message: str, span: Span | None = None, help: str | None = None) -> NoReturn:
        """Report an error and abandon the declaration."""
        self.report(message, span, help)
        raise ProjectPanic

    def fail_unclosed(self, opener: ProjectToken, help: str | None = None) -> NoReturn:
        """Report a bracket that is not closed."""
        self.report(f"`{opener.kind}` is not closed", self.span_of(opener), help)
        raise UnclosedPanic

    @contextmanager
    def nested(self) -> Iterator[None]:
        """Enter a nested value. Fail beyond the maximum depth."""
        if self._depth >= _DEEPEST:
            self.fail(f"nested too deeply: at most {_DEEPEST} levels are supported")
        self._depth += 1
        try:
            yield
        finally:
            self._depth -= 1

    def number(self, token: ProjectToken) -> int | float:
        """Return the value of a number token."""
        if token.text.lstrip("-").isdigit():
            if len(token.text) > _LONGEST:
                self.fail(f"number too long: at most {_LONGEST} digits are supported", self.span_of(token))
            return int(token.text)
        return float(token.text)

    def at_key(self) -> bool:
        """Return whether ``key:`` comes next."""
        return self.token.kind == "word" and self.peek().kind == ":"

    def raw(self, ends: Callable[[], bool]) -> str:
        """Return the text up to where *ends* holds outside brackets, or to a closing bracket that is not opened in it."""
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
        """Skip to the token after the matching closing bracket."""
        opener = self.advance()
        depth = 1
        while depth:
            token = self.advance()
            if token.kind == "end":
                self.fail_unclosed(opener)
            depth += (token.kind in OPENERS) - (token.kind in OPENERS.values())


def text_of(token: ProjectToken) -> str:
    """Return the content of a string, or the text of any other token."""
    if token.kind != "string":
        return token.text
    return unquoted(token.text)


def _tokenize(file: SourceFile, report: Callable[[str, Span], None]) -> list[ProjectToken]:
    tokens: list[ProjectToken] = []
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
            what = "unterminated string" if text[0] == '"' else f"unexpected `{text[0]}`"
            what = "unterminated comment" if kind == "open_comment" else what
            report(what, Span(file, line, column, line, column + len(text.splitlines()[0].rstrip())))
            continue
        tokens.append(
            ProjectToken(text if kind == "sign" else kind, text, line, column, start, stop, line != last_line)
        )
        last_line = line
    end = (tokens[-1].line, tokens[-1].column + len(tokens[-1].text)) if tokens else (1, 1)
    tokens.append(ProjectToken("end", "", *end, len(file.text), len(file.text), False))
    return tokens
