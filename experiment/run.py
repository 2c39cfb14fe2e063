"""Run the experiment, and write its page: python experiment/run.py

With ``--journal FILE``, the runs are written to the file when they end, and an interrupted experiment continues from there.
With ``--quick``, repeat some of the recorded runs, and check that they and the page are as recorded.
"""

import argparse
import json
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

import page
import record
from disturbances import FURTHER_SEEDS, SEEDS
from record import BEFORE, ROS2, Outcome
from record import VIRTUAL as RECORD
from runs import Family, families, run_all
from scenarios import FURTHER_SCENARIOS, SCENARIOS
from sides import NEEDS, can_run

DOCS = Path(__file__).parents[1] / "docs"
PAGE, IMAGES, README = DOCS / "experiment.md", DOCS / "images", DOCS.parent / "README.md"

QUICK = [Family(scenario, SEEDS[0]) for scenario in SCENARIOS] + [
    Family(scenario, FURTHER_SEEDS[0]) for scenario in FURTHER_SCENARIOS
]
"""What ``--quick`` repeats."""


def main() -> int:
    """Do what the command line says; the exit code is 1 if something is not as recorded."""
    parser = argparse.ArgumentParser(description="Run the experiment, and write docs/experiment.md.")
    parser.add_argument(
        "--quick", action="store_true", help="repeat some runs, and compare with what is recorded"
    )
    parser.add_argument("--page", action="store_true", help="write the page anew from the recorded runs")
    parser.add_argument("--workers", type=int, help="runs at the same time (default: the processors)")
    parser.add_argument("--journal", type=Path, help="file of the runs made so far, to continue from")
    given = parser.parse_args()
    if given.quick:
        return check(given.workers)
    if not given.page:
        new = list(made(families(), given.journal, given.workers))
        record.write([*new, *kept(new)], RECORD)
    return write_page()


def made(wanted: list[Family], journal: Path | None, workers: int | None) -> Iterator[Outcome]:
    """Return the outcomes of families; those that a journal has are not made again, and the others are added to it."""
    known = dict(_journal_of(journal))
    new = [family for family in wanted if family not in known]
    for family, outcomes in zip(new, run_all(new, workers), strict=True):
        known[family] = outcomes
        if journal is not None:
            with journal.open("a", encoding="utf-8") as file:
                print(json.dumps([family, [record.as_line(each) for each in outcomes]]), file=file)
    for family in wanted:
        yield from known[family]


def _journal_of(journal: Path | None) -> Iterator[tuple[Family, list[Outcome]]]:
    """Read the families of a journal; one without an effective draw has no outcomes."""
    if journal is not None and journal.exists():
        for line in journal.read_text(encoding="utf-8").splitlines():
            family, outcomes = json.loads(line)
            yield Family(*family), [record.from_line(each) for each in outcomes]


def kept(new: Sequence[Outcome]) -> list[Outcome]:
    """Return the recorded runs of the sides that cannot run here, and print which these are.

    A recorded run is dropped if its seed takes effect with another draw now, or is left out.
    """
    missing = [side for side in NEEDS if not can_run(side)]
    for side in missing:
        print(f"note: the runs of the {side} stay as recorded, because the module {NEEDS[side]} is missing")
    draws = {(each.scenario, each.seed): each.draw for each in new}
    return [
        each
        for each in record.read(RECORD)
        if each.side in missing and draws.get((each.scenario, each.seed)) == each.draw
    ]


def write_page() -> int:
    """Write the page and its pictures, and print the table of the README."""
    outcomes = record.read(RECORD)
    PAGE.write_text(_text(outcomes), encoding="utf-8")
    for name, svg in page.pictures(outcomes).items():
        (IMAGES / name).write_text(svg, encoding="utf-8")
    print(f"wrote {PAGE.name} from {RECORD.name}; the table of the README is:\n\n{page.summary(outcomes)}")
    return 0


def _text(outcomes: list[Outcome]) -> str:
    return page.text(outcomes, record.read(BEFORE), record.read(ROS2))


def check(workers: int | None) -> int:
    """Make some runs again, and compare them, page, pictures and README with what is recorded."""
    outcomes = record.read(RECORD)
    repeated = [each for each in outcomes if (each.scenario, each.seed) in QUICK and can_run(each.side)]
    problems = differences(repeated, list(made(QUICK, None, workers)))
    if PAGE.read_text(encoding="utf-8") != _text(outcomes):
        problems.append(f"{PAGE.name} is not what {RECORD.name} gives")
    for name, svg in page.pictures(outcomes).items():
        if (IMAGES / name).read_text(encoding="utf-8") != svg:
            problems.append(f"{name} is not what {RECORD.name} gives")
    if page.summary(outcomes) not in README.read_text(encoding="utf-8"):
        problems.append(f"README.md has other figures than\n\n{page.summary(outcomes)}\n")
    for problem in problems:
        print(f"error: {problem}", file=sys.stderr)
    if problems:
        print(
            "  = help: run `make experiment`, and copy the table that it prints to README.md", file=sys.stderr
        )
    return 1 if problems else 0


def differences(recorded: Sequence[Outcome], new: Sequence[Outcome]) -> list[str]:
    """Return how new runs differ from the recorded ones."""
    before, after = ({each[:3]: each for each in outcomes} for outcomes in (recorded, new))
    return [
        f"{' '.join(map(str, job))}: {after.get(job, 'not run')}, recorded: {before.get(job, 'nothing')}"
        for job in sorted({*before, *after})
        if before.get(job) != after.get(job)
    ]


if __name__ == "__main__":
    sys.exit(main())
