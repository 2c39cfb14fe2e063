"""Run every part of the test suite, several at a time, and tell at the end what passed, what failed, what did not run.

    test_all.py [--all] [--list] [PART ...]     the parts, or the named ones with what they need; --all: repeats, too

All parts run even when one fails; the exit code is 1 if any did.  A part that this machine cannot run (exit code
3 of its script: no root for a ROS installation, no such interpreter, ...) is reported in capitals at the end; with
CI=true it is a failure.  Logs go to runs/test/.

A part is stopped when it makes no progress or takes far more processor time than it should, never because time has passed:
the machine may be busy with other things.

Two parts that compute run at a time, and beside them `WAITING` parts on real graphs, which wait most of the time; in each
row those that take longest go first.  What compares moments some 40 ms apart runs last, alone.
"""

import argparse
import contextlib
import os
import signal
import subprocess
import sys
import threading
import time
from collections import deque
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
LOGS = ROOT / "runs" / "test"
PYTHON = sys.executable
BIN = Path(PYTHON).parent
NOT_HERE = 3
"""Exit code of a script that cannot do its work on this machine."""

INSTALL = ("tools/install_program.sh",)
PYTEST = (PYTHON, "-m", "pytest", "-q", "-p", "no:cacheprovider")
OTHER_SYSTEMS = tuple(
    f"{PYTHON} -m mypy --platform {name} --cache-dir .mypy_cache/{name} src/jacaros"
    for name in ("win32", "darwin")
)
"""The package as Python is elsewhere: names that Windows or macOS does not have are errors of types."""
SMOKE = ("tests/unit/agents/compiler", "tests/unit/artifacts/env", "tests/unit/agents/python")
"""Tests that show in seconds whether another Python works: code that we generate, annotations, asyncio."""

REAL_GRAPHS = {
    "integration": ("tests/integration",),
    "scenarios": ("tests/scenarios",),
    "contracts": (
        "tests/contracts",
        "tests/packaging/test_ament.py",
        "tests/unit/robots/ros/test_ros_ros1_types.py",
    ),
}
"""Suites that run on every real graph, those that take longest first."""

PROCESSES = "tests/fleet/test_processes.py"
"""Tests in which members of a fleet notice within seconds that others are killed, frozen or cut off."""
WAITING = 3
"""Parts that mostly wait, and so run at the same time beside those that compute."""

RUNAWAY = 5
"""A part that takes so many times its budget of processor time does not end: machines differ by less."""

ONCE_MORE = ("--reruns", "1", "-r", "afER")
"""For parts of several processes that talk over sockets in real time: a test that fails twice has failed.  One that failed
once is counted as rerun in the closing line and named in the log: there is something to look into."""


@dataclass(frozen=True)
class Part:
    """One part of the suite.

    Attributes:
        name: what people call it.
        command: run in the project's folder, without standard input.
        stage: ``install`` (in turn), ``work`` and ``waiting`` (beside each other), ``real-time`` (alone).
        needs: a part that must have passed before.
        budget: seconds of processor time that it takes, processes that it starts included. The closing table shows
            where a part takes more, and one that takes `RUNAWAY` times as much is stopped.
        quiet_minutes: a part that prints nothing for so long has hung and is stopped: no further test has ended.
        skips_fail: a test that was skipped fails the part.
        repeats: runs what another part has run, in another environment; only with ``--all``.
    """

    name: str
    command: tuple[str, ...]
    stage: str = "work"
    needs: str | None = None
    budget: float | None = None
    quiet_minutes: float = 10
    skips_fail: bool = False
    repeats: bool = False


