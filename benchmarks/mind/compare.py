"""Measure the mind beside its peers: every program on each engine, in turn, several times; medians and ratios.

    compare.py [--rounds 3] [--json FILE] [--only NAME ...]

Times are processor seconds of the run without the start.  A peer is measured where its environment is there:
python-agentspeak in ``.venv-bench``, Jason where ``JASON`` names its command (whole wall time less that of an empty
program).  ``-``: the peer lacks what the program needs.  ``>``: it did not end within the time allowed.
"""

import argparse
import json
import os
import platform
import subprocess
import sys
import tempfile
import time
from collections import defaultdict
from dataclasses import dataclass, field
from pathlib import Path
from statistics import median
from typing import Any

sys.path.insert(0, str(Path(__file__).parent))

from workloads import WORKLOADS, Workload

HERE = Path(__file__).parent
ROOT = HERE.parent.parent
PEER = ROOT / ".venv-bench" / "bin" / "python"
PATIENCE = 60.0
"""Seconds after which a peer has taken for ever."""


@dataclass
class Figures:
    """What the rounds of one program gave, by engine."""

    units: int = 0
    calls: list[float] = field(default_factory=list)
    seconds: dict[str, list[float]] = field(default_factory=lambda: defaultdict(list))
    megabytes: dict[str, list[float]] = field(default_factory=lambda: defaultdict(list))
    notes: dict[str, str] = field(default_factory=dict)


def call(command: list[str], environment: dict[str, str] | None = None) -> dict[str, Any]:
    """Run a measuring script; what it printed, or what went wrong under ``note``."""
    try:
        done = subprocess.run(
            command, capture_output=True, text=True, timeout=PATIENCE, env=environment, check=False
        )
    except subprocess.TimeoutExpired:
        return {"note": f"> {PATIENCE:g} s"}
    if done.returncode != 0:
        return {"note": "fails", "why": done.stderr[-400:]}
    found: dict[str, Any] = json.loads(done.stdout.splitlines()[-1])
    return found


def on_jacaros(workload: Workload, folder: Path, n: int) -> dict[str, Any]:
    """Ours, at a size."""
    return call([sys.executable, str(HERE / "on_jacaros.py"), str(workload.write(folder, n))])


def on_agentspeak(workload: Workload, folder: Path) -> dict[str, Any]:
    """python-agentspeak, on the size that it can do."""
    workload.write(folder, workload.agentspeak)
    agents = [
        f"{name}={folder / file}.asl{f'#{count}' if count > 1 else ''}"
        for name, file, count in workload.agents
    ]
    return call([str(PEER), str(HERE / "on_agentspeak.py"), *agents])


def on_jason(project: Path) -> dict[str, Any]:
    """Jason: the whole process, by the wall clock."""
    began = time.monotonic()
    command = [os.environ["JASON"], str(project), "--no-net"]
    try:
        done = subprocess.run(command, capture_output=True, timeout=PATIENCE, cwd=project.parent, check=False)
    except subprocess.TimeoutExpired:
        return {"note": f"> {PATIENCE:g} s"}
    return {"seconds": time.monotonic() - began} if done.returncode == 0 else {"note": "fails"}


def engines(workload: Workload) -> list[str]:
    """What the program is measured on; ``jacaros small`` is ours at the size that python-agentspeak can do."""
    found = ["jacaros"]
    if workload.agentspeak is not None and PEER.exists():
        found += ["agentspeak", "jacaros small"]
    if workload.jason and os.environ.get("JASON"):
        found.append("jason")
    return found


def measure(workload: Workload, engine: str, figures: Figures) -> None:
    """One run of one program on one engine."""
    if engine in figures.notes:
        return
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        if engine == "jacaros":
            result = on_jacaros(workload, folder, workload.n)
        elif engine == "jacaros small":
            result = on_jacaros(workload, folder, workload.agentspeak or workload.n)
        elif engine == "agentspeak":
            result = on_agentspeak(workload, folder)
        else:
            result = on_jason(workload.write(folder))
    if "note" in result:
        figures.notes[engine] = result["note"]
        if "why" in result:
            print(f"{workload.name} on {engine}: {result['why']}", file=sys.stderr)
        return
    figures.seconds[engine].append(result["seconds"])
    if "megabytes" in result:
        figures.megabytes[engine].append(result["megabytes"])
    if engine == "jacaros":
        figures.calls.append(result["call"])
        figures.units = workload.count or result["cycles"]


