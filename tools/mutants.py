"""Change one place of a package at a time, and count the changes that its tests notice.

mutants.py                                  a sample of each subject; prints the scores and the surviving changes
mutants.py agents/mind/rules agents/terms agents/mind/state        the mind's, whose tests are measured once
mutants.py robots/artifacts --sample 0      all changes of one subject
mutants.py ros --sample 150 --seed 3 --shard 2/4
mutants.py terms --files agents/terms/text.py:41:  of the sample, those of a file or a line
mutants.py pkg=tests/pkg --root FOLDER      another package (of FOLDER/src) and its tests

A sample takes the same share of each file. One process collects the tests and forks. A first child runs them all and notes
which lines each test reaches. Then a child for each mutant replaces the code of the changed function in memory and runs the
tests that reach the line, fastest first, until one fails. A mutant that survives this, or changes code that runs on import,
is tried again by a new process on a copy of the source, because programs that tests start and values made on import do not
see the change in memory. (Survivors of the mind's tests are not tried again: these tests start few programs.) A child whose
test uses too much time counts as killed: its mutant loops.

Exit code: 0, or 1 if a score is below ``--least``.
"""

import argparse
import difflib
import gc
import importlib
import io
import itertools
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
from collections.abc import Callable, Container, Iterable, Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from types import CodeType, FunctionType
from typing import NamedTuple

import pytest
from mutation_operators import Mutant, mutants_of

ROOT = Path(__file__).resolve().parent.parent
MIND = (
    "tests/unit/agents",
    "tests/unit/robots/streams",
    "tests/unit/runtime/mas/debugging",
    "tests/integration/test_resources.py",
    "tests/conformance",
)
SUBJECTS: dict[str, tuple[str, ...]] = {
    "jacaros/agents/mind/rules": MIND,
    "jacaros/agents/terms": MIND,
    "jacaros/agents/mind/state": MIND,
    "jacaros/robots/artifacts": ("tests/unit/robots",),
    "jacaros/robots/mapping": ("tests/unit/robots",),
    "jacaros/robots/plane": ("tests/unit/robots/plane",),
    "jacaros/robots/ros": ("tests/unit/robots/ros", "tests/contracts"),
    "jacaros/robots/world": ("tests/unit/robots/world",),
}
"""Packages below ``src``, and the tests that must notice changes of them."""

WITHOUT = ("robots/ros/drivers/ros1/", "robots/ros/drivers/ros2/")
"""Files whose tests need a real ROS."""

NOT_HERE = "not ros1 and not ros2 and not rosbridge and not mqtt and not browser"
SAMPLE, SAMPLES = 120, {"jacaros/agents/mind/rules": 200}
LIMIT, LIMIT_FACTOR = 5.0, 10.0
TESTS_FOR = 20.0
"""Seconds of tests, as measured without a change, that one mutant is given."""
MEMORY = 4 << 30
ASLEEP = 60.0
"""Seconds with hardly any processor time after which a mutant is taken for one that waits for ever."""
HARDLY = 0.01
"""Share of the processor time."""
KILLED, LOOPS, SURVIVED, UNREACHED = "killed", "killed by the time limit", "survived", "reached by no test"
NOT_IN_MEMORY = "not changed in memory"
OUTCOMES = {0: SURVIVED, 1: KILLED, 2: NOT_IN_MEMORY}
"""What the exit code of a child means; any other is that of a child that was stopped."""


class Measured(NamedTuple):
    """The tests without a change: the seconds of those that pass, and the tests that reach each mutant, by indexes."""

    seconds: dict[int, float]
    reaching: list[list[int]]
    failing: list[int]
    modules: list[str]


