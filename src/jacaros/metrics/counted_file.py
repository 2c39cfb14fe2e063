"""One source file with what is counted in it, and the counts of a group of files."""

import gzip
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from types import MappingProxyType
from typing import Final

from jacaros.metrics.comments import Stretch

_LEVEL: Final = 9
"""Compression level of gzip, its highest."""

MEASURES: Final[Mapping[str, str]] = MappingProxyType(
    {
        "identifiers": "Identifiers",
        "names": "Identifiers, with beliefs and variables of agents",
        "lines": "Physical lines",
        "code_lines": "Code lines",
        "gzip_bytes": "Bytes compressed by gzip",
        "gzip_code_bytes": "Bytes of code compressed by gzip",
    }
)
"""The fields of `Counts` with their titles, in the order of tables."""


@dataclass(frozen=True)
class Counts:
    """The size of some source files.  docs/reference/metrics.md has the rules.

    Attributes:
        identifiers: distinct names; of agents those of goals, events and operations.
        names: the same, but of agents those of beliefs, variables and labels, too.
        lines: physical lines, blank lines and comments included.
        code_lines: lines without blank lines, comments and docstrings.
        gzip_bytes: size of all files, concatenated and compressed.
        gzip_code_bytes: size of their code lines, compressed together.
        files: number of files.
    """

    identifiers: int = 0
    names: int = 0
    lines: int = 0
    code_lines: int = 0
    gzip_bytes: int = 0
    gzip_code_bytes: int = 0
    files: int = 0

    def __add__(self, other: "Counts") -> "Counts":
        """The sum, as a total of groups; a name in both groups counts twice, as in the thesis."""
        return Counts(*(getattr(self, name) + getattr(other, name) for name in Counts.__dataclass_fields__))


@dataclass(frozen=True)
class CountedFile:
    """A source file.

    Attributes:
        path: of the file.
        data: its content, as it is on the disk.
        text: its content as text, with line feeds as ends of lines.
        comments: its comments and docstrings, in their order.
        identifiers: the names that `Counts.identifiers` counts.
        names: the names that `Counts.names` counts.
    """

    path: Path
    data: bytes = field(repr=False)
    text: str = field(repr=False)
    comments: Sequence[Stretch] = field(default=(), repr=False)
    identifiers: frozenset[str] = frozenset()
    names: frozenset[str] = frozenset()

    @property
    def lines(self) -> int:
        """The number of physical lines; the last one need not end with a line feed."""
        return self.text.count("\n") + (self.text[-1:] not in ("", "\n"))

    @cached_property
    def code(self) -> str:
        """The code lines: the text without comments, docstrings, blank lines and blanks at the ends of lines."""
        pieces: list[str] = []
        at = 0
        for start, stop in self.comments:
            # What stands before and behind a long comment stays on lines of its own.
            pieces += (self.text[at:start], "\n" * self.text.count("\n", start, stop))
            at = stop
        pieces.append(self.text[at:])
        kept = [line.rstrip() for line in "".join(pieces).split("\n")]
        return "".join(f"{line}\n" for line in kept if line)

    @property
    def counts(self) -> Counts:
        """The counts of this file alone."""
        return counts_of([self])


def counts_of(files: Iterable[CountedFile]) -> Counts:
    """Count a group of files.

    A name in several of them counts once, and they are compressed together: it does not matter into how many files a
    program is split.

    Args:
        files: in the order in which they are compressed.
    """
    group = list(files)
    if not group:
        return Counts()
    code = "".join(each.code for each in group)
    return Counts(
        identifiers=len(frozenset[str]().union(*(each.identifiers for each in group))),
        names=len(frozenset[str]().union(*(each.names for each in group))),
        lines=sum(each.lines for each in group),
        code_lines=code.count("\n"),
        gzip_bytes=_compressed(b"".join(each.data for each in group)),
        gzip_code_bytes=_compressed(code.encode()),
        files=len(group),
    )


def _compressed(data: bytes) -> int:
    return len(gzip.compress(data, _LEVEL, mtime=0)) if data else 0
