"""The sides of the experiment: what each runs in a scenario, and how."""

import re
import shutil
from collections.abc import Callable, Mapping
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import Any, NamedTuple

import jacaros
import jacaros.robots.world
from disturbances import QUARTER, SEEDS
from jacaros.testing import RunResult, run_project
from scenarios import FETCH, FOLDER, SCENARIOS, Scenario
from virtual_run import run_baseline

AGENTS, BASELINE = "agents", "baseline"
PAIR = (AGENTS, BASELINE)
"""The sides that are compared; their runs decide whether a disturbance had an effect."""

OVER_NAV2 = ("patrol", "house_cleaning")
"""Scenarios whose robots drive by Nav2."""

ALL = {**SCENARIOS, "fetch": FETCH}
"""All scenarios by name; fetch has no baseline."""

HOUSE = Path(jacaros.robots.world.__file__).parent / "worlds" / "house.yaml"
LIBRARY = Path(jacaros.__file__).parent / "agents" / "language" / "library" / "navigation.asl"

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
    "patrol": 500.0,
    "house_cleaning": 900.0,
    "fetch": 400.0,
}
"""Seconds of the virtual clock after which a run is ended."""


class Setting(NamedTuple):
    """One run.

    Attributes:
        scenario: name of the scenario.
        seed: of the world.
        faults: text of the fault file.
        folder: for changed files; the run may write there.
    """

    scenario: str
    seed: int
    faults: str
    folder: Path

    @property
    def limit(self) -> float:
        """Seconds after which the run is ended."""
        return LIMITS[self.scenario]


class Side(NamedTuple):
    """A side of the comparison.

    Attributes:
        run: makes one run.
        scenarios: that it has.
        seeds: that it runs.
    """

    run: Callable[[Setting], RunResult]
    scenarios: tuple[str, ...] = OVER_NAV2
    seeds: range = QUARTER


# ---- agents

Change = Callable[[str], str]
"""Changes the text of a program."""


def run_agents(setting: Setting, change: Change | None = None, self_driving: bool = False) -> RunResult:
    """Run the agents of a scenario, with a change to their program and to the library of navigation."""
    project = project_for(setting, change, self_driving)
    world = str(world_of(setting.scenario, setting.folder))
    return run_project(project, world=world, seconds=setting.limit, seed=setting.seed, faults=setting.faults)


def project_for(setting: Setting, change: Change | None = None, self_driving: bool = False) -> Path:
    """Return the project of a run, a copy if its program is changed: a patrol has a short shift."""
    project = project_of(setting.scenario, self_driving)
    if change is not None or setting.scenario == "patrol":
        return _changed(project, change, setting.folder)
    return project


def project_of(scenario: str, self_driving: bool = False) -> Path:
    """Return the project of the agents: over Nav2, unless the scenario has no such agents or they drive themselves."""
    over_nav2 = FOLDER / "agents" / scenario / f"{scenario}.jcm"
    return over_nav2 if over_nav2.exists() and not self_driving else ALL[scenario].project


def _changed(project: Path, change: Change | None, folder: Path) -> Path:
    """Copy a project, with a short shift."""
    program = project.with_name("robot.asl").read_text(encoding="utf-8")
    program = re.sub(r"\bshift\(10\)\.", f"shift({CYCLES}).", program)
    if change is not None:
        program = change(program).replace('"$jacaros/navigation.asl"', '"navigation.asl"')
        library = change(LIBRARY.read_text(encoding="utf-8"))
        (folder / "navigation.asl").write_text(library, encoding="utf-8")
    (folder / "robot.asl").write_text(program, encoding="utf-8")
    return Path(shutil.copy(project, folder))


def without_urgency(program: str) -> str:
    """Take the urgency from all plans: they run in the order in which they become ready."""
    return re.sub(r"urgency\(\d+\),\s*", "", re.sub(r"\[urgency\(\d+\)\]", "", program))


def without_checks(program: str) -> str:
    """Take from a program all that looks whether a goal is achieved.

    These are the radius of an arrival and of a visit, the steps that repeat a drive which ended elsewhere, and the
    conditions at the end of the goals of the motions.
    """
    program = re.sub(r"^(arrives|visits)_within\(.*\n", "", program, flags=re.MULTILINE)
    program = re.sub(r";\n *\.wait\(not beside\(Place\).*\n *!found_at\(.*\)\.", ".", program)
    return re.sub(r";\n +(\?\(Side < 4 \| )?X \* X \+ Y \* Y < 0\.05 \* 0\.05\)?(?=;|\s)", "", program)


# ---- baselines


def run_python(setting: Setting, prefix: str = "", **parameters: Any) -> RunResult:
    """Run the baseline of a scenario, or the one of another library, whose file has a *prefix*."""
    scenario = baseline_of(setting.scenario, prefix)
    shift = {"shift": CYCLES} if setting.scenario == "patrol" else {}
    return run_baseline(
        scenario,
        world_of(setting.scenario, setting.folder),
        setting.limit,
        setting.seed,
        setting.faults,
        {**scenario.parameters, **shift, **parameters},
    )


def baseline_of(scenario: str, prefix: str = "") -> Scenario:
    """Return a scenario with a baseline of another library, whose file has a *prefix*."""
    made = SCENARIOS[scenario]
    return made._replace(baseline=made.baseline.with_name(f"{prefix}{made.baseline.name}"))


def world_of(scenario: str, folder: Path) -> str | Path:
    """Return the world of a scenario; for the house a file in *folder*, as it gets doors."""
    if scenario != "house_cleaning":
        return ALL[scenario].world
    path = folder / "house.yaml"
    path.write_text(HOUSE.read_text(encoding="utf-8") + DOORS, encoding="utf-8")
    return path


# ---- the registry

SIDES: Mapping[str, Side] = {
    AGENTS: Side(run_agents, tuple(SCENARIOS), SEEDS),
    BASELINE: Side(run_python, tuple(SCENARIOS), SEEDS),
    "recovery tree": Side(partial(run_python, prefix="recovery_"), seeds=SEEDS),
    "state machine": Side(partial(run_python, prefix="yasmin_"), seeds=SEEDS),
    "agents that drive themselves": Side(partial(run_agents, self_driving=True)),
    "agents without urgency": Side(partial(run_agents, change=without_urgency)),
    "agents without checks": Side(
        partial(run_agents, change=without_checks), ("out_and_back", "square", *OVER_NAV2)
    ),
    "baseline without pause": Side(partial(run_python, pause=0.0)),
}
"""The sides by name."""

NEEDS = {"state machine": "yasmin"}
"""Modules that are on no package index: without them, the recorded runs of a side stay as they are."""


def can_run(side: str) -> bool:
    """Return whether the module that a side needs is here."""
    return side not in NEEDS or find_spec(NEEDS[side]) is not None
