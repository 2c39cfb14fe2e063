"""``jacaros metrics``: tables, and what cannot be counted."""

from pathlib import Path

import pytest
from command_lab import Outcome

from jacaros.look.metrics import MEASURES

COMMAND = ("metrics",)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "square").mkdir()
    (tmp_path / "square" / "robot.asl").write_text(
        "// A square.\n!drive.\n\n+!drive\n  <- forward(1);\n     turn(90).\n"
    )
    (tmp_path / "square.py").write_text("x = 1\n")
    return tmp_path


def test_each_measure_has_a_table(folder: Path, outcome: Outcome) -> None:
    code, output, errors = outcome("square")
    assert (code, errors) == (0, "")
    tables = output.rstrip("\n").split("\n\n")
    assert [table.split("\n")[0] for table in tables] == list(MEASURES.values())
    assert tables[2] == (
        "Physical lines\n"
        "program  agents  artifacts  total  projects  worlds  library\n"
        "square        6          0      6         0       0        0"
    )
    rows = [table.split("\n")[2].split()[:4] for table in tables]
    assert rows[0] == ["square", "3", "0", "3"]
    assert rows[3] == ["square", "4", "0", "4"]


def test_files_have_a_row_each(folder: Path, outcome: Outcome) -> None:
    code, output, _ = outcome("square", "--files")
    assert code == 0
    assert output.split("\n")[2].split()[:7] == ["square", "agents", "square/robot.asl", "3", "3", "6", "4"]


def test_all_that_cannot_be_counted_is_reported_in_one_pass(folder: Path, outcome: Outcome) -> None:
    for name in ("wrong", "empty", "binary"):
        (folder / name).mkdir()
    (folder / "wrong" / "robot.asl").write_text("!go.\n+!go <- move(1)).\n")
    (folder / "wrong" / "artifacts.py").write_text("class Arm\n    pass\n")
    (folder / "wrong" / "arm.yaml").write_text("operations:\n  lift: {publish: arm\n")
    (folder / "wrong" / "bad.jcm").write_text("mas bad { agent ann : none.asl }\n")
    (folder / "empty" / "notes.txt").write_text("none\n")
    (folder / "binary" / "robot.asl").write_bytes(b"\x7fELF\0\1")
    (folder / "binary" / "arm.yaml").write_bytes(b"caf\xe9: 1\n")
    code, output, errors = outcome("wrong", "empty", "binary", "sqare", "square.py")
    assert (code, output) == (1, "")
    assert errors == (
        "wrong/bad.jcm:1:23: error: program of agent `ann` not found: none.asl\n"
        "  1 | mas bad { agent ann : none.asl }\n"
        "    |                       ^^^^^^^^\n"
        "  = help: expected in wrong, .\n"
        "\n"
        "wrong/robot.asl:2:16: error: unmatched `)`\n"
        "  2 | +!go <- move(1)).\n"
        "    |                ^\n"
        "\n"
        "wrong/artifacts.py:1:10: error: not Python: expected ':'\n"
        "  1 | class Arm\n"
        "    |          ^\n"
        "\n"
        "wrong/arm.yaml:2:9: error: this bracket is never closed\n"
        "  2 |   lift: {publish: arm\n"
        "    |         ^^^^^^^^^^^^^\n"
        "  = help: close the bracket\n"
        "\n"
        "error: no agent programs in `empty`\n"
        "  = help: name a folder with .asl files or Python agents\n"
        "\n"
        "error: cannot read binary/robot.asl: line 1 contains a NUL byte; this is not a text file\n"
        "\n"
        "error: cannot read binary/arm.yaml: line 1 contains a byte (0xe9) that is not UTF-8; save the file as UTF-8\n"
        "\n"
        "error: folder does not exist: `sqare`\n"
        "  = help: did you mean `square`?\n"
        "\n"
        "error: not a folder: `square.py`\n"
        "  = help: name its folder: `.`\n"
    )
