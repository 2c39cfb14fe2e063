"""Tables of counts, and the script that prints them."""

import gzip
from pathlib import Path

import pytest

from counting import CountedFile, Group, ProgramMetrics, Table
from counting.__main__ import main
from counting.tables import as_csv, as_markdown, as_text, file_table, group_table, measure_table


def source(name: str, lines: int) -> CountedFile:
    text = "x\n" * lines
    return CountedFile(Path(name), text.encode(), text, (), frozenset({"x"}), frozenset({"x", name}))


SQUARE = ProgramMetrics(
    "02_square",
    {
        Group.AGENTS: (source("robot.asl", 18),),
        Group.BASELINE: (source("square.py", 55), source("pose.py", 18)),
    },
)
PATROL = ProgramMetrics(
    "04_patrol",
    {
        Group.AGENTS: (source("robot.asl", 98),),
        Group.ARTIFACTS: (source("artifacts.py", 20),),
        Group.PROJECTS: (source("patrol.jcm", 5),),
        Group.LIBRARY: (source("navigation.asl", 234),),
        Group.BASELINE: (source("patrol.py", 162),),
    },
)


def test_a_table_has_a_row_for_each_program_and_a_column_for_each_group() -> None:
    assert as_text(measure_table([SQUARE, PATROL], "lines")) == (
        "Physical lines\n"
        "program    agents  artifacts  total  projects  worlds  library\n"
        "02_square      18          0     18         0       0        0\n"
        "04_patrol      98         20    118         5       0      234"
    )


def test_markdown_aligns_numbers_and_escapes_bars() -> None:
    table = Table("Sizes", ("program", "lines"), (("a | b", 110),))
    assert as_markdown(table) == "| program | lines |\n| --- | ---: |\n| a \\| b | 110 |"


def test_csv_has_a_line_for_each_group_with_files() -> None:
    size = len(gzip.compress(b"x\n" * 18, 9, mtime=0))
    assert as_csv(group_table([SQUARE])) == (
        "program,group,files,identifiers,names,lines,code_lines,gzip_bytes,gzip_code_bytes\n"
        f"02_square,agents,1,1,2,18,18,{size},{size}\n"
        f"02_square,total,1,1,2,18,18,{size},{size}\n"
    )


def test_a_table_shows_the_files() -> None:
    rows = file_table([PATROL]).rows
    assert [row[:6] for row in rows] == [
        ("04_patrol", "agents", "robot.asl", 1, 2, 98),
        ("04_patrol", "artifacts", "artifacts.py", 1, 2, 20),
        ("04_patrol", "projects", "patrol.jcm", 1, 2, 5),
        ("04_patrol", "library", "navigation.asl", 1, 2, 234),
        ("04_patrol", "baseline", "patrol.py", 1, 2, 162),
    ]


def test_a_table_without_rows_is_a_header() -> None:
    assert as_text(Table("None", ("program",), ())) == "None\nprogram"


@pytest.fixture
def square(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "square").mkdir()
    (tmp_path / "square" / "robot.asl").write_text("// A square.\n!drive.\n\n+!drive\n  <- forward(1).\n")
    return tmp_path


@pytest.mark.parametrize(
    ("options", "first"),
    [
        ([], "Identifiers\nprogram  agents  artifacts  total  projects  worlds  library\nsquare        2 "),
        (["--format", "markdown"], "**Identifiers**\n\n| program | agents | artifacts | total "),
        (["--files"], "Files\nprogram  group   file "),
        (["--format", "csv"], "program,group,files,identifiers,names,lines,code_lines,gzip_bytes,"),
    ],
)
def test_the_script_prints_tables(square: Path, capsys, options: list[str], first: str) -> None:
    assert main(["square", *options]) == 0
    assert capsys.readouterr().out.startswith(first)


def test_all_that_cannot_be_counted_is_reported_in_one_pass(square: Path, capsys) -> None:
    for name, content in {
        "robot.asl": b"!go.\n+!go <- move(1)).\n",
        "artifacts.py": b"class Arm\n",
        "arm.yaml": b"operations:\n  lift: {publish: arm\n",
        "bad.jcm": b"mas bad { agent ann : none.asl }\n",
        "empty/notes.txt": b"none\n",
        "binary/robot.asl": b"\x7fELF\0\1",
    }.items():
        path = square / "wrong" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)
    assert main(["wrong", "wrong/empty", "sqare", "wrong/arm.yaml"]) == 1
    errors = capsys.readouterr().err
    assert [line for line in errors.splitlines() if "error:" in line or "help:" in line] == [
        "wrong/bad.jcm:1:23: error: program of agent `ann` not found: none.asl",
        "  = help: expected in wrong, .",
        "error: cannot read wrong/binary/robot.asl: line 1 contains a NUL byte; this is not a text file",
        "wrong/robot.asl:2:16: error: unmatched `)`",
        "wrong/artifacts.py:1:10: error: not Python: expected ':'",
        "wrong/arm.yaml:2:9: error: this bracket is never closed",
        "  = help: close the bracket",
        "error: no agent programs in `wrong/empty`",
        "  = help: name a folder with .asl files or Python agents",
        "error: folder does not exist: `sqare`",
        "  = help: did you mean `square`?",
        "error: not a folder: `wrong/arm.yaml`",
        "  = help: name its folder: `wrong`",
    ]
