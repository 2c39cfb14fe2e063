"""Cells of a notebook, run in IPython without a kernel."""

import re
from base64 import b64decode
from collections.abc import Iterator
from pathlib import Path
from queue import SimpleQueue
from typing import Any

import pytest
from IPython.core.error import UsageError
from IPython.core.interactiveshell import InteractiveShell

from jacaros.notebook import running
from jacaros.notebook.run import Run

SQUARE = """
{ include("$jacaros/artifacts.asl") }
!start.
+!start
  <- !use_artifact("wheels", "ArtCmdVel");
     moveForward(1); rotate(90); moveForward(0.5);
     .print("<b>done</b>");
     +finished;
     .stopMAS.
"""

COUNTER = """
from jacaros.artifacts import Artifact, operation

class Counter(Artifact):
    def init(self, start=0):
        self.define_property("count", start)

    @operation
    def inc(self):
        self.update_property("count", self.value("count") + 1)
"""


@pytest.fixture
def shell(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[Any]:
    """A shell of its own, without a history on disk: the magics are loaded as users load them."""
    monkeypatch.setenv("IPYTHONDIR", str(tmp_path))
    made: Any = InteractiveShell()  # type: ignore[no-untyped-call]
    made.history_manager.enabled = False
    made.run_line_magic("load_ext", "jacaros")
    yield made
    InteractiveShell.clear_instance()


def run(shell: Any, line: str, cell: str) -> Run:
    found: Run = shell.run_cell_magic("asl", line, cell)
    return found


def test_a_cell_drives_a_robot_and_shows_it(shell: Any, capsys: pytest.CaptureFixture[str]) -> None:
    ended = run(shell, "--world house", SQUARE)
    assert capsys.readouterr().out == "[agent] <b>done</b>\n"
    assert ended.lines == ["[agent] <b>done</b>"]
    last = ended.recording.frames[-1].robots[0]
    assert (last.x - ended.recording.frames[0].robots[0].x) == pytest.approx(1, abs=0.15)
    shown = ended._repr_html_()
    svg = b64decode(re.findall(r"base64,([^\"]+)", shown)[0]).decode()
    assert "@keyframes moving-0" in svg
    assert "prefers-reduced-motion" in svg
    assert "<script" not in shown
    assert "finished" in shown


def test_output_of_agents_is_escaped_everywhere(shell: Any) -> None:
    ended = run(shell, "", '!go. +!go <- +said("<img src=x onerror=alert(1)>"); .stopMAS.')
    assert "<img src=x" not in ended._repr_html_()
    assert "&lt;img src=x" in ended._repr_html_()
    assert "<img src=x" not in ended.page().text


def test_a_run_answers_questions_tells_its_story_and_draws(shell: Any) -> None:
    ended = run(shell, "--world house", SQUARE)
    assert repr(ended.why("why did it rotate")).startswith("agent started `rotate(90)` at")
    assert "because agent ran `.stopMAS` for `!start`" in ended.story()
    assert "data:image/svg+xml;base64," in ended.plot("turtlebot.x").text
    assert "<iframe" in ended.page().text
    assert 'sandbox="allow-scripts"' in ended.page().text


def test_named_cells_make_one_system_with_artifacts_of_cells(
    shell: Any, capsys: pytest.CaptureFixture[str]
) -> None:
    # As in a kernel, where the module of a cell is `__main__`.
    names: dict[str, Any] = {"__name__": "__main__"}
    exec(COUNTER, names)
    shell.user_ns["Counter"] = names["Counter"]
    assert run(shell, "alice", '!go. +!go <- makeArtifact(c, "Counter", [4], I); focus(I); inc; ?count(N); '
               ".send(bob, tell, counted(N)).") is None  # fmt: skip
    assert run(shell, "bob", '+counted(N)[source(S)] <- .print(S, " counted to ", N).') is None
    ended = shell.run_line_magic("jacaros", "run --for 5")
    assert ended.lines == ["[bob] alice counted to 5"]
    assert "bob is ready; `%jacaros run` runs alice, bob" in capsys.readouterr().out
    shell.run_line_magic("jacaros", "forget")
    with pytest.raises(UsageError, match="no cell has named an agent"):
        shell.run_line_magic("jacaros", "run")


@pytest.mark.parametrize(
    ("line", "cell", "told"),
    [
        ("", "!go. +!go <- .print(1", r"error: unclosed `\(`"),
        ("--world nowhere", "!go.", "nowhere"),
        ("--seed x", "!go.", "invalid int value"),
        ("--speed 3", "!go.", "unrecognized arguments: --speed"),
        ("bob alice", "!go.", "unrecognized arguments: alice"),
        ("'bob", "!go.", "No closing quotation"),
    ],
)
def test_a_mistake_is_one_message(shell: Any, line: str, cell: str, told: str) -> None:
    with pytest.raises(UsageError, match=told):
        run(shell, line, cell)


def test_a_failure_of_ours_is_not_hidden(shell: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(running, "_ended", lambda *_: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        run(shell, "", "!go.")


def test_an_interruption_stops_the_run_and_the_robot(shell: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    drives = SQUARE.replace("moveForward(1)", ".print(begins); moveForward(100)")

    class Interrupted(SimpleQueue[tuple[str, bool]]):
        def get(self, *given: Any, **named: Any) -> Any:
            line = super().get(*given, **named)
            if line == ("[agent] begins", False):
                raise KeyboardInterrupt
            return line

    monkeypatch.setattr(running, "SimpleQueue", Interrupted)
    ended = run(shell, "--world empty --clock real", drives)
    assert ended.interrupted
    assert "interrupted" in ended._repr_html_()
    assert ended.recording.duration < 30
    assert [data["state"] for _, kind, data in ended.recording.events if kind == "operation"][-1:] != ["done"]
