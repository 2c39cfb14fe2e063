"""Questions that are asked while a run continues: from Python, from agents, and announced by ``--explain``."""

from pathlib import Path

import pytest

import jacaros
from jacaros import Mas
from jacaros.look.why.explanation import Explanation
from jacaros.runtime.cli.main import call
from jacaros.runtime.errors import UsageError

PROGRAM = """
!start.
+!start <- !lost.
+!lost : ready(a) <- true.
-!start <- .wait(1000000).
"""


def explained(question: str, program: str = PROGRAM) -> Explanation:
    async def main() -> Explanation:
        async with Mas(seed=1, explain=True, on_log=lambda *line: None) as mas:
            mas.add_agent("bob", program)
            await mas.sleep(0.1)
            return mas.explain(question)

    return jacaros.run(main(), clock="fast")


def test_python_asks_a_running_system() -> None:
    answer = explained("!lost")
    assert "lost" in answer.answer
    assert answer.data()["question"] == "!lost"


def test_a_question_that_is_not_understood_is_refused() -> None:
    with pytest.raises(UsageError, match="unknown question"):
        explained("how are you")


def test_the_history_of_an_agent_that_asks_begins_with_the_run() -> None:
    prints: list[str] = []

    async def main() -> None:
        async with Mas(
            seed=1, on_print=lambda agent, text: prints.append(text), on_log=lambda *_: None
        ) as mas:
            program = "!go. +!go <- .why(nothing, explanation(Text, Time, Facts, Causes)); .print(Text)."
            mas.add_agent("bob", program)
            await mas.until_idle()

    jacaros.run(main(), clock="fast")
    assert prints


def test_a_run_explains_events(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    program = tmp_path / "bob.asl"
    program.write_text(PROGRAM.replace(".wait(1000000)", "true"))
    assert call(["run", str(program), "--until-idle", "--clock", "fast", "--explain", "!lost"]) == 0
    told = capfd.readouterr().err
    assert "!lost" in told
    assert call(["run", str(program), "--until-idle", "--clock", "fast"]) == 0
    assert "lost" not in capfd.readouterr().err


def test_the_end_explains_events_that_never_happened(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    program = tmp_path / "bob.asl"
    program.write_text("!start. +!start <- +alarm(3). +alarm(_).")
    events = ["--explain", "+alrm", "--explain", "+alarm"]
    assert call(["run", str(program), "--until-idle", "--clock", "fast", *events]) == 0
    told = capfd.readouterr().err
    assert "no event `+alrm` happened" in told
    assert "did you mean `alarm`?" in told
    assert "no event `+alarm`" not in told


def test_what_cannot_be_explained_is_refused_before_the_run(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    program = tmp_path / "bob.asl"
    program.write_text("!start. +!start <- .print(began).")
    assert call(["run", str(program), "--explain", "+a b("]) == 2
    told = capfd.readouterr()
    assert "expected an event, a goal or a belief, found `+a b(`" in told.err
    assert "began" not in told.out
