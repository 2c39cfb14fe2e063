"""``jacaros world``: pictures and exported maps."""

from pathlib import Path
from xml.etree import ElementTree

import pytest
from command_lab import Outcome

from jacaros.robots.world.files.world import load_world

COMMAND = ("world",)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_a_world_is_drawn_as_text_without_a_terminal(outcome: Outcome) -> None:
    code, output, errors = outcome("show", "three_robots")
    assert (code, errors) == (0, "")
    assert output.count("◎") == output.count("→") == 3
    assert output.endswith("3 docks, 3 robots\n")
    assert "\x1b" not in output


def test_a_picture_of_a_world_is_written(folder: Path, outcome: Outcome) -> None:
    assert outcome("show", "house", "--output", "house.svg") == (
        0,
        "wrote house.svg\n",
        "",
    )
    picture = ElementTree.parse("house.svg").getroot()
    assert picture.get("width") == "640"
    assert "living room" in (folder / "house.svg").read_text()


def test_an_exported_world_is_a_world(folder: Path, outcome: Outcome) -> None:
    assert outcome("export", "house", "h.yaml") == (0, "wrote h.yaml\nwrote h.pgm\n", "")
    assert load_world("h.yaml").bounds == load_world("house").bounds
    assert outcome("export", "h.yaml", "h.yaml")[0] == 0


@pytest.mark.parametrize(
    ("arguments", "code", "told"),
    [
        (
            ("show", "house", "--output", "h.gif"),
            2,
            "expected a file name with the suffix .svg, found `h.gif`",
        ),
        (("show", "house", "--output", "notes.svg"), 2, "`notes.svg` exists and is not a picture"),
        (("show", "nowhere"), 1, "world not found: `nowhere`"),
        (("export", "house", "h.png"), 2, "expected a file name with the suffix .yaml, found `h.png`"),
        (("export", "house", "notes.yaml"), 2, "`notes.yaml` exists and is not a map"),
        (("export", "house", "away/h.yaml"), 2, "folder does not exist: `away`"),
    ],
)
def test_wrong_usage_suggests_a_fix(folder: Path, outcome, arguments: tuple[str, ...], code: int, told: str):
    for name in ("notes.svg", "notes.yaml"):
        Path(name).write_text("my notes")
    found, output, errors = outcome(*arguments)
    assert (found, output) == (code, "")
    assert told in errors
