"""``jacaros world``: checks, pictures, new world files and exported maps."""

import re
import sys
from pathlib import Path
from xml.etree import ElementTree

import pytest
from command_lab import Outcome

from jacaros.robots.world.files.world import load_world, shipped_worlds, world_problems

COMMAND = ("world",)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_check_reports_all_mistakes_in_all_worlds(folder: Path, outcome: Outcome) -> None:
    Path("bad.yaml").write_text("wals: []\nrobots: [{nam: a}]\n")
    assert outcome("check", "house", "bad.yaml", "huose", "three_robots") == (
        1,
        (
            "house: 4.4 x 4.4 m, 4 rooms, 24 walls, 0 doors, 1 dock, 1 robot\n"
            "bad.yaml:1:1: error: a world has no key 'wals'\n"
            "    1 | wals: []\n"
            "        ^\n"
            "  = help: did you mean `walls`?\n"
            "bad.yaml:2:11: error: item 1 of 'robots' has no key 'nam'\n"
            "    2 | robots: [{nam: a}]\n"
            "                  ^\n"
            "  = help: did you mean `name`?\n"
            "error: world not found: `huose`\n"
            "  = help: did you mean `house`?\n"
            "three robots: 8 x 6 m, 3 rooms, 12 walls, 0 doors, 3 docks, 3 robots\n"
        ),
        "",
    )


def test_shipped_worlds_have_no_mistakes(outcome: Outcome) -> None:
    assert outcome("check", *shipped_worlds())[0] == 0


def test_a_world_is_drawn_as_text_without_a_terminal(outcome: Outcome) -> None:
    code, output, errors = outcome("show", "three_robots")
    assert (code, errors) == (0, "")
    assert output.count("◎") == output.count("→") == 3
    assert output.endswith("3 docks, 3 robots\n")
    assert "\x1b" not in output


def test_a_picture_of_a_world_is_written(folder: Path, outcome: Outcome) -> None:
    assert outcome("show", "house", "--output", "house.svg", "--width", "300") == (
        0,
        "wrote house.svg\n",
        "",
    )
    picture = ElementTree.parse("house.svg").getroot()
    assert picture.get("width") == "300"
    assert "living room" in (folder / "house.svg").read_text()


def test_a_picture_of_a_world_is_written_as_png(folder: Path, outcome: Outcome) -> None:
    assert outcome("show", "house", "--output", "house.png", "--width", "300")[0] == 0
    picture = (folder / "house.png").read_bytes()
    assert picture.startswith(b"\x89PNG")
    assert int.from_bytes(picture[16:20], "big") == 300


def test_a_missing_png_library_suggests_what_to_install(folder: Path, outcome, monkeypatch):
    monkeypatch.setitem(sys.modules, "resvg_py", None)
    code, _, errors = outcome("show", "house", "--output", "house.png")
    assert code == 2
    assert "pip install 'jacaros[maps]', or --output FILE.svg" in errors


def test_a_new_world_is_valid_with_its_comments_enabled(folder: Path, outcome: Outcome) -> None:
    assert outcome("new", "new.yaml")[0] == 0
    first, *lines = Path("new.yaml").read_text().splitlines()
    Path("new.yaml").write_text("\n".join([first, *(re.sub(r"^( *)# ", r"\1", line) for line in lines)]))
    assert outcome("check", "new.yaml")[1].endswith("1 door, 1 dock, 1 robot, 1 person\n")


def test_a_new_world_is_valid_and_never_overwritten(folder: Path, outcome: Outcome) -> None:
    assert outcome("new", 'my "lab".yaml') == (0, 'wrote my "lab".yaml\n', "")
    assert world_problems(Path('my "lab".yaml'))[1] == []
    world = load_world('my "lab".yaml')
    assert (world.name, len(world.rooms), len(world.docks)) == ('my "lab"', 2, 1)
    code, _, errors = outcome("new", 'my "lab".yaml')
    assert code == 2
    assert errors.startswith("error: file exists:")


def test_a_world_survives_export_and_import_as_a_map(folder: Path, outcome: Outcome) -> None:
    assert outcome("export", "house", "h.yaml") == (0, "wrote h.yaml\nwrote h.pgm\n", "")
    (folder / "worlds").mkdir()
    assert outcome("new", "worlds/again.yaml", "--map", "h.yaml")[0] == 0
    world = load_world("worlds/again.yaml")
    assert world.bounds == load_world("house").bounds
    (robot,) = world.robots
    assert (robot.pose.x, robot.pose.y) == (world.docks[0].pose.x, world.docks[0].pose.y)
    assert outcome("export", "worlds/again.yaml", "h.yaml")[0] == 0


def test_an_image_gets_a_map_file(folder: Path, outcome: Outcome) -> None:
    outcome("export", "house", "h.yaml")
    assert outcome("new", "lab.yaml", "--map", "h.pgm", "--resolution", "0.1") == (
        0,
        "wrote lab_map.yaml\nwrote lab.yaml\n",
        "",
    )
    assert load_world("lab.yaml").bounds == (0, 0, 8.8, 8.8)


@pytest.mark.parametrize(
    ("arguments", "code", "told"),
    [
        (
            ("show", "house", "--output", "h.gif"),
            2,
            "expected a file name with the suffix .svg or .png, found `h.gif`",
        ),
        (("show", "house", "--output", "notes.svg"), 2, "`notes.svg` exists and is not a picture"),
        (("show", "nowhere"), 1, "world not found: `nowhere`"),
        (("export", "house", "h.png"), 2, "expected a file name with the suffix .yaml, found `h.png`"),
        (("export", "house", "notes.yaml"), 2, "`notes.yaml` exists and is not a map"),
        (("export", "house", "away/h.yaml"), 2, "folder does not exist: `away`"),
        (("new", "a.txt"), 2, "expected a file name with the suffix .yaml, found `a.txt`"),
        (("new", "away/a.yaml"), 2, "cannot write `away/a.yaml`: No such file or directory"),
        (("new", "a.yaml", "--resolution", "1"), 2, "--resolution needs the image of a map"),
        (
            ("new", "a.yaml", "--map", "broken.yaml"),
            1,
            "broken.yaml:1:1: error: a map lacks the key 'origin'",
        ),
        (("new", "a.yaml", "--map", "missing.yaml"), 1, "missing.yaml:1:1: error: cannot read the file"),
    ],
)
def test_wrong_usage_suggests_a_fix(folder: Path, outcome, arguments: tuple[str, ...], code: int, told: str):
    for name in ("notes.svg", "notes.yaml"):
        Path(name).write_text("my notes")
    Path("broken.yaml").write_text("image: h.pgm\nresolution: 0.1\n")
    found, output, errors = outcome(*arguments)
    assert (found, output) == (code, "")
    assert told in errors
    assert not Path("a.yaml").exists()