def parts() -> list[Part]:
    """All parts, in the order in which they start."""
    found = [
        Part("chromium", (*INSTALL, "chromium", "chromium", "chromium-browser", "google-chrome"), "install"),
        Part("site-install", ("tools/install_site_checks.sh",), "install"),
        Part("live-build", (PYTHON, "tools/build_live.py", "build/live"), "install"),
        Part("mosquitto", (*INSTALL, "mosquitto", "mosquitto"), "install"),
        Part("zsh", (*INSTALL, "zsh", "zsh"), "install"),
        Part("fish", (*INSTALL, "fish", "fish"), "install", needs="zsh"),
        Part("compiler", (*INSTALL, "build-essential", "cc"), "install"),
        Part("tree-sitter", (*INSTALL, "libtree-sitter-dev", "/usr/include/tree_sitter/parser.h"), "install"),
        Part("neovim", (*INSTALL, "neovim", "nvim"), "install"),
        Part("ros1-install", ("tools/install_ros1.sh",), "install"),
        Part("ros2-jazzy-install", ("tools/install_ros2.sh", "jazzy"), "install"),
        Part("ros2-kilted-install", ("tools/install_ros2.sh", "kilted"), "install"),
        Part("style", (f"{BIN}/ruff", "check", ".")),
        Part("format", (f"{BIN}/ruff", "format", "--check", ".")),
        Part(
            "types",
            ("sh", "-c", " && ".join((f"{PYTHON} -m mypy", *OTHER_SYSTEMS, f"{BIN}/pyright"))),
            budget=145,
        ),
        Part("layers", (f"{BIN}/lint-imports", "--no-logo")),
        Part("unit", (*PYTEST, "tests/unit", "-m", "not browser"), budget=245),
        Part("wheel", ("tools/test_wheel.sh",)),
        Part("recorded", (*PYTEST, "tests/conformance"), budget=15),
        # The checker prints at its end.
        Part("conformance", (PYTHON, "tools/check_conformance.py", "language"), budget=120, quiet_minutes=30),
        Part("plain", (PYTHON, "tools/check_conformance.py", "plain"), budget=180, quiet_minutes=30),
        Part("restored", (PYTHON, "tools/check_conformance.py", "restored"), budget=180, quiet_minutes=30),
        Part("formatted", (PYTHON, "tools/check_conformance.py", "formatted"), budget=120, quiet_minutes=30),
        Part(
            "environment", (PYTHON, "tools/check_conformance.py", "environment"), budget=50, quiet_minutes=30
        ),
        Part(
            "contracts",
            (*PYTEST, "tests/contracts", "-m", "not ros1 and not ros2 and not rosbridge and not mqtt"),
            budget=5,
        ),
        Part(
            "mqtt",
            (*PYTEST, "tests/contracts", "-m", "mqtt", "--require-mqtt"),
            "waiting",
            needs="mosquitto",
            budget=20,
        ),
        Part(
            "rosbridge",
            (*PYTEST, "tests/contracts", "-m", "rosbridge", "--require-rosbridge", *ONCE_MORE),
            "waiting",
            budget=115,
        ),
        Part(
            "integration",
            (*PYTEST, "tests/integration", "tests/compatibility", "-m", "not ros1 and not ros2", *ONCE_MORE),
            budget=60,
        ),
        Part("fleet", (*PYTEST, "tests/fleet", f"--ignore={PROCESSES}", *ONCE_MORE), "waiting", budget=240),
        Part("scenarios", (*PYTEST, "tests/scenarios", "-m", "not ros1 and not ros2"), budget=165),
        Part("experiment", (PYTHON, "experiment/run.py", "--quick"), budget=150, quiet_minutes=30),
        Part("faults", (*PYTEST, "tests/faults"), budget=10),
        Part("examples", (f"{BIN}/jacaros", "test", "examples"), budget=5),
        Part("fuzz", (PYTHON, "tools/fuzz.py", "--minutes", "1"), budget=620, repeats=True),
        Part("docs", (*PYTEST, "tests/docs", "tests/packaging", "-m", "not ros2"), budget=100),
        Part("mistakes", (*PYTEST, "tests/mistakes"), budget=170),
        Part("shells", (*PYTEST, "tests/shells"), needs="fish", skips_fail=True),
        Part("browser", (*PYTEST, "tests/unit/look", "-m", "browser"), needs="chromium", skips_fail=True),
        Part("site", (*PYTEST, "tests/site"), needs="site-install", budget=600, skips_fail=True),
        Part(
            "editors", ("tools/test_editors.sh", "tests/editors"), needs="neovim", budget=120, skips_fail=True
        ),
        Part("live", (*PYTEST, "tests/live"), needs="live-build", budget=120, skips_fail=True),
    ]
    for minor in (12, 13, 14):
        python = newer_python(minor)
        if python is not None:
            command = ("tools/test_python.sh", str(python))
            found.append(Part(f"python3.{minor}", command, needs="wheel", budget=200, repeats=True))
            found.append(Part(f"python3.{minor}-smoke", (*command, *SMOKE), needs="wheel", budget=25))
    found.append(Part("fleet-processes", (*PYTEST, PROCESSES, *ONCE_MORE), "real-time", budget=80))
    found.append(Part("real-time", (PYTHON, "tools/check_conformance.py", "real-time"), "real-time"))
    for suite, folders in REAL_GRAPHS.items():
        for name in ("ros1", "ros2-jazzy", "ros2-kilted"):
            python, kind = str(ROOT / f".venv-{name}" / "bin" / "python"), name.partition("-")[0]
            # Discovery in a real graph loses a first message now and then.
            command = (python, *PYTEST[1:], *folders, "-m", kind, f"--require-{kind}", *ONCE_MORE)
            found.append(Part(f"{name}-{suite}", command, "waiting", f"{name}-install", budget=90))
    return found


