"""Sizes of the solutions of the workshop's problems: ours, counted now, and published ones, from ``published.yaml``.

``python -m workshop.published`` prints them as a table in Markdown.
"""

from pathlib import Path
from typing import Any, Final, NamedTuple

from counting import CountedFile, Group, Table, as_markdown, counts_of, measure
from jacaros.runtime.files.yaml import plain_values

FOLDER: Final = Path(__file__).parent
SETTINGS: Final = ("1_fetch", "2_waste", "3_search", "4_battery")
SHARED: Final = "shared"
"""The part of a solution that several settings use."""


class Row(NamedTuple):
    """The size of a part of a solution.

    Attributes:
        system: what it is written in; ours is JaCaROS.
        part: the setting that it is for, one of `SETTINGS`, or `SHARED`.
        lines: physical lines.
        code_lines: lines without blank lines and comments.
        files: their names; ``file.py#13-20`` is a part of a file, from line to line.
        source: repository on GitHub, commit and folder; "" for ours, which are in this folder.
        note: what to know when comparing.
    """

    system: str
    part: str
    lines: int
    code_lines: int
    files: tuple[str, ...]
    source: str = ""
    note: str = ""


def rows() -> list[Row]:
    """All solutions, ours first; for each system the settings that it solves, in order, and then what they share.

    Raises:
        MetricsError: a file of ours cannot be counted.
        ValueError: ``published.yaml`` is not YAML.
    """
    return [*our_rows(), *published_rows()]


def our_rows() -> list[Row]:
    """Our agents and mapping files; worlds, faults and project files are configuration, and are not counted."""
    found = []
    shared: dict[Path, CountedFile] = {}
    for setting, program in zip(SETTINGS, measure([FOLDER / each for each in SETTINGS]), strict=True):
        files = [each for group in (Group.AGENTS, Group.ARTIFACTS) for each in program.files.get(group, ())]
        own = [each for each in files if each.path.resolve().parent == (FOLDER / setting).resolve()]
        shared |= {each.path.resolve(): each for each in files if each not in own}
        found.append((setting, own))
    found.append((SHARED, [shared[path] for path in sorted(shared)]))
    return [
        Row("JaCaROS", part, counts.lines, counts.code_lines, tuple(_name(each.path) for each in files))
        for part, files in found
        for counts in (counts_of(files),)
    ]


def _name(path: Path) -> str:
    return path.resolve().relative_to(FOLDER.resolve()).as_posix()


def published_rows() -> list[Row]:
    """The solutions of others."""
    document, problem = plain_values((FOLDER / "published.yaml").read_text(encoding="utf-8"))
    if problem is not None:
        raise ValueError(f"published.yaml:{problem.line}: {problem.message}")
    return [
        _published(system, document["repositories"][system["repository"]], part)
        for system in document["systems"]
        for part in (*SETTINGS, SHARED)
        if part in system["parts"]
    ]


def _published(system: dict[str, Any], repository: dict[str, Any], part: str) -> Row:
    size = system["parts"][part]
    source = f"{repository['name']}, commit {repository['commit']}, {system['folder']}"
    return Row(
        system["name"],
        part,
        size["lines"],
        size["code_lines"],
        tuple(size["files"]),
        source,
        system["note"],
    )


def size_table() -> Table:
    """A row for each system: lines for each setting, shared, and in total; "-" where it has no solution."""
    found = rows()
    systems = list(dict.fromkeys(row.system for row in found))
    parts = (*SETTINGS, SHARED)
    cells = {(row.system, row.part): f"{row.lines} / {row.code_lines}" for row in found}
    lines = []
    for system in systems:
        own = [row for row in found if row.system == system]
        total = f"{sum(row.lines for row in own)} / {sum(row.code_lines for row in own)}"
        lines.append((system, *(cells.get((system, part), "-") for part in parts), total, own[0].source))
    return Table("Physical lines / code lines", ("system", *parts, "total", "source"), tuple(lines))


if __name__ == "__main__":
    print(as_markdown(size_table()))
