"""Texts with possible line breaks, and their layout for a given width.

After Wadler's "prettier printer": a group is put on one line if it fits, and otherwise broken at its own breaks.
Comments do not count for the width. A comment at the end of a line is held back until the line ends, and ends it at the
next possible break, so that it can never swallow code.

>>> print(render(Group(row("if (near)", Break(), "{ stop }"))), end="")
if (near) { stop }
"""

from typing import Final, NamedTuple

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
