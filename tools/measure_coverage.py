"""Measure which lines the tests run, and print a table of packages.

measure_coverage.py                    unit tests, contracts without a real ROS, recorded cases; then the table
measure_coverage.py COMMAND [ARGS]     one of them, such as `-m pytest tests/unit/artifacts/env`; then the table

Processes started by tests are measured, too. A failing test does not stop the measurement: some tests check which modules
are loaded, and coverage loads more.
"""

import json
import subprocess
import sys
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
DATA = ROOT / "runs" / "coverage"
REPORT = DATA / "lines.json"
PARTS = (
    ("-m", "pytest", "-q", "tests/unit", "-m", "not browser"),
    ("-m", "pytest", "-q", "tests/contracts", "-m", "not ros1 and not ros2"),
    ("tools/check_conformance.py", "language"),
    ("tools/check_conformance.py", "environment"),
)
APART = (
    "agents/mind/actions",
    "agents/mind/compiled",
    "agents/mind/generated",
    "agents/mind/rules",
    "agents/mind/state",
    "robots/ros/drivers",
)
"""Folders with their own row."""


def main(arguments: list[str]) -> int:
    """Measure, and print the table."""
    DATA.mkdir(parents=True, exist_ok=True)
    for old in DATA.iterdir():
        old.unlink()
    for part in (arguments,) if arguments else PARTS:
        coverage("run", *part, check=False)
    coverage("combine", "-q")
    coverage("json", "-q", "-o", str(REPORT))
    print("\n".join(table(json.loads(REPORT.read_text(encoding="utf-8"))["files"])))
    return 0


def coverage(*arguments: str, check: bool = True) -> None:
    """Run coverage, with the settings in pyproject.toml."""
    subprocess.run([sys.executable, "-m", "coverage", *arguments], cwd=ROOT, check=check)


def table(files: dict[str, dict[str, dict[str, int]]]) -> list[str]:
    """Return the rows of the table: package, statements, percentage of them that were run."""
    run, all_of_them = Counter[str](), Counter[str]()
    for file, found in files.items():
        for package in (_package(file), "all"):
            run[package] += found["summary"]["covered_lines"]
            all_of_them[package] += found["summary"]["num_statements"]
    rows = [
        f"| {package} | {all_of_them[package]:,} | {100 * run[package] / all_of_them[package]:.0f} % |"
        for package in sorted(all_of_them, key=lambda name: (name == "all", name))
    ]
    return ["| package | statements | run |", "|---|---|---|", *rows]


def _package(file: str) -> str:
    inside = file.partition("src/jacaros/")[2]
    apart = next((each for each in APART if inside.startswith(f"{each}/")), None)
    return apart or (inside.partition("/")[0] if "/" in inside else "jacaros")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
