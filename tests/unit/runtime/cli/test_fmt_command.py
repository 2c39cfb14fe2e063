"""``jacaros fmt``: what it reads and writes, its exit codes."""

import io
import sys
from pathlib import Path

import pytest
from command_lab import Outcome

from jacaros.runtime.cli.main import call

COMMAND = ("fmt",)

ROOT = Path(__file__).parents[4]
UGLY = "+!g<-a;b.   // c\n"
NICE = "+!g <- a; b.  // c\n"
DIFFERENCE = f"--- a.asl\n+++ a.asl\n@@ -1 +1 @@\n-{UGLY}+{NICE}"


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a.asl").write_text(UGLY, encoding="utf-8")
    (tmp_path / "inner").mkdir()
    (tmp_path / "inner" / "b.asl").write_text(NICE, encoding="utf-8")
    return tmp_path


def test_programs_are_formatted_in_place(folder: Path, outcome: Outcome) -> None:
    assert outcome(".") == (0, "", "1 of 2 files changed\n")
    assert (folder / "a.asl").read_text(encoding="utf-8") == NICE
    assert outcome(".") == (0, "", "0 of 2 files changed\n")


def test_check_and_diff_show_the_difference_and_change_nothing(folder: Path, outcome: Outcome) -> None:
    assert outcome("--check", "a.asl") == (1, DIFFERENCE, "1 of 1 file would change\n")
    assert outcome("--check", "inner") == (0, "", "0 of 1 file would change\n")
    assert (folder / "a.asl").read_text(encoding="utf-8") == UGLY


def test_the_standard_input_goes_to_the_standard_output(folder: Path, outcome, monkeypatch):
    monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(UGLY.encode())))
    assert outcome("-") == (0, NICE, "")
    monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(b"p(")))
    code, output, errors = outcome("-")
    assert (code, output) == (1, "")
    assert errors.startswith("<stdin>:1:")


def test_a_program_with_errors_is_kept_and_the_others_are_formatted(folder: Path, outcome: Outcome) -> None:
    (folder / "0.asl").write_text("p( ", encoding="utf-8")
    (folder / "1.asl").write_bytes(b"\xff")
    code, output, errors = outcome(".")
    assert (code, output) == (1, "")
    assert "0.asl:1:" in errors
    assert "cannot read 1.asl" in errors
    assert (folder / "a.asl").read_text(encoding="utf-8") == NICE
    assert (folder / "0.asl").read_text(encoding="utf-8") == "p( "


def test_a_program_whose_meaning_would_change_is_kept(folder: Path, outcome, monkeypatch):
    monkeypatch.setattr("jacaros.agents.language.formatting._laid_out", lambda text: "p.")
    code, output, errors = outcome(".")
    assert (code, output) == (1, "")
    assert errors.count("would change the meaning of") == 2
    assert (folder / "a.asl").read_text(encoding="utf-8") == UGLY


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["aa.asl"], "did you mean `a.asl`?"),
        (["-", "a.asl"], "`-` cannot be combined with files"),
        (["p.jcm"], "unsupported file type: `p.jcm`\n  = help: expected .asl"),
        ([], "FILE"),
    ],
)
def test_wrong_usage(folder: Path, outcome: Outcome, arguments: list[str], told: str) -> None:
    (folder / "p.jcm").write_text("mas p {}", encoding="utf-8")
    code, _, errors = outcome(*arguments)
    assert code == 2
    assert told in errors


def test_the_programs_of_the_repository_are_formatted(outcome: Outcome) -> None:
    folders = ("examples", "tests/compatibility", "tests/integration", "benchmarks/latency", "src")
    code, output, _ = outcome("--check", *(str(ROOT / folder) for folder in folders))
    assert (code, output) == (0, "")


@pytest.mark.parametrize("command", ["fmt", "check"])
def test_a_folder_without_programs_is_wrong_usage(command: str, tmp_path, capsys):
    assert call([command, str(tmp_path)]) == 2
    assert capsys.readouterr().err == f"error: no agent programs in `{tmp_path}`\n"


@pytest.mark.skipif(sys.platform == "win32", reason="files on Windows have no such modes")
def test_formatting_keeps_the_file_mode_and_leaves_no_temporary_files(folder: Path, outcome: Outcome) -> None:
    (folder / "a.asl").chmod(0o640)
    assert outcome("a.asl")[0] == 0
    assert (folder / "a.asl").stat().st_mode & 0o777 == 0o640
    assert sorted(path.name for path in folder.iterdir()) == ["a.asl", "inner"]
