"""Measure everything in one go, and write what came out: ``make bench``.

    bench.py [--quick] [--rounds N] [--only NAME ...] [--output FOLDER] [--page]

The figures go to FOLDER/benchmarks.json (runs/bench unless given) and to the standard output, pictures beside them.  A
complete run renews the page docs/benchmarks.md with its figures (docs/benchmarks.json) and pictures; ``--page`` writes the
page from those figures once more, without measuring.  Jason takes part where the variable JASON names its command.
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
    """Measure everything that the arguments ask for."""
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
    """The workloads of those names, all of them unless there are any."""
    unknown = set(names or ()) - {workload.name for workload in WORKLOADS}
    if unknown:
        sys.exit(
            f"there is no program {', '.join(unknown)}; there are {', '.join(w.name for w in WORKLOADS)}"
        )
    return [workload for workload in WORKLOADS if not names or workload.name in names]


def draw(file: Path, folder: Path) -> None:
    """Draw the pictures, where there is the library for it."""
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
    parser.add_argument("--quick", action="store_true", help="one round, and the page is left as it is")
    parser.add_argument("--rounds", type=int, help="runs of each program on each engine (3; quick: 1)")
    parser.add_argument(
        "--only", nargs="+", metavar="NAME", help="programs to measure; the page is left as it is"
    )
    parser.add_argument("--output", type=Path, default=ROOT / "runs" / "bench", help="folder of the figures")
    parser.add_argument("--page", action="store_true", help="write the page from its figures once more")
    arguments = parser.parse_args()
    arguments.rounds = arguments.rounds or (1 if arguments.quick else 3)
    return arguments


if __name__ == "__main__":
    main()
