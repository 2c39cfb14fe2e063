"""Fills the page of the experiment: the words of ``page.md`` with the tables and sentences that the record gives."""

import re
import textwrap
from collections.abc import Callable, Mapping
from functools import partial

import change_requests
import figures
import sentences
import sizes
import tables
from counting import Table, as_markdown
from family import AGENTS, BASELINE, DONE, SILENT, Runs, compared, ends, family, of_protocol, runs_of
from scenarios import FOLDER, SCENARIOS
from workshop.published import size_table

MARK = re.compile(r"<!-- (\w+) -->")
FRONT_PAGE_WIDTH, PAGE_WIDTH = 140, 150

Texts = Mapping[str, Callable[[], str]]
Tables = Mapping[str, Callable[[], Table]]


def text(record: Runs, before: Runs = (), real: Runs = ()) -> str:
    """Return the text of ``docs/experiment.md``.

    Args:
        record: all runs on the virtual clock.
        before: runs of an earlier version of the agents, as the side ``agents before``.
        real: runs on real ROS 2.
    """
    outcomes = [*record, *before]
    found = _tables(outcomes)
    said = _sentences(outcomes, real)

    def filled(line: str) -> str:
        marks = MARK.findall(line)
        if marks and marks[0] in found:
            return as_markdown(found[marks[0]]())
        if marks:
            words = MARK.sub(lambda mark: said[mark[1]](), line)
            return words if "|" in words else _wrapped(words)
        return line

    words = (FOLDER / "page.md").read_text(encoding="utf-8")
    return "\n".join(map(filled, words.split("\n")))


def pictures(record: Runs) -> dict[str, str]:
    """Return the pictures of the page, by the names of their files in ``docs/images``."""
    outcomes = of_protocol(record)
    return {
        "experiment_differences.svg": figures.differences(family(outcomes)),
        "experiment_doses.svg": figures.responses(outcomes),
        "experiment_outcomes.svg": figures.outcomes_by_side(outcomes, tables.WHOLE, tuple(SCENARIOS)),
    }


def summary(record: Runs) -> str:
    """Return the table of the front page, and its conditions; where the agents do worst comes first."""
    outcomes = of_protocol(record)
    found = {each: compared(outcomes, each, DONE) for each in SCENARIOS}
    rows: list[tuple[str | int, ...]] = []
    for name in sorted(SCENARIOS, key=lambda each: found[each].pairs.difference):
        pair = (AGENTS, BASELINE)
        lines = " / ".join(str(sizes.size_of(name, side).program.code_lines) for side in pair)
        cells = (ends(runs_of(outcomes, name, side)) for side in pair)
        silent = compared(outcomes, name, SILENT)
        rows.append((name.replace("_", " "), sum(silent.pairs), *cells, found[name].text, silent.text, lines))
    header = ("scenario", "pairs", "agents", "Python", "done: difference", "silent: difference", "code lines")
    table = as_markdown(Table("Summary", header, tuple(rows)))
    return f"{table}\n\n{textwrap.fill(sentences.conditions(record), FRONT_PAGE_WIDTH)}"


def _tables(outcomes: Runs) -> Tables:
    """The tables, by the marks that they replace."""
    return {
        "H1": partial(tables.hypothesis_table, outcomes, "H1"),
        "H2": partial(tables.hypothesis_table, outcomes, "H2"),
        "outcomes": partial(tables.outcome_table, outcomes),
        "damage": partial(tables.damage_table, outcomes),
        "kinds": partial(tables.kind_table, outcomes),
        "halves": partial(tables.half_table, outcomes),
        "baselines": partial(tables.beside_table, outcomes, tables.OTHERS),
        "ablations": partial(tables.beside_table, outcomes, tables.ABLATIONS),
        "further": partial(tables.further_table, outcomes),
        "sizes": sizes.size_table,
        "thesis": sizes.thesis_table,
        "changes": changes_table,
        "workshop": size_table,
    }


def _sentences(outcomes: Runs, real: Runs) -> Texts:
    """The sentences, by the marks that they replace."""
    of_record = (
        sentences.lost,
        sentences.won,
        sentences.undecided,
        sentences.exploratory,
        sentences.telling,
        sentences.drawn,
        sentences.absent,
    )
    return {
        **{each.__name__: partial(each, outcomes) for each in of_record},
        "larger_with_library": sizes.larger_with_library,
        "dearer": dearer,
        "agreement": lambda: agreement(outcomes, real),
        "against": lambda: against(outcomes),
    }


def against(outcomes: Runs) -> str:
    """Return the table of what points against the agents; nothing if nothing does."""
    table = tables.against_table(outcomes)
    return as_markdown(table) if table.rows else ""


def agreement(virtual: Runs, real: Runs) -> str:
    """Return how often the runs on both clocks agree; without runs on real ROS 2, say so."""
    if not real:
        return "This was not run."
    return f"{sentences.agreeing(virtual, real)}\n\n{as_markdown(tables.agreement_table(virtual, real))}"


def changes_table() -> Table:
    """Changed code lines of each request."""
    rows = tuple(
        (
            row.request,
            *(f"{each.changed} (+{each.added} -{each.removed})" for each in (row.agents, row.baseline)),
        )
        for row in change_requests.table()
    )
    return Table("Changed code lines", ("request", AGENTS, BASELINE), rows)


def dearer() -> str:
    """Which change requests cost the agents more code lines than the baseline."""
    more = [
        f"{row.request} ({row.agents.changed} lines against {row.baseline.changed})"
        for row in change_requests.table()
        if row.agents.changed > row.baseline.changed
    ]
    return f"Change requests that cost the agents more: {', '.join(more) or 'none'}."


def _wrapped(words: str) -> str:
    return textwrap.fill(words, PAGE_WIDTH, subsequent_indent="  " if words.startswith("- ") else "")