def newer_python(minor: int) -> Path | None:
    """An interpreter 3.*minor* of this machine, on the path or beside pyenv's others."""
    if sys.version_info[:2] == (3, minor):
        return None
    folders = [Path(folder) for folder in os.environ.get("PATH", "").split(os.pathsep) if folder]
    folders += sorted(Path.home().glob(f".pyenv/versions/3.{minor}.*/bin"))
    for python in (folder / f"python3.{minor}" for folder in folders):
        try:
            # A shim of pyenv is there for versions that are not; only one that runs counts.
            subprocess.run(
                (python, "-c", "import venv, ensurepip"), check=True, capture_output=True, timeout=60
            )
        except (OSError, subprocess.SubprocessError):
            continue
        return python
    return None


@dataclass
class Result:
    """How a part went; `verdict` is ``ok``, ``FAILED`` or ``NOT RUN``; `processor` is in seconds, too."""

    part: Part
    verdict: str
    seconds: float
    processor: float
    closing_line: str

    @property
    def over_budget(self) -> bool:
        """Whether it took so much more processor time that tests have become slow."""
        return self.part.budget is not None and self.processor > 1.5 * self.part.budget


class Run:
    """Starts the parts and keeps their results."""

    def __init__(self, chosen: list[Part], must_run: bool) -> None:
        self._must_run = must_run
        self._chosen = chosen
        self._started = threading.Lock()
        self._children: set[subprocess.Popen[bytes]] = set()
        self._stopped = False
        self.results: dict[str, Result] = {}

    def everything(self) -> None:
        """Run all stages."""

        def stage(name: str) -> deque[Part]:
            return deque(part for part in self._chosen if part.stage == name)

        needed = {part.needs for part in self._chosen}
        longest = sorted(stage("work"), key=lambda part: (part.name not in needed, -(part.budget or 0)))
        work, waiting = deque(longest), stage("waiting")
        beside = [(deque[Part](), waiting)] * WAITING
        self._side_by_side((stage("install"), work), (deque(), work), *beside)
        self._work(stage("real-time"), deque())

    def _side_by_side(self, *queues: tuple[deque[Part], deque[Part]]) -> None:
        workers = [threading.Thread(target=self._work, args=each) for each in queues]
        for worker in workers:
            worker.start()
        for worker in workers:
            worker.join()

    def _work(self, own: deque[Part], common: deque[Part]) -> None:
        while (part := self._next(own, common)) is not None:
            self._run(part)

    def _next(self, own: deque[Part], common: deque[Part]) -> Part | None:
        """The next part whose need is met; waits for one that another worker is about to finish."""
        while True:
            with self._started:
                if self._stopped:
                    return None
                if own:
                    return own.popleft()
                for part in common:
                    if part.needs is None or part.needs in self.results or not self._is_coming(part.needs):
                        common.remove(part)
                        return part
                if not common:
                    return None
            time.sleep(0.2)

    def _is_coming(self, name: str) -> bool:
        return any(part.name == name for part in self._chosen)

    def _run(self, part: Part) -> None:
        needed = self.results.get(part.needs) if part.needs is not None else None
        if needed is not None and needed.verdict != "ok":
            self._finish(Result(part, needed.verdict, 0.0, 0.0, f"needs {part.needs}"), LOGS / "none")
            return
        log = LOGS / f"{part.name}.log"
        say(f"start    {part.name}")
        began = time.monotonic()
        code, processor = self._call(part, log)
        seconds = time.monotonic() - began
        closing_line = last_line(log)
        verdict = "ok" if code == 0 else "FAILED"
        if code == NOT_HERE and part.command[0].startswith("tools/"):
            verdict = "FAILED" if self._must_run else "NOT RUN"
        if part.skips_fail and " skipped" in closing_line:
            verdict = "FAILED"
        self._finish(Result(part, verdict, seconds, processor, closing_line), log)

    def _call(self, part: Part, log: Path) -> tuple[int, float]:
        """Run a part; return its exit code and the seconds of processor time that it took."""
        environment = {**os.environ, "PYTHON": PYTHON, "PYTHONUNBUFFERED": "1"}
        # Hundreds of processes start; none of them should have to compile the package again.
        environment.pop("PYTHONDONTWRITEBYTECODE", None)
        with log.open("wb") as output:
            try:
                child = subprocess.Popen(
                    part.command,
                    cwd=ROOT,
                    env=environment,
                    stdin=subprocess.DEVNULL,
                    stdout=output,
                    stderr=subprocess.STDOUT,
                    # What installs may ask for a password, and stays with the terminal for that.
                    start_new_session=part.stage != "install",
                )
            except OSError as error:
                output.write(f"cannot run {part.command[0]}: {error}\n".encode())
                return 127, 0.0
            self._children.add(child)
            try:
                reason, processor = watch(child, part, log)
                if reason is not None:
                    output.write(f"\nstopped: {reason}\n".encode())
                    return 124, processor
                return child.wait(), processor
            finally:
                end(child)
                self._children.discard(child)

    def _finish(self, result: Result, log: Path) -> None:
        if result.verdict == "FAILED" and log.is_file():
            text = log.read_text(errors="replace").splitlines()[-150:]
            say(
                "\n".join((f"----- {result.part.name}, end of {log.relative_to(ROOT)} -----", *text, "-----"))
            )
        say(f"{result.verdict:8} {result.part.name}  {result.seconds:.0f} s  {result.closing_line}")
        with self._started:
            self.results[result.part.name] = result

    def stop(self) -> None:
        """Start nothing more, and end what still runs."""
        self._stopped = True
        for child in list(self._children):
            end(child)


