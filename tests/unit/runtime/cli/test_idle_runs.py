"""Idle runs, and runs that lost a goal: log lines and exit codes."""

from pathlib import Path

import pytest

from jacaros.runtime.cli.run import report_idleness
from jacaros.runtime.mas.launch import launch
from jacaros.runtime.mas.options import RunOptions
from jacaros.runtime.mas.system import System
from jacaros.testing import RunResult, run_project


class EndingConsole(RunResult):
    """Ends the run at the note that nothing is left to do."""

    mas: System

    def begin(self, mas: System) -> None:
        self.mas = mas
        report_idleness(mas)

    def log(self, text: str, level: str = "info") -> None:
        super().log(text, level)
        if text.startswith("note: nothing left to do"):
            self.mas.end(0)


def notes(folder: Path, program: str, name: str = "robot.asl", seconds: float = 50.0) -> list[str]:
    """Return the notes of a run of several seconds that ends at the first one."""
    file = folder / name
    file.write_text(program, encoding="utf-8")
    console = EndingConsole()
    launch(file, RunOptions(fast=True, seconds=seconds), console, console.begin, own_process=False)
    return [line for line in console.errors if line.startswith("note:")]


HOW_TO_END = "press Ctrl+C to end the run, or start it with --until-idle"


def test_a_run_with_nothing_left_to_do_logs_a_note(tmp_path: Path) -> None:
    (note,) = notes(tmp_path, "!go.\n+!go <- .wait(1000).")
    assert note == f"note: nothing left to do: no agent has a goal or an event; {HOW_TO_END}"
    (note,) = notes(tmp_path, "!go.\n+!go <- .wait({+never}).")
    waits = "the goals of robot wait, and no agent can wake them"
    assert note == f"note: nothing left to do: {waits}; {HOW_TO_END}"
    program = '!go.\n+!go <- makeArtifact("w", "NoSuchType", [], Id).'
    assert len(notes(tmp_path, program)) == 1


@pytest.mark.parametrize(
    "program",
    [
        '!go.\n+!go <- makeArtifact("w", "ArtOdometry", [], Id); focus(Id).',  # the robot may move
        "!go.\n+!go <- .wait(10); !go.",
        "!go.\n+!go <- .wait(100000).",
    ],
)
def test_runs_that_may_continue_log_no_note(tmp_path: Path, program: str) -> None:
    assert notes(tmp_path, program, seconds=5.0) == []


def test_a_run_with_an_agent_in_python_logs_no_note(tmp_path: Path) -> None:
    program = "import jacaros\n\n\nclass Robot(jacaros.PythonAgent):\n    async def run(self) -> None:\n        pass\n"
    assert notes(tmp_path, program, "robot.py", seconds=5.0) == []


def code(folder: Path, program: str, fail: bool = True) -> tuple[int, list[str]]:
    file = folder / "robot.asl"
    file.write_text(program, encoding="utf-8")
    result = run_project(file, until_idle=True, fail_on_lost_goal=fail)
    return result.exit_code, [line for line in result.errors if line.startswith("error:")]


def test_lost_goals_fail_the_run_if_asked_for(tmp_path: Path) -> None:
    assert code(tmp_path, "!go.\n+!go <- .fail.") == (1, ["error: 1 goal was lost (--fail-on-lost-goal)"])
    assert code(tmp_path, "!go.\n+!go <- .fail.", fail=False) == (0, [])
    program = "!a. !b. !c.\n+!b <- .fail.\n-!b : never.\n+!c <- .wait(100); .kill_agent(robot)."
    assert code(tmp_path, program) == (1, ["error: 2 goals were lost (--fail-on-lost-goal)"])


def test_a_handled_failure_does_not_fail_the_run(tmp_path: Path) -> None:
    assert code(tmp_path, "!go.\n+!go <- .fail.\n-!go.") == (0, [])


def test_the_code_of_the_program_overrides_that_of_a_lost_goal(tmp_path: Path) -> None:
    assert code(tmp_path, "!a. !go.\n+!go <- .wait(100); .stopMAS(0, 7).")[0] == 7


def test_an_exception_of_an_agent_in_python_fails_the_run(tmp_path: Path) -> None:
    file = tmp_path / "robot.py"
    file.write_text(
        "import jacaros\n\n\nclass Robot(jacaros.PythonAgent):\n    async def run(self) -> None:\n        1 / 0\n",
        encoding="utf-8",
    )
    assert run_project(file, until_idle=True, fail_on_lost_goal=True).exit_code == 1
