"""Output files are checked before the run."""

from pathlib import Path

import pytest

from jacaros.cli.main import call

PROGRAM = '!go.\n+!go <- .print("ran"); .stopMAS.\n'


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "agent.asl").write_text(PROGRAM, encoding="utf-8")
    return tmp_path


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (
            ["--replay", "no/such/page.html"],
            "error: folder does not exist: `no/such`\n  = help: mkdir -p no/such\n",
        ),
        (["--record", "."], "error: `.` is a folder\n  = help: name a file in it for the recording\n"),
        (
            ["--record", "agent.asl"],
            "error: `agent.asl` exists and is not a recording\n  = help: name another file, or delete it\n",
        ),
        (
            ["--ground-truth", "agent.asl"],
            "error: `agent.asl` exists and is not a ground truth\n  = help: name another file, or delete it\n",
        ),
        (
            ["--replay", "page.jsonl"],
            "error: expected a file name with the suffix .html, found `page.jsonl`\n  = help: --replay page.html\n",
        ),
        (
            ["--record", "x.jsonl", "--ground-truth", "x.jsonl"],
            "error: `x.jsonl` cannot be both recording and ground truth\n  = help: name two files\n",
        ),
    ],
)
def test_an_unwritable_output_is_reported_before_the_run(
    folder: Path, capsys: pytest.CaptureFixture[str], arguments: list[str], message: str
) -> None:
    assert call(["run", "agent.asl", "--clock", "fast", *arguments]) == 2
    assert capsys.readouterr() == ("", message)
    assert (folder / "agent.asl").read_text(encoding="utf-8") == PROGRAM


def test_recordings_and_pages_are_overwritten(folder: Path) -> None:
    for _ in range(2):
        assert call(["run", "agent.asl", "--clock", "fast", "--record", "r.jsonl", "--replay", "r.html"]) == 0


def test_a_report_of_tests_does_not_overwrite_a_program(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert call(["test", "agent.asl", "--junit", "agent.asl"]) == 2
    assert "error: `agent.asl` exists and is not a JUnit report" in capsys.readouterr().err
