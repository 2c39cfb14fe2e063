"""Text of files in messages: what would confuse a terminal is escaped, and everything has a bounded length."""

import re
from typing import Final

WIDTH: Final = 100
"""Characters of a line that an excerpt shows."""

LONGEST: Final = 500
"""Characters of one line of a message."""

MOST: Final = 100
"""Messages about one file (or one call) that are printed; of all others only the number."""

_UNSAFE: Final = re.compile(
    "[\x00-\x08\x0b-\x1f\x7f-\x9f\u061c\u200b-\u200f\u2028-\u202e\u2060-\u206f\ufeff\ufff9-\ufffb\ud800-\udfff]"
)
"""Characters that a terminal obeys or does not show: control characters, marks of direction, parts of surrogate pairs."""


def escaped(text: str) -> str:
    r"""Return *text* with ``\x1b``, ``\u202e`` and the like in place of characters that are not safe to print."""
    return _UNSAFE.sub(_escape, text)


def _escape(found: re.Match[str]) -> str:
    code = ord(found.group())
    return f"\\x{code:02x}" if code < 0x100 else f"\\u{code:04x}"


def printable(text: str) -> str:
    """Return a message with unsafe characters escaped and each of its lines cut to `LONGEST` characters."""
    return "\n".join(_cut(line) for line in escaped(text).split("\n"))


def _cut(line: str) -> str:
    return line if len(line) <= LONGEST else f"{line[: LONGEST - 3]}..."


def help_line(text: str) -> str:
    """Return the line below a message that says what to do about it."""
    return f"  = help: {printable(text)}"


def marked(line: str, column: int, end: int | None = None) -> tuple[str, str]:
    """Return the part of a line around a place, and the carets below it.

    Args:
        line: of a file, without its end.
        column: where the carets begin, counted from 1.
        end: the column behind them; one caret if None.
    """
    first = max(0, min(column - 1 - WIDTH // 2, len(line) - WIDTH))
    last = first + WIDTH
    begin = min(column - 1, len(line))
    before = ("..." if first else "") + escaped(line[first:begin])
    meant = escaped(line[begin : min(last, begin + 1 if end is None else end - 1)])
    behind = escaped(line[begin:last]) + ("..." if last < len(line) else "")
    # Tabs are repeated below, so that the carets are under the same stretch at any width of a tab.
    indent = "".join("\t" if char == "\t" else " " for char in before)
    return before + behind, indent + "^" * max(1, len(meant))