def watch(child: "subprocess.Popen[bytes]", part: Part, log: Path) -> tuple[str | None, float]:
    """Wait until a part has ended or has to be stopped.

    What limits a part is its progress and its processor time: how long a test takes says nothing on a busy machine.

    Returns:
        Why it has to be stopped, or None when it has ended, and the seconds of processor time that it took.
    """
    written, progress = 0, time.monotonic()
    while True:
        known = processes()
        processor = sum(known[process][1] for process in family(child.pid, known))
        with contextlib.suppress(subprocess.TimeoutExpired):
            child.wait(0.5)
            return None, processor
        if part.budget is not None and processor > RUNAWAY * part.budget:
            return f"{processor:.0f} s of processor time, {RUNAWAY} times its budget", processor
        if (size := log.stat().st_size) > written:
            written, progress = size, time.monotonic()
        if time.monotonic() - progress > part.quiet_minutes * 60:
            return f"no output for {part.quiet_minutes:g} minutes", processor


def end(child: "subprocess.Popen[bytes]") -> None:
    """End a part with its descendants, and whatever it left behind if it leads a group of its own."""
    descendants = family(child.pid, processes()) - {child.pid}
    for number in (signal.SIGTERM, signal.SIGKILL):
        try:
            if os.getpgid(0) == process_group(child):
                child.send_signal(number)
            else:
                os.killpg(child.pid, number)
            child.wait(5)
        except ProcessLookupError:
            break
        except subprocess.TimeoutExpired:
            continue
    child.wait()
    for process in descendants:
        with contextlib.suppress(ProcessLookupError):
            os.kill(process, signal.SIGKILL)


def process_group(child: "subprocess.Popen[bytes]") -> int:
    """The group that a part belongs to; its own when it has ended."""
    try:
        return os.getpgid(child.pid)
    except ProcessLookupError:
        return child.pid


def processes() -> dict[int, tuple[int, float]]:
    """Return the parent of each process of this machine, and the seconds of processor time that it took.

    Children that a process has waited for count as its own. Reads ``/proc``; empty on systems without it.
    """
    found = {}
    # Not `Path.glob`: it raises ProcessLookupError when a process ends between listing and looking.
    for number in filter(str.isdigit, os.listdir("/proc") if os.path.isdir("/proc") else ()):
        try:
            # The name of the program, in parentheses, may hold anything.
            fields = Path("/proc", number, "stat").read_text(errors="replace").rpartition(")")[2].split()
        except OSError:  # it has just ended
            continue
        found[int(number)] = int(fields[1]), sum(map(int, fields[11:15])) / os.sysconf("SC_CLK_TCK")
    return found


