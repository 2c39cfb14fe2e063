"""Runs of all sides with one seed, judged from the ground truth."""

import os
import tempfile
from collections.abc import Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import NamedTuple

from disturbances import DRAWS, FURTHER_SEEDS, SEEDS, Disturbance, disturbance, is_further
from jacaros.testing import RunResult
from outcomes import SILENT, TOLD, Damage, damage, effect_at, end_of, told_at
from record import Outcome
from scenarios import FURTHER_SCENARIOS, SCENARIOS
from sides import ALL, CYCLES, LIMITS, PAIR, SIDES, Setting, can_run

NEAR = 0.1
"""Metres from a corner that count as a visit here: a robot that Nav2 stops within its tolerance of 5 cm and that slips a
little must not count as one that leaves the corner and comes again."""


class Family(NamedTuple):
    """The runs of all sides with the same disturbance."""

    scenario: str
    seed: int


def families() -> list[Family]:
    """Return all families of the experiment."""
    return [Family(scenario, seed) for scenario in SCENARIOS for seed in SEEDS] + [
        Family(scenario, seed) for scenario in FURTHER_SCENARIOS for seed in FURTHER_SEEDS
    ]


def sides_of(family: Family) -> list[str]:
    """Return the sides of a family."""
    if family.scenario == "fetch":
        return [PAIR[0]]
    if is_further(family.seed):
        return [*PAIR]
    return [
        name
        for name, side in SIDES.items()
        if family.scenario in side.scenarios and family.seed in side.seeds
    ]


def run_all(wanted: Iterable[Family], workers: int | None = None) -> Iterator[list[Outcome]]:
    """Run families, as many at once as there are processors, and yield the outcomes of each in turn."""
    with ProcessPoolExecutor(workers or os.cpu_count()) as pool:
        yield from pool.map(run_family, wanted)


def run_family(family: Family) -> list[Outcome]:
    """Run all sides of a family; nothing if no draw of its seed has an effect on both sides of the pair.

    The pair alone decides which draw it is: so the comparison does not depend on which other sides there are. Those on
    which this draw has no effect are left out, such as robots that drive themselves when Nav2 aborts its goals.
    """
    possible = sides_of(family)
    # Trees take less of the processor than agents do: they are the first to find out that a draw has no effect.
    pair = [side for side in reversed(PAIR) if side in possible]
    for draw in range(DRAWS):
        found = []
        for side in pair:
            found.append(run_one(family, side, draw))
            if found[-1].effect is None:
                break
        else:
            others = [side for side in possible if side not in PAIR and can_run(side)]
            found += [run_one(family, side, draw) for side in others]
            return sorted(each for each in found if each.effect is not None)
    return []


def run_one(family: Family, side: str, draw: int) -> Outcome:
    """Make one run, and judge it."""
    drawn = disturbance(*family, draw)
    return judged(family, side, draw, drawn, run(family, side, drawn))


def run(family: Family, side: str, drawn: Disturbance) -> RunResult:
    """Make one run."""
    with tempfile.TemporaryDirectory() as folder:
        return SIDES[side].run(Setting(*family, drawn.faults, Path(folder)))


def judged(family: Family, side: str, draw: int, drawn: Disturbance, result: RunResult) -> Outcome:
    """Judge a run."""
    limits = {"cycles": CYCLES, "near": NEAR} if family.scenario == "patrol" else {}
    complaints = ALL[family.scenario].judge(result, **limits).complaints
    effect = effect_at(result)
    told = told_at(result, effect or 0.0)
    end = end_of(told, not complaints)
    return Outcome(
        family.scenario,
        side,
        family.seed,
        draw,
        drawn.kind,
        drawn.dose,
        drawn.share,
        end,
        end == SILENT and result.seconds >= LIMITS[family.scenario],
        round(result.seconds, 1),
        None if effect is None else round(effect, 1),
        round(told - effect, 1) if end == TOLD and told is not None and effect is not None else None,
        round(result.ground_truth.odometer(), 1),
        Damage(0, False, 0) if effect is None else damage(result.ground_truth, effect),
        next(iter(complaints), ""),
    )
