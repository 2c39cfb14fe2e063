"""The sizes of both sides, with and without the library code that they use, beside the thesis's own figures."""

from collections.abc import Mapping
from functools import cache
from typing import Any, NamedTuple

from counting import Counts, Group, Table, measure_beside
from jacaros.runtime.files.yaml import plain_values
from scenarios import FOLDER, SCENARIOS

AGENTS, BASELINE, SELF_DRIVING = "agents", "baseline", "agents that drive themselves"

MEASURES = {"identifiers": "identifiers", "lines": "lines", "gzip_bytes": "bytes compressed"}
"""The measures of the thesis, with their names in a table."""


class Size(NamedTuple):
    """A program of one side of a scenario, and the library code that it uses."""

    scenario: str
    side: str
    program: Counts
    library: Counts

    @property
    def lines_with_library(self) -> int:
        """Physical lines of both: the thesis counted its artifacts with the programs."""
        return self.program.lines + self.library.lines


@cache
def sizes() -> tuple[Size, ...]:
    """Measure all sides of each scenario."""
    over_nav2 = {each.parent.name: each.parent for each in sorted((FOLDER / "agents").glob("*/*.jcm"))}
    folders = {
        (name, SELF_DRIVING if name in over_nav2 else AGENTS): each.project.parent
        for name, each in SCENARIOS.items()
    }
    folders |= {(name, AGENTS): folder for name, folder in over_nav2.items()}
    baselines = [[SCENARIOS[name].baseline] for name, _ in folders]
    found = []
    for (name, side), program in zip(folders, measure_beside([*folders.values()], baselines), strict=True):
        found.append(Size(name, side, program.total, program.counts(Group.LIBRARY)))
        if side == AGENTS:
            beside = (program.counts(each) for each in (Group.BASELINE, Group.BASELINE_LIBRARY))
            found.append(Size(name, BASELINE, *beside))
    order = (AGENTS, BASELINE, SELF_DRIVING)
    return tuple(sorted(found, key=lambda each: ([*SCENARIOS].index(each.scenario), order.index(each.side))))


def size_of(scenario: str, side: str) -> Size:
    """Return the size of one side of a scenario."""
    return next(each for each in sizes() if each[:2] == (scenario, side))


def size_table() -> Table:
    """A row for each side of each scenario."""
    header = (
        "identifiers",
        "with beliefs and variables",
        "code lines",
        "lines",
        "bytes compressed",
        "lines with library",
    )
    rows = tuple(
        (
            *(
                each.scenario,
                each.side,
                each.program.identifiers,
                each.program.names,
                each.program.code_lines,
            ),
            *(each.program.lines, each.program.gzip_bytes, each.lines_with_library),
        )
        for each in sizes()
    )
    return Table("Sizes", ("scenario", "side", *header), rows)


def thesis_table() -> Table:
    """What the thesis counted for each scenario: agents with artifacts, and Python."""
    tables = thesis_figures()["tables"]
    rows: list[tuple[str | int, ...]] = []
    for name in tables["lines"]:
        if name != "source":
            figures = (tables[measure][name] for measure in MEASURES)
            rows.append(
                (name.partition("_")[2], *(f"{each['total']} : {each['python']}" for each in figures))
            )
    return Table("The thesis", ("scenario", *MEASURES.values()), tuple(rows))


def larger_with_library() -> str:
    """In which scenarios the agents have more lines, if the library code that both sides use counts."""
    sides = [(size_of(name, AGENTS), size_of(name, BASELINE)) for name in SCENARIOS]
    more = [
        f"{agents.scenario} ({agents.lines_with_library} : {baseline.lines_with_library})"
        for agents, baseline in sides
        if agents.lines_with_library > baseline.lines_with_library
    ]
    return (
        f"With the library code that each side uses, the agents have more lines than the baseline in {len(more)} of "
        f"{len(sides)} scenarios{': ' if more else ''}{', '.join(more)}."
    )


def thesis_figures() -> Mapping[str, Any]:
    """The figures of the thesis."""
    figures, problem = plain_values((FOLDER / "thesis.yaml").read_text(encoding="utf-8"))
    assert problem is None
    return dict(figures)
