"""Make disturbed runs of one scenario, and print how each ended, with its last words.

python experiment/watch.py patrol --side baseline --kind carried

The seeds are fresh ones, which the experiment does not use.
"""

import argparse
import os
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from functools import partial

from disturbances import FURTHER_KINDS, FURTHER_SEEDS, KINDS, disturbance, kind_of
from record import Outcome
from runs import Family, judged, run
from sides import AGENTS, ALL, SIDES

WATCHED, FURTHER_WATCHED = 1, FURTHER_SEEDS[-1] + 1
"""First seeds to watch."""


def main() -> None:
    """Do what the command line says."""
    parser = argparse.ArgumentParser(
        description="Make disturbed runs of one scenario, and print how each ended."
    )
    parser.add_argument("scenario", choices=ALL)
    parser.add_argument("--side", choices=SIDES, default=AGENTS)
    parser.add_argument("--runs", type=int, default=50, help="number of seeds to choose from (default 50)")
    parser.add_argument("--seed", type=int, action="append", help="only this seed; repeatable")
    parser.add_argument("--draw", type=int, default=0, help="number of the draw, from 0 (default 0)")
    parser.add_argument(
        "--kind", choices=[*KINDS, *FURTHER_KINDS], action="append", help="only this disturbance; repeatable"
    )
    parser.add_argument("--further", action="store_true", help="the further kinds of disturbances")
    parser.add_argument(
        "--lines", type=int, default=3, help="last lines of output to print (default 3; 0 for all)"
    )
    parser.add_argument("--workers", type=int, default=os.cpu_count(), help="runs at the same time")
    given = parser.parse_args()
    first = FURTHER_WATCHED if given.further else WATCHED
    wanted = [
        Family(given.scenario, seed)
        for seed in given.seed or range(first, first + given.runs)
        if not given.kind or kind_of(given.scenario, seed) in given.kind
    ]
    with ProcessPoolExecutor(given.workers) as pool:
        runs = pool.map(partial(watched, side=given.side, draw=given.draw), wanted)
        found = [show(*each, given.lines) for each in runs]
    print(", ".join(f"{count} {end}" for end, count in Counter(each.end for each in found).most_common()))


def watched(family: Family, side: str, draw: int) -> tuple[Outcome, list[str]]:
    """Make one run; return its outcome, and its output with the seconds of each line."""
    drawn = disturbance(*family, draw)
    result = run(family, side, drawn)
    return judged(family, side, draw, drawn, result), [
        f"{time:7.1f} s  {text}" for time, text in result.timed
    ]


def show(outcome: Outcome, output: list[str], lines: int) -> Outcome:
    """Print a run."""
    damage = outcome.damage
    effect = "no effect" if outcome.effect is None else f"effect at {outcome.effect:g} s"
    told = "" if outcome.told is None else f", told {outcome.told:g} s later"
    harm = f"bumps {damage.bumps}, battery {'empty' if damage.empty else 'ok'}, wrong room {damage.elsewhere}"
    print(
        f"seed {outcome.seed} {outcome.kind} {outcome.dose:g} at {outcome.share:g}: {outcome.end.upper()}",
        end=" ",
    )
    print(f"at {outcome.seconds:g} s and {outcome.metres:g} m, {effect}{told}; {harm}")
    if outcome.complaint:
        print(f"  checker: {outcome.complaint}")
    print("".join(f"{line}\n" for line in output[-lines:]), end="", flush=True)
    return outcome


if __name__ == "__main__":
    main()
