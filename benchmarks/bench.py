"""Run all benchmarks and write the results: ``make bench``.

    bench.py [--quick] [--rounds N] [--only NAME ...] [--output FOLDER] [--page]

The figures are written to FOLDER/benchmarks.json (default: runs/bench) and to the standard output, with pictures next to
the file. A complete run updates docs/benchmarks.md with its figures (docs/benchmarks.json) and pictures; ``--page`` writes
the page again from those figures, without measuring. Jason is included if the variable JASON names its command.
"""

import argparse
import json
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import graphs
import processes
from machine import machine
from mind import engines, rounds, scaling
from mind.workloads import WORKLOADS, Workload
from report.page import filled
from report.tables import parts_of

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "benchmarks.md"
DATA = ROOT / "docs" / "benchmarks.json"
PICTURES = ROOT / "docs" / "images"
FILE = "benchmarks.json"


def main() -> None:
    """Measure, print, write."""
    arguments = _arguments()
    arguments.output.mkdir(parents=True, exist_ok=True)
    file = DATA if arguments.page else arguments.output / FILE
    if not arguments.page:
        report = measured(arguments)
        file.write_text(json.dumps(report, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    report = json.loads(file.read_text(encoding="utf-8"))
    for part, text in parts_of(report).items():
        print(f"\n## {part}\n\n{text}")
    whole = report["complete"]
    draw(file, PICTURES if whole else arguments.output)
    if whole:
        page = filled(PAGE.read_text(encoding="utf-8"), parts_of(report))
        PAGE.write_text(page, encoding="utf-8")
        DATA.write_text(file.read_text(encoding="utf-8"), encoding="utf-8")
    print(f"\nfigures: {file}" + (f"\npage: {PAGE}" if whole else ""))


def measured(arguments: argparse.Namespace) -> dict[str, Any]:
    """Measure everything that the arguments select."""
    began = time.monotonic()

    def tell(text: str) -> None:
        print(f"{time.monotonic() - began:4.0f} s  {text}", file=sys.stderr, flush=True)

    quick, turns = arguments.quick, arguments.rounds
    if quick:
        engines.PATIENCE[engines.AGENTSPEAK] = 10.0
    there = engines.available()
    tell(f"engines: {', '.join(there)}")
    where = machine()
    chosen = chosen_workloads(arguments.only)
    start = processes.started(3 if quick else 10, there)
    memory = processes.memory(1 if quick else 3)
    loading = processes.loading(2 if quick else 5)
    imports = processes.imports()
    figures = rounds.measure(chosen, there, turns, engines.run, tell)
    curves = scaling.measure(
        scaling.CURVES, [engines.OURS] if quick else there, 1 if quick else 2, engines.run, tell
    )
    tell("what a robot asks of its agent")
    robot = _robot(arguments.output / "robot.json")
    latency = graphs.latencies([] if quick else list(graphs.ENVIRONMENTS), tell)
    tell("patrol")
    return {
        "complete": not quick and not arguments.only,
        "rounds": turns,
        "minutes": round((time.monotonic() - began) / 60, 1),
        "machine": where,
        "programs": [rounds.row_of(w, each, there) for w, each in zip(chosen, figures, strict=True)],
        "scaling": curves,
        "start": start,
        "memory": memory,
        "loading": loading,
        "imports": imports,
        "robot": robot,
        "latency": latency,
        "patrol": _patrol(),
    }


def chosen_workloads(names: Sequence[str] | None) -> list[Workload]:
    """Return the workloads with these names; all of them without names."""
    unknown = set(names or ()) - {workload.name for workload in WORKLOADS}
    if unknown:
        sys.exit(
            f"there is no program {', '.join(unknown)}; there are {', '.join(w.name for w in WORKLOADS)}"
        )
    return [workload for workload in WORKLOADS if not names or workload.name in names]


def draw(file: Path, folder: Path) -> None:
    """Draw the pictures, if the library is installed."""
    if not engines.PEER.exists():
        print("no pictures: .venv-bench does not exist (make bench creates it)", file=sys.stderr)
        return
    script = Path(__file__).parent / "report" / "charts.py"
    subprocess.run([engines.PEER, script, file, folder], check=True)


def _robot(file: Path) -> dict[str, Any]:
    script = Path(__file__).parent / "robot.py"
    subprocess.run([sys.executable, script, "--json", file], stdout=subprocess.DEVNULL, check=True)
    found: dict[str, Any] = json.loads(file.read_text(encoding="utf-8"))
    return found


def _patrol() -> str:
    script = Path(__file__).parent / "patrol_speed.py"
    done = subprocess.run([sys.executable, script], capture_output=True, text=True, check=True)
    return done.stdout.strip()


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description="Measure everything in one go.")
    parser.add_argument("--quick", action="store_true", help="one round, without updating the page")
    parser.add_argument("--rounds", type=int, help="runs of each program on each engine (3; quick: 1)")
    parser.add_argument(
        "--only", nargs="+", metavar="NAME", help="programs to measure, without updating the page"
    )
    parser.add_argument("--output", type=Path, default=ROOT / "runs" / "bench", help="folder for the figures")
    parser.add_argument("--page", action="store_true", help="write the page again from its figures")
    arguments = parser.parse_args()
    arguments.rounds = arguments.rounds or (1 if arguments.quick else 3)
    return arguments


if __name__ == "__main__":
    main()