class Trial:
    """A plugin of pytest: in place of running the tests once, run those that a mutant needs, for every mutant."""

    def __init__(
        self, source: Path, mutants: Sequence[Mutant], jobs: int, limit: float = LIMIT, twice: bool = True
    ) -> None:
        self.outcomes: dict[Mutant, str] = {}
        self.problems: list[str] = []
        self._source, self._mutants, self._jobs = source, mutants, jobs
        self._places = {each: place for place, each in enumerate(mutants)}
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
        with tempfile.TemporaryDirectory(prefix="mutants-") as folder:
            self._scratch = Path(folder)
            self._tests = self._measure()
            self._prepare()
            in_memory = [each for each in self._mutants if each.functions]
            self._try(in_memory, self._run_in_memory)
            again = SURVIVED if self._twice else None
            copies = [
                each for each in self._mutants if self.outcomes.get(each) in (None, NOT_IN_MEMORY, again)
            ]
            self._try(copies, self._run_on_copy)
        return True

    def _prepare(self) -> None:
        """Import what the tests need, and find the functions that change: children must not import them anew."""
        for name in self._tests.modules:
            with suppress(ImportError):  # a test has made the module
                importlib.import_module(name)
        gc.collect()
        files = {str(self._source / each.file) for each in self._mutants}
        self._functions = [each for each in gc.get_objects() if _is_of(each, files)]
        gc.freeze()  # a collection in a child must not copy the memory of this process

    # ---- without a change

    def _measure(self) -> Measured:
        """Run each test once, and return what they do."""
        report = self._scratch / "tests.json"
        _wait(_fork(lambda: self._write_report(report), self._scratch))
        if not report.exists():
            raise RuntimeError((self._scratch / "error.txt").read_text(encoding="utf-8"))
        seconds, *rest = json.loads(report.read_text(encoding="utf-8"))
        found = Measured({int(index): each for index, each in seconds.items()}, *rest)
        failing = [self._items[index].nodeid for index in found.failing]
        self.problems += [f"left out, as it fails without a change: {each}" for each in failing]
        return found

    def _write_report(self, report: Path) -> bool:
        from coverage import Coverage  # here: it must not be in the processes that run mutants

        files = {str(self._source / each.file) for each in self._mutants}
        measured = Coverage(data_file=None, include=list(files), config_file=False)
        measured.set_option("run:disable_warnings", ["no-data-collected"])
        seconds, failing = {}, []
        with measured.collect():
            for index in range(len(self._items)):
                measured.switch_context(str(index))
                began = time.monotonic()
                if self._passes([index]):
                    seconds[index] = time.monotonic() - began
                else:
                    failing.append(index)
        lines = {file: measured.get_data().contexts_by_lineno(file) for file in files}
        reaching = [
            _reaching(lines[str(self._source / each.file)], each) & seconds.keys() for each in self._mutants
        ]
        modules = sorted(each for each in sys.modules if each.partition(".")[0] == "jacaros")
        found = Measured(seconds, [sorted(each) for each in reaching], failing, modules)
        report.write_text(json.dumps(found), encoding="utf-8")
        return True

    def _passes(self, indexes: Sequence[int], limits: Sequence[float] = ()) -> bool:
        """Run tests until one fails; one that takes more processor time than its limit ends the process."""
        self._failed = False
        items = [self._items[index] for index in indexes]
        for place, item in enumerate(items):
            if limits:
                signal.setitimer(signal.ITIMER_PROF, limits[place])
            following = items[place + 1] if place + 1 < len(items) else None
            item.ihook.pytest_runtest_protocol(item=item, nextitem=following)
            if self._failed:
                return False
        return True

    # ---- with a change

    def _try(self, mutants: Sequence[Mutant], run: Callable[[Mutant, list[int]], int]) -> None:
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
                process = _fork(lambda: run(mutant, tests), folder, self._limit_of(tests))  # noqa: B023 - called by the child at once
                running[process] = (mutant, _Progress(process))
            for process, (mutant, progress) in list(running.items()):
                if progress.has_ceased():
                    _kill(process)
                if (status := _ended(process)) is not None:
                    del running[process]
                    self.outcomes[mutant] = OUTCOMES.get(status, LOOPS)
                    self._show(mutant, len(waiting) + len(running))
            time.sleep(0.02)

    def _show(self, mutant: Mutant, left: int) -> None:
        """Show progress on the terminal, which pytest has taken."""
        where, change = f"{mutant.file}:{mutant.line}", mutant.text.splitlines()[0]
        os.write(self._terminal, f"{left} left: {self.outcomes[mutant]}: {where}: {change}\n".encode())

    def _tests_for(self, mutant: Mutant) -> list[int]:
        """The tests that reach the changed line (the file, if the line runs on import only), the fastest first."""
        seconds, found, total = self._tests.seconds, [], 0.0
        for index in sorted(self._tests.reaching[self._places[mutant]], key=seconds.__getitem__):
            total += seconds[index]
            if found and total > TESTS_FOR:
                break
            found.append(index)
        return found

    def _limits_of(self, tests: Sequence[int]) -> list[float]:
        return [max(self._limit, LIMIT_FACTOR * self._tests.seconds[index]) for index in tests]

    def _limit_of(self, tests: Sequence[int]) -> float:
        """Return the processor time of a child that runs tests; a new process also imports and collects."""
        slowest = max(self._limits_of(tests))
        return 5 * self._limit + slowest + 2 * sum(self._tests.seconds[index] for index in tests)

    def _run_in_memory(self, mutant: Mutant, tests: list[int]) -> int:
        path = self._source / mutant.file
        changed = compile(mutant.apply(path.read_bytes()), str(path), "exec", dont_inherit=True)
        if not _replace_code(self._functions, str(path), mutant, changed):
            return 2
        return 0 if self._passes(tests, self._limits_of(tests)) else 1

    def _run_on_copy(self, mutant: Mutant, tests: list[int]) -> int:
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


