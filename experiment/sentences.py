"""Sentences of the page that the figures decide; each comparison has its interval beside it."""

from collections.abc import Iterable

import tables
from family import (
    AGENTS,
    BASELINE,
    DONE,
    HYPOTHESES,
    SILENT,
    Comparison,
    Runs,
    count,
    family,
    of_protocol,
    share,
)
from scenarios import SCENARIOS

_WORDS = {DONE: "runs done", SILENT: "runs that fail in silence"}


def lost(outcomes: Runs) -> str:
    """Which of the ten differences the baseline wins."""
    return (
        _verdicts(outcomes, BASELINE) or "In none of the ten comparisons was the baseline shown to be better."
    )


def won(outcomes: Runs) -> str:
    """Which of the ten differences the agents win."""
    return _verdicts(outcomes, AGENTS) or "In none of the ten comparisons were the agents shown to be better."


def undecided(outcomes: Runs) -> str:
    """In which of the ten comparisons no difference was shown."""
    found = _each_hypothesis([each for each in family(outcomes) if each.winner is None])
    return (
        f"No difference was shown in {found}." if found else "A difference was shown in all ten comparisons."
    )


def exploratory(outcomes: Runs) -> str:
    """How many comparisons have no verdict, and in how many of them the interval excludes zero against the agents."""
    found = tables.exploratory(outcomes)
    against = sum(each.against for each in found)
    return (
        f"{len(found)} further comparisons have no verdict: single kinds of disturbance, damage, other baselines and "
        f"ablations. In {against} of them, the interval excludes zero against the agents{'.' if against == 0 else ':'}"
    )


def telling(outcomes: Runs) -> str:
    """Which share of the failing runs of each side is silent."""
    cells = []
    for side in (AGENTS, BASELINE):
        failing = [each for each in of_protocol(outcomes) if each.side == side and each.end != DONE]
        silent = share(count(failing, SILENT), len(failing)) or "none"
        cells.append(f"of the {len(failing)} failing runs of the {side}, {silent}")
    return f"Failing runs that end in silence: {'; '.join(cells)}."


def drawn(outcomes: Runs) -> str:
    """How often disturbances were drawn again, and seeds left out."""
    seeds = {(each.scenario, each.seed): each.draw for each in of_protocol(outcomes)}
    all_seeds = {seed for _, seed in seeds}
    again, without = sum(map(bool, seeds.values())), len(SCENARIOS) * len(all_seeds) - len(seeds)
    return (
        f"Of {len(seeds) + without} pairs of scenario and seed, {again} needed a further draw, and {without} are left out, "
        "because none of their draws had an effect on both sides."
    )


def absent(outcomes: Runs) -> str:
    """Which sides the record lacks."""
    there = {each.side for each in outcomes}
    missing = _phrase(side for side in tables.BESIDE if side not in there)
    return f"These sides were not run: {missing}." if missing else "All sides of the protocol were run."


def agreeing(virtual: Runs, real: Runs) -> str:
    """How many runs on real ROS 2 have the outcome of their twin on the virtual clock."""
    pairs = tables.twins(virtual, real)
    alike = sum(one.end == other.end for one, other in pairs)
    return (
        f"{len(real)} runs were made on real ROS 2. {len(pairs)} of them have a twin with the same draw on the virtual "
        f"clock; {share(alike, len(pairs)) or 'none'} of these have the same outcome."
    )


def conditions(outcomes: Runs) -> str:
    """What a reader must know beside the table of the front page, which has the intervals."""
    found = family(outcomes)
    better = [
        f"the {side} in {_each_hypothesis([each for each in found if each.winner == side], False) or 'none'}"
        for side in (BASELINE, AGENTS)
    ]
    return (
        "Cells have the runs done / failed and said so / failed in silence. Differences are agents minus Python, in "
        "percentage points, with their 95 % intervals. Of the ten differences, these were shown (McNemar's exact test, "
        f"adjusted by Holm): {'; '.join(better)}. {telling(outcomes)} Code lines do not include libraries."
    )


def _verdicts(outcomes: Runs, side: str) -> str:
    found = _each_hypothesis([each for each in family(outcomes) if each.winner == side])
    verb = "is" if side == BASELINE else "are"
    return f"The {side} {verb} shown to be better in {found}." if found else ""


def _each_hypothesis(found: Iterable[Comparison], with_interval: bool = True) -> str:
    """Name comparisons, by what they count."""
    parts = []
    of_each = list(found)
    for what in HYPOTHESES.values():
        names = _phrase(
            f"{each.scenario} ({each.text})" if with_interval else each.scenario.replace("_", " ")
            for each in of_each
            if each.what == what
        )
        if names:
            parts.append(f"{_WORDS[what]}: {names}")
    return "; ".join(parts)


def _phrase(names: Iterable[str]) -> str:
    """Return names as a phrase: "a, b and c", or "" without any."""
    *first, last = ["", *names]
    return " and ".join(each for each in (", ".join(first[1:]), last) if each)
