"""``!help`` of the library: what it asks, and how it ends with and without a person."""

from pathlib import Path

import pytest

from jacaros.testing.run import run_project

PROGRAM = """
{ include("$jacaros/help.asl") }
{ include("$jacaros/artifacts.asl") }
battery(12, discharging). docked(false). tried("docked twice"). tried("backed off").
!charge.
+!charge <- OPERATOR !help(no_current); .print("again").
-!charge[error(E), env_failure_reason(R)] <- .print(E, " ", R).
+question(Id, _, _) : advice(Answer) <- answer(Id, Answer).
"""
OPERATOR = '!use_artifact("operator", "Operator", [timeout(60)]);'
ASKED = (
    "I am stuck: no_current. I tried: docked twice, backed off. I believe: battery(12,discharging), docked(false). "
    "What would help: put me into the dock, or wipe its contacts. What shall I do?"
)
QUESTION = f"question 1: {ASKED} 1) retry 2) skip 3) stop"


@pytest.mark.parametrize(("status", "more"), [(0, "advice(retry)."), (1, "advice(stop)."), (1, "")])
def test_help_or_stop_ends_the_run_without_the_answer_retry(tmp_path: Path, status: int, more: str) -> None:
    program = PROGRAM.replace("OPERATOR", OPERATOR).replace("!help(no_current)", "!help_or_stop(no_current)")
    (tmp_path / "robot.asl").write_text(program + more)
    ran = run_project(tmp_path / "robot.asl", until_idle=True)
    assert (ran.exit_code, ran.lines[1:]) == (status, ["[robot] again"] if not status else [])


@pytest.mark.parametrize(
    ("operator", "advice", "lines"),
    [
        (OPERATOR, "advice(retry).", [QUESTION, "again"]),
        (OPERATOR, "advice(skip).", [QUESTION, "no_help advised(skip)"]),
        (OPERATOR, "", [QUESTION, "no_help no_help(no_current)"]),
        ("", "", [ASKED, "no_help no_help(no_current)"]),
    ],
    ids=["retry", "skip", "no answer", "no Operator"],
)
def test_help_ends_as_the_person_says(tmp_path: Path, operator: str, advice: str, lines: list[str]) -> None:
    (tmp_path / "robot.asl").write_text(PROGRAM.replace("OPERATOR", operator) + advice)
    ran = run_project(tmp_path / "robot.asl", until_idle=True)
    assert ran.of("robot") == lines
    assert ran.ground_truth is None, "a program without robots opens no world"
