"""Tables of the disturbed runs; each share and each difference has its interval."""

from collections.abc import Callable, Iterator
from statistics import median
from typing import NamedTuple

from counting import Table
from family import (
    AGENTS,
    BASELINE,
    DAMAGES,
    DONE,
    ENDS,
    HYPOTHESES,
    SILENT,
    Comparison,
    Runs,
    compared,
    count,
    ends,
    family,
    of_protocol,
    runs_of,
    share,
)
from record import Outcome
from response import DOSES, half
from scenarios import SCENARIOS

Cell = str | int

MEANT_TO_RUN_EMPTY = ("fake_battery", "an empty battery")

BESIDE = {
    "recovery tree": AGENTS,
    "state machine": AGENTS,
    "agents that drive themselves": AGENTS,
    "agents before": AGENTS,
    "agents without urgency": AGENTS,
    "agents without checks": AGENTS,
    "baseline without pause": BASELINE,
}
"""Further sides, and what each stands beside in a table."""

OTHERS, ABLATIONS = tuple(BESIDE)[:3], tuple(BESIDE)[3:]
WHOLE = (AGENTS, BASELINE, *OTHERS)
"""The sides that run whole programs."""

WITH_ALL_SEEDS = WHOLE[:4]
"""The sides with enough runs for a curve of dose and response."""


def hypothesis_table(outcomes: Runs, name: str) -> Table:
    """A row for each scenario: the share of each side, their difference, and whether it was shown."""
    rows = []
    for each in family(outcomes):
        if each.what == HYPOTHESES[name]:
            pairs, p = each.pairs, "< 0.0001" if (each.adjusted or 0) < 0.0001 else f"{each.adjusted:.2g}"
            shares = (share(pairs.first, sum(pairs)), share(pairs.second, sum(pairs)))
            rows.append((each.scenario, sum(pairs), *shares, each.text, p, each.winner or "none shown"))
    header = ("scenario", "pairs", AGENTS, BASELINE, "difference in points", "p, adjusted", "win")
    return Table(name, header, tuple(rows))


def outcome_table(outcomes: Runs) -> Table:
    """A row for each side of each scenario: its outcomes, the time until a failing program says so, and the damage."""
    rows: list[tuple[Cell, ...]] = []
    for scenario, side, runs in _by_side(of_protocol(outcomes), WHOLE):
        told = [each.told for each in runs if each.told is not None]
        shares = (share(count(runs, end), len(runs)) for end in ENDS)
        until = f"{median(told):.0f} s" if told else ""
        rows.append((scenario, side, len(runs), *shares, sum(each.hung for each in runs), until))
    header = ("scenario", "side", "runs", *ENDS, "silent and hung", "until told, median")
    return Table("Outcomes", header, tuple(rows))


def damage_table(outcomes: Runs) -> Table:
    """A row for each side of each scenario: runs with each damage, and what the runs that are done took."""
    rows: list[tuple[Cell, ...]] = []
    for scenario, side, runs in _by_side(of_protocol(outcomes), WHOLE):
        harm = [each.damage for each in runs]
        numbers = (
            sum(each.bumps > 0 for each in harm),
            sum(each.empty for each in harm),
            sum(each.elsewhere > 0 for each in harm),
        )
        done = [each for each in runs if each.end == DONE]
        took = (_median(done, lambda run: run.seconds, "s"), _median(done, lambda run: run.metres, "m"))
        rows.append((scenario, side, len(runs), *(share(each, len(runs)) for each in numbers), *took))
    header = ("scenario", "side", "runs", *(f"with {each}" for each in DAMAGES), "seconds", "metres")
    return Table("Damage", header, tuple(rows))


def kind_table(outcomes: Runs) -> Table:
    """A row for each kind of disturbance: runs of agents and baseline that are done, in each scenario."""
    rows = []
    for kind in DOSES:
        runs = [each for each in outcomes if each.kind == kind]
        cells = (_score(compared(runs, scenario, DONE)) for scenario in SCENARIOS)
        rows.append((kind, *cells))
    return Table("Done, by kind", ("disturbance", *SCENARIOS), tuple(rows))


def half_table(outcomes: Runs) -> Table:
    """A row for each kind of disturbance: the dose at which half of the runs of each side fail."""
    rows: list[tuple[Cell, ...]] = []
    sides = [side for side in WITH_ALL_SEEDS if any(each.side == side for each in outcomes)]
    for kind, dose in DOSES.items():
        cells = []
        for side in sides:
            runs = [
                (each.dose, each.end == DONE) for each in outcomes if (each.kind, each.side) == (kind, side)
            ]
            cells.append(f"{half(runs, dose, kind)}, {len(runs)} runs" if runs else "")
        rows.append((kind, dose.name, *cells))
    return Table("Half fail", ("disturbance", "dose", *sides), tuple(rows))


