"""The sizes of both sides, beside the thesis's own figures."""

from collections.abc import Mapping, Sequence
from typing import Any

from counting import MEASURES, Group, ProgramMetrics, Table, measure_beside, measure_chart
from jacaros.runtime.files.yaml import plain_values
from scenarios import FOLDER, SCENARIOS

CHARTS = ("identifiers", "lines", "gzip_bytes")
"""Measures that have a chart, as figures 8.7 to 8.9 of the thesis."""

OURS, THEIRS = ("agents", "artifacts", "total", "baseline"), ("total", "python")


def examples() -> list[ProgramMetrics]:
    """The five examples, beside their baselines."""
    return measure_beside(
        [each.project.parent for each in SCENARIOS.values()], [[each.baseline] for each in SCENARIOS.values()]
    )


def over_nav2() -> list[ProgramMetrics]:
    """The agents that drive by Nav2's actions, beside the same baselines."""
    folders = sorted(each.parent for each in (FOLDER / "agents").glob("*/*.jcm"))
    return measure_beside(folders, [[SCENARIOS[folder.name].baseline] for folder in folders])


def size_table(programs: Sequence[ProgramMetrics], kind: str) -> Table:
    """One measure of both sides, and, where the thesis has it, what it tells of the same scenario."""
    thesis = thesis_figures()["tables"].get(kind, {})
    rows: list[tuple[str | int, ...]] = []
    for program in programs:
        columns = (
            program.counts(Group.AGENTS),
            program.counts(Group.ARTIFACTS),
            program.total,
            program.counts(Group.BASELINE),
        )
        theirs = thesis.get(program.name, {})
        rows.append(
            (
                program.name,
                *(getattr(counts, kind) for counts in columns),
                *(theirs.get(each, "") for each in THEIRS if thesis),
            )
        )
    header = ("scenario", *OURS, *(("thesis: total", "thesis: Python") if thesis else ()))
    return Table(MEASURES[kind], header, tuple(rows))


def library_table(programs: Sequence[ProgramMetrics]) -> Table:
    """Code lines of configuration and libraries, which the totals leave out."""
    groups = (Group.PROJECTS, Group.WORLDS, Group.LIBRARY, Group.BASELINE_LIBRARY)
    rows: tuple[tuple[str | int, ...], ...] = tuple(
        (each.name, *(each.counts(group).code_lines for group in groups)) for each in programs
    )
    header = ("scenario", "projects", "worlds", "our library", "py_trees")
    return Table("Code lines of configuration and libraries", header, rows)


def charts(programs: Sequence[ProgramMetrics]) -> dict[str, str]:
    """The SVG texts of the charts, by the names of their measures."""
    return {kind: measure_chart(programs, kind) for kind in CHARTS}


def thesis_figures() -> Mapping[str, Any]:
    """The figures of the thesis."""
    figures, problem = plain_values((FOLDER / "thesis.yaml").read_text(encoding="utf-8"))
    assert problem is None
    return dict(figures)
