"""Run the experiment, and write its page: python experiment/run.py

With ``--journal FILE``, each run is written to the file when it ends, and an interrupted experiment continues from there.
With ``--quick``, repeat some of the recorded runs, and check that they and the page are as recorded.
"""

import argparse
import json
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import sizes
from disturbed_runs import Job, Outcome, further_jobs, held_out_jobs, jobs, run_all
from outcomes import Damage
from page import page, summary

DOCS = Path(__file__).parents[1] / "docs"
PAGE, RECORD, IMAGES = DOCS / "experiment.md", DOCS / "experiment.json", DOCS / "images"
README = DOCS.parent / "README.md"
RUNS, FURTHER_RUNS, FURTHER_HELD_OUT, QUICK_RUNS = 50, 20, 10, 2


def main() -> int:
    """Do what the command line says; the exit code is 1 if something is not as recorded."""
    parser = argparse.ArgumentParser(description="Run the experiment, and write docs/experiment.md.")
    parser.add_argument(
        "--quick", action="store_true", help="repeat some runs, and compare with what is recorded"
    )
    parser.add_argument("--page", action="store_true", help="write the page anew from the recorded runs")
    parser.add_argument("--runs", type=int, default=RUNS, help=f"runs of each side (default {RUNS})")
    parser.add_argument("--workers", type=int, help="runs at the same time (default: the processors)")
    parser.add_argument("--journal", type=Path, help="file of the runs made so far, to continue from")
    given = parser.parse_args()
    if given.quick:
        return check()
    if not given.page:
        wanted = jobs(range(1, given.runs + 1)) + further_jobs(FURTHER_RUNS)
        wanted += held_out_jobs(given.runs, FURTHER_HELD_OUT)
        RECORD.write_text(as_json(recorded(wanted, given.journal, given.workers)), encoding="utf-8")
    return write(from_json(RECORD.read_text(encoding="utf-8")))


def recorded(wanted: list[Job], journal: Path | None, workers: int | None) -> list[Outcome]:
    """Return the outcomes of runs; those that a journal has are not made again, and the others are added to it."""
    if journal is None:
        return list(run_all(wanted, workers))
    journal.touch()
    known = {
        each.job: each for line in journal.read_text("utf-8").splitlines() for each in from_json(f"[{line}]")
    }
    with journal.open("a", encoding="utf-8") as file:
        for each in run_all([job for job in wanted if job not in known], workers):
            known[each.job] = each
            print(as_line(each), file=file, flush=True)
    return [known[job] for job in wanted]


def write(outcomes: Sequence[Outcome]) -> int:
    """Write the page and the charts."""
    PAGE.write_text(page(outcomes), encoding="utf-8")
    for kind, svg in sizes.charts(sizes.examples()).items():
        (IMAGES / f"experiment_{kind}.svg").write_text(svg, encoding="utf-8")
    print(f"wrote {PAGE.name} and {RECORD.name}; the table of the README is:\n\n{summary(outcomes)}")
    return 0


def check() -> int:
    """Make the first runs again, and compare them, page, charts and README with what is recorded."""
    recorded = from_json(RECORD.read_text(encoding="utf-8"))
    known = {each.job: each for each in recorded}
    problems = [
        f"{' '.join(map(str, new.job))}: {new[1:]}, recorded: {known[new.job][1:]}"
        for new in run_all(jobs(range(1, QUICK_RUNS + 1)) + further_jobs(1))
        if new != known[new.job]
    ]
    if PAGE.read_text(encoding="utf-8") != page(recorded):
        problems.append(f"{PAGE.name} is not what these programs give")
    for kind, svg in sizes.charts(sizes.examples()).items():
        if (IMAGES / f"experiment_{kind}.svg").read_text(encoding="utf-8") != svg:
            problems.append(f"the chart of {kind} is not what these programs give")
    if summary(recorded) not in README.read_text(encoding="utf-8"):
        problems.append(f"README.md has other figures than\n\n{summary(recorded)}\n")
    for problem in problems:
        print(f"error: {problem}", file=sys.stderr)
    if problems:
        print(
            "  = help: run `make experiment`, and copy the table that it prints to README.md", file=sys.stderr
        )
    return 1 if problems else 0


def as_json(outcomes: Sequence[Outcome]) -> str:
    """The record of runs: one line for each."""
    return "[\n" + ",\n".join(map(as_line, outcomes)) + "\n]\n"


def as_line(outcome: Outcome) -> str:
    """A run, as JSON."""
    return json.dumps([outcome.job, outcome[1:-1], outcome.damage])


def from_json(text: str) -> list[Outcome]:
    """The runs of a record."""
    rows: list[list[Any]] = json.loads(text)
    return [Outcome(Job(*job), *how)._replace(damage=Damage(*harm)) for job, how, harm in rows]


if __name__ == "__main__":
    sys.exit(main())
