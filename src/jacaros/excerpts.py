"""Excerpts of files in messages: unsafe characters are escaped, and everything has a limited length."""

import re
from typing import Final

WIDTH: Final = 100
"""Maximum number of characters of a line in an excerpt."""

LONGEST: Final = 500
"""Maximum number of characters of a message line."""

MOST: Final = 100
"""Maximum number of messages printed about one file (or one call); the rest is only counted."""

_UNSAFE: Final = re.compile(
    "[\x00-\x08\x0b-\x1f\x7f-\x9f\u061c\u200b-\u200f\u2028-\u202e\u2060-\u206f\ufeff\ufff9-\ufffb\ud800-\udfff]"
)
"""Characters that a terminal obeys or hides: control characters, direction marks, parts of surrogate pairs."""


_OBEYED: Final = re.compile(
    "[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069]|\r(?!\n)"
)
"""Characters that a terminal obeys: control characters without tabs and line ends, and direction marks."""


def visible(text: str) -> str:
    r"""Return *text* with characters that a terminal obeys replaced by escapes such as ``\x1b`` and ``\u202e``.

    JSON without escapes for them stays JSON: it contains none below ``\u007f``.
    """
    return _OBEYED.sub(_escape, text)


def is_worth_a_line(count: int, more: int = 1) -> bool:
    """Return whether a repeated message is printed: it is the 1st, 10th, 100th, … or one of the *more* last ones was."""
    before = count - more
    return not before or len(str(before)) < len(str(count))


def escaped(text: str) -> str:
    r"""Return *text* with unsafe characters replaced by escapes such as ``\x1b`` and ``\u202e``."""
    return _UNSAFE.sub(_escape, text)


def _escape(found: re.Match[str]) -> str:
    code = ord(found.group())
    return f"\\x{code:02x}" if code < 0x20 else f"\\u{code:04x}"


def printable(text: str) -> str:
    """Return a message with unsafe characters escaped and each line cut to `LONGEST` characters."""
    return "\n".join(_cut(line) for line in escaped(text).split("\n"))


def _cut(line: str) -> str:
    return line if len(line) <= LONGEST else f"{line[: LONGEST - 3]}..."


def help_line(text: str) -> str:
    """Return the ``help:`` line of a message."""
    return f"  = help: {printable(text)}"


def marked(line: str, column: int, end: int | None = None) -> tuple[str, str]:
    """Return the part of a line around a place, and the carets below it.

    Args:
        line: of a file, without its end.
        column: where the carets begin, counted from 1.
        end: the column after the carets; one caret if None.
    """
    first = max(0, min(column - 1 - WIDTH // 2, len(line) - WIDTH))
    last = first + WIDTH
    begin = min(column - 1, len(line))
    before = ("..." if first else "") + escaped(line[first:begin])
    meant = escaped(line[begin : min(last, begin + 1 if end is None else end - 1)])
    behind = escaped(line[begin:last]) + ("..." if last < len(line) else "")
    # Tabs are repeated below, so that the carets are aligned at any tab width.
    indent = "".join("\t" if char == "\t" else " " for char in before)
    return before + behind, indent + "^" * max(1, len(meant))
