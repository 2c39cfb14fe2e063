"""Output files are checked before the run."""

import errno
import os
from pathlib import Path
from typing import Any

import pytest
from command_lab import Outcome

from jacaros.runtime.cli.main import call

PROGRAM = '!go.\n+!go <- .print("ran"); .stopMAS.\n'


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "agent.asl").write_text(PROGRAM, encoding="utf-8")
    return tmp_path


TAKEN = "`agent.asl` exists and is not"
OTHER = "name another file, or delete it"


@pytest.mark.parametrize(
    ("arguments", "error", "help"),
    [
        ("--replay no/such/page.html", "folder does not exist: `no/such`", "mkdir -p no/such"),
        ("--record .", "`.` is a folder", "name a file in it for the recording"),
        ("--record agent.asl", f"{TAKEN} a recording", OTHER),
        ("--ground-truth agent.asl", f"{TAKEN} a ground truth", OTHER),
        (
            "--replay page.jsonl",
            "expected a file name with the suffix .html, found `page.jsonl`",
            "--replay page.html",
        ),
        (
            "--record x.jsonl --ground-truth x.jsonl",
            "`x.jsonl` cannot be both recording and ground truth",
            "name two files",
        ),
        (
            "--record x.jsonl --ground-truth x.jsonl.1",
            "`x.jsonl.1` cannot be both older part of the recording and ground truth",
            "name two files",
        ),
    ],
)
def test_an_unwritable_output_is_reported_before_the_run(
    folder: Path, outcome: Outcome, arguments: str, error: str, help: str
) -> None:
    told = outcome("run", "agent.asl", "--clock", "fast", *arguments.split())
    assert told == (2, "", f"error: {error}\n  = help: {help}\n")
    assert (folder / "agent.asl").read_text(encoding="utf-8") == PROGRAM


def test_recordings_and_pages_are_overwritten(folder: Path) -> None:
    for _ in range(2):
        assert call(["run", "agent.asl", "--clock", "fast", "--record", "r.jsonl", "--replay", "r.html"]) == 0


def test_the_older_part_of_a_recording_overwrites_no_other_file(folder: Path, capsys):
    (folder / "x.jsonl.1").write_text(PROGRAM, encoding="utf-8")
    assert call(["run", "agent.asl", "--clock", "fast", "--record", "x.jsonl"]) == 2
    assert capsys.readouterr().err.startswith("error: `x.jsonl.1` exists and is not a recording\n")
    assert not (folder / "x.jsonl").exists()


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this system has no named pipes")
def test_a_named_pipe_is_not_an_output(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    os.mkfifo(folder / "pipe")
    assert call(["run", "agent.asl", "--clock", "fast", "--record", "pipe"]) == 2
    assert "error: `pipe` is a named pipe, and opening it waits for a reader" in capsys.readouterr().err


def test_a_replay_page_that_cannot_be_written_is_an_error_without_a_cut_file(
    folder: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    write_text = Path.write_text

    def full(path: Path, text: str, **options: Any) -> int:
        if path.name.startswith("r.html"):
            write_text(path, text[:100], **options)
            raise OSError(errno.ENOSPC, "No space left on device")
        return write_text(path, text, **options)

    monkeypatch.setattr(Path, "write_text", full)
    assert call(["run", "agent.asl", "--clock", "fast", "--replay", "r.html"]) == 1
    assert "error: cannot write `r.html`: No space left on device" in capsys.readouterr().err
    assert [each.name for each in folder.iterdir() if "html" in each.name] == []
