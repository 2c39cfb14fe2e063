"""The options of the view, and ``jacaros view``: checks before the run."""

import sys
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from jacaros.runtime.cli.main import main as jacaros_main
from jacaros.runtime.cli.recordings import view as view_command
from jacaros.runtime.cli.run import command as run_command
from jacaros.runtime.errors import UsageError

PROGRAM = "!start. +!start <- .print(hello); .stopMAS."


@pytest.fixture
def program(tmp_path: Path) -> Path:
    """A program that ends."""
    path = tmp_path / "hello.asl"
    path.write_text(PROGRAM)
    return path


def refused(command: object, *arguments: str) -> str:
    """Return the error for a command line."""
    with pytest.raises(UsageError) as error:
        CliRunner().invoke(command, arguments, catch_exceptions=False, standalone_mode=False)  # type: ignore[arg-type]
    return str(error.value)


def run(*arguments: str) -> Result:
    """Run a program."""
    return CliRunner().invoke(run_command, arguments, catch_exceptions=False, standalone_mode=False)


@pytest.mark.parametrize("before", [True, False])
def test_view_does_not_consume_the_next_argument(program: Path, before: bool) -> None:
    words = ["--view", str(program)] if before else [str(program), "--view"]
    result = run(*words)
    assert "[hello] hello" in result.stdout
    assert "view: http://127.0.0.1:" in result.stderr


def test_view_in_the_terminal(program: Path) -> None:
    result = run(str(program), "--view=terminal")
    assert "[hello] hello" in result.stdout
    assert "view: " not in result.stderr


def test_other_machines_need_a_token_and_their_rights_are_logged(
    program: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("JACAROS_VIEW_TOKEN", raising=False)
    told = refused(run_command, str(program), "--view", "--view-address", "0.0.0.0")
    assert "needs a token" in told
    assert "JACAROS_VIEW_TOKEN" in told
    assert "invalid view token" in refused(run_command, str(program), "--view", "--view-token", "short")
    monkeypatch.setenv("JACAROS_VIEW_TOKEN", "a-token-that-tests-know")
    result = run(str(program), "--view", "--view-address", "0.0.0.0")
    assert "/a-token-that-tests-know/" in result.stderr
    assert "can command its agents and robots" in result.stderr
    assert "not encrypted" in result.stderr
    result = run(str(program), "--view", "--view-address", "0.0.0.0", "--view-role", "observer")
    assert "including the programs; the connection" in result.stderr


def test_a_missing_websockets_library_is_reported_before_the_run(program: Path, monkeypatch):
    monkeypatch.setitem(sys.modules, "websockets.asyncio", None)
    told = refused(run_command, str(program), "--view")
    assert "pip install 'websockets>=15'" in told
    assert "[hello] hello" in run(str(program), "--view=terminal").stdout


def test_a_missing_recording_suggests_a_command(tmp_path: Path) -> None:
    told = refused(view_command, str(tmp_path / "none.jsonl"))
    assert told.startswith("error: recording not found: ")
    assert "= help: jacaros run FILE --record" in told


def test_the_page_is_written_to_a_file_but_not_over_another(program: Path, tmp_path: Path) -> None:
    record = tmp_path / "run.jsonl"
    run(str(program), "--record", str(record))
    assert "exists and is not a replay page" in refused(view_command, str(record), "--output", str(program))
    assert program.read_text() == PROGRAM
    record, page = tmp_path / "run.jsonl", tmp_path / "run.html"
    run(str(program), "--record", str(record))
    result = CliRunner().invoke(view_command, [str(record), "--output", str(page)], catch_exceptions=False)
    assert result.output == f"wrote {page}\n"
    assert page.read_text().lower().startswith("<!doctype html>")


def test_the_list_of_commands_contains_view(capsys, monkeypatch):
    monkeypatch.setattr("sys.argv", ["jacaros", "--help"])
    with pytest.raises(SystemExit):
        jacaros_main()
    assert "view      Show a recorded run" in capsys.readouterr().out
