"""Texts with possible line breaks, and their layout for a given width.

After Wadler's "prettier printer": a group is put on one line if it fits, and otherwise broken at its own breaks.
Comments do not count for the width. A comment at the end of a line is held back until the line ends, and ends it at the
next possible break, so that it can never swallow code.

>>> print(render(Group(row("if (near)", Break(), "{ stop }"))), end="")
if (near) { stop }
"""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Final, NamedTuple

from jacaros.agents.language.cursor import CLOSERS
from jacaros.agents.language.diagnostics import SourceFile
from jacaros.agents.language.lexer import Comment, Token, tokenize
from jacaros.agents.terms.operators import BINARY, symbols_of
from jacaros.agents.terms.values import LOGIC

WIDTH: Final = 100
_ALIGNED: Final = 60
"""Comments of consecutive lines are aligned in one column, unless the code of a line is longer than this."""


class Text(NamedTuple):
    """Characters without a line break."""

    text: str


class Break(NamedTuple):
    """A possible line break: *flat* is the text without the break; None for a mandatory break.

    ``blank`` asks for a blank line there.
    """

    flat: str | None = " "
    blank: bool = False


class Row(NamedTuple):
    """Parts in sequence."""

    parts: "tuple[Document, ...]"


class Group(NamedTuple):
    """On one line, if it fits."""

    content: "Document"


class Nest(NamedTuple):
    """Indents new lines: by *by* columns, or to the present column if it is None."""

    by: int | None
    content: "Document"


class LineEnd(NamedTuple):
    """A comment for the end of the line."""

    comment: str


class OwnLine(NamedTuple):
    """A comment on its own line, if it is at the beginning of one."""

    comment: str
    blank_behind: bool = False


Document = Text | Break | Row | Group | Nest | LineEnd | OwnLine
HARD: Final = Break(None)
NOTHING: Final = Row(())


def row(*parts: "Document | str") -> Row:
    """Return the parts in sequence; strings are texts."""
    return Row(tuple(Text(part) if isinstance(part, str) else part for part in parts))


def render(document: Document) -> str:
    """Return the document as lines."""
    return _Printer().run(document)


class _Printer:
    def __init__(self) -> None:
        self._lines: list[tuple[str, str]] = []
        self._line = ""
        self._indent = 0
        self._fresh = True
        self._kept: list[str] = []

    def run(self, document: Document) -> str:
        stack: list[tuple[int, bool, Document]] = [(0, False, document)]
        while stack:
            indent, flat, item = stack.pop()
            if isinstance(item, Text):
                self._write(item.text)
            elif isinstance(item, Row):
                stack.extend((indent, flat, part) for part in reversed(item.parts))
            elif isinstance(item, Nest):
                column = self._column() if item.by is None else indent + item.by
                stack.append((column, flat, item.content))
            elif isinstance(item, Group):
                stack.append((indent, flat or self._fits(item.content, stack), item.content))
            elif isinstance(item, Break):
                self._break(item, indent, flat)
            elif isinstance(item, LineEnd):
                self._kept.append(item.comment)
            elif self._fresh:
                self._write(item.comment)
                self._end_line(indent)
                if item.blank_behind:
                    self._lines.append(("", ""))
            else:
                self._kept.append(item.comment)
        self._end_line(0)
        return self._text()

    def _column(self) -> int:
        return self._indent if self._fresh else len(self._line)

    def _write(self, text: str) -> None:
        if self._fresh and text:
            self._line = " " * self._indent
            self._fresh = False
        self._line += text

    def _break(self, item: Break, indent: int, flat: bool) -> None:
        if item.flat is not None and flat and not self._kept:
            if not self._fresh:
                self._line += item.flat
            return
        self._end_line(indent)
        if item.blank and self._lines and self._lines[-1] != ("", ""):
            self._lines.append(("", ""))

    def _end_line(self, indent: int) -> None:
        if not self._fresh or self._kept:
            self._lines.append((self._line.rstrip(), _joined(self._kept)))
        self._line, self._kept, self._fresh, self._indent = "", [], True, indent

    def _fits(self, content: Document, rest: list[tuple[int, bool, Document]]) -> bool:
        """Return whether *content*, and the text after it up to the next possible break, fits here."""
        left = WIDTH - self._column()
        at = len(rest)
        stack: list[tuple[bool, Document]] = [(True, content)]
        while left >= 0:
            if not stack:
                if at == 0:
                    return True
                at -= 1
                stack.append((rest[at][1], rest[at][2]))
            flat, item = stack.pop()
            if isinstance(item, Text):
                left -= len(item.text)
            elif isinstance(item, Row):
                stack.extend((flat, part) for part in reversed(item.parts))
            elif isinstance(item, Nest | Group):
                stack.append((flat, item.content))
            elif isinstance(item, Break):
                if not flat:
                    return True
                if item.flat is None:
                    return False
                left -= len(item.flat)
            elif flat:
                # A comment inside ends a line.
                return False
        return False

    def _text(self) -> str:
        lines: list[str] = []
        at = 0
        while at < len(self._lines):
            behind = at
            while behind < len(self._lines) and _is_aligned(self._lines[behind]):
                behind += 1
            column = max((len(code) for code, _ in self._lines[at:behind]), default=0)
            lines += [f"{code.ljust(column)}  {comment}" for code, comment in self._lines[at:behind]]
            if behind == at:
                code, comment = self._lines[at]
                lines.append(f"{code}  {comment}" if code and comment else code or comment)
                behind += 1
            at = behind
        while lines and not lines[-1]:
            lines.pop()
        return "\n".join(lines) + "\n" if lines else ""


