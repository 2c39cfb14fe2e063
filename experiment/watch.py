"""Make disturbed runs of one scenario, and print how each ended, with its last words.

python experiment/watch.py patrol --side "agents over Nav2" --kind carried

Without --held-out, only the seeds that programs may be tuned with.
"""

import argparse
import os
from collections import Counter
from concurrent.futures import ProcessPoolExecutor

from disturbances import FURTHER, FURTHER_KINDS, KINDS, SEEN, faults_for, kind_of
from disturbed_runs import AGENTS, ALL, SIDES, Job, Outcome, judged, run


def main() -> None:
    """Do what the command line says."""
    parser = argparse.ArgumentParser(
        description="Make disturbed runs of one scenario, and print how each ended."
    )
    parser.add_argument("scenario", choices=ALL)
    parser.add_argument("--side", choices=SIDES, default=AGENTS)
    parser.add_argument("--runs", type=int, default=50, help="number of seeds to choose from (default 50)")
    parser.add_argument("--seed", type=int, action="append", help="only this seed; repeatable")
    parser.add_argument(
        "--kind", choices=[*KINDS, *FURTHER_KINDS], action="append", help="only this disturbance; repeatable"
    )
    parser.add_argument(
        "--further", action="store_true", help=f"the further kinds of disturbances: seeds from {FURTHER + 1}"
    )
    parser.add_argument("--held-out", action="store_true", help=f"seeds from {SEEN + 1}, which are held out")
    parser.add_argument(
        "--lines", type=int, default=3, help="last lines of output to print (default 3; 0 for all)"
    )
    parser.add_argument("--workers", type=int, default=os.cpu_count(), help="runs at the same time")
    given = parser.parse_args()
    first = (FURTHER if given.further else 0) + (SEEN if given.held_out else 0) + 1
    wanted = [
        Job(given.scenario, given.side, seed)
        for seed in given.seed or range(first, first + given.runs)
        if not given.kind or kind_of(given.scenario, seed) in given.kind
    ]
    with ProcessPoolExecutor(given.workers) as pool:
        found = [show(*each, given.lines) for each in pool.map(watched, wanted)]
    print(", ".join(f"{count} {end}" for end, count in Counter(each.end for each in found).most_common()))


def watched(job: Job) -> tuple[Outcome, list[str]]:
    """Make one run; return its outcome, and its output with the seconds of each line."""
    result = run(job)
    return judged(job, result), [f"{time:7.1f} s  {text}" for time, text in result.timed]


def show(outcome: Outcome, output: list[str], lines: int) -> Outcome:
    """Print a run."""
    job, damage = outcome.job, outcome.damage
    told = "" if outcome.silence is None else f", told {outcome.silence:g} s after the disturbance"
    harm = f"bumps {damage.bumps}, battery {'empty' if damage.empty else 'ok'}, wrong room {damage.elsewhere}"
    print(f"seed {job.seed} {outcome.kind}: {outcome.end.upper()} at {outcome.seconds:g} s{told}; {harm}")
    print(*faults_for(job.scenario, job.seed).splitlines()[1:3], sep="\n")
    if outcome.complaint:
        print(f"  checker: {outcome.complaint}")
    print("".join(f"{line}\n" for line in output[-lines:]), end="", flush=True)
    return outcome


if __name__ == "__main__":
    main()
