"""Sentences of the page that the figures decide; each comparison has its interval beside it."""

from collections.abc import Iterable

from family import (
    AGENTS,
    BASELINE,
    DAMAGES,
    DONE,
    HYPOTHESES,
    SILENT,
    Comparison,
    Runs,
    compared,
    count,
    family,
    of_protocol,
    share,
)
from response import DOSES
from scenarios import SCENARIOS
from tables import BESIDE

_WORDS = {DONE: "runs done", SILENT: "runs that fail in silence"}
_MEANT_TO_RUN_EMPTY = ("fake_battery", "an empty battery")


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


def weaker(outcomes: Runs) -> str:
    """Where single kinds of disturbance, or damage, point against the agents: exploratory, and not adjusted."""
    protocol = of_protocol(outcomes)
    found = []
    for scenario in SCENARIOS:
        for kind in DOSES:
            runs = [each for each in protocol if each.kind == kind]
            found += [(f", {kind}", compared(runs, scenario, what)) for what in (DONE, SILENT)]
        harm = [what for what in DAMAGES if (scenario, what) != _MEANT_TO_RUN_EMPTY]
        found += [("", compared(protocol, scenario, what)) for what in harm]
    found = [(kind, each) for kind, each in found if any(each.pairs)]
    against = [
        f"{each.scenario}{kind}: {_WORDS.get(each.what, f'runs with {each.what}')}, {each.text}"
        for kind, each in found
        if each.interval.excludes_zero and not each.first_is_better
    ]
    text = "; ".join(against)
    return (
        f"{len(found)} further comparisons were made without a verdict: each kind of disturbance, and each damage, in each "
        f"scenario. The interval excludes zero against the agents in {len(against)} of them{': ' if text else ''}{text}."
    )


def behind(outcomes: Runs) -> str:
    """Which further sides do better than the agents, ablations included: exploratory, and not adjusted."""
    protocol = of_protocol(outcomes)
    found = [
        (side, compared(protocol, scenario, what, (side, AGENTS)))
        for side, beside in BESIDE.items()
        for scenario in SCENARIOS
        for what in (DONE, SILENT)
        if beside == AGENTS
    ]
    better = "; ".join(
        f"{side} in {each.scenario}: {_WORDS[each.what]}, {each.text}"
        for side, each in found
        if each.interval.excludes_zero and each.first_is_better
    )
    return (
        "Of the other baselines and the ablations, these do better than the agents, without a verdict: "
        f"{better or 'none'}."
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
    missing = _phrase(side for side in BESIDE if side not in there)
    return f"These sides were not run: {missing}." if missing else "All sides of the protocol were run."


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