def _joined(comments: list[str]) -> str:
    """Join comments for the end of one line; a block comment cannot follow a line comment."""
    text = ""
    for comment in comments:
        swallowed = "\n" in comment and "//" in text.rpartition("\n")[2]
        text += ("\n" if swallowed else "  " if text else "") + comment
    return text


def _is_aligned(line: tuple[str, str]) -> bool:
    code, comment = line
    return 0 < len(code) <= _ALIGNED and bool(comment) and "\n" not in comment


# Tokens with their comments, and the layout of terms and conditions.


@dataclass(slots=True)
class Remark:
    """A comment before a token; ``blank``: there is a blank line before it."""

    text: str
    own_line: bool
    blank: bool


@dataclass(slots=True)
class Piece:
    """A token with the comments before it, and those after it at the end of its line.

    ``blank``: there is a blank line before it, or before its first comment.
    """

    token: Token
    blank: bool
    before: list[Remark] = field(default_factory=list)
    behind: list[str] = field(default_factory=list)
    blank_behind_remarks: bool = False

    @property
    def kind(self) -> str:
        """The kind of the token."""
        return self.token.kind

    @property
    def text(self) -> str:
        """The text of the token."""
        return self.token.text


def pieces_of(file: SourceFile) -> list[Piece]:
    """Return the pieces of a file; the last one is of kind ``end`` and holds the comments at the end."""
    comments: list[Comment] = []
    tokens = tokenize(file, lambda _: None, comments)[:-1]
    pieces: list[Piece] = []
    at = 0
    last_line = 0
    for index, token in enumerate(tokens):
        piece = Piece(token, False)
        following = None if token.kind == "end" else token.line
        while at < len(comments) and comments[at].next_token <= index:
            comment = comments[at]
            at += 1
            end_line = comment.line + comment.text.count("\n")
            blank = comment.line > last_line + 1 and last_line > 0
            if pieces and not piece.before and comment.line == last_line and following != end_line:
                pieces[-1].behind.append(_clean(comment.text))
            else:
                own = following != end_line or "\n" in comment.text
                piece.before.append(Remark(_clean(comment.text), own, blank))
            last_line = end_line
        blank = token.line > last_line + 1 and last_line > 0 and token.kind != "end"
        piece.blank = piece.before[0].blank if piece.before else blank
        piece.blank_behind_remarks = bool(piece.before) and blank
        last_line = max(last_line, token.line)
        pieces.append(piece)
    return pieces


def _clean(comment: str) -> str:
    return "\n".join(line.rstrip() for line in comment.split("\n"))


_BINARY: Final = frozenset(BINARY) | {":-", ":", "<-", "<:", "|&|", "|||"}
_OPERANDS: Final = frozenset({"atom", "variable", "number", "string", "true", "false"})
_CONNECTIVES: Final = tuple(symbols_of(LOGIC))
_CLOSING: Final = frozenset(CLOSERS.values())


