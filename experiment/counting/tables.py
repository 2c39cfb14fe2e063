"""Tables of counts: one per measure, as tables 8.1 to 8.3 of the thesis, or of all groups, or of all files."""

import csv
import io
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Final

from counting.counts import MEASURES, Counts, Group, ProgramMetrics

TableCell = str | int

_TOTAL: Final = "total"
_COLUMNS: Final = (Group.AGENTS, Group.ARTIFACTS, _TOTAL, Group.PROJECTS, Group.WORLDS, Group.LIBRARY)


@dataclass(frozen=True)
class Table:
    """A table with a title; the first column is text."""

    title: str
    header: tuple[str, ...]
    rows: tuple[tuple[TableCell, ...], ...]


def measure_table(programs: Sequence[ProgramMetrics], measure: str) -> Table:
    """Return the table of one measure: a row for each program, a column for each group and for the total of code.

    Args:
        programs: the rows.
        measure: one of `MEASURES`.
    """
    rows = tuple(
        (program.name, *(getattr(_counts(program, column), measure) for column in _COLUMNS))
        for program in programs
    )
    return Table(MEASURES[measure], ("program", *_COLUMNS), rows)


def group_table(programs: Sequence[ProgramMetrics]) -> Table:
    """Return the table of all measures: a row for each non-empty group of each program, and for its total."""
    columns = ("files", *MEASURES)
    rows = tuple(
        (program.name, str(column), *(getattr(counts, each) for each in columns))
        for program in programs
        for column in _COLUMNS
        if (counts := _counts(program, column)).files
    )
    return Table("Groups", ("program", "group", *columns), rows)


def file_table(programs: Sequence[ProgramMetrics]) -> Table:
    """Return the table of all files: a row for each file of each program."""
    rows = tuple(
        (program.name, str(group), str(file.path), *(getattr(file.counts, each) for each in MEASURES))
        for program in programs
        for group in Group
        for file in program.files.get(group, ())
    )
    return Table("Files", ("program", "group", "file", *MEASURES), rows)


def _counts(program: ProgramMetrics, column: str) -> Counts:
    return program.total if column == _TOTAL else program.counts(Group(column))


def as_text(table: Table) -> str:
    """Return the table for a terminal: aligned columns below the title."""
    lines = [table.header, *(tuple(map(str, row)) for row in table.rows)]
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    numeric = _numeric(table)
    return "\n".join((table.title, *("  ".join(_aligned(line, widths, numeric)).rstrip() for line in lines)))


def _aligned(line: Sequence[str], widths: Sequence[int], numeric: Sequence[bool]) -> Iterator[str]:
    for cell, width, right in zip(line, widths, numeric, strict=True):
        yield cell.rjust(width) if right else cell.ljust(width)


def _numeric(table: Table) -> list[bool]:
    """Return which columns contain only numbers, and are aligned to the right."""
    return [
        bool(table.rows) and all(isinstance(row[column], int) for row in table.rows)
        for column in range(len(table.header))
    ]


def as_markdown(table: Table) -> str:
    """Return the table in Markdown, without its title."""
    rule = ["---:" if right else "---" for right in _numeric(table)]
    lines = [table.header, rule, *(tuple(map(str, row)) for row in table.rows)]
    return "\n".join("| " + " | ".join(cell.replace("|", "\\|") for cell in line) + " |" for line in lines)


def as_csv(table: Table) -> str:
    """Return the table as CSV with a header line; lines end with a line feed."""
    written = io.StringIO()
    writer = csv.writer(written, lineterminator="\n")
    writer.writerow(table.header)
    writer.writerows(table.rows)
    return written.getvalue()