def line_of(workload: Workload, figures: Figures, jason_start: float) -> dict[str, Any]:
    """The figures of a program, as they are written to the file."""
    ours = median(figures.seconds["jacaros"])
    unit = ours / figures.units
    found: dict[str, Any] = {
        "name": workload.name,
        "unit": workload.unit,
        "units": figures.units,
        "seconds": ours,
        "nanoseconds": unit * 1e9,
        "calls": unit / median(figures.calls),
        "goal": workload.goal,
        "megabytes": median(figures.megabytes["jacaros"]),
        "agentspeak": "-" if workload.agentspeak is None else figures.notes.get("agentspeak"),
        "lacks": workload.lacks,
        "ratio_goal": workload.ratio if workload.agentspeak is not None else None,
    }
    if figures.seconds["agentspeak"]:
        peer, small = median(figures.seconds["agentspeak"]), median(figures.seconds["jacaros small"])
        found |= {"agentspeak_n": workload.agentspeak, "agentspeak_seconds": peer, "ratio": peer / small}
        found["agentspeak_megabytes"] = median(figures.megabytes["agentspeak"])
    if figures.seconds["jason"]:
        found["jason_seconds"] = max(0.0, median(figures.seconds["jason"]) - jason_start)
        found["jason_ratio"] = found["jason_seconds"] / ours
    return found


def table(lines: list[dict[str, Any]]) -> str:
    """The figures as a table in Markdown; a goal that is missed is marked with an exclamation mark."""
    rows = ["| program | ns a unit | in empty calls | goal | MB | python-agentspeak | goal | Jason |"]
    rows.append("|---|---:|---:|---:|---:|---:|---:|---:|")
    for line in lines:
        goal = line["goal"]
        missed = "!" if goal is not None and line["calls"] > goal else ""
        ratio, wanted = line.get("ratio"), line["ratio_goal"]
        slow = "!" if ratio is not None and wanted is not None and ratio < wanted else ""
        peer = f"{ratio:.0f} x{slow}" if ratio is not None else line["agentspeak"] or "not measured"
        jason = f"{line['jason_ratio']:.1f} x" if "jason_ratio" in line else ""
        rows.append(
            f"| {line['name']} | {line['nanoseconds']:.0f} a {line['unit']} | {line['calls']:.0f}{missed} | "
            f"{goal or ''} | {line['megabytes']:.0f} | {peer} | {wanted or ''} | {jason} |"
        )
    return "\n".join(rows)


def start_time() -> dict[str, float]:
    """Processor seconds of whole processes, the best of five: an empty Python, and a program that says hello."""
    with tempfile.TemporaryDirectory() as scratch:
        hello = Path(scratch) / "hello.asl"
        hello.write_text('!hello. +!hello <- .print("hello"); .stopMAS.\n', encoding="utf-8")
        script = [sys.executable, "-m", "jacaros", "run", str(hello)]
        return {
            "python": min(processor_seconds([sys.executable, "-c", "pass"]) for _ in range(5)),
            "hello": min(processor_seconds(script) for _ in range(5)),
        }


def processor_seconds(command: list[str]) -> float:
    """Of a process and what it waits for."""
    before = os.times()
    subprocess.run(command, check=True, capture_output=True)
    after = os.times()
    return (after.children_user - before.children_user) + (after.children_system - before.children_system)


def machine() -> dict[str, str]:
    """Where this was measured."""
    model = platform.processor() or platform.machine()
    info = Path("/proc/cpuinfo")
    if info.exists():
        names = [
            x.split(":", 1)[1].strip() for x in info.read_text().splitlines() if x.startswith("model name")
        ]
        model = f"{len(names)} x {names[0]}" if names else model
    return {"processor": model, "python": platform.python_version(), "system": platform.platform()}


def main() -> None:
    """Measure, print the table, write the file."""
    parser = argparse.ArgumentParser(description="Measure the mind beside its peers.")
    parser.add_argument("--rounds", type=int, default=3, help="runs of each program on each engine")
    parser.add_argument("--json", type=Path, help="write all figures here")
    parser.add_argument("--only", nargs="+", metavar="NAME", help="programs to measure")
    arguments = parser.parse_args()
    chosen = [w for w in WORKLOADS if not arguments.only or w.name in arguments.only]
    all_figures = {workload.name: Figures() for workload in chosen}
    jason_start = on_jason_empty() if os.environ.get("JASON") else 0.0
    for _ in range(arguments.rounds):
        for workload in chosen:
            for engine in engines(workload):
                measure(workload, engine, all_figures[workload.name])
    lines = [line_of(w, all_figures[w.name], jason_start) for w in chosen if all_figures[w.name].units]
    report = {"machine": machine(), "start": start_time(), "programs": lines}
    print("\n".join(f"{name}: {value}" for name, value in report["machine"].items()))
    print("processor seconds of a start: " + ", ".join(f"{k} {v:.3f}" for k, v in report["start"].items()))
    print(table(lines))
    if arguments.json:
        arguments.json.write_text(json.dumps(report, indent=1) + "\n", encoding="utf-8")


def on_jason_empty() -> float:
    """Seconds of a Jason that does nothing: its start."""
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        (folder / "bench.asl").write_text("!s. +!s <- .stopMAS.\n", encoding="utf-8")
        project = folder / "bench.mas2j"
        project.write_text("MAS bench { agents: bench; }\n", encoding="utf-8")
        return float(on_jason(project).get("seconds", 0.0))


if __name__ == "__main__":
    main()
