"""``jacaros demo``: the robot that a new user sees first."""

from pathlib import Path

import pytest
from click.testing import CliRunner

from jacaros.agents.language.formatting import format_program
from jacaros.runtime.cli import run
from jacaros.runtime.cli.main import call
from jacaros.runtime.errors import UsageError


def test_the_robot_patrols_and_charges(capfd: pytest.CaptureFixture[str]) -> None:
    assert call(["demo", "--clock", "fast", "--for", "100"]) == 0
    printed = capfd.readouterr().out.splitlines()
    assert printed[:4] == [f"[patrol] corner {number}" for number in (1, 2, 3, 4)]
    charging = printed.index("[patrol] battery at 59 %")
    assert printed[charging + 1] == "[patrol] corner 4"
    assert printed[charging - 1] == "[patrol] corner 3"


@pytest.mark.parametrize(
    ("display", "given", "view"),
    [
        (True, (), "--view"),
        (False, (), "--view=terminal"),
        (True, ("--view=terminal",), "--view=terminal"),
        (False, ("--view",), "--view"),
    ],
)
def test_the_run_is_shown_where_the_user_can_see_it(
    monkeypatch: pytest.MonkeyPatch, display: bool, given: tuple[str, ...], view: str
) -> None:
    calls: list[list[str]] = []
    monkeypatch.setattr(run, "has_display", lambda: display)
    monkeypatch.setattr(run.command, "main", lambda arguments, *_, **__: calls.append(arguments) or 0)
    assert call(["demo", *given, "--seed", "1"]) == 0
    (arguments,) = calls
    assert [each for each in arguments if each.startswith("--view")] == [view]
    assert arguments[-2:] == ["--seed", "1"]


def test_the_program_is_saved_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert "jacaros run patrol.asl --world patrol" in CliRunner().invoke(run.demo, ["--save"]).output
    saved = tmp_path / "patrol.asl"
    assert saved.read_bytes() == run.PROGRAM.read_bytes()
    saved.write_text("mine", encoding="utf-8")
    with pytest.raises(UsageError, match=r"file exists: `patrol[.]asl`"):
        CliRunner().invoke(run.demo, ["--save"], standalone_mode=False, catch_exceptions=False)
    assert saved.read_text(encoding="utf-8") == "mine"


def test_the_program_has_the_layout_of_the_formatter() -> None:
    text = run.PROGRAM.read_text(encoding="utf-8")
    assert format_program("patrol", text) == text