def beside_table(outcomes: Runs, sides: tuple[str, ...]) -> Table:
    """A row for each further side of each scenario, beside the side that it is compared with."""
    rows: list[tuple[Cell, ...]] = []
    for scenario, side, _ in _by_side(of_protocol(outcomes), sides):
        pair = (side, BESIDE[side])
        found = [compared(of_protocol(outcomes), scenario, what, pair) for what in (DONE, SILENT)]
        rows.append((scenario, side, pair[1], sum(found[0].pairs), *(_scored(each) for each in found)))
    header = ("scenario", "side", "beside", "pairs", "done", "silent")
    return Table("Beside", header, tuple(rows))


class Exploratory(NamedTuple):
    """A comparison without a verdict.

    Attributes:
        runs: which runs it is about: with a kind of disturbance, or of another side than the baseline.
        comparison: agents, minus the other side.
    """

    runs: str
    comparison: Comparison

    @property
    def against(self) -> bool:
        """Whether the interval excludes zero, and the agents do worse."""
        return self.comparison.interval.excludes_zero and not self.comparison.first_is_better


def exploratory(outcomes: Runs) -> list[Exploratory]:
    """Return all comparisons of the agents that have runs and no verdict."""
    protocol, found = of_protocol(outcomes), []
    others = [side for side, beside in BESIDE.items() if beside == AGENTS]
    for scenario in SCENARIOS:
        for kind in DOSES:
            runs = [each for each in protocol if each.kind == kind]
            found += [Exploratory(kind, compared(runs, scenario, what)) for what in (DONE, SILENT)]
        harm = [what for what in DAMAGES if (scenario, what) != MEANT_TO_RUN_EMPTY]
        found += [Exploratory("all", compared(protocol, scenario, what)) for what in harm]
        for side in others:
            pair = [compared(protocol, scenario, what, (AGENTS, side)) for what in (DONE, SILENT)]
            found += [Exploratory(f"beside {side}", each) for each in pair]
    return [each for each in found if any(each.comparison.pairs)]


def against_table(outcomes: Runs) -> Table:
    """A row for each comparison without a verdict whose interval excludes zero against the agents."""
    rows = tuple(
        (each.scenario, runs, each.what, each.text)
        for runs, each in (found for found in exploratory(outcomes) if found.against)
    )
    return Table("Against the agents", ("scenario", "runs", "share with", "difference in points"), rows)


def further_table(outcomes: Runs) -> Table:
    """A row for each further kind of disturbance in each scenario: the outcomes of agents and baseline."""
    further = [each for each in outcomes if each.kind not in DOSES]
    rows = []
    for kind, scenario in sorted({(each.kind, each.scenario) for each in further}):
        runs = [each for each in further if (each.kind, each.scenario) == (kind, scenario)]
        cells = (ends([each for each in runs if each.side == side]) for side in (AGENTS, BASELINE))
        rows.append((kind, scenario, *cells))
    return Table("Further kinds", ("disturbance", "scenario", AGENTS, BASELINE), tuple(rows))


def agreement_table(virtual: Runs, real: Runs) -> Table:
    """A row for each side of each scenario: how often runs on real ROS 2 have the outcome of those on the virtual clock."""
    rows: list[tuple[Cell, ...]] = []
    for scenario, side, runs in _by_side(real, WHOLE):
        pairs = twins(virtual, runs)
        alike = sum(one.end == other.end for one, other in pairs)
        both = [ends([pair[place] for pair in pairs]) for place in (1, 0)]
        rows.append((scenario, side, len(pairs), share(alike, len(pairs)), *both))
    header = ("scenario", "side", "runs", "same outcome", "virtual clock", "real ROS 2")
    return Table("Agreement", header, tuple(rows))


def twins(virtual: Runs, real: Runs) -> list[tuple[Outcome, Outcome]]:
    """Return runs on real ROS 2, each with that on the virtual clock with the same seed and draw."""
    known = {_key(each): each for each in virtual}
    return [(each, known[_key(each)]) for each in real if _key(each) in known]


def _key(run: Outcome) -> tuple[str, str, int, int]:
    return run.scenario, run.side, run.seed, run.draw


def _by_side(outcomes: Runs, sides: tuple[str, ...]) -> Iterator[tuple[str, str, Runs]]:
    for scenario in SCENARIOS:
        for side in sides:
            runs = runs_of(outcomes, scenario, side)
            if runs:
                yield scenario, side, runs


def _median(runs: Runs, of: Callable[[Outcome], float], unit: str) -> str:
    return f"{median(map(of, runs)):.0f} {unit}" if runs else ""


def _score(each: Comparison) -> str:
    pairs = each.pairs
    return f"{pairs.first} : {pairs.second} of {sum(pairs)}" if any(pairs) else ""


def _scored(each: Comparison) -> str:
    return f"{each.pairs.first} : {each.pairs.second}, {each.text}"
