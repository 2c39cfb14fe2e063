"""Two sides of a scenario, run by run; and the family of ten tests that the protocol fixes."""

from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

from intervals import Interval, Pairs, holm, mcnemar, newcombe, wilson
from record import Outcome
from response import DOSES
from scenarios import SCENARIOS

Runs = Sequence[Outcome]

AGENTS, BASELINE = "agents", "baseline"
DONE, TOLD, SILENT = "done", "told", "silent"
ENDS = (DONE, TOLD, SILENT)
HYPOTHESES = {"H1": DONE, "H2": SILENT}
"""What is compared in each scenario: the outcome that it is about."""

HAS: Mapping[str, Callable[[Outcome], bool]] = {
    DONE: lambda run: run.end == DONE,
    SILENT: lambda run: run.end == SILENT,
    "a bump": lambda run: run.damage.bumps > 0,
    "an empty battery": lambda run: run.damage.empty,
    "work in a wrong room": lambda run: run.damage.elsewhere > 0,
}
"""What a run can have, by its name; only the first is good."""

DAMAGES = tuple(HAS)[2:]
SIGNIFICANT = 0.05
NO_BREAK = "\N{NO-BREAK SPACE}"


class Comparison(NamedTuple):
    """How many runs of two sides have something in a scenario, with the same seeds and draws.

    Attributes:
        scenario: name of the scenario.
        what: what is counted, one of `HAS`.
        pairs: in how many pairs of runs both sides, one or none has it.
        adjusted: p of McNemar's test, adjusted for the family; None outside of the family, where nothing is tested.
    """

    scenario: str
    what: str
    pairs: Pairs
    adjusted: float | None = None

    @property
    def interval(self) -> Interval:
        """Interval of the difference: first side minus second."""
        return newcombe(self.pairs)

    @property
    def shown(self) -> bool:
        """Whether the protocol calls this difference shown."""
        return self.adjusted is not None and self.adjusted < SIGNIFICANT and self.interval.excludes_zero

    @property
    def first_is_better(self) -> bool:
        """Whether the first side has more of what is good, or less of what is bad."""
        return (self.pairs.difference > 0) == (self.what == DONE)

    @property
    def winner(self) -> str | None:
        """The side that wins; None if no difference was shown."""
        return (AGENTS if self.first_is_better else BASELINE) if self.shown else None

    @property
    def text(self) -> str:
        """The difference with its interval, in percentage points."""
        return f"{points(self.pairs.difference)} [{points(self.interval.low)}, {points(self.interval.high)}]"


def family(outcomes: Runs) -> list[Comparison]:
    """Return the ten comparisons of agents and baseline, H1 of all scenarios first, with adjusted p values."""
    protocol = of_protocol(outcomes)
    found = [compared(protocol, scenario, what) for what in HYPOTHESES.values() for scenario in SCENARIOS]
    adjusted = holm([mcnemar(each.pairs) for each in found])
    return [each._replace(adjusted=p) for each, p in zip(found, adjusted, strict=True)]


def of_protocol(outcomes: Runs) -> Runs:
    """Return the runs with a disturbance of the protocol; the others are exploratory."""
    return [each for each in outcomes if each.kind in DOSES]


def compared(
    outcomes: Runs, scenario: str, what: str, sides: tuple[str, str] = (AGENTS, BASELINE)
) -> Comparison:
    """Compare two sides in a scenario, by the runs with the same seed and draw."""
    first, second = (
        {(each.seed, each.draw): HAS[what](each) for each in runs_of(outcomes, scenario, side)}
        for side in sides
    )
    return Comparison(scenario, what, Pairs.of((first[key], second[key]) for key in first if key in second))


def runs_of(outcomes: Runs, scenario: str, side: str) -> Runs:
    """Return the runs of one side of a scenario."""
    return [each for each in outcomes if (each.scenario, each.side) == (scenario, side)]


def count(outcomes: Runs, end: str) -> int:
    """Return how many runs have an outcome."""
    return sum(each.end == end for each in outcomes)


def ends(outcomes: Runs) -> str:
    """Return how many runs have each outcome, in one cell; nothing without runs."""
    return " / ".join(str(count(outcomes, end)) for end in ENDS) if outcomes else ""


def share(part: int, runs: int) -> str:
    """Return a number of runs, with the interval of its share; nothing without runs."""
    low, high = wilson(part, runs)
    return f"{part} ({100 * low:.0f}–{100 * high:.0f}{NO_BREAK}%)" if runs else ""


def points(difference: float) -> str:
    """Return a difference in percentage points, with a sign."""
    rounded = round(100 * difference)
    return f"{rounded:+d}".replace("-", "−") if rounded else "0"
