"""Runs of all sides of the scenarios under disturbances, judged from the ground truth."""

import os
import shutil
import tempfile
from collections.abc import Iterable, Iterator, Mapping
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import NamedTuple

import jacaros.robots.world
from disturbances import FURTHER, SEEN, faults_for, kind_of
from jacaros.testing import RunResult, run_project
from outcomes import Damage, damage, disturbed_at, end_of, told_at
from scenarios import FETCH, FOLDER, FURTHER_SCENARIOS, SCENARIOS
from virtual_run import run_baseline

AGENTS, OVER_NAV2, BASELINE = "agents", "agents over Nav2", "baseline"
PATIENT = "baseline, 20 attempts"
"""The baseline with the policy of the agents over Nav2: as many attempts, with the same pause between them."""
SIDES = (AGENTS, OVER_NAV2, BASELINE, PATIENT)

HOUSE = Path(jacaros.robots.world.__file__).parent / "worlds" / "house.yaml"

DOORS = """
doors:
  - {name: living_room, segment: [[1, -0.5], [1, 0.4]], open: true}
  - {name: bathroom, segment: [[1, 1.6], [1, 2.5]], open: true}
"""
"""Doors that the house has for this: a closed one can be passed in the middle of the house."""

CYCLES = 2
"""Recharges after which a patrol ends here; the whole shift has ten."""

SHIFTS = {"shift(10).": f"shift({CYCLES}).", "SHIFT = 10": f"SHIFT = {CYCLES}"}
"""The lines of the programs that say how long a shift is, and what takes their place."""

PATIENCE = {
    "ATTEMPTS = 3": "ATTEMPTS = 20",
    "py_trees.decorators.Retry(": "try_patiently(",
    "\n\n\nclass NavigateTo": """


def try_patiently(name, way, attempts):
    pause = py_trees.behaviours.TickCounter("Pause", 20, Status.FAILURE)  # two seconds
    children = [way, pause]
    return py_trees.decorators.Retry(
        name, py_trees.composites.Selector(f"{name} or pause", memory=True, children=children), attempts
    )


class NavigateTo""",
}
"""The changes to a tree that give it the policy of the agents over Nav2."""

NEAR = 0.1
"""Metres from a corner that count as a visit here: a robot that Nav2 stops within its tolerance of 5 cm and that slips a
little must not count as one that leaves the corner and comes again."""

LIMITS: Mapping[str, float] = {
    "out_and_back": 120.0,
    "square": 180.0,
    "fake_battery": 400.0,
    "patrol": 500.0,
    "house_cleaning": 900.0,
    "fetch": 400.0,
}
"""Seconds of the virtual clock after which a run is ended."""


class Job(NamedTuple):
    """One run: side, scenario and seed."""

    scenario: str
    side: str
    seed: int


class Outcome(NamedTuple):
    """How a run ended.

    Attributes:
        job: the run.
        kind: of the disturbance.
        passed: whether the checker of the example was content.
        seconds: of the virtual clock that it took.
        complaint: the first complaint of the checker, or "".
        end: how it ended: one of `ENDS`.
        silence: seconds from the disturbance until the program said that it failed; None if it did not.
        damage: after the disturbance.
    """

    job: Job
    kind: str
    passed: bool
    seconds: float
    complaint: str
    end: str
    silence: float | None = None
    damage: Damage = Damage(0, False, 0)


ALL = {**SCENARIOS, "fetch": FETCH}
"""All scenarios by name."""


def sides_of(scenario: str) -> list[str]:
    """The sides that a scenario has."""
    if scenario == "fetch":
        return [AGENTS]
    over_nav2 = _over_nav2(scenario).exists()
    return [AGENTS, OVER_NAV2, BASELINE, PATIENT] if over_nav2 else [AGENTS, BASELINE]


