"""Runs in which agents accept no plans from others, use no files and create no Python objects."""

from pathlib import Path

import pytest

from jacaros.runtime.cli.main import call


def run(folder: Path, capsys: pytest.CaptureFixture[str], step: str, *options: str) -> tuple[str, str]:
    handler = '-!go[error(E), error_msg(M)] <- .print(E, ": ", M); .stopMAS.'
    program = f"!go.\n+!go <- {step}; .print(done); .stopMAS.\n{handler}\n"
    (folder / "a.asl").write_text(program, encoding="utf-8")
    (folder / "b.asl").write_text("p.\n", encoding="utf-8")
    assert call(["run", str(folder / "a.asl"), "--clock", "fast", *options]) == 0
    outcome = capsys.readouterr()
    return outcome.out, outcome.err


@pytest.mark.parametrize(
    "step",
    [
        '.include("b.asl")',
        '.list_files(".", L)',
        '.save_agent("c.asl")',
        '.create_agent(bob, "b.asl")',
        'cartago.new_obj("list", [], L)',
        'cartago.invoke_obj("math", sqrt(4), R)',
    ],
)
def test_a_forbidden_step_fails_with_the_reason(step: str, tmp_path, capsys):
    name = step.partition("(")[0]
    told = f"[a] internal_action: {name} is forbidden: this run is restricted (--restrict)\n"
    assert run(tmp_path, capsys, step, "--restrict")[0] == told
    assert not (tmp_path / "c.asl").exists()
    assert run(tmp_path, capsys, step)[0] == "[a] done\n"


@pytest.mark.parametrize("step", ["saveMap", "loadMap"])
def test_a_map_is_neither_written_nor_read(step: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    file = tmp_path / "map.yaml"
    steps = f'makeArtifact("m", "ArtSlamData", [], M); focus(M); {step}("{file}")'
    told = f"[a] action_failed: {step} is forbidden: this run is restricted (--restrict)\n"
    assert run(tmp_path, capsys, steps, "--restrict")[0] == told
    assert not file.exists()


def test_an_agent_of_the_project_may_be_made(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "bob.asl").write_text("p.\n", encoding="utf-8")
    assert run(tmp_path, capsys, ".create_agent(bob)", "--restrict")[0] == "[a] done\n"


def test_a_plan_of_a_message_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    step = '.my_name(Me); .send(Me, tellHow, "+!h <- .print(told)"); .wait(10); !h'
    output, errors = run(tmp_path, capsys, step)
    assert output == "[a] told\n[a] done\n"
    output, errors = run(tmp_path, capsys, step, "--restrict")
    assert "told\n" not in output
    assert "refused a plan from self: this run is restricted" in errors
