"""Semantic tokens: what each word of a program is, from its tokens alone, so that a text with errors has colours too."""

from collections.abc import Iterator, Sequence
from typing import Final, NamedTuple

from lsprotocol import types

from jacaros.agents.language.diagnostics import SourceFile
from jacaros.agents.language.lexer import Comment, Token, tokenize
from jacaros.editors.lsp.positions import Positions

_KINDS: Final = (
    *("comment", "string", "number", "variable", "keyword", "macro", "namespace", "decorator"),
    *("event", "property", "method", "function", "enumMember"),
)
"""Goals are events, beliefs properties, operations methods, internal actions functions, and other atoms enumMembers."""
_MODIFIERS: Final = ("defaultLibrary",)
LEGEND: Final = types.SemanticTokensLegend(list(_KINDS), list(_MODIFIERS))
_WORDS: Final = frozenset({"not", "div", "mod", "true", "false", "if", "else", "elif", "for", "while"})
_DIRECTIVES: Final = frozenset(
    {"include", "namespace", "begin", "end", "offer", "register_function", "plugin"}
)
_PLAIN: Final = {"string": "string", "number": "number", "variable": "variable"}
_GOALS: Final = frozenset({"!", "!!"})
_STEPS: Final = frozenset({"<-", ";", "|&|", "|||"})
_GROUP: Final = "group"
"""A bracket around a part of a condition."""
_TERMS: Final = frozenset({"atom", "variable", ")", "]"})


class _Coloured(NamedTuple):
    line: int
    column: int
    text: str
    kind: str
    is_standard: bool = False


def colours(file: SourceFile, positions: Positions) -> list[int]:
    """Return the semantic tokens of a program, encoded as in the protocol."""
    data: list[int] = []
    line = column = 0
    for each in sorted(_coloured(file)):
        start = positions.to_client(each.line, each.column)
        end = positions.to_client(each.line, each.column + len(each.text))
        data += [
            start.line - line,
            start.character - (column if start.line == line else 0),
            end.character - start.character,
            _KINDS.index(each.kind),
            int(each.is_standard),
        ]
        line, column = start.line, start.character
    return data


def _coloured(file: SourceFile) -> Iterator[_Coloured]:
    comments: list[Comment] = []
    tokens = tokenize(file, lambda _: None, comments)
    for comment in comments:
        for number, text in enumerate(comment.text.split("\n")):
            column = comment.column if not number else 1
            if text.strip():
                yield _Coloured(comment.line + number, column, text.rstrip("\r"), "comment")
    yield from _Words(tokens).coloured()


class _Words:
    """Follows the tokens of a program through clauses and brackets."""

    def __init__(self, tokens: Sequence[Token]) -> None:
        self._tokens = tokens
        self._brackets: list[str] = []
        """The open brackets: ``(`` of arguments, ``{``, ``[`` of a list, ``@`` of annotations, `_GROUP`."""
        self._in_body = False

    def coloured(self) -> Iterator[_Coloured]:
        """Yield the words with their kinds."""
        for at, token in enumerate(self._tokens):
            kind = self._kind(at, token)
            if kind:
                is_standard = kind == "function" and token.text.startswith(".")
                yield _Coloured(token.line, token.column, token.text, kind, is_standard)
            self._follow(at, token)

    def _follow(self, at: int, token: Token) -> None:
        before = self._tokens[at - 1] if at else None
        touches = before is not None and before.kind in _TERMS and before.end == token.column
        if token.kind == "(":
            self._brackets.append("(" if touches else _GROUP)
        elif token.kind == "{":
            self._brackets.append("{")
        elif token.kind == "[":
            self._brackets.append("@" if touches else "[")
        elif token.kind in (")", "}", "]"):
            if self._brackets:
                self._brackets.pop()
        elif token.kind == "<-":
            self._in_body = True
        elif token.kind == "." and self._tokens[at + 1].first:
            self._in_body = False
            self._brackets = [each for each in self._brackets if each == "{"]

    def _kind(self, at: int, token: Token) -> str:
        if token.kind in _PLAIN:
            return _PLAIN[token.kind]
        if token.kind in _WORDS:
            return "keyword"
        if token.kind != "atom":
            return ""
        before = self._tokens[at - 1].kind if at else "."
        if self._tokens[at + 1].kind == "::":
            return "namespace"
        if token.text in _DIRECTIVES and before == "{":
            return "macro"
        if before == "@" or (self._brackets and self._brackets[-1] == "@"):
            return "decorator"
        if "." in token.text:
            return "function"
        return self._kind_of_literal(at, before)

    def _kind_of_literal(self, at: int, before: str) -> str:
        if before == "::":
            before = self._tokens[at - 3].kind if at >= 3 else "."
        if before in _GOALS:
            return "event"
        if self._brackets and self._brackets[-1] in ("(", "["):
            return "enumMember" if self._tokens[at + 1].kind != "(" else ""
        if self._in_body and (before in _STEPS or before in ("{", "}")):
            return "method"
        return "property"