def _reaching(tests_of: dict[int, list[str]], mutant: Mutant) -> set[int]:
    """Return the tests that run a line of a change; any line of the file, if the change is of code that runs on import."""
    lines: Iterable[int] = range(mutant.line, mutant.last_line + 1) if mutant.functions else tests_of
    return {int(test) for line in lines for test in tests_of.get(line, ()) if test}


def _replace_code(functions: Sequence[FunctionType], path: str, mutant: Mutant, changed: CodeType) -> bool:
    """Give every function around the change its new code, and return whether there are such functions."""
    new = {(each.co_name, each.co_firstlineno): each for each in _codes(changed)}
    replaced = False
    for function in functions:
        if function.__code__.co_filename == path:
            key = function.__code__.co_name, function.__code__.co_firstlineno
            if key in mutant.functions and key in new:
                with suppress(ValueError):  # other free variables: a new process tries this mutant
                    function.__code__ = new[key]
                    replaced = True
    return replaced


def _codes(code: CodeType) -> Iterator[CodeType]:
    for each in code.co_consts:
        if isinstance(each, CodeType):
            yield each
            yield from _codes(each)


# ---- processes


def _fork(run: Callable[[], int], folder: Path, limit: float | None = None) -> int:
    """Start a child that runs a function in silence, with limits of its processor time and memory; return its process."""
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
        status = run()
    except BaseException:  # a mutant can do anything, such as ending the process
        (folder / "error.txt").write_text(traceback.format_exc(), encoding="utf-8")
        status = 1
    finally:
        os._exit(status)


class _Progress:
    """Notices that a child waits for ever: it uses hardly any processor time, however busy the machine is."""

    def __init__(self, process: int) -> None:
        self._process = process
        self._used = 0.0
        self._since = time.monotonic()

    def has_ceased(self) -> bool:
        """Whether the child has used hardly any processor time for a minute; a thread that looks around uses a little."""
        passed = time.monotonic() - self._since
        if passed <= ASLEEP:
            return False
        before, self._used = self._used, _processor_time(self._process)
        self._since += passed
        return self._used - before < HARDLY * passed


