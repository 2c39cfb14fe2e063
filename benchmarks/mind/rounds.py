"""Run workloads on all engines in turn, and collect the results."""

import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from statistics import median
from typing import Any

from mind.engines import OURS
from mind.workloads import Workload

Runner = Callable[[str, Workload, int], dict[str, Any]]


@dataclass
class Figures:
    """The results of the runs of one program.

    Attributes:
        runs: by engine and size, the figures of each round.
        notes: by engine, why it has none.
    """

    runs: dict[tuple[str, int], list[dict[str, Any]]] = field(default_factory=dict)
    notes: dict[str, dict[str, Any]] = field(default_factory=dict)

    def median(self, engine: str, n: int, key: str) -> float | None:
        """Return the median of the rounds; None without rounds."""
        runs = self.runs.get((engine, n))
        return median(run[key] for run in runs) if runs else None


def measure(
    workloads: Sequence[Workload],
    engines: Sequence[str],
    rounds: int,
    run: Runner,
    tell: Callable[[str], None],
) -> list[Figures]:
    """Run every workload on every engine, round after round.

    In a round the engines take turns, each right after the others: what disturbs one disturbs all.  Where an engine
    does less work than is in the table, ours does as little once more.
    """
    found = [Figures() for _ in workloads]
    for number in range(1, rounds + 1):
        for workload, figures in zip(workloads, found, strict=True):
            tell(f"round {number} of {rounds}: {workload.name}")
            for engine, n in turns(workload, engines):
                _once(workload, figures, engine, n, run)
    return found


def turns(workload: Workload, engines: Sequence[str]) -> list[tuple[str, int]]:
    """Return which engine runs at which size, in which order."""
    order = [(OURS, workload.n)]
    for engine in engines:
        if engine == OURS or engine in workload.lacks:
            continue
        size = workload.size_on(engine)
        order.append((engine, size))
        if (OURS, size) not in order:
            order.append((OURS, size))
    return order


def _once(workload: Workload, figures: Figures, engine: str, n: int, run: Runner) -> None:
    if engine in figures.notes:
        return
    result = run(engine, workload, n)
    if "note" in result:
        figures.notes[engine] = result
        if "why" in result:
            print(f"{workload.name} on {engine}: {result['why']}", file=sys.stderr)
        return
    figures.runs.setdefault((engine, n), []).append(result)


def row_of(workload: Workload, figures: Figures, engines: Sequence[str]) -> dict[str, Any]:
    """A program's row of the report."""
    row: dict[str, Any] = {
        "name": workload.name,
        "unit": workload.unit,
        "units": workload.count,
        "goal": workload.goal,
        "peers": {engine: _peer(workload, figures, engine) for engine in engines if engine != OURS},
    }
    if OURS in figures.notes:
        return row | {"note": figures.notes[OURS]["note"]}
    seconds, calls = (figures.median(OURS, workload.n, key) for key in ("seconds", "calls"))
    assert seconds is not None
    assert calls is not None
    return row | {
        "seconds": seconds,
        "nanoseconds": seconds / workload.count * 1e9,
        "calls": calls / workload.count,
        "megabytes": figures.median(OURS, workload.n, "megabytes"),
    }


def _peer(workload: Workload, figures: Figures, engine: str) -> dict[str, Any]:
    """Return the result of an engine relative to ours, or why it has no result. `ratio` is the relative time."""
    goal = workload.faster if engine == "agentspeak" else workload.faster_jason
    found: dict[str, Any] = {"goal": goal, "n": workload.size_on(engine)}
    if engine in workload.lacks:
        return found | {"lacks": workload.lacks[engine]}
    theirs = figures.runs.get((engine, found["n"]), [])
    ours = figures.runs.get((OURS, found["n"]), [])
    if engine in figures.notes:
        found["note"] = figures.notes[engine]["note"]
        spent = figures.notes[engine].get("at_least")
        if spent is not None and ours:
            found["least_ratio"] = spent / median(run["seconds"] for run in ours)
        return found
    if not theirs or not ours:
        return found | {"note": "not measured"}
    if theirs[0]["results"][-1] != ours[0]["results"][-1]:
        return found | {"note": f"is wrong: {theirs[0]['results'][-1]}"}
    pairs = zip(theirs, ours, strict=False)
    return found | {
        "seconds": median(run["seconds"] for run in theirs),
        "ours": median(run["seconds"] for run in ours),
        "ratio": median(their["seconds"] / our["seconds"] for their, our in pairs),
        "megabytes": median(run["megabytes"] for run in theirs),
    }
