"""Program text to tokens.

One compiled expression finds all tokens.  Wrong characters are reported here and never stop the lexer: an
identifier with letters outside ASCII is handed on as if it were right, and what cannot be used at all (a string
without an end) becomes a token of kind ``error``, at which the parser gives up the clause without a second report.
"""

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

from jacaros.asl.diagnostics import Diagnostic
from jacaros.asl.source import SourceFile, Span

RESERVED: Final = frozenset({"true", "false", "not", "div", "mod", "if", "else", "elif", "for", "while"})
"""Words that can never be atoms."""

_TOKEN: Final = re.compile(
    r"""
      (?P<blank>\s+)
    | (?P<atom>(?:[a-z]|\.[^\W\d])\w*(?:\.[^\W\d]\w*)*)
    | (?P<punctuation><-|<:|<=|>=|=\.\.|==|\\==|:-|::|\*\*|\|&\||\|\|\||!!|//|/\*|[-+*(){}\[\],;:!?&|=<>@~^]
        |\.(?![0-9])|/)
    | (?P<variable>[A-Z_]\w*)
    | (?P<number>[0-9]+(?:\.[0-9]+)?(?:[eE][+-]?[0-9]+)?|\.[0-9]+(?:[eE][+-]?[0-9]+)?)
    | (?P<string>"(?:[^"\\\n]|\\[^\n])*")
    | (?P<quoted>'[^'\n]*')
    | (?P<word>[^\W\d]\w*)
    | (?P<wrong>.)
    """,
    re.VERBOSE,
)
_LINE_END: Final = re.compile(r"\n|\Z")


class Token:
    """One token.

    ``kind`` is ``atom``, ``variable``, ``number``, ``string``, ``error`` or ``end``, and otherwise (punctuation
    and reserved words) the text itself.  ``end`` is the column behind the token; tokens never span lines.
    ``first`` tells whether the token is the first one of its line.
    """

    __slots__ = ("column", "end", "first", "kind", "line", "text")

    def __init__(self, kind: str, text: str, line: int, column: int, first: bool) -> None:
        self.kind = kind
        self.text = text
        self.line = line
        self.column = column
        self.end = column + len(text)
        self.first = first

    def __repr__(self) -> str:
        return f"Token({self.kind!r}, {self.text!r}, {self.line}:{self.column})"


@dataclass
class _Place:
    """Where the lexer is: the current line, and the offset at which that line begins."""

    line: int = 1
    begin: int = 0
    token_line: int = 0

    def advance_over(self, text: str, offset: int) -> None:
        """Take note of the line ends in *text*, which begins at *offset*."""
        count = text.count("\n")
        if count:
            self.line += count
            self.begin = offset + text.rfind("\n") + 1


def tokenize(file: SourceFile, report: Callable[[Diagnostic], None]) -> list[Token]:
    """The tokens of *file*, closed by one of kind ``end`` that stands right behind the last of the others."""
    text = file.text
    match = _TOKEN.match
    place = _Place()
    tokens: list[Token] = []
    position, length = 0, len(text)
    while position < length:
        found = match(text, position)
        assert found is not None  # the last alternative takes any character
        group, lexeme = found.lastgroup, found.group()
        start, position = position, found.end()
        if group == "blank":
            place.advance_over(lexeme, start)
            continue
        if lexeme == "//":
            line_end = _LINE_END.search(text, position)
            position = line_end.start() if line_end else length
            continue
        if lexeme == "/*":
            position = _skip_comment(file, start, place, report)
            continue
        column = start - place.begin + 1
        kind = _kind(group, lexeme)
        if kind == "error":
            position = _report_wrong(file, start, place, report)
        elif not lexeme.isascii() and group not in ("string", "quoted"):
            report(_not_ascii(file, lexeme, place.line, column))
        if kind:
            tokens.append(Token(kind, lexeme, place.line, column, place.line != place.token_line))
            place.token_line = place.line
    tokens.append(_end_token(tokens))
    return tokens


def _kind(group: str | None, lexeme: str) -> str:
    if group == "atom":
        return lexeme if lexeme in RESERVED else "atom"
    if group == "punctuation":
        return lexeme
    if group in ("quoted", "word"):
        return "atom"
    return "error" if group == "wrong" else group or ""


def _end_token(tokens: list[Token]) -> Token:
    if not tokens:
        return Token("end", "", 1, 1, True)
    return Token("end", "", tokens[-1].line, tokens[-1].end, False)


def _skip_comment(file: SourceFile, start: int, place: _Place, report: Callable[[Diagnostic], None]) -> int:
    """Behind the ``/* */`` comment that begins at *start*."""
    close = file.text.find("*/", start + 2)
    if close < 0:
        column = start - place.begin + 1
        span = Span(file, place.line, column, place.line, column + 2)
        report(Diagnostic("error", "the comment is not closed", span, "end it with */"))
        return len(file.text)
    place.advance_over(file.text[start:close], start)
    return close + 2


def _report_wrong(file: SourceFile, start: int, place: _Place, report: Callable[[Diagnostic], None]) -> int:
    """Report the wrong character at *start*; where to go on."""
    text, column = file.text, start - place.begin + 1
    char = text[start]
    end = start + 1
    if char in "\"'":
        line_end = _LINE_END.search(text, start)
        end = line_end.start() if line_end else len(text)
        what, example = ("string", '"text"') if char == '"' else ("quoted atom", "'an atom'")
        message = f"the {what} does not end on its line"
        hint = f"close it: {example}" + (r"; a line break inside is written \n" if char == '"' else "")
    elif char == "\\":
        message, hint = "'\\' does not begin anything", r"'not equal' is written \==, 'not' is written not"
    else:
        message, hint = f"the character {char!r} does not belong to the language", None
    span = Span(file, place.line, column, place.line, column + len(text[start:end].rstrip()))
    report(Diagnostic("error", message, span, hint))
    return end


def _not_ascii(file: SourceFile, lexeme: str, line: int, column: int) -> Diagnostic:
    letter = next(char for char in lexeme if not char.isascii())
    return Diagnostic(
        "error",
        f"'{lexeme}' holds the letter '{letter}'; names are made of the letters a to z, digits and '_'",
        Span(file, line, column, line, column + len(lexeme)),
        f"rename it, or put it between single quotes to make it an atom: '{lexeme}'",
    )
