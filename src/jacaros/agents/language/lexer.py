"""Program text to tokens.

One compiled expression finds all tokens. Wrong characters are reported here and never stop the lexer. An identifier with
letters outside ASCII is passed on as if it were valid. What is unusable (such as an unterminated string) becomes a token
of kind ``error``: there the parser abandons the clause without a further report.

>>> [token.kind for token in tokenize(SourceFile("robot.asl", "at(X) :- near(X)."), print)]
['atom', '(', 'variable', ')', ':-', 'atom', '(', 'variable', ')', '.', 'end', 'end']
"""

import re
from collections.abc import Callable
from typing import Final, NamedTuple

from jacaros.agents.language.diagnostics import Diagnostic, SourceFile, Span, problem
from jacaros.agents.terms.operators import BINARY, WORDS

RESERVED: Final = WORDS | {"true", "false", "if", "else", "elif", "for", "while"}
"""Words that cannot be atoms."""

_OPERATORS: Final = "|".join(
    re.escape(s) for s in sorted(BINARY, key=len, reverse=True) if len(s) > 1 and s not in WORDS
)
_SIGNS: Final = re.escape("".join(each for each in BINARY if len(each) == 1))
# Groups named "open..." match unterminated strings and comments. Blanks before a token belong to its match.
_TOKEN: Final = re.compile(
    rf"""
    [^\S\n]*
    (?: (?P<atom>(?:[a-z]|\.[^\W\d])\w*(?:\.[^\W\d]\w*)*)
      | (?P<comment>//[^\n]*)
      | (?P<long_comment>/\*(?s:.*?)\*/)
      | (?P<open_comment>/\*(?s:.*))
      | (?P<punctuation>[,;(){{}}]|<-|<:|:-|::|\|&\||\|\|\||!!|{_OPERATORS}|\.(?![0-9])
          |[{_SIGNS}\[\]:!?@~^])
      | (?P<variable>[A-Z_]\w*)
      | (?P<lines>\n\s*)
      | (?P<number>[0-9]+(?:\.[0-9]+)?(?:[eE][+-]?[0-9]+)?|\.[0-9]+(?:[eE][+-]?[0-9]+)?)
      | (?P<string>"(?:[^"\\\n]|\\[^\n])*")
      | (?P<quoted>'[^'\n]*')
      | (?P<word>[^\W\d]\w*)
      | (?P<open_string>"[^\n]*)
      | (?P<open_quoted>'[^\n]*)
      | (?P<wrong>\S)
    )
    """,
    re.VERBOSE,
)
_ESCAPES: Final = re.compile(r"""\\[ntbrf\\'"0-7]|\\(?P<wrong>.)""")
"""The escapes that a string may contain; they are converted elsewhere."""
_UNUSUAL: Final = frozenset({"quoted", "word", "open_string", "open_quoted", "open_comment", "wrong"})


_WRONG: Final = {
    "open_string": (
        "unclosed-string",
        "unterminated string",
        r'close it on the same line: "text"; write a line break as `\n`',
    ),
    "open_quoted": ("unclosed-string", "unterminated quoted atom", "close it on the same line: 'an atom'"),
    "open_comment": ("unclosed-comment", "unterminated comment", "end it with `*/`"),
    "\\": ("wrong-operator", r"unexpected `\`", r"write `\==` for 'not equal' and `not` for 'not'"),
}
"""Unusable tokens by their group or text: code, message and help."""


class Token:
    """One token.

    ``kind`` is ``atom``, ``variable``, ``number``, ``string``, ``error`` or ``end``, and otherwise (punctuation and
    reserved words) the text itself. ``end`` is the column after the token; tokens never span lines. ``first`` marks the
    first token of a line.
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


class Comment(NamedTuple):
    """A comment with its marks; ``next_token`` is the index of the token after it."""

    text: str
    line: int
    column: int
    next_token: int


def tokenize(
    file: SourceFile, report: Callable[[Diagnostic], None], comments: list[Comment] | None = None
) -> list[Token]:
    """Return the tokens of *file*, followed by two of kind ``end`` right after the last one.

    If *comments* is given, comments are added to it.
    """
    tokens: list[Token] = []
    append = tokens.append
    line, begin, last_line = 1, 0, 0
    ascii_only = file.text.isascii()
    for found in _TOKEN.finditer(file.text):
        kind = found.lastgroup
        assert kind is not None
        text = found[kind]
        if kind == "punctuation":
            kind = text
        elif kind == "atom":
            if text in RESERVED:
                kind = text
        elif kind in ("lines", "long_comment", "comment"):
            if comments is not None and kind != "lines":
                comments.append(Comment(text, line, found.end() - len(text) - begin + 1, len(tokens)))
            count = text.count("\n")
            if count:
                line += count
                begin = found.end() - len(text) + text.rfind("\n") + 1
            continue
        column = found.end() - len(text) - begin + 1
        if kind == "string" and "\\" in text:
            for escape in _ESCAPES.finditer(text):
                if escape["wrong"]:
                    report(_wrong_escape(file, escape, line, column))
        if kind in _UNUSUAL:
            kind = _unusual(file, kind, text, line, column, report)
        if not ascii_only and kind in ("atom", "variable") and text[0] != "'" and not text.isascii():
            report(_not_ascii(file, text, line, column))
        append(Token(kind, text, line, column, line != last_line))
        last_line = line
    end_line, end_column = (tokens[-1].line, tokens[-1].end) if tokens else (1, 1)
    tokens += [Token("end", "", end_line, end_column, False) for _ in range(2)]
    return tokens


def _unusual(
    file: SourceFile, group: str, text: str, line: int, column: int, report: Callable[[Diagnostic], None]
) -> str:
    """Return the kind of a token of one of the rarer groups, and report what is wrong with it."""
    if group in ("quoted", "word"):
        return "atom"
    code, message, help = _WRONG.get("\\" if text == "\\" else group) or (
        "unknown-character",
        f"unexpected character {text!r}",
        "begin comments with `//`" if text in "#%" else None,
    )
    end = column + (2 if group == "open_comment" else len(text.rstrip()))
    report(problem(code, message, Span(file, line, column, line, end), help))
    return "error"


def _wrong_escape(file: SourceFile, escape: re.Match[str], line: int, column: int) -> Diagnostic:
    begin, end = column + escape.start(), column + escape.end()
    return problem(
        "wrong-escape",
        f"invalid escape `{escape.group()}` in a string",
        Span(file, line, begin, line, end),
        r"only `\n` and `\"` are converted; write a backslash as `\\`",
    )


def _not_ascii(file: SourceFile, lexeme: str, line: int, column: int) -> Diagnostic:
    letter = next(char for char in lexeme if not char.isascii())
    return problem(
        "non-ascii-name",
        f"name `{lexeme}` contains the letter `{letter}`; names consist of the letters a to z, digits and `_`",
        Span(file, line, column, line, column + len(lexeme)),
        f"rename it, or quote it as an atom: '{lexeme}'",
    )
