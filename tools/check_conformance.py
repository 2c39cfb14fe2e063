"""Run the conformance cases and hold every area to what it has reached.

    check_conformance.py language       all areas of the language, on the virtual clock
    check_conformance.py real-time      the areas that must be complete, on the wall clock
    check_conformance.py environment    artifacts, on the virtual clock
    check_conformance.py --update language     raise the floors to what passes now

Areas in REQUIRED must be complete.  Of the others, tests/conformance_floors.json keeps how many cases have passed;
fewer is a failure, more asks for --update.
"""

import json
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
FLOORS = ROOT / "tests" / "conformance_floors.json"
JACAROS = Path(sys.executable).parent / "jacaros"
REQUIRED = ("beliefs", "body_statements", "failure", "intentions", "plan_selection")


def main(arguments: list[str]) -> int:
    """Run one of the three suites."""
    update = "--update" in arguments
    suite = next(iter([each for each in arguments if not each.startswith("-")]), "language")
    if suite == "language":
        passed, total = run("conformance", "fast", jobs=2)
        return judge(passed, total, REQUIRED, update)
    if suite == "real-time":
        # One at a time: these cases measure moments 40 ms apart.
        areas = [part for area in REQUIRED for part in ("--area", area)]
        passed, total = run("conformance", "real", 1, *areas)
        return judge(passed, total, REQUIRED, False)
    if suite == "environment":
        passed, total = run("conformance_environment", "fast", jobs=2)
        return judge(passed, total, tuple(total), False)
    print(f"no suite {suite}", file=sys.stderr)
    return 2


def run(folder: str, clock: str, jobs: int, *options: str) -> tuple[Counter[str], Counter[str]]:
    """How many cases of each area pass, and how many there are; shows the report of the checker."""
    with tempfile.TemporaryDirectory() as scratch:
        results = Path(scratch) / "results.xml"
        command = f"{JACAROS} run {{project}} --clock {clock}"
        checker = ROOT / "tests" / "conformance" / "check.py"
        call = (
            sys.executable,
            checker,
            "--command",
            command,
            "--jobs",
            str(jobs),
            "--junit",
            results,
            *options,
        )
        subprocess.run((*call, ROOT / "tests" / folder), check=False)
        passed: Counter[str] = Counter()
        total: Counter[str] = Counter()
        for case in ElementTree.parse(results).iter("testcase"):
            area = case.get("classname", "").removeprefix("conformance.")
            total[area] += 1
            passed[area] += case.find("failure") is None and case.find("error") is None
    return passed, total


def judge(passed: Counter[str], total: Counter[str], required: tuple[str, ...], update: bool) -> int:
    """Compare with what must pass; the exit code."""
    floors: dict[str, int] = json.loads(FLOORS.read_text()) if FLOORS.is_file() else {}
    if update:
        floors = {area: passed[area] for area in sorted(total)}
        FLOORS.write_text(json.dumps(floors, indent=2) + "\n")
    wrong = [
        f"{area}: {passed[area]} of {total[area]} pass, all must"
        for area in required
        if passed[area] < total[area]
    ]
    wrong += [f"{area}: no cases found" for area in required if not total[area]]
    for area in sorted(set(total) - set(required)):
        floor = floors.get(area, 0)
        if passed[area] < floor:
            wrong.append(f"{area}: {passed[area]} pass, {floor} did before")
        elif passed[area] > floor:
            print(f"{area}: {passed[area]} pass, {floor} did before: raise the floor with --update")
    print("\n".join(wrong))
    print(f"{passed.total()} of {total.total()} cases pass, {'FAILED' if wrong else 'as they should'}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
