"""Change one place of a package at a time, and count the changes that its tests notice.

mutants.py                                  a sample of each subject; prints the scores and the surviving changes
mutants.py artifacts/robots --sample 0      all changes of one subject
mutants.py ros --sample 150 --seed 3 --shard 2/4
mutants.py pkg=tests/pkg --root FOLDER      another package (of FOLDER/src) and its tests

One process collects the tests and forks. A first child runs them all and notes which lines each test reaches. Then a child
for each mutant replaces the code of the changed function in memory and runs the tests that reach the line, fastest first,
until one fails. A mutant that survives this, or changes code that runs on import, is tried again by a new process on a copy
of the source, because programs that tests start and values made on import do not see the change in memory. A child that
uses too much time counts as killed: its mutant loops.

Exit code: 0, or 1 if a score is below ``--least``.
"""

import argparse
import difflib
import gc
import io
import json
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import traceback
from collections.abc import Callable, Container, Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from types import CodeType, FunctionType
from typing import NamedTuple

import pytest
from mutation_operators import Mutant, mutants_of

ROOT = Path(__file__).resolve().parent.parent
SUBJECTS: dict[str, tuple[str, ...]] = {
    "jacaros/artifacts/robots": ("tests/unit/artifacts",),
    "jacaros/artifacts/mapping": ("tests/unit/artifacts",),
    "jacaros/ros": ("tests/unit/ros", "tests/contracts"),
    "jacaros/sim": ("tests/unit/sim",),
}
"""Packages below ``src``, and the tests that must notice changes of them."""

WITHOUT = ("ros/drivers/ros1/", "ros/drivers/ros2/")
"""Files whose tests need a real ROS."""

NOT_HERE = "not ros1 and not ros2 and not rosbridge and not mqtt and not browser and not whole_stack"
SAMPLE = 120
LIMIT, LIMIT_FACTOR = 5.0, 10.0
MEMORY = 4 << 30
ASLEEP = 60.0
"""Seconds without processor time after which a mutant is taken for one that waits for ever."""
KILLED, LOOPS, SURVIVED, UNREACHED = "killed", "killed by the time limit", "survived", "reached by no test"


class Test(NamedTuple):
    """What a test does without a change: its index, its seconds and the lines that it reaches, by file."""

    index: int
    seconds: float
    lines: dict[str, set[int]]


