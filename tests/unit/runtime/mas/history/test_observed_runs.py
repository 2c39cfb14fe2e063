"""Every run is the same with and without its history, and every goal in it ends exactly once."""

from pathlib import Path
from typing import Any

import pytest

from jacaros.runtime.mas.system import System
from jacaros.testing import RunResult, run_project

ROOT = Path(__file__).parents[5]
CASES = sorted((ROOT / "tests" / "conformance").rglob("*.asl"))
EXAMPLES = sorted((ROOT / "examples").rglob("*.jcm"))
SITUATED = [
    path
    for suffix in ("jcm", "mas2j")
    for path in sorted((ROOT / "tests" / "conformance_environment").rglob(f"project.{suffix}"))
]
OPEN = ("pursued", "suspended", "resumed")
OVER = ("achieved", "recovered", "dropped", "replaced")


def observed(path: Path, **options: Any) -> tuple[RunResult, list[dict[str, Any]]]:
    """Run a project with its history; the result, and the records of goals."""
    goals: list[dict[str, Any]] = []

    def started(mas: System) -> None:
        history = mas.history()
        history.listen(lambda t, event, data: goals.append(dict(data)) if event == "goal" else None)
        history.start()

    return run_project(path, when_started=started, **options), goals


def check(path: Path, **options: Any) -> None:
    """Compare a run with and without its history, and check the ends of its goals."""
    alone = run_project(path, **options)
    watched, goals = observed(path, **options)
    assert (watched.lines, watched.errors, watched.exit_code) == (alone.lines, alone.errors, alone.exit_code)
    states: dict[int, str] = {}
    for goal in goals:
        assert states.get(goal["id"]) not in OVER, goal
        assert goal["id"] in states or goal["state"] in (*OPEN, "failed"), goal
        states[goal["id"]] = goal["state"]
    assert not [number for number, state in states.items() if state in OPEN]


@pytest.mark.parametrize("case", CASES, ids=lambda path: f"{path.parent.name}/{path.stem}")
def test_programs_of_the_corpus(case: Path) -> None:
    if "syntax_errors" in case.parts or not case.with_suffix(".expected").exists():
        return
    check(case, until_idle=True, seconds=20.0)


@pytest.mark.parametrize(
    "project", SITUATED, ids=lambda path: f"{path.parent.parent.name}/{path.parent.name}"
)
def test_projects_of_the_corpus(project: Path) -> None:
    check(project, seconds=20.0)


@pytest.mark.parametrize("project", EXAMPLES, ids=lambda path: path.stem)
def test_examples(project: Path) -> None:
    check(project, seconds=60.0)