def _processor_time(process: int) -> float:
    """Return the seconds of processor time that a process has used; 0 if unknown."""
    try:
        fields = Path(f"/proc/{process}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()
    except OSError:  # not Linux, or it has ended
        return 0.0
    return (float(fields[11]) + float(fields[12])) / os.sysconf("SC_CLK_TCK")


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
    """Draw a sample (0 for all) with the same share of each file, and return one part of it."""
    generator, places = random.Random(seed), []
    by_file = itertools.groupby(sorted(mutants), key=lambda each: each.file)
    for group in (list(each) for _, each in by_file):
        generator.shuffle(group)
        places += [((place + generator.random()) / len(group), each) for place, each in enumerate(group)]
    drawn = [each for _, each in sorted(places)[: sample or None]]
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
    packages = dict(map(_package_and_tests, subjects))
    if len(set(packages.values())) > 1:  # a process has one collection of tests
        options = [each for each in arguments if each not in subjects]
        same = [
            [each for each in subjects if _package_and_tests(each)[1] == tests]
            for tests in dict.fromkeys(packages.values())
        ]
        command = [sys.executable, __file__]
        return max(subprocess.run([*command, *each, *options], check=False).returncode for each in same)
    source = given.root / "src"
    samples = {each: _sample(source, each, given) for each in packages}
    wanted = [mutant for each in samples.values() for mutant in each]
    tests = next(iter(packages.values()))
    trial = Trial(source, wanted, given.jobs, given.limit, not given.once and tests != MIND)
    try_mutants(given.root, tests, trial)
    print(*trial.problems, sep="\n")
    return max(_report(package, sample, trial, given) for package, sample in samples.items())


def _package_and_tests(subject: str) -> tuple[str, tuple[str, ...]]:
    """Return the package of a subject and the tests that must notice its changes."""
    package, _, folders = subject.partition("=")
    if folders:
        return package, tuple(folders.split(","))
    package = f"jacaros/{package.removeprefix('jacaros/')}"
    if package not in SUBJECTS:
        raise SystemExit(
            f"error: unknown subject: {package}\n  = help: give its tests, as in {package}=tests/unit"
        )
    return package, SUBJECTS[package]


def _sample(source: Path, package: str, given: argparse.Namespace) -> list[Mutant]:
    """Return the mutants of a package that the command line asks for."""
    sample = SAMPLES.get(package, SAMPLE) if given.sample is None else given.sample
    drawn = chosen(changes_of(source, package), sample, given.seed, given.shard)
    wanted = given.files or [""]
    return [each for each in drawn if any(part in f"{each.file}:{each.line}:" for part in wanted)]


def _report(package: str, sample: list[Mutant], trial: Trial, given: argparse.Namespace) -> int:
    """Print the report on a package, and return its exit code."""
    outcomes = {each: trial.outcomes[each] for each in sample}
    print(*report(package, outcomes, given.root / "src"), sep="\n", flush=True)
    return 1 if score(outcomes) < given.least else 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(description="Count the one-line changes that tests notice.")
    names = ", ".join(each.removeprefix("jacaros/") for each in SUBJECTS)
    parser.add_argument("subjects", nargs="*", help=f"packages (default: {names}), or PACKAGE=TESTS,TESTS")
    parser.add_argument(
        "--sample",
        type=int,
        help=f"mutants of a package (default {SAMPLE}, 200 of agents/mind/rules; 0: all)",
    )
    parser.add_argument("--seed", type=int, default=1, help="seed of the sample (default 1)")
    parser.add_argument(
        "--shard", type=_shard, default=(1, 1), metavar="I/N", help="the I-th of N parts of the sample"
    )
    parser.add_argument(
        "--files", nargs="+", help="of the sample, only changes with one of these texts in FILE:LINE:"
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
