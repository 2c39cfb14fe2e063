"""Agents beside the baseline, run by run: who passed, whether it can be chance, and how all ended."""

import re
from collections import Counter
from collections.abc import Iterable, Sequence
from math import comb
from typing import NamedTuple

from counting import Table
from disturbances import faults_for
from disturbed_runs import AGENTS, BASELINE, OVER_NAV2, PATIENT, Outcome
from outcomes import AS_IF_DONE, ENDS, HUNG
from scenarios import SCENARIOS

SIGNIFICANT = 0.05
SILENT = (HUNG, AS_IF_DONE)


class Comparison(NamedTuple):
    """The outcomes of two sides of a scenario, in the order of their seeds.

    Attributes:
        scenario: name of the scenario.
        agents: of the agents; over Nav2, if they have such a program.
        baseline: of the baseline.
    """

    scenario: str
    agents: tuple[Outcome, ...]
    baseline: tuple[Outcome, ...]

    @property
    def fisher(self) -> float:
        """The probability of such a difference by chance, if runs are independent: Fisher's exact test, two-sided."""
        return fisher(passed(self.agents), len(self.agents), passed(self.baseline), len(self.baseline))

    @property
    def mcnemar(self) -> float:
        """The same for pairs of runs with one seed: McNemar's exact test, two-sided."""
        pairs = Counter(
            (one.passed, other.passed) for one, other in zip(self.agents, self.baseline, strict=True)
        )
        return mcnemar(pairs[True, False], pairs[False, True])

    def disturbed(self) -> "Comparison":
        """The seeds alone whose disturbance began before the end of both programs."""
        pairs = [
            pair
            for pair in zip(self.agents, self.baseline, strict=True)
            if not any(map(ended_before_its_fault, pair))
        ]
        return Comparison(self.scenario, tuple(one for one, _ in pairs), tuple(other for _, other in pairs))


def compared(outcomes: Sequence[Outcome], side: str = BASELINE) -> list[Comparison]:
    """Compare the agents with one side of the baseline, for each scenario that has it."""
    found = []
    for name in SCENARIOS:
        sides = {each.job.side for each in outcomes if each.job.scenario == name}
        agents = OVER_NAV2 if OVER_NAV2 in sides else AGENTS
        if side in sides:
            found.append(Comparison(name, runs_of(outcomes, name, agents), runs_of(outcomes, name, side)))
    return found


def runs_of(outcomes: Iterable[Outcome], scenario: str, side: str) -> tuple[Outcome, ...]:
    """Return the runs of one side of a scenario, by seed."""
    return tuple(sorted(each for each in outcomes if each.job[:2] == (scenario, side)))


def passed(outcomes: Iterable[Outcome]) -> int:
    """How many runs passed."""
    return sum(each.passed for each in outcomes)


def ended_before_its_fault(outcome: Outcome) -> bool:
    """Whether the program had ended when its first disturbance began, without a word about it."""
    begins = re.findall(r"\bat: ([\d.]+)", faults_for(outcome.job.scenario, outcome.job.seed))
    return outcome.silence is None and outcome.seconds <= min(map(float, begins))


def fisher(passed: int, runs: int, others_passed: int, others_runs: int) -> float:
    """Return p of Fisher's exact test: the share of the tables with these sums that are at most as likely."""
    all_passed, all_runs = passed + others_passed, runs + others_runs

    def ways(first: int) -> int:
        return comb(runs, first) * comb(others_runs, all_passed - first)

    as_rare = ways(passed)
    possible = range(max(0, all_passed - others_runs), min(runs, all_passed) + 1)
    return sum(ways(each) for each in possible if ways(each) <= as_rare) / comb(all_runs, all_passed)


def mcnemar(only_one: int, only_other: int) -> float:
    """Return p of McNemar's exact test, from the pairs in which only the one or only the other run passed."""
    pairs, less = only_one + only_other, min(only_one, only_other)
    return min(1.0, sum(comb(pairs, each) for each in range(less + 1)) / 2.0 ** (pairs - 1))


# ---- tables


def comparison_table(outcomes: Sequence[Outcome], side: str = BASELINE) -> Table:
    """A row for each scenario: all runs, tests for chance, and the runs that were disturbed on both sides."""
    rows = []
    for each in compared(outcomes, side):
        disturbed = each.disturbed()
        chance = (f"{each.fisher:.2g}", f"{each.mcnemar:.2g}")
        rows.append((each.scenario, _score(each), *chance, _score(disturbed)))
    header = ("scenario", f"agents : {side}", "p (Fisher)", "p (McNemar)", "disturbed on both sides")
    return Table("Agents beside the baseline", header, tuple(rows))


def ends_table(outcomes: Sequence[Outcome]) -> Table:
    """A row for each side: how its runs ended, and the share of its failing runs that report nothing."""
    rows: list[tuple[str | int, ...]] = []
    for side in (AGENTS, OVER_NAV2, BASELINE):
        ends = Counter(each.end for each in outcomes if each.job.side == side)
        rows.append((side, ends.total(), *(ends[end] for end in ENDS), _silent(outcomes, side)))
    return Table("How runs end", ("side", "runs", *ENDS, "in silence, of the failing"), tuple(rows))


