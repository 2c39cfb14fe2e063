"""Run random programs in two builds, or on two paths of one build, and show the first difference.

compare_builds.py --old ../before/src --new src --seconds 3600     two source trees, side by side
compare_builds.py --seconds 600                                    this tree with and without optimisations,
                                                                   and with searched contexts
compare_builds.py --seed 17 --programs 1 --show                    print the program with this number

Every program ends: goals call later goals only, and waits are short. The output of agents must be equal, in its order, and
with one tree also the log. A program that differs is reduced line by line, and written with both outputs to the folder
given by --into.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from random import Random

from running_programs import Writer

ROOT = Path(__file__).resolve().parent.parent
PATIENCE = 8.0
"""Time limit of a program in seconds; a slower program is skipped in both builds."""


def work(path: str) -> None:
    """Be a worker: read projects as lines, run each on one *path*, write the results as lines."""
    os.environ["JACAROS_PLAIN"] = str(int(path == "plain"))  # before the import, which reads it
    from jacaros.testing import run_project

    if path == "searched":
        from jacaros.agents.mind.generated import conditions  # here: may differ in the other build

        conditions._MAX_LOOPS = 0
    answers, sys.stdout = sys.stdout, sys.stderr
    for line in sys.stdin:
        with tempfile.TemporaryDirectory() as folder:
            for name, text in json.loads(line).items():
                (Path(folder) / name).write_text(text, encoding="utf-8")
            result = run_project(Path(folder) / "random.jcm", seconds=30, until_idle=True)
            told = [each.replace(folder, "") for each in result.errors]
        print(
            json.dumps({"lines": result.lines, "told": told, "code": result.exit_code}),
            file=answers,
            flush=True,
        )


class Build:
    """A process that runs programs in one build, on one path; restarted when a program blocks it."""

    def __init__(self, source: Path, path: str = "") -> None:
        self._source, self._path = source, path
        self._process: subprocess.Popen[str] | None = None

    def run(self, files: dict[str, str]) -> dict[str, object] | None:
        """Return the result of a project; None if it took too long or ended the process."""
        if self._process is None:
            command = (sys.executable, str(Path(__file__)), "--worker", self._path or "fast")
            self._process = subprocess.Popen(
                command,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
                text=True,
                env={**os.environ, "PYTHONPATH": str(self._source)},
            )
        process = self._process
        assert process.stdin is not None
        assert process.stdout is not None
        process.stdin.write(json.dumps(files) + "\n")
        process.stdin.flush()
        answer = _line_within(process, PATIENCE)
        if not answer:
            self.close()
            return None
        found: dict[str, object] = json.loads(answer)
        return found

    def close(self) -> None:
        """End the process."""
        if self._process is not None:
            self._process.kill()
            self._process.wait()
            self._process = None


def _line_within(process: "subprocess.Popen[str]", seconds: float) -> str:
    from threading import Timer

    timer = Timer(seconds, process.kill)
    timer.start()
    try:
        assert process.stdout is not None
        return process.stdout.readline()
    finally:
        timer.cancel()


class Comparison:
    """Runs each program in all builds.

    Args:
        builds: builds to run.
        prints_only: compare only the output of agents, not the log.
        into: folder for programs that differ.

    Attributes:
        ran, late, different: numbers of programs.
    """

    def __init__(self, builds: list[Build], prints_only: bool, into: Path) -> None:
        self._builds, self._prints_only, self._into = builds, prints_only, into
        self.ran = self.late = self.different = 0

    def take(self, seed: int) -> None:
        """Run the program with a number, and keep it if the results differ."""
        files = Writer(Random(seed)).files()
        self.ran += 1
        results = self._results(files)
        if results is None:
            self.late += 1
        elif _differ(results):
            self.different += 1
            self._keep(self._into / str(seed), self._shrunk(files))

    def close(self) -> None:
        """End the processes."""
        for build in self._builds:
            build.close()

    def _results(self, files: dict[str, str]) -> list[dict[str, object]] | None:
        """Return the result of a program in each build; None if it took too long in one of them."""
        results = []
        for build in self._builds:
            found = build.run(files)
            if found is None:
                return None
            results.append(found)
        return [{"lines": each["lines"]} for each in results] if self._prints_only else results

    def _shrunk(self, files: dict[str, str]) -> dict[str, str]:
        """Remove lines of the programs while the results differ, for at most a minute."""
        ends = time.monotonic() + 60
        for name in [name for name in files if name.endswith(".asl")]:
            lines, at = files[name].split("\n"), 0
            while at < len(lines) and time.monotonic() < ends:
                fewer = {**files, name: "\n".join(lines[:at] + lines[at + 1 :])}
                results = self._results(fewer)
                if results is not None and _differ(results) and all(each["lines"] for each in results):
                    files = fewer
                    del lines[at]
                else:
                    at += 1
        return files

    def _keep(self, folder: Path, files: dict[str, str]) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        for name, text in files.items():
            (folder / name).write_text(text, encoding="utf-8")
        for number, result in enumerate(self._results(files) or ()):
            (folder / f"result_{number}.json").write_text(json.dumps(result, indent=1), encoding="utf-8")
        print(f"different: {folder}", flush=True)


def _differ(results: list[dict[str, object]]) -> bool:
    return any(each != results[0] for each in results)


def main() -> int:
    """Compare until the time is over."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--old", type=Path, help="source tree of the other build")
    parser.add_argument("--new", type=Path, default=ROOT / "src", help="source tree of this one")
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--programs", type=int, default=1_000_000_000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--into", type=Path, default=ROOT / "runs" / "differences")
    parser.add_argument("--show", action="store_true", help="print the programs instead of running them")
    parser.add_argument("--worker", help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.worker:
        work(given.worker)
        return 0
    if given.show:
        for seed in range(given.seed, given.seed + given.programs):
            files = Writer(Random(seed)).files()
            print("\n".join(f"--- {name}\n{text}" for name, text in files.items()))
        return 0
    new = given.new.resolve()
    others = [Build(given.old.resolve())] if given.old else [Build(new, "plain"), Build(new, "searched")]
    comparison = Comparison([Build(new), *others], prints_only=given.old is not None, into=given.into)
    try:
        ends = time.monotonic() + given.seconds
        for seed in range(given.seed, given.seed + given.programs):
            if time.monotonic() > ends:
                break
            comparison.take(seed)
    finally:
        comparison.close()
    print(f"{comparison.ran} programs, {comparison.late} took too long, {comparison.different} different")
    return 1 if comparison.different else 0


if __name__ == "__main__":
    sys.exit(main())
