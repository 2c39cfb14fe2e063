"""Questions that are asked while a run continues: from Python, from agents, and announced by ``--explain``."""

from collections.abc import Callable
from pathlib import Path

import pytest

from jacaros import Mas
from jacaros.runtime.cli.main import call
from jacaros.runtime.errors import UsageError

PROGRAM = """
!start.
+!start <- !lost.
+!lost : ready(a) <- true.
-!start <- .wait(1000000).
"""


async def test_python_asks_a_running_system() -> None:
    async with Mas(seed=1, explain=True, on_log=lambda *line: None) as mas:
        mas.add_agent("bob", PROGRAM)
        await mas.sleep(0.1)
        answer = mas.explain("!lost")
        assert "lost" in answer.answer
        assert answer.data()["question"] == "!lost"
        with pytest.raises(UsageError, match="unknown question"):
            mas.explain("how are you")


async def test_the_history_of_an_agent_that_asks_begins_with_the_run(lines: list[str]) -> None:
    async with Mas(on_print=lambda agent, text: lines.append(text), on_log=lambda *_: None) as mas:
        program = "!go. +!go <- .why(nothing, explanation(Text, Time, Facts, Causes)); .print(Text)."
        mas.add_agent("bob", program)
        await mas.until_idle()
    assert lines


Explained = Callable[..., tuple[int, str, str]]


@pytest.fixture
def explained(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> Explained:
    """Runs a program with options: exit code, output and errors."""

    def run(program: str, *options: str) -> tuple[int, str, str]:
        file = tmp_path / "bob.asl"
        file.write_text(program)
        code = call(["run", str(file), "--until-idle", "--clock", "fast", *options])
        return code, *capfd.readouterr()

    return run


def test_a_run_explains_events(explained: Explained) -> None:
    program = PROGRAM.replace(".wait(1000000)", "true")
    code, _, told = explained(program, "--explain", "!lost")
    assert code == 0
    assert "!lost" in told
    code, _, told = explained(program)
    assert code == 0
    assert "lost" not in told


def test_the_end_explains_events_that_never_happened(explained: Explained) -> None:
    program = "!start. +!start <- +alarm(3). +alarm(_)."
    code, _, told = explained(program, "--explain", "+alrm", "--explain", "+alarm")
    assert code == 0
    assert "no event `+alrm` happened" in told
    assert "did you mean `alarm`?" in told
    assert "no event `+alarm`" not in told


def test_what_cannot_be_explained_is_refused_before_the_run(explained: Explained) -> None:
    code, output, told = explained("!start. +!start <- .print(began).", "--explain", "+a b(")
    assert code == 2
    assert "expected an event, a goal or a belief, found `+a b(`" in told
    assert "began" not in output
