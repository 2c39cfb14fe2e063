"""Maps in map_server's format: saved, loaded, and refused."""

from pathlib import Path

import pytest
from robot_lab import Lab

from jacaros.artifacts import Out, Structure
from jacaros.robots.map.map_files import MapFileError, OccupancyGrid, load, save
from jacaros.robots.map.slam_data import ArtSlamData
from jacaros.robots.plane.pose import ORIGIN, Pose
from jacaros.runtime.files.maps import meanings

LABELS = {(0, 0): "free", (1, 0): "free", (2, 0): "wall", (0, 2): "free"}
"""Three columns and rows; any label that is not free is an obstacle."""


def test_a_map_is_saved_as_map_server_wants_it(tmp_path: Path) -> None:
    save(tmp_path / "new" / "flat.yaml", 0.05, LABELS, {"home": (0, 0), "tom's": (1, 0)})
    text = (tmp_path / "new" / "flat.yaml").read_text(encoding="utf-8")
    assert text == (
        "image: flat.pgm\nmode: trinary\nresolution: 0.05\norigin: [-0.025, -0.025, 0]\nnegate: 0\n"
        "occupied_thresh: 0.65\nfree_thresh: 0.196\nplaces:\n  'home': [0, 0]\n  'tom''s': [0.05, 0]\n"
    )
    image = (tmp_path / "new" / "flat.pgm").read_bytes()
    assert image == b"P5\n3 3\n255\n" + bytes([254, 205, 205, 205, 205, 205, 254, 254, 0])


def test_what_was_saved_is_loaded(tmp_path: Path) -> None:
    save(tmp_path / "flat.yaml", 0.05, LABELS, {"tom's": (1, 0)})
    saved = load(tmp_path / "flat.yaml")
    assert saved.grid.labels(0.05) == {**LABELS, (2, 0): "obstacle"}
    assert saved.places == {"tom's": (0.05, 0.0)}


def test_the_map_of_another_tool_is_read(tmp_path: Path) -> None:
    (tmp_path / "room.pgm").write_bytes(b"P5 # by another tool\n2 # wide\n1\n100\n" + bytes([100, 0]))
    (tmp_path / "room.yaml").write_text(
        "image: room.pgm\nresolution: 1\norigin: [2.0, 3.0, 0.0]\nnegate: 1\noccupied_thresh: 0.65\nfree_thresh: 0.2\n",
        encoding="utf-8",
    )
    assert load(tmp_path / "room.yaml").grid == OccupancyGrid(1.0, 2, Pose(2.0, 3.0, 0.0), meanings([100, 0]))


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("image: room.pgm\n", "lacks the key 'resolution'"),
        ("image: room.pgm\nresolution: 0\norigin: [0, 0]\n", "'origin' must be three numbers"),
        (
            "image: room.pgm\nresolution: 1\norigin: [0, 0, 0]\nocupied_thresh: 1\n",
            "did you mean `occupied_thresh`",
        ),
        ("image: none.pgm\nresolution: 1\norigin: [0, 0, 0]\n", "none.pgm"),
        (
            "image: short.pgm\nresolution: 1\norigin: [0, 0, 0]\n",
            "ends after 3 of 4 pixels (2 x 2); save the map again",
        ),
    ],
)
def test_a_map_that_cannot_be_read_is_refused_with_the_reason(tmp_path: Path, text: str, told: str) -> None:
    (tmp_path / "short.pgm").write_bytes(b"P5\n2 2\n255\nabc")
    (tmp_path / "room.yaml").write_text(text, encoding="utf-8")
    with pytest.raises(MapFileError, match=r"cannot read the map .*room\.yaml") as wrong:
        load(tmp_path / "room.yaml")
    assert told in str(wrong.value)


def test_cells_of_another_size_are_obstacles_if_some_of_them_is() -> None:
    cells = meanings([0, 0, 100, 0, 0, -1, 50, 0])
    assert OccupancyGrid(0.5, 4, Pose(-0.5, -0.5, 0.0), cells).labels(1.0) == {
        (0, 0): "free",
        (1, 0): "obstacle",
    }
    turned = OccupancyGrid(1.0, 2, Pose(0.5, -0.5, 1.5707963267948966), meanings([0, 100]))
    assert turned.labels(1.0) == {(0, 0): "free", (0, 1): "obstacle"}
    assert OccupancyGrid(1.0, 1, ORIGIN, b"").labels(1.0) == {}


async def test_an_agent_saves_its_map_and_another_loads_it(lab: Lab, tmp_path: Path) -> None:
    file = str(tmp_path / "map.yaml")
    first = await lab.make(ArtSlamData)
    for x, word in enumerate(["home", "free", "unknown", "obstacle"]):
        await lab.do(first, "updateSlamData", x, 0, word)
    await lab.do(first, "saveMap", file)
    second = await lab.make(ArtSlamData, Structure("obstacle", ("wall",)))
    watcher = lab.watch(second)
    await lab.do(second, "updateSlamData", 9, 0, "free")
    await lab.do(second, "loadMap", file)
    assert ("home", 0, 0) in watcher.holds("pos2d")
    out = Out()
    for x, word in enumerate(["home", "free", "unknown", "wall"]):
        await lab.do(second, "getSlamData", x, 0, out)
        assert out.value == word
    await lab.do(second, "getSlamData", 9, 0, out)
    assert out.value == "unknown"


async def test_files_that_cannot_be_written_or_read_fail_with_a_reason(lab: Lab, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("", encoding="utf-8")
    artifact = await lab.make(ArtSlamData, Structure("cell_size", (0.5,)))
    other = await lab.make(ArtSlamData)
    run = await lab.call(artifact, "saveMap", str(tmp_path / "file" / "map.yaml"))
    assert run.reason.startswith("map_file(")
    missing = str(tmp_path / "none.yaml")
    assert (await lab.call(artifact, "loadMap", missing)).reason == f'map_file("{missing}")'
    await lab.do(other, "saveMap", str(tmp_path / "map.yaml"))
    run = await lab.call(artifact, "loadMap", str(tmp_path / "map.yaml"))
    assert "the cells of" in run.message