def jobs(seeds: Iterable[int], scenarios: Iterable[str] = SCENARIOS) -> list[Job]:
    """All runs with some seeds."""
    return [
        Job(scenario, side, seed) for scenario in scenarios for side in sides_of(scenario) for seed in seeds
    ]


def further_jobs(runs: int) -> list[Job]:
    """That number of runs of each side of the scenarios with the further kinds of disturbances."""
    every = jobs(range(FURTHER + 1, FURTHER + runs + 1), FURTHER_SCENARIOS)
    return [job for job in every if job.side != PATIENT]


def held_out_jobs(runs: int, further: int) -> list[Job]:
    """That number of runs of the agents with seeds that are kept out of tuning, and with the further kinds."""
    every = jobs(range(SEEN + 1, SEEN + runs + 1))
    first = FURTHER + SEEN + 1
    every += jobs(range(first, first + further), FURTHER_SCENARIOS)
    return [job for job in every if job.side in (AGENTS, OVER_NAV2)]


def run_all(wanted: list[Job], workers: int | None = None) -> Iterator[Outcome]:
    """Make runs, as many at once as there are processors; their order does not matter to their outcomes."""
    with ProcessPoolExecutor(workers or os.cpu_count()) as pool:
        yield from pool.map(run_one, wanted)


def run_one(job: Job) -> Outcome:
    """Make one run, and judge it."""
    return judged(job, run(job))


def judged(job: Job, result: RunResult) -> Outcome:
    """Judge a run."""
    limits = {"cycles": CYCLES, "near": NEAR} if job.scenario == "patrol" else {}
    complaints = ALL[job.scenario].judge(result, **limits).complaints
    return Outcome(
        job,
        kind_of(job.scenario, job.seed),
        not complaints,
        round(result.seconds, 1),
        next(iter(complaints), ""),
        end_of(result, not complaints, LIMITS[job.scenario]),
        _silence(result),
        damage(result.ground_truth),
    )


def _silence(result: RunResult) -> float | None:
    told, begin = told_at(result), disturbed_at(result.ground_truth)
    return None if told is None or begin is None else round(max(0.0, told - begin), 1)


def run(job: Job) -> RunResult:
    """Make one run."""
    with tempfile.TemporaryDirectory() as folder:
        return _run(job, Path(folder))


def _run(job: Job, folder: Path) -> RunResult:
    faults, limit = faults_for(job.scenario, job.seed), LIMITS[job.scenario]
    scenario, world = ALL[job.scenario], world_of(job.scenario, folder)
    changes = SHIFTS if job.scenario == "patrol" else {}
    if job.side in (BASELINE, PATIENT):
        changes = {**changes, **PATIENCE} if job.side == PATIENT else changes
        changed = scenario._replace(baseline=_changed(scenario.baseline, changes, folder))
        return run_baseline(changed, world, limit, job.seed, faults)
    project = scenario.project if job.side == AGENTS else _over_nav2(job.scenario)
    if changes:
        _changed(project.with_name("robot.asl"), changes, folder)
        project = Path(shutil.copy(project, folder))
    return run_project(project, world=str(world), seconds=limit, seed=job.seed, faults=faults)


def _changed(program: Path, changes: Mapping[str, str], folder: Path) -> Path:
    """Copy a program into *folder*, with changes to its text."""
    text = program.read_text(encoding="utf-8")
    for old, new in changes.items():
        text = text.replace(old, new)
    made = folder / program.name
    made.write_text(text, encoding="utf-8")
    return made


def _over_nav2(scenario: str) -> Path:
    return FOLDER / "agents" / scenario / f"{scenario}.jcm"


def world_of(scenario: str, folder: Path) -> str | Path:
    """The world of a scenario; for the house a file in *folder*, as it gets doors."""
    if scenario != "house_cleaning":
        return ALL[scenario].world
    path = folder / "house.yaml"
    path.write_text(HOUSE.read_text(encoding="utf-8") + DOORS, encoding="utf-8")
    return path