def _silent(outcomes: Iterable[Outcome], side: str) -> str:
    """The share of a side's failing runs that report nothing."""
    ends = [each.end for each in outcomes if each.job.side == side and not each.passed]
    return f"{100 * sum(end in SILENT for end in ends) / len(ends):.0f} %" if ends else "0 %"


# ---- sentences


def significance(outcomes: Sequence[Outcome]) -> str:
    """Which differences are more than chance, by both tests."""
    all_of_them = compared(outcomes)
    by_fisher = _names(each.scenario for each in all_of_them if each.fisher < SIGNIFICANT)
    by_mcnemar = _names(each.scenario for each in all_of_them if each.mcnemar < SIGNIFICANT)
    equal = _names(each.scenario for each in compared(outcomes, PATIENT) if each.mcnemar < SIGNIFICANT)
    return (
        f"Significant differences (p < {SIGNIFICANT}) by Fisher's exact test: {by_fisher or 'none'}. "
        f"Runs with the same seed are pairs; by McNemar's exact test for pairs: {by_mcnemar or 'none'}. "
        f"The same with the agents' policy of attempts for the trees: {equal or 'none'}."
    )


def fewer(outcomes: Sequence[Outcome]) -> str:
    """Where the agents pass fewer runs than the baseline, if only disturbed runs count."""
    found = [each.disturbed() for each in compared(outcomes)]
    worse = _names(
        f"{each.scenario} ({_score(each)})" for each in found if passed(each.agents) < passed(each.baseline)
    )
    return (
        "Among the seeds that disturb both sides, the agents pass fewer runs than the baseline in "
        f"{worse or 'no scenario'}."
    )


def equal_policy(outcomes: Sequence[Outcome]) -> str:
    """What the lead of the agents is with the same policy of attempts."""
    scores = _names(f"{each.scenario} {_score(each)}" for each in compared(outcomes, PATIENT))
    return f"If the trees, too, have 20 attempts and a pause of two seconds, the score is {scores} (agents : trees)."


def after_the_end(outcomes: Sequence[Outcome]) -> str:
    """How many runs had ended before their disturbance."""
    early = [each for each in outcomes if ended_before_its_fault(each)]
    where = Counter((each.job.scenario, each.job.side) for each in early)
    counts = _names(f"{count} of the {side} in {scenario}" for (scenario, side), count in where.items())
    if not early:
        return "No program ended before its disturbance began."
    return (
        f"In {len(early)} runs, the program had ended before its disturbance began ({counts}); "
        f"{passed(early)} of these passed."
    )


def alike(outcomes: Sequence[Outcome]) -> str:
    """How many combinations of scenario and disturbance cannot tell the sides apart."""
    cells: dict[tuple[str, str], bool] = {}
    for each in compared(outcomes):
        for one, other in zip(each.agents, each.baseline, strict=True):
            cell = (each.scenario, one.kind)
            cells[cell] = cells.get(cell, True) and one.passed == other.passed
    return (
        f"{sum(cells.values())} of the {len(cells)} combinations of scenario and disturbance give both sides the same "
        "result on every seed."
    )


def late_runs(outcomes: Sequence[Outcome]) -> str:
    """How many of the runs that drive pass with late messages."""
    late = [each for each in outcomes if each.kind == "late" and each.job.scenario != "fake_battery"]
    of_sides = [
        (side, [each for each in late if each.job.side == side]) for side in (AGENTS, OVER_NAV2, BASELINE)
    ]
    counts = _names(f"{passed(runs)} of {len(runs)} runs of the {side}" for side, runs in of_sides)
    return f"With late messages, {counts} pass, those of fake_battery not counted."


def conditions(outcomes: Sequence[Outcome]) -> str:
    """What a reader must know beside the table of the front page."""
    silent = [f"{_silent(outcomes, side)} of the {side}" for side in (AGENTS, OVER_NAV2, BASELINE)]
    significant = _names(each.scenario for each in compared(outcomes) if each.fisher < SIGNIFICANT)
    return (
        "Patrol and house cleaning are agents over Nav2, which try to reach a place up to 20 times, with pauses. "
        "The trees try 3 times, without a pause; the last column gives them the policy of the agents. "
        f"Significant differences by Fisher's exact test (p < {SIGNIFICANT}): {significant or 'none'}. "
        f"{after_the_end(outcomes)} Failing runs that end without any report: {_names(silent)}."
    )


def _score(comparison: Comparison) -> str:
    return f"{passed(comparison.agents)} : {passed(comparison.baseline)} of {len(comparison.agents)}"


def _names(names: Iterable[str]) -> str:
    """Return names as a phrase: "a, b and c", or "" without any."""
    *first, last = ["", *names]
    return " and ".join(each for each in (", ".join(first[1:]), last) if each)
