"""Source files with their counts, and the programs that consist of them."""

import gzip
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, fields
from enum import StrEnum
from functools import cached_property
from pathlib import Path
from types import MappingProxyType
from typing import Final

Stretch = tuple[int, int]
"""A part of a text: the offset of its first character, and the offset after its last one."""

_LEVEL: Final = 9
"""Compression level of gzip (the highest)."""

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
"""Fields of `Counts` with their titles, in the order of tables."""


@dataclass(frozen=True)
class Counts:
    """The size of source files, by the rules in docs/reference/metrics.md.

    Attributes:
        identifiers: number of distinct names; for agents, names of goals, events and operations.
        names: the same, but for agents also names of beliefs, variables and labels.
        lines: physical lines, including blank lines and comments.
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
        """Return the sum, as a total of groups; a name in both groups counts twice, as in the thesis."""
        return Counts(*(getattr(self, each.name) + getattr(other, each.name) for each in fields(self)))


@dataclass(frozen=True)
class CountedFile:
    """A source file.

    Attributes:
        path: path of the file.
        data: content as bytes.
        text: content as text, with line feeds as line ends.
        comments: comments and docstrings, in order; a docstring of several literals may have comments in it.
        identifiers: names counted by `Counts.identifiers`.
        names: names counted by `Counts.names`.
    """

    path: Path
    data: bytes = field(repr=False)
    text: str = field(repr=False)
    comments: Sequence[Stretch] = field(default=(), repr=False)
    identifiers: frozenset[str] = frozenset()
    names: frozenset[str] = frozenset()

    @property
    def lines(self) -> int:
        """Number of physical lines; the last one need not end with a line feed."""
        return self.text.count("\n") + (self.text[-1:] not in ("", "\n"))

    @cached_property
    def code(self) -> str:
        """The code lines: the text without comments, docstrings, blank lines and trailing blanks."""
        pieces: list[str] = []
        at = 0
        for start, stop in self.comments:
            # Code before and after a long comment stays on separate lines.
            pieces += (self.text[at:start], "\n" * self.text.count("\n", start, stop))
            at = max(at, stop)
        pieces.append(self.text[at:])
        kept = [line.rstrip() for line in "".join(pieces).split("\n")]
        return "".join(f"{line}\n" for line in kept if line)

    @property
    def counts(self) -> Counts:
        """Counts of this file alone."""
        return counts_of([self])


def counts_of(files: Iterable[CountedFile]) -> Counts:
    """Count a group of files.

    A name in several files counts once, and the files are compressed together, so that counts do not depend on how a
    program is split into files.

    Args:
        files: files in the order of compression.
    """
    group = list(files)
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


class Group(StrEnum):
    """The role of source files."""

    AGENTS = "agents"
    """Agent programs (.asl), and Python files with agents."""

    ARTIFACTS = "artifacts"
    """All other Python code of a program, and its mapping files."""

    PROJECTS = "projects"
    """Project files (.jcm, .mas2j) and launch files."""

    WORLDS = "worlds"
    """World files and fault files."""

    LIBRARY = "library"
    """Parts of the artifacts and plans of jacaros, and of other libraries, that the program uses."""

    BASELINE = "baseline"
    """Python files of a program without agents and with the same behaviour."""

    BASELINE_LIBRARY = "baseline_library"
    """Library code that the baseline uses: of py_trees."""


@dataclass(frozen=True)
class ProgramMetrics:
    """A program with its files.

    Attributes:
        name: name of its folder.
        files: files by `Group`, sorted by path; groups without files may be missing.
    """

    name: str
    files: Mapping[Group, tuple[CountedFile, ...]]

    def counts(self, group: Group) -> Counts:
        """Return the counts of one group."""
        return counts_of(self.files.get(group, ()))

    @property
    def total(self) -> Counts:
        """Counts of the code that the program author wrote: agents and artifacts, as in the thesis; no configuration."""
        return self.counts(Group.AGENTS) + self.counts(Group.ARTIFACTS)
