"""Tables of the disturbed runs: how many passed, and how long they took."""

from collections.abc import Iterable, Sequence
from statistics import median

from disturbances import KINDS
from disturbed_runs import AGENTS, BASELINE, OVER_NAV2, PATIENT, Outcome
from jacaros.look.metrics import Table
from scenarios import SCENARIOS

SIDES = (AGENTS, OVER_NAV2, BASELINE, PATIENT)


def success_table(outcomes: Sequence[Outcome]) -> Table:
    """A row for each scenario: runs that passed, of all, and the median of their seconds."""
    rows = []
    for name in SCENARIOS:
        cells = [_cell(each for each in outcomes if each.job[:2] == (name, side)) for side in SIDES]
        rows.append((name, *cells))
    return Table("Runs that passed", ("scenario", *SIDES), tuple(rows))


def kind_table(outcomes: Sequence[Outcome], scenario: str) -> Table:
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
