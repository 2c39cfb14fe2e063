"""Format programs in the project's one style (`jacaros fmt`): blanks and indentation; most line breaks are the author's.

>>> print(format_program("robot.asl", "+!go:near<-move;\\n!stop."), end="")
+!go : near
  <- move;
     !stop.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import groupby
from typing import Final

from jacaros.agents.language import nodes
from jacaros.agents.language.cursor import CLOSERS
from jacaros.agents.language.diagnostics import AslError, SourceFile, problem
from jacaros.agents.language.lexer import Comment, tokenize
from jacaros.agents.language.loader import load_program
from jacaros.agents.language.nodes import Declaration
from jacaros.agents.terms.operators import BINARY
from jacaros.runtime.errors import InternalError

_ALIGNED: Final = 60
"""Comments of consecutive lines are aligned in one column, unless the code of a line is longer than this."""
_COMMENT: Final = "comment"
_BETWEEN: Final = frozenset(BINARY) | {":-", ":", "<-", "<:", "|&|", "|||"}
_OPERANDS: Final = frozenset({"atom", "variable", "number", "string", "true", "false"})
_CONTROL: Final = frozenset({"if", "elif", "else", "while", "for"})
_WORDS: Final = _CONTROL | {"not"}
_CLOSING: Final = frozenset(CLOSERS.values())
_NEVER_FIRST: Final = frozenset({";", ",", ".", ")", "]", "else", "elif"})
"""Tokens that begin a line only after a comment."""
_NEVER_LAST: Final = frozenset({"<-", ":", "<:"})
_TIGHT: Final = frozenset({",", ";", ".", ")", "]"})
_SPACED_BEHIND: Final = _WORDS | {",", ";", ".", "{", "<-"}
_COLUMN_BEHIND: Final = frozenset({":", "<:", ":-", "<-"})
"""Tokens after which further lines are aligned with what follows."""
_PLAN_STARTS: Final = frozenset({"@", "+", "-", "^"})
_LABEL_PARTS: Final = frozenset({"atom", "variable", "::"})
_BODY, _CONDITION, _BLOCK = 2, 4, 3
"""Columns by which bodies, conditions and blocks are indented."""


@dataclass(slots=True)
class _Item:
    """A token or a comment.

    Attributes:
        until: the line on which it ends: for a bracket, that of the closing one; for a clause, that of its dot.
        following: the next token.
        trailing: it is a comment at the end of a line of code.
    """

    kind: str
    text: str
    line: int
    until: int
    following: "_Item | None" = None
    trailing: bool = False

    @property
    def end(self) -> int:
        """The line on which its text ends."""
        return self.line + self.text.count("\n")


def _items(text: str) -> list[_Item]:
    comments: list[Comment] = []
    tokens = tokenize(SourceFile("", text), lambda _: None, comments)[:-2]
    made = [_Item(token.kind, token.text, token.line, token.line) for token in tokens]
    _find_ends(made)
    items: list[_Item] = []
    behind = [*comments[::-1]]
    for index, following in enumerate([*made, None]):
        while behind and behind[-1].next_token <= index:
            items.append(_comment(behind.pop(), items[-1] if items else None, following))
        if following is not None:
            following.following = made[index + 1] if index + 1 < len(made) else None
            items.append(following)
    return items


def _comment(comment: Comment, before: _Item | None, following: _Item | None) -> _Item:
    text = "\n".join(line.rstrip() for line in comment.text.split("\n"))
    made = _Item(_COMMENT, text, comment.line, comment.line, following)
    alone = following is None or following.line > made.end
    made.trailing = alone and before is not None and before.end == comment.line
    return made


def _find_ends(tokens: list[_Item]) -> None:
    """Set where brackets and clauses end."""
    openers: list[_Item] = []
    starts: list[_Item | None] = [None]
    for token in tokens:
        if token.kind in _CLOSING:
            starts.pop()
            opener = openers.pop()
            opener.until = token.line
            if starts[-1] is opener and opener.kind == "{":
                starts[-1] = None
            continue
        start = starts[-1] = starts[-1] or token
        if token.kind in CLOSERS:
            openers.append(token)
            starts.append(None)
        elif token.kind == ".":
            start.until = token.line
            starts[-1] = None


@dataclass(slots=True)
class _Frame:
    """A bracket that is open, or the whole program.

    Attributes:
        opener: its kind; empty for the program.
        base: column of its clauses or steps.
        column: column of the next line; None for that of the next token.
        closer: column of the closing bracket, if it begins a line.
        spans_lines: whether it begins and ends on different lines.
        holds_clauses: whether a ``.`` in it ends a clause.
        ends: what its end is that of: ``step``, ``clause`` or neither.
        broken: whether the steps of the clause have lines of their own.
        at_start: whether a clause begins.
        in_label: whether the label of a plan has begun.
    """

    opener: str = ""
    base: int = 0
    column: int | None = 0
    closer: int = 0
    spans_lines: bool = False
    holds_clauses: bool = False
    ends: str = ""
    broken: bool = False
    at_start: bool = True
    in_label: bool = False

    def begin_clause(self) -> None:
        self.at_start, self.column, self.broken = True, self.base, self.spans_lines


class _Layout:
    """Lays out the items of a program in turn."""

    def __init__(self) -> None:
        self._frames = [_Frame(holds_clauses=True)]
        self._lines: list[tuple[str, str]] = []
        self._line = ""
        self._comments: list[str] = []
        self._last: _Item | None = None
        # What the last token says about the next one: a new line, a blank; a comment requires a new line.
        self._wants_line = self._needs_line = self._wants_blank = self._after_operand = False

    def run(self, items: list[_Item]) -> str:
        for item in items:
            if item.kind == _COMMENT:
                self._put_comment(item)
            else:
                self._put_token(item)
            self._last = item
        self._end_line()
        return _text(self._lines)

    def _put_comment(self, item: _Item) -> None:
        last = self._last
        introduces = last is not None and last.kind == "<-"
        if item.trailing and not introduces:
            self._comments.append(item.text)
        else:
            breaks = last is None or self._needs_line or self._wants_line or item.line > last.end
            if breaks and not introduces:
                self._begin_line(item, self._indent(item.following, comment=True))
            self._write(item.text, blank=True)
            self._wants_line = False
        alone = item.following is None or item.following.line > item.end
        self._needs_line = self._needs_line or alone or "\n" in item.text
        self._wants_blank = True

    def _put_token(self, item: _Item) -> None:
        frame = self._frames[-1]
        if frame.at_start and frame.holds_clauses:
            frame.broken = item.until > item.line
        if frame.in_label and not self._continues_label(item):
            self._end_label(frame)
        if self._breaks(item, frame):
            self._begin_line(item, self._indent(item))
        self._needs_line = self._wants_line = False
        self._write(item.text, self._is_spaced(item, frame))
        self._follow(item, frame)

    # lines

    def _breaks(self, item: _Item, frame: _Frame) -> bool:
        """Return whether a token begins a line."""
        last = self._last
        if last is None or self._needs_line:
            return True
        if item.kind == "<-" and frame.broken:
            return True
        if item.kind in _NEVER_FIRST or last.kind in _NEVER_LAST or (last.kind, item.kind) == ("{", "}"):
            return False
        return (item.kind == "}" and frame.spans_lines) or self._wants_line or item.line > last.end

    def _indent(self, item: _Item | None, comment: bool = False) -> int:
        """Return the column of a line that begins with *item*, or with a comment before it."""
        frame = self._frames[-1]
        kind = "" if item is None else item.kind
        if kind in _CLOSING and not comment:
            return frame.closer
        if kind == "<-":
            return frame.base + _BODY
        if kind in (":", "<:") or frame.column is None:
            return frame.base + _CONDITION
        return frame.column

    def _begin_line(self, item: _Item, column: int) -> None:
        self._end_line()
        if self._last is not None and item.line > self._last.end + 1:
            self._lines.append(("", ""))
        self._line = " " * column

    def _end_line(self) -> None:
        if self._line.strip() or self._comments:
            self._lines.append((self._line.rstrip(), _joined(self._comments)))
        self._line, self._comments = "", []

    def _write(self, text: str, blank: bool) -> None:
        if blank and self._line.strip():
            self._line += " "
        frame = self._frames[-1]
        if frame.column is None:
            frame.column = len(self._line)
        *whole, last = text.split("\n")
        if whole:
            self._lines.append((self._line + "\n".join(whole), ""))
            self._line = ""
        self._line += last

    # tokens

    def _is_spaced(self, item: _Item, frame: _Frame) -> bool:
        """Return whether a blank separates a token from the one before it."""
        kind = item.kind
        if kind in _TIGHT or (kind == "|" and frame.opener == "["):
            return False
        if kind in _OPERANDS or kind in _WORDS or kind == "{":
            return self._wants_blank or self._after_operand
        return self._wants_blank or kind == "}" or self._is_between(kind, frame)

    def _is_between(self, kind: str, frame: _Frame) -> bool:
        """Return whether a token is an operator between two operands."""
        tail = kind == "|" and frame.opener == "["
        return kind in _BETWEEN and self._after_operand and not tail

    def _follow(self, item: _Item, frame: _Frame) -> None:
        """Note what a token means for those after it."""
        kind = item.kind
        self._wants_blank = kind in _SPACED_BEHIND or self._is_between(kind, frame)
        self._after_operand = kind in _OPERANDS or kind in _CLOSING
        starts, frame.at_start = frame.at_start, False
        if starts and frame.holds_clauses:
            frame.column = frame.base + _CONDITION
        if kind in CLOSERS:
            self._open(item, frame, starts and frame.holds_clauses)
        elif kind in _CLOSING:
            self._close(frame)
        elif kind in _COLUMN_BEHIND:
            frame.column = None
        elif kind == ";":
            self._wants_line = frame.broken
        elif kind == "@":
            frame.in_label = True
        elif kind == "." and frame.holds_clauses:
            frame.begin_clause()
            self._wants_line = not _holds_plans(item.following)

    def _open(self, item: _Item, frame: _Frame, starts: bool) -> None:
        spans_lines = item.until > item.line
        behind, step = len(self._line), frame.column or 0
        if item.kind != "{":
            inner = _Frame(item.kind, behind, behind, behind - 1, spans_lines)
        elif starts:
            base, plans = frame.base + _BODY, _holds_plans(item)
            spans_lines = spans_lines and plans  # a directive continues on its line
            inner = _Frame("{", base, base, frame.base, spans_lines, plans, "clause")
        else:
            control = self._last is not None and self._last.kind in (")", "else")
            base = step + _BLOCK
            inner = _Frame("{", base, base, step, spans_lines, ends="step" if control else "")
        inner.broken = spans_lines
        self._wants_line = spans_lines and item.kind == "{"
        self._frames.append(inner)

    def _close(self, frame: _Frame) -> None:
        self._frames.pop()
        if frame.ends:
            self._wants_blank, self._after_operand = True, False
        if frame.ends == "clause":
            self._frames[-1].begin_clause()
            self._wants_line = True

    def _continues_label(self, item: _Item) -> bool:
        bracket = item.kind == "[" or (item.kind == "(" and self._last is not None and self._last.kind != "@")
        return bracket or item.kind in _LABEL_PARTS

    def _end_label(self, frame: _Frame) -> None:
        frame.in_label, frame.at_start, frame.column = False, True, frame.base
        self._wants_blank, self._after_operand = True, False
        self._wants_line = frame.broken


def _holds_plans(opener: _Item | None) -> bool:
    """Return whether a token opens the braces of sub-plans."""
    following = opener.following if opener is not None and opener.kind == "{" else None
    return following is not None and following.kind in _PLAN_STARTS


def _text(lines: list[tuple[str, str]]) -> str:
    """Join lines of code with the comments at their ends."""
    written: list[str] = []
    for aligned, group in groupby(lines, _is_aligned):
        rows = list(group)
        column = max(len(code) for code, _ in rows) if aligned else 0
        for code, comment in rows:
            written.append(f"{code.ljust(column)}  {comment}" if code and comment else code or comment)
    return "\n".join(written) + "\n" if written else ""


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


_MOST_ROUNDS: Final = 4


def format_program(name: str, text: str, actions: Mapping[str, Declaration] | None = None) -> str:
    """Format the program *text*; tokens and comments are kept.

    Included files are not read.

    Args:
        name: the file name in diagnostics.
        text: the AgentSpeak source.
        actions: the internal actions, as for `load_program`.

    Raises:
        AslError: the program has errors.
        InternalError: formatting would change the meaning of the program.
    """
    meaning = _meaning(name, text, actions)
    try:
        result = _laid_out(text)
        for _ in range(_MOST_ROUNDS):
            # A comment that has moved to the end of another line may have to move once more.
            again = _laid_out(result)
            if again == result:
                break
            result = again
    except RecursionError:
        wrong = problem("nested-too-deeply", f"{name} is nested too deeply to be formatted", None)
        raise AslError([wrong]) from None
    if _substance(result) != _substance(text) or _meaning(name, result, actions) != meaning:
        raise InternalError(f"formatting would change the meaning of {name}")
    return result


def _laid_out(text: str) -> str:
    return _Layout().run(_items(text))


def _meaning(name: str, text: str, actions: Mapping[str, Declaration] | None) -> nodes.Program:
    return load_program(name, text, lambda path, _: (f"{path} in {name}", ""), actions=actions)[0]


def _substance(text: str) -> tuple[list[tuple[str, str]], list[str]]:
    """Return the tokens of a text, and the sorted words of its comments: formatting may join two comments."""
    comments: list[Comment] = []
    tokens = tokenize(SourceFile("", text), lambda _: None, comments)
    words = sorted(word for comment in comments for word in comment.text.split())
    return [(token.kind, token.text) for token in tokens], words