class ExpressionLayout(ABC):
    """Lays out stretches of pieces that are terms or conditions."""

    def __init__(self, pieces: Sequence[Piece]) -> None:
        self.pieces = pieces
        self.closer = _matching(pieces)
        self.opener = {closer: opener for opener, closer in self.closer.items()}

    @abstractmethod
    def braces(self, opener: int) -> Document:
        """Lay out the contents of the braces that open at *opener*."""

    @abstractmethod
    def group(self, begin: int, end: int) -> Document:
        """Lay out steps in round brackets."""

    # pieces

    def piece(self, index: int) -> Document:
        """Lay out one token with its comments."""
        piece = self.pieces[index]
        if not piece.before and not piece.behind:
            return Text(piece.text)
        return row(self.remarks(index), piece.text, self.line_end(index))

    def remarks(self, index: int) -> Document:
        """Lay out the comments before a token."""
        piece = self.pieces[index]
        parts: list[Document | str] = []
        for at, remark in enumerate(piece.before):
            if remark.own_line:
                following = piece.before[at + 1 : at + 2]
                blank = following[0].blank if following else piece.blank_behind_remarks
                parts.append(OwnLine(remark.text, blank))
            else:
                parts.append(f"{remark.text} ")
        return row(*parts) if parts else NOTHING

    def hoisted(self, index: int) -> Document:
        """Lay out the comments before a token, to be put before the group that begins with it."""
        remarks = self.remarks(index)
        self.pieces[index].before.clear()
        return remarks

    def line_end(self, index: int) -> Document:
        """Lay out the comments after a token at the end of its line."""
        behind = self.pieces[index].behind
        return Row(tuple(LineEnd(comment) for comment in behind)) if behind else NOTHING

    def split(self, begin: int, end: int, *kinds: str) -> list[int]:
        """Return the indices of tokens of these kinds outside brackets."""
        found = []
        at = begin
        while at < end:
            if self.pieces[at].kind in kinds:
                found.append(at)
            at = self.closer.get(at, at) + 1
        return found

    def find(self, begin: int, end: int, kind: str) -> int:
        """Return the index of the first token of this kind outside brackets, or *end*."""
        at = begin
        while at < end and self.pieces[at].kind != kind:
            at = self.closer.get(at, at) + 1
        return min(at, end)

    def on_one_line(self, begin: int, end: int) -> bool:
        """Return whether the pieces are on one line of the source."""
        return begin >= end or self.pieces[begin].token.line == self.pieces[end - 1].token.line

    # expressions

    def formula(self, begin: int, end: int) -> Document:
        """Lay out a condition; if it is too long, it is broken after its ``|`` and ``&``."""
        return self._chain(begin, end, _CONNECTIVES)

    def _chain(self, begin: int, end: int, operators: Sequence[str]) -> Document:
        if not operators:
            return self.plain(begin, end)
        places = self.split(begin, end, operators[0])
        if not places:
            return self._chain(begin, end, operators[1:])
        parts: list[Document | str] = []
        for place in places:
            parts += [self._chain(begin, place, operators[1:]), " ", self.piece(place), Break()]
            begin = place + 1
        parts.append(self._chain(begin, end, operators[1:]))
        return Group(Nest(None, row(*parts)))

    def plain(self, begin: int, end: int) -> Document:
        """Lay out tokens and brackets with the usual blanks between them."""
        parts: list[Document | str] = []
        operand_next = True
        at = begin
        while at < end:
            kind = self.pieces[at].kind
            if kind in CLOSERS:
                if not operand_next and kind == "{":
                    parts.append(" ")
                parts.append(self._bracket(at, call=not operand_next))
                operand_next = False
                at = self.closer[at] + 1
                continue
            if kind in _OPERANDS:
                parts += [self.piece(at)] if operand_next else [" ", self.piece(at)]
                operand_next = False
            elif kind == "not":
                parts += [self.piece(at), " "]
                operand_next = True
            elif kind in _BINARY and not operand_next:
                parts += [" ", self.piece(at), Break() if kind in ("|&|", "|||") else " "]
                operand_next = True
            else:
                # Prefixes, '::' and dots.
                parts.append(self.piece(at))
                operand_next = kind not in (".", ";", ",")
            at += 1
        return row(*parts)

    def _bracket(self, opener: int, call: bool) -> Document:
        kind = self.pieces[opener].kind
        closer = self.closer[opener]
        if kind == "{":
            return self.braces(opener)
        if kind == "(" and not call and self.split(opener + 1, closer, ";"):
            return row(self.piece(opener), self.group(opener + 1, closer), self.piece(closer))
        return row(self.piece(opener), self._items(opener + 1, closer, kind), self.piece(closer))

    def _items(self, begin: int, end: int, kind: str) -> Document:
        """Lay out bracketed contents, separated by ``,`` (and the ``|`` of a tail); as many per line as fit."""
        places = self.split(begin, end, ",", "|") if kind == "[" else self.split(begin, end, ",")
        if not places:
            return Nest(None, self.formula(begin, end))
        parts: list[Document] = []
        between: Document = NOTHING
        following: Document = NOTHING
        for place in [*places, end]:
            item: Document = self.formula(begin, place)
            if place < end:
                tail = self.pieces[place].kind == "|"
                item = row(item, self.piece(place))
                following = Break("") if tail else Break()
            parts.append(Group(row(between, item)))
            between, begin = following, place + 1
        return Nest(None, Row(tuple(parts)))


def _matching(pieces: Sequence[Piece]) -> dict[int, int]:
    """Return the closing bracket of each opening one."""
    open_brackets: list[int] = []
    found: dict[int, int] = {}
    for index, piece in enumerate(pieces):
        if piece.kind in CLOSERS:
            open_brackets.append(index)
        elif piece.kind in _CLOSING:
            found[open_brackets.pop()] = index
    return found