class Trial:
    """A plugin of pytest: in place of running the tests once, run those that a mutant needs, for every mutant."""

    def __init__(
        self, source: Path, mutants: Sequence[Mutant], jobs: int, limit: float = LIMIT, twice: bool = True
    ) -> None:
        self.outcomes: dict[Mutant, str] = {}
        self.problems: list[str] = []
        self._source, self._mutants, self._jobs = source, mutants, jobs
        self._limit, self._twice = limit, twice
        self._terminal = os.dup(2)
        self._failed = False

    @property
    def complete(self) -> bool:
        """Whether every mutant has an outcome."""
        return len(self.outcomes) == len(set(self._mutants))

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Note a failure."""
        self._failed = self._failed or report.failed

    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        """Run the tests without a change, then with each."""
        self._items = session.items
        gc.collect()
        files = {str(self._source / each.file) for each in self._mutants}
        self._functions = [each for each in gc.get_objects() if _is_of(each, files)]
        gc.freeze()  # a collection in a child must not copy the memory of this process
        with tempfile.TemporaryDirectory(prefix="mutants-") as folder:
            self._scratch = Path(folder)
            self._tests = self._measure()
            limit = max(self._limit, LIMIT_FACTOR * max((each.seconds for each in self._tests), default=0.0))
            in_memory = [each for each in self._mutants if each.functions]
            self._try(in_memory, self._run_in_memory, limit)
            again = SURVIVED if self._twice else None
            copies = [each for each in self._mutants if self.outcomes.get(each) in (None, again)]
            self._try(copies, self._run_on_copy, 3 * limit)
        return True

    # ---- without a change

    def _measure(self) -> list[Test]:
        """Run each test once, and return those that pass with what they reach; the fastest first."""
        report = self._scratch / "tests.json"
        _wait(_fork(lambda: self._write_report(report), None, self._scratch))
        if not report.exists():
            raise RuntimeError((self._scratch / "error.txt").read_text(encoding="utf-8"))
        found = json.loads(report.read_text(encoding="utf-8"))
        failing = [self._items[index].nodeid for index, passed, *_ in found if not passed]
        self.problems += [f"left out, as it fails without a change: {each}" for each in failing]
        tests = [
            Test(index, seconds, {file: set(lines) for file, lines in reached.items()})
            for index, passed, seconds, reached in found
            if passed
        ]
        return sorted(tests, key=lambda each: each.seconds)

    def _write_report(self, report: Path) -> bool:
        from coverage import Coverage  # here: it must not be in the processes that run mutants

        files = {str(self._source / each.file): each.file for each in self._mutants}
        measured = Coverage(data_file=None, include=list(files), config_file=False)
        measured.set_option("run:disable_warnings", ["no-data-collected"])
        found: list[tuple[int, bool, float, dict[str, list[int]]]] = []
        with measured.collect():
            for index in range(len(self._items)):
                measured.switch_context(str(index))
                began = time.monotonic()
                found.append((index, self._passes([index]), time.monotonic() - began, {}))
        data = measured.get_data()
        for path in data.measured_files():
            for line, tests in data.contexts_by_lineno(path).items():
                for test in filter(None, tests):
                    found[int(test)][3].setdefault(files[path], []).append(line)
        report.write_text(json.dumps(found), encoding="utf-8")
        return True

    def _passes(self, indexes: Sequence[int]) -> bool:
        """Run tests until one fails."""
        self._failed = False
        items = [self._items[index] for index in indexes]
        for item, following in zip(items, [*items[1:], None], strict=True):
            item.ihook.pytest_runtest_protocol(item=item, nextitem=following)
            if self._failed:
                return False
        return True

    # ---- with a change

    def _try(self, mutants: Sequence[Mutant], run: Callable[[Mutant, list[int]], bool], limit: float) -> None:
        """Run mutants, some at the same time."""
        running: dict[int, tuple[Mutant, _Progress]] = {}
        waiting = list(reversed(mutants))
        while waiting or running:
            while waiting and len(running) < self._jobs:
                mutant = waiting.pop()
                tests = self._tests_for(mutant)
                if not tests:
                    self.outcomes[mutant] = UNREACHED
                    continue
                folder = Path(tempfile.mkdtemp(dir=self._scratch))
                process = _fork(lambda: run(mutant, tests), limit, folder)  # noqa: B023 - called by the child at once
                running[process] = (mutant, _Progress(process))
            for process, (mutant, progress) in list(running.items()):
                if progress.has_ceased():
                    _kill(process)
                if (status := _ended(process)) is not None:
                    del running[process]
                    self.outcomes[mutant] = {0: SURVIVED, 1: KILLED}.get(status, LOOPS)
                    self._show(mutant, len(waiting) + len(running))
            time.sleep(0.02)

    def _show(self, mutant: Mutant, left: int) -> None:
        """Show progress on the terminal, which pytest has taken."""
        where, change = f"{mutant.file}:{mutant.line}", mutant.text.splitlines()[0]
        os.write(self._terminal, f"{left} left: {self.outcomes[mutant]}: {where}: {change}\n".encode())

    def _tests_for(self, mutant: Mutant) -> list[int]:
        """The tests that reach the changed line; the file, if the line runs on import only."""
        reaching = [each for each in self._tests if mutant.file in each.lines]
        if not mutant.functions:
            return [each.index for each in reaching]
        span = set(range(mutant.line, mutant.last_line + 1))
        return [each.index for each in reaching if each.lines[mutant.file] & span]

    def _run_in_memory(self, mutant: Mutant, tests: list[int]) -> bool:
        path = self._source / mutant.file
        changed = compile(mutant.apply(path.read_bytes()), str(path), "exec", dont_inherit=True)
        _replace_code(self._functions, str(path), mutant, changed)
        return self._passes(tests)

    def _run_on_copy(self, mutant: Mutant, tests: list[int]) -> bool:
        """Run tests by a new interpreter, which replaces this process."""
        copy = Path(os.environ["PYTEST_DEBUG_TEMPROOT"]) / "src"
        shutil.copytree(self._source, copy, ignore=shutil.ignore_patterns("*.egg-info", "__pycache__"))
        (copy / mutant.file).write_bytes(mutant.apply((self._source / mutant.file).read_bytes()))
        names = copy.parent / "tests.txt"
        names.write_text("\n".join(self._items[index].nodeid for index in tests), encoding="utf-8")
        os.environ |= {"PYTHONPATH": str(copy), "PYTHONDONTWRITEBYTECODE": "1"}
        os.execv(sys.executable, [sys.executable, "-m", "pytest", f"@{names}", "-x", *OPTIONS])


OPTIONS = ("-q", "-p", "no:cacheprovider", "-p", "no:rerunfailures", "-m", NOT_HERE)


def _is_of(each: object, files: Container[str]) -> bool:
    return isinstance(each, FunctionType) and each.__code__.co_filename in files


def _replace_code(functions: Sequence[FunctionType], path: str, mutant: Mutant, changed: CodeType) -> None:
    """Give every function around the change its new code; those that exist are all that tests can call."""
    new = {(each.co_name, each.co_firstlineno): each for each in _codes(changed)}
    for function in functions:
        if function.__code__.co_filename == path:
            key = function.__code__.co_name, function.__code__.co_firstlineno
            if key in mutant.functions and key in new:
                with suppress(ValueError):  # other free variables: a new process tries this mutant again
                    function.__code__ = new[key]


def _codes(code: CodeType) -> Iterator[CodeType]:
    for each in code.co_consts:
        if isinstance(each, CodeType):
            yield each
            yield from _codes(each)


# ---- processes


def _fork(run: Callable[[], bool], limit: float | None, folder: Path) -> int:
    """Start a child that runs a function in silence, with limits of its processor time and memory."""
    process = os.fork()
    if process:
        return process
    status = 70
    try:
        os.setsid()
        quiet = os.open(os.devnull, os.O_RDWR)
        for stream in (0, 1, 2):
            os.dup2(quiet, stream)
        os.environ["PYTEST_DEBUG_TEMPROOT"] = str(folder)
        if limit is not None:
            resource.setrlimit(resource.RLIMIT_CPU, (round(limit), round(limit) + 1))
            resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        status = 0 if run() else 1
    except BaseException:  # a mutant can do anything, such as ending the process
        (folder / "error.txt").write_text(traceback.format_exc(), encoding="utf-8")
        status = 1
    finally:
        os._exit(status)


class _Progress:
    """Notices that a child waits for ever: it uses no processor time, however busy the machine is."""

    def __init__(self, process: int) -> None:
        self._process = process
        self._used = -1.0
        self._since = time.monotonic()

    def has_ceased(self) -> bool:
        """Whether the child has used no processor time for a minute."""
        used = _processor_time(self._process)
        if used != self._used:
            self._used, self._since = used, time.monotonic()
        return time.monotonic() - self._since > ASLEEP


def _processor_time(process: int) -> float:
    try:
        fields = Path(f"/proc/{process}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()
    except OSError:  # not Linux, or it has ended
        return 0.0
    return float(fields[11]) + float(fields[12])


def _ended(process: int) -> int | None:
    """Return the exit code of a child, or None if it is running; negative for a signal."""
    found, status = os.waitpid(process, os.WNOHANG)
    if not found:
        return None
    _kill(process)  # what its tests have left
    return os.waitstatus_to_exitcode(status)


def _wait(process: int) -> None:
    while _ended(process) is None:
        time.sleep(0.05)


def _kill(process: int) -> None:
    with suppress(ProcessLookupError, PermissionError):
        os.killpg(process, signal.SIGKILL)


# ---- subjects and reports


def changes_of(source: Path, package: str) -> list[Mutant]:
    """Return all mutants of a package's files."""
    files = sorted(each.relative_to(source).as_posix() for each in (source / package).rglob("*.py"))
    wanted = [each for each in files if not any(part in each for part in WITHOUT)]
    return [mutant for file in wanted for mutant in mutants_of(file, (source / file).read_bytes())]


