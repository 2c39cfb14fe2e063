"""Make the six recordings of the study, without the lines that name the fault: python recordings.py FOLDER

A simulated world records its faults, which no real robot does; participants must not read the answer there.
"""

import json
import subprocess
import sys
from pathlib import Path

STUDY = Path(__file__).parent
ROOT = STUDY.parents[1]
RUNS = (
    "examples/02_square/turtlebot4.jcm",
    "experiment/agents/patrol/patrol.jcm",
    "experiment/agents/house_cleaning/house_cleaning.jcm",
    "experiment/agents/patrol/patrol.jcm",
    "examples/02_square/turtlebot4.jcm",
    "examples/01_out_and_back/turtlebot4.jcm",
)
"""The project of each run, in the order of their numbers; ``runs/`` has their faults."""


def record(number: int, folder: Path) -> Path:
    """Make a recording, and return its file. The output of the run is beside it."""
    file = folder / f"run_{number}.jsonl"
    faults = STUDY / "runs" / f"{number}.yaml"
    options = (
        "--clock",
        "fast",
        "--seed",
        "1",
        "--for",
        "400",
        "--faults",
        str(faults),
        "--record",
        str(file),
    )
    run = subprocess.run(
        [sys.executable, "-m", "jacaros", "run", str(ROOT / RUNS[number - 1]), *options],
        capture_output=True,
        text=True,
        check=False,
    )
    file.with_suffix(".txt").write_text(run.stdout + run.stderr, encoding="utf-8")
    lines = file.read_text(encoding="utf-8").splitlines()
    kept = [line for line in lines if json.loads(line).get("event") != "fault"]
    file.write_text("\n".join(kept) + "\n", encoding="utf-8")
    return file


def main() -> None:
    """Record all runs."""
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for number in range(1, len(RUNS) + 1):
        print(record(number, folder))


if __name__ == "__main__":
    main()
