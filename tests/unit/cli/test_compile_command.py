"""`jacaros compile` shows the code that is made of a program, below the lines that it comes from."""

from pathlib import Path

import pytest

from jacaros.cli.main import call

PROGRAM = """\
far(X) :- pos(X) & X > 10.

@done +!count(0) <- .print("over").
@go
+!count(N)
   : N > 0 & not far(N)
  <- -+left(N - 1);
     !count(N - 1).
+left(N)[source(S)] <- .print(N, S).
"""


@pytest.fixture
def program(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    monkeypatch.chdir(tmp_path)
    Path("robot.asl").write_text(PROGRAM, encoding="utf-8")
    return "robot.asl"


def shown(capsys: pytest.CaptureFixture[str], *arguments: str) -> list[str]:
    assert call(["compile", *arguments]) == 0
    return capsys.readouterr().out.splitlines()


def test_generated_code_follows_its_source_line(program: str, capsys: pytest.CaptureFixture[str]) -> None:
    lines = shown(capsys, program, "--show")
    for title in ("the rules of far/1", "the plans for +!count/1", "the plans for +left/1"):
        assert f"# ---- {title} ----" in lines
    step = lines.index("# robot.asl:8: !count(N - 1).")
    assert lines[step + 1].startswith("def step")
    context = next(i for i, line in enumerate(lines) if line.endswith("# robot.asl:6: : N > 0 & not far(N)"))
    assert lines[context + 1].strip().startswith("if ")


def test_the_listing_is_python_and_explains_its_names(
    program: str, capsys: pytest.CaptureFixture[str]
) -> None:
    lines = shown(capsys, program, "--show")
    compile("\n".join(lines), "listing", "exec")
    meanings = {line.rpartition(": ")[2] for line in lines if line.startswith("# K_")}
    assert {"left/1", "+!count/1", "the plan go", "jacaros.agents.mind.actions.output.print_"} <= meanings
    assert lines == shown(capsys, program, "--show")


def test_an_internal_action_in_a_condition_is_shown(program: str, capsys: pytest.CaptureFixture[str]) -> None:
    Path(program).write_text("+!go(L) : .member(X, L) <- .print(X).", encoding="utf-8")
    assert any(line.endswith(": the internal action .member") for line in shown(capsys, program, "--show"))


def test_a_join_by_an_index_is_shown(program: str, capsys: pytest.CaptureFixture[str]) -> None:
    Path(program).write_text("+!go : p(X, Y, _) & p(Y, Z, _) <- .print(Z).", encoding="utf-8")
    assert any(
        line.endswith(": (0,)") for line in shown(capsys, program, "--show") if line.startswith("# K_")
    )


@pytest.mark.parametrize("wanted", ["done", "@done"])
def test_a_label_selects_the_steps_of_one_plan(
    wanted: str, program: str, capsys: pytest.CaptureFixture[str]
) -> None:
    text = "\n".join(shown(capsys, program, "--show", "--plan", wanted))
    assert '# robot.asl:3: @done +!count(0) <- .print("over").\ndef step' in text
    assert "def select" in text
    assert "robot.asl:8" not in text
    assert "+left" not in text


@pytest.mark.parametrize("wanted", ["+!count", "+!count/1", "+!count(N)"])
def test_plans_are_selected_by_event(wanted: str, program: str, capsys: pytest.CaptureFixture[str]) -> None:
    titles = [line for line in shown(capsys, program, "--show", "--plan", wanted) if line.startswith("# --")]
    assert titles == ["# ---- the plans for +!count/1 ----"]


def test_an_unknown_plan_is_reported(program: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert call(["compile", program, "--plan", "stop"]) == 2
    assert capsys.readouterr().err == (
        "error: unknown plan: `stop`\n  = help: the program has plans for +!count/1, +left/1\n"
    )


def test_without_show_it_prints_the_size(program: str, capsys: pytest.CaptureFixture[str]) -> None:
    (line,) = shown(capsys, program)
    assert line.startswith("robot.asl: 3 plans and 1 rule: ")
    assert line.endswith(" lines")


def test_errors_are_reported_as_by_check(program: str, capsys: pytest.CaptureFixture[str]) -> None:
    Path(program).write_text("+!g <- .print(.\n", encoding="utf-8")
    assert call(["check", program]) == 1
    checked = capsys.readouterr()
    assert call(["compile", program, "--show"]) == 1
    assert capsys.readouterr() == checked


def test_subplans_and_plans_for_everything_are_shown(
    program: str, capsys: pytest.CaptureFixture[str]
) -> None:
    Path(program).write_text(
        "@outer +!g(X) <: false <- .wait(10) { @inner +e(Y) <- .print(X, Y). }\n+!G <- .print(G).\n",
        encoding="utf-8",
    )
    titles = [line for line in shown(capsys, program, "--show") if line.startswith("# --")]
    assert titles == [
        "# ---- the plans for +!g/1 ----",
        "# ---- the plans for +e/1 in outer ----",
        "# ---- the plans for +!any literal ----",
    ]


def test_internal_actions_of_the_project_are_known(program: str, capsys: pytest.CaptureFixture[str]) -> None:
    Path("tools_of_mine.py").write_text(
        "from jacaros import internal_action\n\n\n@internal_action\ndef hum() -> None:\n    pass\n",
        encoding="utf-8",
    )
    Path(program).write_text("+!g <- tools_of_mine.hum.\n", encoding="utf-8")
    assert "def step" in "\n".join(shown(capsys, program, "--show"))
