"""Fills the page of the experiment: the words of ``page.md`` with the tables that were measured."""

import re
import textwrap
from collections.abc import Callable, Sequence
from functools import partial

import change_requests
import comparison
import sizes
import success
from counting import Group, ProgramMetrics, Table, as_markdown
from disturbances import held_out, is_further
from disturbed_runs import AGENTS, BASELINE, OVER_NAV2, PATIENT, Outcome
from scenarios import FOLDER, SCENARIOS
from workshop.published import size_table

MARK = re.compile(r"<!-- (\w+) -->")
FRONT_PAGE_WIDTH, PAGE_WIDTH = 140, 150
SENTENCES = (
    comparison.significance,
    comparison.fewer,
    comparison.equal_policy,
    comparison.after_the_end,
    comparison.alike,
    comparison.late_runs,
)
"""What the figures decide, by the names of the functions."""


def page(record: Sequence[Outcome]) -> str:
    """The text of ``docs/experiment.md``, from all recorded runs."""
    outcomes, further = split(record)
    tables = all_tables(outcomes) | further_tables(further) | halves_tables(record)
    words = (FOLDER / "page.md").read_text(encoding="utf-8")
    sentences = {each.__name__: each(outcomes) for each in SENTENCES}

    def filled(line: str) -> str:
        found = MARK.findall(line)
        if not any(mark in sentences for mark in found):
            return MARK.sub(lambda mark: as_markdown(tables[mark[1]]()), line)
        text = MARK.sub(lambda mark: sentences[mark[1]], line)
        return textwrap.fill(text, PAGE_WIDTH, subsequent_indent="  " if line.startswith("- ") else "")

    return "\n".join(map(filled, words.split("\n")))


def split(record: Sequence[Outcome]) -> tuple[Sequence[Outcome], Sequence[Outcome]]:
    """The runs of the comparison, and those with the further kinds of disturbances, without the seeds held out."""
    seen = [each for each in record if not held_out(each.job.seed)]
    further = [each for each in seen if is_further(each.job.seed)]
    return [each for each in seen if not is_further(each.job.seed)], further


def halves_tables(record: Sequence[Outcome]) -> dict[str, Callable[[], Table]]:
    """The tables of the seeds to tune with beside those held out."""
    further = [each for each in record if is_further(each.job.seed)]
    return {
        "halves": lambda: success.halves_table([each for each in record if not is_further(each.job.seed)]),
        "further_halves": lambda: success.halves_table(further),
    }


def further_tables(further: Sequence[Outcome]) -> dict[str, Callable[[], Table]]:
    """The tables of the runs with the further kinds of disturbances."""
    return {
        "further": lambda: success.further_table(further),
        "further_outcomes": lambda: success.outcome_table(further),
    }


def all_tables(outcomes: Sequence[Outcome]) -> dict[str, Callable[[], Table]]:
    """The other tables of the page, by the marks that they replace."""
    examples, over_nav2 = sizes.examples(), sizes.over_nav2()
    kinds = ("identifiers", "names", "lines", "code_lines", "gzip_bytes")
    return {
        **{kind: partial(sizes.size_table, examples, kind) for kind in kinds},
        "over_nav2": lambda: over_nav2_table(over_nav2),
        "library": lambda: sizes.library_table([*examples, *over_nav2]),
        "changes": changes_table,
        "workshop": size_table,
        "success": lambda: success.success_table(outcomes),
        "compared": lambda: comparison.comparison_table(outcomes),
        "equal": lambda: comparison.comparison_table(outcomes, PATIENT),
        "ends": lambda: comparison.ends_table(outcomes),
        "outcomes": lambda: success.outcome_table(outcomes),
        "patrol_by_kind": lambda: success.kind_table(outcomes, "patrol"),
        "house_cleaning_by_kind": lambda: success.kind_table(outcomes, "house_cleaning"),
    }


def over_nav2_table(programs: Sequence[ProgramMetrics]) -> Table:
    """Sizes of the agents over Nav2, beside those of the baseline over Nav2."""
    kinds = ("identifiers", "names", "code_lines", "gzip_bytes")
    rows = tuple(
        (
            f"{program.name}, {side}",
            *(getattr(counts, kind) for kind in kinds),
        )
        for program in programs
        for side, counts in (
            ("agents", program.total),
            (BASELINE, program.counts(Group.BASELINE)),
        )
    )
    return Table(
        "Over Nav2",
        ("program", "identifiers", "with beliefs and variables", "code lines", "bytes compressed"),
        rows,
    )


def changes_table() -> Table:
    """Changed code lines of each request."""
    rows = tuple(
        (
            row.request,
            *(f"{each.changed} (+{each.added} -{each.removed})" for each in (row.agents, row.baseline)),
        )
        for row in change_requests.table()
    )
    return Table("Changed code lines", ("request", "agents", BASELINE), rows)


def summary(record: Sequence[Outcome]) -> str:
    """The table of the front page, and its conditions: code lines, and runs that passed under disturbances."""
    outcomes, _ = split(record)
    agents = {each.name.partition("_")[2]: each for each in sizes.examples()}
    nav2 = {each.name: each for each in sizes.over_nav2()}
    rows: list[tuple[str | int, ...]] = []
    for name in SCENARIOS:
        program, side = (nav2[name], OVER_NAV2) if name in nav2 else (agents[name], AGENTS)
        rows.append(
            (
                name.replace("_", " "),
                program.total.code_lines,
                program.counts(Group.BASELINE).code_lines,
                *(
                    success.share(comparison.runs_of(outcomes, name, each))
                    for each in (side, BASELINE, PATIENT)
                ),
            )
        )
    runs = ("disturbed runs passed: agents", "Python", "Python, same attempts")
    table = Table("Summary", ("scenario", "code lines: agents", "Python", *runs), tuple(rows))
    return f"{as_markdown(table)}\n\n{textwrap.fill(comparison.conditions(outcomes), FRONT_PAGE_WIDTH)}"