def family(root: int, known: dict[int, tuple[int, float]]) -> set[int]:
    """Return a process and its descendants, whatever sessions they have made for themselves."""
    members = {root} & known.keys()
    # Parents are not always older than their children, so repeat until no process is added.
    while more := {child for child, (parent, _) in known.items() if parent in members} - members:
        members |= more
    return members


def last_line(log: Path) -> str:
    """What a part said last, such as the closing line of pytest."""
    lines = [line for line in log.read_text(errors="replace").splitlines() if line.strip()]
    return lines[-1].strip()[:160] if lines else ""


def say(text: str) -> None:
    """Print at once and as a whole: two workers talk."""
    sys.stdout.write(text + "\n")
    sys.stdout.flush()


def report(results: list[Result], seconds: float) -> int:
    """Print the table; the exit code."""
    say("\n" + "=" * 100)
    say(f"{'':33} {'took':>8}  {'processor, budget':>17}")
    for result in results:
        budget = "" if result.part.budget is None else f"{result.part.budget:.0f} s"
        took = f"{result.seconds:6.0f} s  {result.processor:6.0f} s {budget:>8}"
        say(f"{result.verdict:8} {result.part.name:24} {took}  {result.closing_line[:90]}")
    over = [result.part.name for result in results if result.over_budget]
    failed = [result.part.name for result in results if result.verdict == "FAILED"]
    left_out = [result.part.name for result in results if result.verdict == "NOT RUN"]
    say("=" * 100)
    if left_out:
        say(f"\n!!!!! NOT RUN ON THIS MACHINE: {', '.join(left_out)} !!!!!")
        say("      Their logs in runs/test/ say what is missing.\n")
    passed = len(results) - len(failed) - len(left_out)
    say(
        f"{passed} parts passed, {len(failed)} failed, {len(left_out)} not run, in {seconds / 60:.1f} minutes"
    )
    if over:
        say(f"over their budget of processor time by half: {', '.join(over)}")
    if failed:
        say(f"FAILED: {', '.join(failed)}")
    return 1 if failed else 0


def choose(names: list[str], repeats: bool = False) -> list[Part]:
    """The named parts with what they need; when none is named, all, or all but the repeats."""
    known = {part.name: part for part in parts()}
    unknown = [name for name in names if name not in known]
    if unknown:
        sys.exit(f"test_all: no part {', '.join(unknown)}; there are {', '.join(known)}")
    wanted = set(names) or {name for name, part in known.items() if repeats or not part.repeats}
    wanted |= {needs for name in wanted if (needs := known[name].needs) is not None}
    return [part for name, part in known.items() if name in wanted]


def stop_ignoring_signals() -> None:
    """Give the parts the usual signals, even if this run was started by nohup or in the background of a script.

    A signal that is ignored stays ignored in children, and tests of how a program ends send it; one with a handler is as
    usual again in them.
    """
    if signal.getsignal(signal.SIGHUP) is signal.SIG_IGN:
        signal.signal(signal.SIGHUP, lambda *_: None)
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)


def main() -> int:
    """Run what the command line names."""
    parser = argparse.ArgumentParser(description="Run the test suite.")
    parser.add_argument("parts", nargs="*", metavar="PART")
    parser.add_argument("--all", action="store_true", help="run the repeats, too")
    parser.add_argument("--list", action="store_true", help="name the parts")
    arguments = parser.parse_args()
    if arguments.list:
        say("\n".join(f"{part.name:20} {' '.join(part.command)}" for part in parts()))
        return 0
    LOGS.mkdir(parents=True, exist_ok=True)
    chosen = choose(arguments.parts, arguments.all)
    run = Run(chosen, must_run=os.environ.get("CI", "").lower() in ("true", "1"))
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    stop_ignoring_signals()
    began = time.monotonic()
    try:
        run.everything()
    finally:
        run.stop()
    return report([run.results[part.name] for part in chosen], time.monotonic() - began)


if __name__ == "__main__":
    sys.exit(main())