def chosen(mutants: list[Mutant], sample: int, seed: int, shard: tuple[int, int]) -> list[Mutant]:
    """Draw a sample (0 for all), and return one part of it."""
    drawn = random.Random(seed).sample(mutants, min(sample or len(mutants), len(mutants)))
    return sorted(drawn)[shard[0] - 1 :: shard[1]]


def score(outcomes: dict[Mutant, str]) -> float:
    """Return the percentage of mutants that the tests notice."""
    killed = sum(each in (KILLED, LOOPS) for each in outcomes.values())
    return 100.0 * killed / len(outcomes) if outcomes else 100.0


def report(package: str, outcomes: dict[Mutant, str], source: Path) -> list[str]:
    """Return the lines of a report: scores of the package and its files, and the changes that survived."""
    lines = [f"{package}: {_counts(outcomes)}"]
    for file in sorted({each.file for each in outcomes}):
        of_file = {mutant: each for mutant, each in outcomes.items() if mutant.file == file}
        lines.append(f"    {file.removeprefix(package + '/')}: {_counts(of_file)}")
    for mutant, outcome in sorted(outcomes.items()):
        if outcome in (SURVIVED, UNREACHED):
            lines += [
                "",
                f"{mutant.file}:{mutant.line}: {outcome} ({mutant.operator})",
                *_diff(mutant, source),
            ]
    return lines


