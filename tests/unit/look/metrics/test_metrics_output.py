"""Tables and charts of counts."""

from pathlib import Path
from xml.etree import ElementTree

import pytest

from jacaros.look import metrics
from jacaros.look.metrics import CountedFile, Group, ProgramMetrics, Series, Table, as_text

SVG = "{http://www.w3.org/2000/svg}"


def source(name: str, lines: int) -> CountedFile:
    text = "x\n" * lines
    return CountedFile(Path(name), text.encode(), text, (), frozenset({"x"}), frozenset({"x", name}))


SQUARE = ProgramMetrics(
    "02_square",
    {
        Group.AGENTS: (source("robot.asl", 18),),
        "python": (source("square.py", 55), source("pose.py", 18)),
    },
)
PATROL = ProgramMetrics(
    "04_patrol",
    {
        Group.AGENTS: (source("robot.asl", 98),),
        Group.ARTIFACTS: (source("artifacts.py", 20),),
        Group.PROJECTS: (source("patrol.jcm", 5),),
        Group.LIBRARY: (source("navigation.asl", 234),),
        "python": (source("patrol.py", 162),),
    },
)


def test_a_table_has_a_row_for_each_program_and_a_column_for_each_group() -> None:
    assert as_text(metrics.measure_table([SQUARE, PATROL], "lines")) == (
        "Physical lines\n"
        "program    agents  artifacts  total  projects  worlds  library\n"
        "02_square      18          0     18         0       0        0\n"
        "04_patrol      98         20    118         5       0      234"
    )


def test_external_figures_get_a_column() -> None:
    table = metrics.measure_table([SQUARE, PATROL], "code_lines").with_column("thesis | Python", [110, "536"])
    assert metrics.as_markdown(table) == (
        "| program | agents | artifacts | total | projects | worlds | library | thesis \\| Python |\n"
        "| --- | ---: | ---: | ---: | ---: | ---: | ---: | --- |\n"
        "| 02_square | 18 | 0 | 18 | 0 | 0 | 0 | 110 |\n"
        "| 04_patrol | 98 | 20 | 118 | 5 | 0 | 234 | 536 |"
    )
    with pytest.raises(ValueError, match="zip"):
        table.with_column("short", [1])


def test_a_table_shows_the_files() -> None:
    rows = metrics.file_table([PATROL]).rows
    assert [row[:6] for row in rows] == [
        ("04_patrol", "agents", "robot.asl", 1, 2, 98),
        ("04_patrol", "artifacts", "artifacts.py", 1, 2, 20),
        ("04_patrol", "projects", "patrol.jcm", 1, 2, 5),
        ("04_patrol", "library", "navigation.asl", 1, 2, 234),
    ]


def test_a_table_without_rows_is_a_header() -> None:
    assert as_text(Table("None", ("program",), ())) == "None\nprogram"


def texts(svg: str) -> list[str]:
    return [each.text or "" for each in ElementTree.fromstring(svg).iter(f"{SVG}text")]


def bars(svg: str) -> list[tuple[str, float, float]]:
    """What each bar says of itself, its upper edge and its height."""
    return [
        (title.text or "", float(each.attrib["y"]), float(each.attrib["height"]))
        for each in ElementTree.fromstring(svg).iter(f"{SVG}rect")
        if (title := each.find(f"{SVG}title")) is not None
    ]


def test_a_chart_has_bars_in_proportion_with_artifacts_on_agents() -> None:
    svg = metrics.measure_chart([SQUARE, PATROL], "lines", ["python"])
    drawn = bars(svg)
    assert [title for title, _, _ in drawn] == [
        "02_square, agents: 18",
        "02_square, python: 73",
        "04_patrol, agents: 98",
        "04_patrol, artifacts: 20",
        "04_patrol, python: 162",
    ]
    heights = [height for _, _, height in drawn]
    scale = heights[-1] / 162
    assert heights == pytest.approx([18 * scale, 73 * scale, 98 * scale, 20 * scale, 162 * scale], abs=0.1)
    (_, agents, _), (_, artifacts, height) = drawn[2:4]
    assert artifacts + height == pytest.approx(agents, abs=0.1)
    assert texts(svg) == [
        *("Physical lines", "agents", "artifacts", "python"),
        *("0", "40", "80", "120", "160", "200"),
        *("18", "73", "118", "162"),
        *("02 square", "04 patrol"),
    ]


def test_a_chart_escapes_names_and_accepts_zeros() -> None:
    svg = metrics.bar_chart("<&>", ['a"<b'], [[Series("x & y", (0,))], [Series("z", (3,))]])
    assert texts(svg) == ["<&>", "z", "0", "1", "2", "3", "4", "5", "0", "3", 'a"<b']
    assert metrics.bar_chart("none", [], []).count("<rect") == 0
