"""One reading of an occupancy grid: by the agents' map, by the page, and of the files that both write."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from jacaros.look.page.graph_scene import map_drawing
from jacaros.robots.map import map_files
from jacaros.robots.map.cells import FREE, OBSTACLE
from jacaros.robots.map.map_files import OccupancyGrid
from jacaros.robots.world import World
from jacaros.robots.world.files.map import map_of_world, read_map
from jacaros.runtime.files import maps

MEANINGS = [
    (-1, None),
    (0, FREE),
    (25, FREE),
    (26, None),
    (51, None),
    (64, None),
    (65, OBSTACLE),
    (100, OBSTACLE),
]
"""As ``map_saver`` of ROS 1 and of Nav2 reads a cell with its defaults."""


def grid(percent: int) -> Any:
    at = SimpleNamespace(x=0.0, y=0.0, z=0.0)
    origin = SimpleNamespace(position=at, orientation=SimpleNamespace(x=0.0, y=0.0, z=0.0, w=1.0))
    info = SimpleNamespace(resolution=0.1, width=3, height=1, origin=origin)
    return SimpleNamespace(info=info, data=[percent] * 3)


@pytest.mark.parametrize(("percent", "meaning"), MEANINGS)
def test_an_agents_map_and_the_page_agree_what_a_cell_is(percent: int, meaning: str | None) -> None:
    assert set(OccupancyGrid.of(grid(percent)).labels(0.1).values()) == ({meaning} if meaning else set())
    drawn = map_drawing(grid(percent))
    assert bool(drawn["walls"]) == bool(drawn["boxes"]) == (meaning == OBSTACLE)


@pytest.mark.parametrize(("percent", "meaning"), MEANINGS[1:])
def test_a_raw_image_is_read_as_a_grid_is(percent: int, meaning: str | None, tmp_path: Path) -> None:
    (tmp_path / "m.pgm").write_bytes(b"P5 1 1 255\n" + bytes([percent]))
    file = tmp_path / "m.yaml"
    file.write_text("image: m.pgm\nresolution: 0.1\norigin: [0, 0, 0]\nmode: raw\n", encoding="utf-8")
    assert set(map_files.load(file).grid.labels(0.1).values()) == ({meaning} if meaning else set())
    _, problems, found = read_map(file)
    assert not problems
    assert found is not None
    assert bool(found.boxes()) == (meaning == OBSTACLE)
    assert found.known_part() == found.bounds
    assert (found.free_place(0.0) is not None) == (meaning == FREE)


def test_both_writers_state_thresholds_with_which_unknown_cells_stay_unknown(tmp_path: Path) -> None:
    map_files.save(tmp_path / "agents.yaml", 0.1, {(0, 0): FREE, (2, 0): OBSTACLE}, {})
    text, _ = map_of_world(World.load("empty").description, "world.pgm")
    written = (tmp_path / "agents.yaml").read_text(encoding="utf-8")
    for key in ("occupied_thresh: 0.65", "free_thresh: 0.196", "mode: trinary", "negate: 0"):
        assert key in text.splitlines()
        assert key in written.splitlines()
    loaded = map_files.load(tmp_path / "agents.yaml").grid
    assert list(loaded.cells) == [maps.FREE, maps.UNKNOWN, maps.OCCUPIED]