def _counts(outcomes: dict[Mutant, str]) -> str:
    found = list(outcomes.values())
    killed = found.count(KILLED) + found.count(LOOPS)
    rest = ", ".join(f"{found.count(each)} {each}" for each in (LOOPS, UNREACHED) if each in found)
    return f"{killed} of {len(found)} killed ({score(outcomes):.0f} %)" + (f"; {rest}" if rest else "")


def _diff(mutant: Mutant, source: Path) -> list[str]:
    before = (source / mutant.file).read_bytes()
    old, new = (each.decode().splitlines() for each in (before, mutant.apply(before)))
    return list(difflib.unified_diff(old, new, n=0, lineterm=""))[3:]


def try_mutants(root: Path, tests: Sequence[str], trial: Trial) -> None:
    """Run tests against mutants, in a pytest of this process."""
    os.chdir(root)
    sys.path.insert(0, str(root / "src"))
    os.environ["PYTHONPATH"] = str(root / "src")  # for programs that tests start
    said, sys.stdout = sys.stdout, io.StringIO()
    try:
        code = pytest.main([*tests, *OPTIONS], plugins=[trial])
    finally:
        output, sys.stdout = sys.stdout.getvalue(), said
    if code not in (pytest.ExitCode.OK, pytest.ExitCode.NO_TESTS_COLLECTED) or not trial.complete:
        raise SystemExit(f"error: the tests cannot be collected\n{output}")


def main(arguments: Sequence[str]) -> int:
    """Run what the command line says."""
    given = _parser().parse_args(arguments)
    subjects = given.subjects or [each.removeprefix("jacaros/") for each in SUBJECTS]
    if len(subjects) > 1:  # a process has one collection of tests
        options = [each for each in arguments if each not in subjects]
        command = [sys.executable, __file__]
        return max(subprocess.run([*command, each, *options], check=False).returncode for each in subjects)
    package, _, folder = subjects[0].partition("=")
    if not folder:
        package = f"jacaros/{package.removeprefix('jacaros/')}"
        if package not in SUBJECTS:
            raise SystemExit(
                f"error: unknown subject: {package}\n  = help: give its tests, as in {package}=tests/unit"
            )
    source = given.root / "src"
    wanted = chosen(changes_of(source, package), given.sample, given.seed, given.shard)
    if given.files:
        wanted = [each for each in wanted if any(part in each.file for part in given.files)]
    trial = Trial(source, wanted, given.jobs, given.limit, not given.once)
    try_mutants(given.root, folder.split(",") if folder else SUBJECTS[package], trial)
    print(*trial.problems, *report(package, trial.outcomes, source), sep="\n", flush=True)
    return 1 if score(trial.outcomes) < given.least else 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(description="Count the one-line changes that tests notice.")
    names = ", ".join(each.removeprefix("jacaros/") for each in SUBJECTS)
    parser.add_argument("subjects", nargs="*", help=f"packages (default: {names}), or PACKAGE=TESTS,TESTS")
    parser.add_argument(
        "--sample", type=int, default=SAMPLE, help=f"mutants of a package (default {SAMPLE}; 0: all)"
    )
    parser.add_argument("--seed", type=int, default=1, help="seed of the sample (default 1)")
    parser.add_argument(
        "--shard", type=_shard, default=(1, 1), metavar="I/N", help="the I-th of N parts of the sample"
    )
    parser.add_argument(
        "--files", nargs="+", help="of the sample, only files with one of these texts in their names"
    )
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="mutants at the same time")
    limits = f"seconds of processor time of a mutant, or {LIMIT_FACTOR:g} times the slowest test (default {LIMIT:g})"
    parser.add_argument("--limit", type=float, default=LIMIT, help=limits)
    once = "do not try survivors again on a copy: faster, and the score is a lower bound"
    parser.add_argument("--once", action="store_true", help=once)
    parser.add_argument("--least", type=float, default=0.0, help="least score in percent (default 0)")
    parser.add_argument("--root", type=Path, default=ROOT, help="folder with src and tests")
    return parser


def _shard(text: str) -> tuple[int, int]:
    part, _, parts = text.partition("/")
    found = int(part), int(parts)
    if not 1 <= found[0] <= found[1]:
        raise argparse.ArgumentTypeError(f"expected I/N with 1 <= I <= N, found {text}")
    return found


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
