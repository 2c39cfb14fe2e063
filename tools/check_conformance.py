"""Run the conformance cases; all of them must pass.

check_conformance.py language       all areas of the language, on the virtual clock
check_conformance.py plain          the same without any optimisation (JACAROS_PLAIN=1)
check_conformance.py restored       the same with minds that are stored and restored at random cycles
check_conformance.py formatted      the same programs, formatted by `jacaros fmt`
check_conformance.py real-time      the areas about the reasoning cycle, on the wall clock
check_conformance.py environment    artifacts, on the virtual clock
"""

import os
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from collections import Counter
from pathlib import Path

from jacaros.agents.language.formatting import format_program

ROOT = Path(__file__).resolve().parent.parent
CASES = ROOT / "tests" / "conformance"
JACAROS = Path(sys.executable).parent / "jacaros"
PRINT_LINE_NUMBERS = ("failure/error_code_annotation.asl",)
CYCLE = ("beliefs", "body_statements", "failure", "intentions", "plan_selection")


def main(arguments: list[str]) -> int:
    """Run one of the suites."""
    suite = arguments[0] if arguments else "language"
    if suite == "language":
        return judge(*run(CASES, "fast", 2))
    if suite == "plain":
        os.environ["JACAROS_PLAIN"] = "1"
        language = judge(*run(CASES, "fast", 2))
        return judge(*run(ROOT / "tests" / "conformance_environment", "fast", 2)) or language
    if suite == "restored":
        return restored()
    if suite == "formatted":
        with tempfile.TemporaryDirectory() as scratch:
            return judge(*run(formatted(Path(scratch)), "fast", 2))
    if suite == "real-time":
        # One at a time: these cases measure times 40 ms apart.
        return judge(*run(CASES, "real", 1, *(part for area in CYCLE for part in ("--area", area))))
    if suite == "environment":
        return judge(*run(ROOT / "tests" / "conformance_environment", "fast", 2))
    print(f"error: unknown suite: `{suite}`", file=sys.stderr)
    return 2


def restored() -> int:
    """Run the language cases with minds stored as JSON and restored; list those that could not be stored."""
    with tempfile.TemporaryDirectory() as scratch:
        report = Path(scratch) / "not_restored"
        os.environ["JACAROS_NOT_RESTORED"] = str(report)
        code = judge(*run(CASES, "fast", 2, command=f"{sys.executable} {ROOT / 'tools' / 'run_restored.py'}"))
        lines = sorted(report.read_text(encoding="utf-8").splitlines()) if report.exists() else []
    print("\n".join(["minds that could not be stored:", *(lines or ["none"])]))
    return code


def formatted(scratch: Path) -> Path:
    """Yield a copy of the cases, with all programs without errors formatted by `jacaros fmt`."""
    copy = scratch / "conformance"
    shutil.copytree(CASES, copy, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.rmtree(copy / "syntax_errors")
    changed = 0
    for path in sorted(set(copy.rglob("*.asl")) - {copy / name for name in PRINT_LINE_NUMBERS}):
        before = path.read_text(encoding="utf-8")
        after = format_program(str(path), before)
        path.write_text(after, encoding="utf-8")
        changed += before != after
    print(f"{changed} programs changed by formatting")
    return copy


def run(
    folder: Path, clock: str, jobs: int, *options: str, command: str = f"{JACAROS} run"
) -> tuple[Counter[str], Counter[str]]:
    """Return how many cases of each area pass, and their total; print the report of the checker."""
    with tempfile.TemporaryDirectory() as scratch:
        results = Path(scratch) / "results.xml"
        whole = f"{command} {{project}} --clock {clock}"
        checker = ROOT / "tests" / "conformance" / "check.py"
        call = (
            sys.executable,
            checker,
            "--command",
            whole,
            "--jobs",
            str(jobs),
            "--junit",
            results,
            *options,
        )
        subprocess.run((*call, folder), check=False)
        passed: Counter[str] = Counter()
        total: Counter[str] = Counter()
        for case in ElementTree.parse(results).iter("testcase"):
            area = case.get("classname", "").removeprefix("conformance.")
            total[area] += 1
            passed[area] += case.find("failure") is None and case.find("error") is None
    return passed, total


def judge(passed: Counter[str], total: Counter[str]) -> int:
    """Return the exit code: 0 if every case passes."""
    wrong = [
        f"{area}: {passed[area]} of {total[area]} pass"
        for area in sorted(total)
        if passed[area] < total[area]
    ]
    if not total:
        wrong.append("no cases found")
    print("\n".join(wrong))
    print(f"{passed.total()} of {total.total()} cases pass, {'FAILED' if wrong else 'ok'}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
