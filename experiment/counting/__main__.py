"""Print the counts of the program in each folder: python experiment/counting FOLDER...

Agents, artifacts, project files, world files and library code are counted separately; the total covers agents and
artifacts. Tests are not counted, and no code is run.
"""

import argparse
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))  # Python puts only this folder there

from counting.counts import MEASURES, ProgramMetrics
from counting.programs import DEFAULT, MetricsError, measure
from counting.tables import Table, as_csv, as_markdown, as_text, file_table, group_table, measure_table


def main(arguments: Sequence[str] | None = None) -> int:
    """Do what the command line says; the exit code is 1 if a program cannot be counted."""
    parser = argparse.ArgumentParser(prog="python experiment/counting", description=__doc__.split("\n")[0])
    parser.add_argument("folders", metavar="FOLDER", type=Path, nargs="+")
    parser.add_argument("--files", action="store_true", help="list every counted file")
    parser.add_argument("--format", choices=SHOWN, default="text")
    parser.add_argument(
        "--library",
        metavar="PACKAGE",
        action="append",
        help="installed package whose imported modules count as library code (default: py_trees); repeatable",
    )
    given = parser.parse_args(arguments)
    try:
        programs = measure(given.folders, given.library or DEFAULT)
    except MetricsError as wrong:
        print(wrong, file=sys.stderr)
        return 1
    print(SHOWN[given.format](programs, given.files))
    return 0


def _text(programs: Sequence[ProgramMetrics], files: bool) -> str:
    return "\n\n".join(map(as_text, _tables(programs, files)))


def _markdown(programs: Sequence[ProgramMetrics], files: bool) -> str:
    return "\n\n".join(f"**{table.title}**\n\n{as_markdown(table)}" for table in _tables(programs, files))


def _tables(programs: Sequence[ProgramMetrics], files: bool) -> list[Table]:
    return [file_table(programs)] if files else [measure_table(programs, name) for name in MEASURES]


def _csv(programs: Sequence[ProgramMetrics], files: bool) -> str:
    return as_csv((file_table if files else group_table)(programs)).rstrip("\n")


SHOWN: Mapping[str, Callable[[Sequence[ProgramMetrics], bool], str]] = {
    "text": _text,
    "markdown": _markdown,
    "csv": _csv,
}
"""What prints the counts, by the formats of the command line."""

if __name__ == "__main__":
    sys.exit(main())
