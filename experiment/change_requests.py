"""Three change requests to the house cleaning of both sides: what they change, applied to the present programs, and judged.

    python experiment/change_requests.py

prints the table of changed lines. ``changes/`` has a folder for each request.
"""

import os
import re
import runpy
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from jacaros.runtime.errors import JacarosError
from jacaros.testing import RunResult, Verdict
from scenarios import SCENARIOS, Scenario

CHANGES = Path(__file__).parent / "changes"
REQUESTS = ("add_a_room", "add_an_emergency_stop", "add_a_second_robot")
"""The requests by the names of their folders."""

STUDY = Path(__file__).parent / "study" / "requests"
STUDY_REQUESTS = ("change_the_order", "charge_before_the_last_round")
"""Two more, for the study with users; they are not counted."""

SIDES = ("agents", "baseline")
_PRESENT = SCENARIOS["house_cleaning"]
_PRESENT = _PRESENT._replace(project=_PRESENT.project.with_name("house_cleaning.jcm"))
_QUOTES = '"""'


class Cost(NamedTuple):
    """What a request costs one side.

    Attributes:
        added, removed: code lines, without blank lines, comments and docstrings; a line that is modified counts in both.
        files: names of the files touched.
    """

    added: int
    removed: int
    files: tuple[str, ...]

    @property
    def changed(self) -> int:
        """Lines added and removed."""
        return self.added + self.removed


class Row(NamedTuple):
    """A line of the table: a request, and what it costs each side."""

    request: str
    agents: Cost
    baseline: Cost


def table() -> list[Row]:
    """Return what each request costs, in the order of `REQUESTS`."""
    return [Row(title(request), cost(request, "agents"), cost(request, "baseline")) for request in REQUESTS]


def title(request: str) -> str:
    """Return the heading of a request."""
    first = (folder_of(request) / "request.md").read_text(encoding="utf-8").partition("\n")[0]
    return first.removeprefix("# ")


def folder_of(request: str) -> Path:
    """Return the folder of a request."""
    return (STUDY if request in STUDY_REQUESTS else CHANGES) / request


def cost(request: str, side: str) -> Cost:
    """Count the code lines that the diff of a side adds and removes."""
    diff = diff_of(request, side).read_text(encoding="utf-8")
    files = tuple(re.findall(r"^\+\+\+ b/(\S+)", diff, re.MULTILINE))
    return Cost(code_lines(diff, "+"), code_lines(diff, "-"), files)


def diff_of(request: str, side: str) -> Path:
    """Return the diff of a side."""
    return folder_of(request) / f"{side}.diff"


def code_lines(diff: str, sign: str) -> int:
    """Count the lines of a unified diff with *sign* (``+`` or ``-``) that are neither blank nor comment nor docstring."""
    return sum(line[0] == sign for line in _code_lines(diff, sign))


def _code_lines(diff: str, sign: str) -> Iterator[str]:
    """Yield the code lines of one version of a file, those around the changes included."""
    in_docstring = False
    for line in _body(diff):
        text = line[1:].strip()
        if line[0] not in (" ", sign) or not text:
            continue
        # Docstrings are the only texts in triple quotes here.
        comment = in_docstring or text.startswith(("//", "/*", "#", _QUOTES))
        in_docstring ^= text.count(_QUOTES) % 2 == 1
        if not comment:
            yield line


def _body(diff: str) -> Iterator[str]:
    """Yield the lines of the hunks, each with its sign."""
    in_hunk = False
    for line in diff.splitlines():
        if line.startswith(("diff ", "@@")):
            in_hunk = line.startswith("@@")
        elif in_hunk and line[:1] in ("+", "-", " "):
            yield line


def changed(request: str, folder: Path) -> Scenario:
    """Apply both diffs of a request to copies of the present programs.

    Args:
        request: one of `REQUESTS` or `STUDY_REQUESTS`.
        folder: for the copies; it must not have any.

    Returns:
        The changed programs, in the request's world if it has one.

    Raises:
        JacarosError: the present programs are no longer those that the diff was made for.
    """
    agents, baseline = folder / "agents", folder / "baseline"
    shutil.copytree(_PRESENT.project.parent, agents)
    baseline.mkdir(parents=True)
    shutil.copy(_PRESENT.baseline, baseline)
    for side, copy in (("agents", agents), ("baseline", baseline)):
        apply(diff_of(request, side), copy)
    world = folder_of(request) / "world.yaml"
    return _PRESENT._replace(
        project=agents / _PRESENT.project.name,
        baseline=baseline / _PRESENT.baseline.name,
        world=world if world.exists() else _PRESENT.world,
    )


def apply(diff: Path, folder: Path) -> None:
    """Apply a diff to the files of a folder.

    Raises:
        JacarosError: it does not fit the files.
    """
    # The folder can be inside another repository, which must not interfere.
    environment = {**os.environ, "GIT_CEILING_DIRECTORIES": str(folder.resolve().parent)}
    command = ["git", "apply", "--whitespace=nowarn", str(diff.resolve())]
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)
    if done.returncode:
        name = f"{diff.parent.name}/{diff.name}"
        raise JacarosError(
            f"the program has changed, and {name} no longer fits it: {done.stderr.strip()}\n"
            "help: make the diff again, see experiment/changes/README.md"
        )


def judge(request: str, result: RunResult) -> Verdict:
    """Judge a run of either side by the checker of a request."""
    check = runpy.run_path(str(folder_of(request) / "check.py"))["check"]
    verdict: Verdict = check(result.ground_truth)
    return verdict


def main() -> None:
    """Print the table."""
    print("| request | agents | baseline | files of the agents | files of the baseline |")
    print("|---|---|---|---|---|")
    for request, agents, baseline in table():
        costs = [f"{each.changed} (+{each.added} -{each.removed})" for each in (agents, baseline)]
        files = [", ".join(each.files) for each in (agents, baseline)]
        print("|", " | ".join([request, *costs, *files]), "|")


if __name__ == "__main__":
    main()
