"""Tables of the disturbed runs: how many passed and how long they took, how they ended, and the damage."""

from collections import Counter
from collections.abc import Iterable, Sequence
from statistics import median

from counting import Table
from disturbances import FURTHER_KINDS, KINDS, held_out
from disturbed_runs import SIDES, Outcome
from outcomes import ENDS
from scenarios import FURTHER_SCENARIOS, SCENARIOS

Runs = Sequence[Outcome]


def success_table(outcomes: Runs) -> Table:
    """A row for each scenario: runs that passed, of all, and the median of their seconds."""
    rows = []
    for name in SCENARIOS:
        cells = [_cell(each for each in outcomes if each.job[:2] == (name, side)) for side in SIDES]
        rows.append((name, *cells))
    return Table("Runs that passed", ("scenario", *SIDES), tuple(rows))


def kind_table(outcomes: Runs, scenario: str) -> Table:
    """A row for each kind of disturbance in a scenario."""
    of_scenario = [each for each in outcomes if each.job.scenario == scenario]
    sides = [side for side in SIDES if any(each.job.side == side for each in of_scenario)]
    kinds = [kind for kind in KINDS if any(each.kind == kind for each in of_scenario)]
    rows = tuple(
        (
            kind,
            *(
                share(each for each in of_scenario if (each.kind, each.job.side) == (kind, side))
                for side in sides
            ),
        )
        for kind in kinds
    )
    return Table(scenario, ("disturbance", *sides), rows)


def outcome_table(outcomes: Runs) -> Table:
    """A row for each side of each scenario: how its runs ended, and the damage after the disturbance."""
    rows: list[tuple[str | int, ...]] = []
    for name, side, runs in _by_side(outcomes):
        told = [each.silence for each in runs if not each.passed and each.silence is not None]
        harm = [each.damage for each in runs]
        until = f"{median(told):.0f} s" if told else ""
        bumps, empty, elsewhere = map(sum, zip(*harm, strict=True))
        rows.append((name, side, *_ends(runs), until, bumps, empty, elsewhere))
    damage = ("until told", "bumps", "batteries empty", "tasks in wrong room")
    return Table("Outcomes", ("scenario", "side", *ENDS, *damage), tuple(rows))


def halves_table(outcomes: Runs) -> Table:
    """A row for each side of each scenario: how its runs ended, with seeds that are tuned with, and with fresh ones."""
    rows = []
    for name, side, runs in _by_side(outcomes):
        halves: dict[bool, list[Outcome]] = {False: [], True: []}
        for each in runs:
            halves[held_out(each.job.seed)].append(each)
        if halves[True]:
            rows.append((name, side, *map(ends_of, halves.values())))
    return Table("Halves", ("scenario", "side", "seeds to tune with", "seeds held out"), tuple(rows))


def further_table(outcomes: Runs) -> Table:
    """A row for each further kind of disturbance in each scenario: how the runs of each side ended."""
    sides = [side for side in SIDES if any(each.job.side == side for each in outcomes)]
    rows = []
    for name in FURTHER_SCENARIOS:
        for kind in FURTHER_KINDS:
            runs = [each for each in outcomes if (each.job.scenario, each.kind) == (name, kind)]
            if runs:
                cells = (ends_of([each for each in runs if each.job.side == side]) for side in sides)
                rows.append((name, kind, *cells))
    return Table("Further disturbances", ("scenario", "disturbance", *sides), tuple(rows))


def ends_of(runs: Runs) -> str:
    """How many runs ended in each of `ENDS`, in one cell; nothing without runs."""
    return " / ".join(map(str, _ends(runs))) if runs else ""


def _by_side(outcomes: Runs) -> Iterable[tuple[str, str, Runs]]:
    for name in {**SCENARIOS, **FURTHER_SCENARIOS}:
        for side in SIDES:
            runs = [each for each in outcomes if each.job[:2] == (name, side)]
            if runs:
                yield name, side, runs


def _ends(runs: Runs) -> list[int]:
    """How many runs ended in each of `ENDS`."""
    counts = Counter(each.end for each in runs)
    return [counts[end] for end in ENDS]


def _cell(found: Iterable[Outcome]) -> str:
    outcomes = list(found)
    if not outcomes:
        return ""
    times = [each.seconds for each in outcomes if each.passed]
    return f"{share(outcomes)}, {median(times):.0f} s" if times else share(outcomes)


def share(found: Iterable[Outcome]) -> str:
    """How many runs passed, of all; nothing without runs."""
    outcomes = list(found)
    if not outcomes:
        return ""
    return f"{sum(each.passed for each in outcomes)} of {len(outcomes)}"
