"""Run the agents of the version before robots looked whether they had achieved their goals.

    python experiment/before.py [--seeds 50]

That version comes from the history of the repository. World, harness and checkers are today's: only the agents, their
library and their interpreter differ. Each run has the disturbance that the record has for its seed; outcomes go to
docs/experiment_before.jsonl.gz.
"""

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import record
from disturbances import SEEDS, disturbance
from runs import Family, judged
from sides import AGENTS, Setting, run_agents

ROOT = Path(__file__).parents[1]
COMMIT = "30978c45"
"""The last commit before that work."""

SIDE = "agents before"
SCENARIOS = ("out_and_back", "square", "patrol", "house_cleaning")
TODAY = ("src/jacaros/robots/world", "src/jacaros/testing", "experiment")
"""Folders that are today's."""

PROJECTS = {
    "01_out_and_back": "out_and_back",
    "02_square": "square",
    "04_patrol": "patrol",
    "05_house_cleaning": "house_cleaning",
}
"""Examples, and what their projects were called then."""


def earlier(folder: Path) -> None:
    """Put the earlier version into a folder, with today's world and harness."""
    archive = subprocess.run(
        ["git", "-C", str(ROOT), "archive", COMMIT, "src", "examples", "experiment/agents"],
        check=True,
        capture_output=True,
    )
    subprocess.run(["tar", "-x", "-C", str(folder)], input=archive.stdout, check=True)
    agents = folder / "agents"
    (folder / "experiment" / "agents").rename(agents)
    for name in TODAY:
        shutil.rmtree(folder / name)
        shutil.copytree(ROOT / name, folder / name)
    shutil.rmtree(folder / "experiment" / "agents")
    agents.rename(folder / "experiment" / "agents")
    for example, project in PROJECTS.items():
        there = folder / "examples" / example
        shutil.copy(there / f"{project}.jcm", there / "turtlebot4.jcm")
        shutil.copy(ROOT / "examples" / example / "check.py", there)


def run_all(wanted: list[record.Outcome]) -> list[record.Outcome]:
    """Run the agents of this checkout, with the draws of other runs."""
    with ProcessPoolExecutor() as pool:
        return list(pool.map(run_one, wanted))


def run_one(known: record.Outcome) -> record.Outcome:
    """Make one run, and judge it."""
    family = Family(known.scenario, known.seed)
    drawn = disturbance(*family, known.draw)
    with tempfile.TemporaryDirectory() as folder:
        result = run_agents(Setting(*family, drawn.faults, Path(folder)))
    return judged(family, SIDE, known.draw, drawn, result)


def main() -> None:
    """Make the earlier version, and run it in a process of its own."""
    parser = argparse.ArgumentParser(description="Run the agents of an earlier version.")
    parser.add_argument("--seeds", type=int, default=len(SEEDS) // 4, help="number of seeds (default 50)")
    parser.add_argument("--to", type=Path, default=record.BEFORE, help="file to write")
    parser.add_argument(
        "--here", type=Path, help="run the agents of this checkout, with the draws of a record"
    )
    given = parser.parse_args()
    if given.here is not None:
        runs = [
            each
            for each in record.read(given.here)
            if (each.side, each.scenario in SCENARIOS) == (AGENTS, True)
        ]
        record.write(run_all([each for each in runs if each.seed in SEEDS[: given.seeds]]), given.to)
        return
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        earlier(folder)
        script = str(folder / "experiment" / "before.py")
        options = [
            "--seeds",
            str(given.seeds),
            "--to",
            str(given.to.resolve()),
            "--here",
            str(record.VIRTUAL),
        ]
        environment = os.environ | {"PYTHONPATH": str(folder / "src")}
        subprocess.run([sys.executable, script, *options], env=environment, check=True)


if __name__ == "__main__":
    main()
