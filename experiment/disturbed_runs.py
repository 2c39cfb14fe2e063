"""Runs of all sides of the scenarios under disturbances, judged from the ground truth."""

import contextlib
import os
import tempfile
from collections.abc import Iterable, Iterator, Mapping
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import NamedTuple

import jacaros.sim
from disturbances import faults_for, kind_of
from jacaros.testing import RunResult, run_project
from scenarios import FOLDER, SCENARIOS
from virtual_run import run_baseline

AGENTS, OVER_NAV2, BASELINE = "agents", "agents over Nav2", "baseline"

HOUSE = Path(jacaros.sim.__file__).parent / "worlds" / "house.yaml"

DOORS = """
doors:
  - {name: living_room, segment: [[1, -0.5], [1, 0.4]], open: true}
  - {name: bathroom, segment: [[1, 1.6], [1, 2.5]], open: true}
"""
"""Doors that the house has for this: a closed one can be passed in the middle of the house."""

CYCLES = 2
"""Recharges after which a patrol ends here; the whole shift has ten."""

LIMITS: Mapping[str, float] = {
    "out_and_back": 120.0,
    "square": 180.0,
    "fake_battery": 400.0,
    "patrol": 240.0,
    "house_cleaning": 900.0,
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
    """

    job: Job
    kind: str
    passed: bool
    seconds: float
    complaint: str


def sides_of(scenario: str) -> list[str]:
    """The sides that a scenario has."""
    over_nav2 = [OVER_NAV2] if _over_nav2(scenario).exists() else []
    return [AGENTS, *over_nav2, BASELINE]


def jobs(seeds: Iterable[int], scenarios: Iterable[str] = SCENARIOS) -> list[Job]:
    """All runs with some seeds."""
    return [
        Job(scenario, side, seed) for scenario in scenarios for side in sides_of(scenario) for seed in seeds
    ]


def run_all(wanted: list[Job], workers: int | None = None) -> list[Outcome]:
    """Make runs, as many at once as there are processors; their order does not matter to their outcomes."""
    with ProcessPoolExecutor(workers or os.cpu_count()) as pool:
        return list(pool.map(run_one, wanted, chunksize=4))


def run_one(job: Job) -> Outcome:
    """Make one run, and judge it."""
    scenario = SCENARIOS[job.scenario]
    faults, limit = faults_for(job.scenario, job.seed), LIMITS[job.scenario]
    with world_of(job.scenario) as world:
        if job.side == BASELINE:
            result = run_baseline(job.scenario, world, limit, job.seed, faults)
        else:
            project = scenario.project if job.side == AGENTS else _over_nav2(job.scenario)
            result = run_project(project, world=str(world), seconds=limit, seed=job.seed, faults=faults)
    complaints = _complaints(job.scenario, result)
    return Outcome(
        job,
        kind_of(job.scenario, job.seed),
        not complaints,
        round(result.seconds, 1),
        next(iter(complaints), ""),
    )


def _complaints(name: str, result: RunResult) -> list[str]:
    scenario = SCENARIOS[name]
    return (
        scenario.judge(result, cycles=CYCLES).complaints
        if name == "patrol"
        else scenario.judge(result).complaints
    )


def _over_nav2(scenario: str) -> Path:
    return FOLDER / "agents" / scenario / f"{scenario}.jcm"


@contextlib.contextmanager
def world_of(scenario: str) -> Iterator[str | Path]:
    """The world of a scenario; the house gets doors."""
    if scenario != "house_cleaning":
        yield SCENARIOS[scenario].world
        return
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "house.yaml"
        path.write_text(HOUSE.read_text(encoding="utf-8") + DOORS, encoding="utf-8")
        yield path
