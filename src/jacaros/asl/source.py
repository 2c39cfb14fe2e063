r"""Source files and positions in them.

>>> file = SourceFile("robot.asl", "at(home).\nat(dock).")
>>> file.lines[1]
'at(dock).'
"""

from dataclasses import dataclass, field
from functools import cached_property
from typing import Final, NamedTuple

TEXT: Final = "<string>"
"""The name of a text that is not in a file."""


@dataclass(frozen=True)
class SourceFile:
    """The text of one file; ``name`` is what diagnostics show (a path, or `TEXT`)."""

    name: str
    text: str = field(repr=False)

    @cached_property
    def lines(self) -> tuple[str, ...]:
        """The lines without their ends; only a line feed (optionally after a carriage return) ends a line."""
        return tuple(line.removesuffix("\r") for line in self.text.split("\n"))


class Span(NamedTuple):
    """A range of a source file: lines and columns count from 1, the end column is exclusive.

    A named tuple because a program has thousands of them, and these are created three times as fast as instances of a
    frozen dataclass.
    """

    file: SourceFile
    line: int
    column: int
    end_line: int
    end_column: int

    def to(self, other: "Span") -> "Span":
        """Return the range from the beginning of this one to the end of *other*."""
        return Span(self.file, self.line, self.column, other.end_line, other.end_column)
