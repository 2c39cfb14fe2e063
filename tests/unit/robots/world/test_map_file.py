"""Maps of map_server as worlds, and worlds as maps."""

import itertools
import math
import random
import sys
from pathlib import Path

import pytest

from jacaros.robots.world import World, WorldError
from jacaros.robots.world.data.grid import Grid
from jacaros.robots.world.data.world import WorldDescription
from jacaros.robots.world.files.map import OccupancyMap, map_of_world, read_map
from jacaros.robots.world.files.world import is_world, load_world, world_problems
from jacaros.runtime.files.maps import GreyImage, ImageError, pgm_bytes, read_image

YAML = "image: m.pgm\nresolution: 0.5\norigin: [-1, -2, 0.0]\n"
ROOM = ["########", "#......#", "#......#", "#..##..#", "#......#", "#......#", "#......#", "########"]
SHADES = {"#": 0, ".": 254, "?": 205}


def image_of(picture: list[str]) -> GreyImage:
    pixels = bytes(SHADES[cell] for row in picture for cell in row)
    return GreyImage(len(picture[0]), len(picture), pixels)


def write_map(folder: Path, picture: list[str] | bytes = ROOM, text: str = YAML) -> Path:
    content = picture if isinstance(picture, bytes) else pgm_bytes(image_of(picture))
    (folder / "m.pgm").write_bytes(content)
    path = folder / "m.yaml"
    path.write_text(text)
    return path


def loaded(path: Path) -> OccupancyMap:
    _, problems, found = read_map(path)
    assert problems == []
    assert found is not None
    return found


def test_the_boundary_of_occupied_cells_is_walls_and_the_cells_are_boxes(tmp_path: Path) -> None:
    found = loaded(write_map(tmp_path, ["....", ".##.", ".#?.", "...."]))
    assert found.bounds == (-1, -2, 1, 0)
    assert [tuple(wall) for wall in found.walls()] == [
        *((-0.5, -1.5, 0.0, -1.5), (0.0, -1.0, 0.5, -1.0), (-0.5, -0.5, 0.5, -0.5)),
        *((-0.5, -1.5, -0.5, -0.5), (0.0, -1.5, 0.0, -1.0), (0.5, -1.0, 0.5, -0.5)),
    ]
    assert [tuple(box) for box in found.boxes()] == [(-0.5, -1.5, 0, -1), (-0.5, -1, 0.5, -0.5)]


def test_boxes_cover_each_occupied_cell_once_and_walls_separate_kinds_of_cells(tmp_path: Path) -> None:
    draw = random.Random("map")
    for _ in range(20):
        width, height = draw.randint(1, 12), draw.randint(1, 12)
        picture = ["".join(draw.choice("##..?") for _ in range(width)) for _ in range(height)]
        found = loaded(write_map(tmp_path, picture))
        covered = [
            sum(box.contains(-1 + (x + 0.5) / 2, -2 + (y + 0.5) / 2) for box in found.boxes())
            for y in range(height)
            for x in range(width)
        ]
        assert covered == [int(cell == "#") for row in reversed(picture) for cell in row]
        length = sum(math.hypot(wall.bx - wall.ax, wall.by - wall.ay) for wall in found.walls())
        padded = ["." * (width + 2), *(f".{row}." for row in picture), "." * (width + 2)]
        columns = ["".join(column) for column in zip(*padded, strict=True)]
        edges = sum(
            (one == "#") != (other == "#")
            for line in padded + columns
            for one, other in itertools.pairwise(line)
        )
        assert length == pytest.approx(edges * 0.5)


@pytest.mark.parametrize(
    ("line", "occupied"),
    [
        ("", {0, 50}),
        ("negate: 1\n", {205, 254, 255, 220}),
        ("negate: true\n", {205, 254, 255, 220}),
        ("occupied_thresh: 0.15\n", {0, 50, 205}),
        ("mode: scale\n", {0, 50}),
        ("mode: raw\n", {100, 90}),
    ],
)
def test_shades_have_the_meaning_of_map_server(tmp_path: Path, line: str, occupied: set[int]) -> None:
    pixels = (
        bytes([0, 50, 205, 254, 255, 220, 100, 90]) if "raw" in line else bytes([0, 50, 205, 254, 255, 220])
    )
    found = loaded(write_map(tmp_path, pgm_bytes(GreyImage(len(pixels), 1, pixels)), YAML + line))
    assert {pixel for pixel, cell in zip(pixels, found.cells, strict=True) if cell == 1} == occupied


def test_images_with_comments_few_shades_and_in_text_are_read(tmp_path: Path) -> None:
    path = tmp_path / "m.pgm"
    for content in (
        b"P5\n# made by slam\n2 # width\n2\n255\n\x00\xff\x10\x20",
        b"P2 2 2 255\n0 255 # white\n16 32\n",
    ):
        path.write_bytes(content)
        assert read_image(path) == GreyImage(2, 2, b"\x00\xff\x10\x20")
    path.write_bytes(b"P5 2 1 1\n\x00\x01")
    assert read_image(path).pixels == b"\x00\xff"


@pytest.mark.parametrize(
    ("text", "image", "wrong"),
    [
        ("resolution: 1\norigin: [0, 0, 0]\nmode: raw\nimage: n.pgm", ROOM, ["4: image not found: "]),
        (
            "image: m.pgm\nmode: fast\norigin: [0, 0, 0]",
            ROOM,
            ["1: lacks the key 'resolution'", "2: 'mode' is 'fast'"],
        ),
        ("image: m.pgm\nresolution: 1", ROOM, ["1: a map lacks the key 'origin'"]),
        ("image: m.pgm\nresolution: 0\norigin: [0, 0]\n", ROOM, ["2: 'resolution' is 0", "3: three numbers"]),
        (YAML.replace("0.0]", "0.3]"), ROOM, ["3: the map is rotated by 0.3 radians"]),
        (YAML + "ocupied_thresh: 1\n", ROOM, ["4: no key 'ocupied_thresh'"]),
        (YAML + "occupied_thresh: 0.1\nfree_thresh: 0.2\n", ROOM, ["5: more than 'occupied_thresh'"]),
        (YAML, b"P5\n4 4\n255\n\x00\x00", ["1: the image ends after 2 of 16 pixels (4 x 4)"]),
        (YAML, b"P5\n4 4\n", ["1: header without largest value"]),
        (YAML, b"P5\n4 0\n255\n", ["1: header without height"]),
        (YAML, b"P5\n1 1\n65535\n\x00\x00", ["1: the image has 16 bits a pixel"]),
        (YAML, b"P2\n1 1\n255\nx", ["1: a pixel is not a non-negative integer"]),
        (YAML, b"P6\n1 1\n255\nxyz", ["1: expected a PGM or PNG image, found something else"]),
        (YAML, b"GIF89a", ["1: expected a PGM or PNG image, found a GIF image"]),
        (YAML, b"", ["1: found something else"]),
    ],
)
def test_all_mistakes_in_a_map_are_reported_with_their_lines(
    tmp_path: Path, text: str, image: list[str] | bytes, wrong: list[str]
) -> None:
    for problem, told in zip(world_problems(write_map(tmp_path, image, text))[1], wrong, strict=True):
        line, _, message = told.partition(": ")
        assert problem.line == int(line)
        assert message in problem.message


def test_a_png_image_needs_pillow(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "PIL.Image", None)
    (problem,) = world_problems(write_map(tmp_path, b"\x89PNG\r\n"))[1]
    assert "Pillow, which reads PNG images, is not installed" in problem.message
    assert problem.help.startswith("pip install 'jacaros[maps]', or magick ")


def test_a_png_image_is_read_with_pillow(tmp_path: Path) -> None:
    pillow = pytest.importorskip("PIL.Image")
    path = tmp_path / "m.pgm"
    pillow.frombytes("L", (2, 2), b"\x00\xff\x10\x20").convert("RGB").save(path, "PNG")
    assert read_image(path) == GreyImage(2, 2, b"\x00\xff\x10\x20")
    path.write_bytes(path.read_bytes()[:40])
    with pytest.raises(ImageError, match="the PNG image is broken"):
        read_image(path)


def test_a_map_is_a_world_with_a_robot_at_a_free_place(tmp_path: Path) -> None:
    path = write_map(tmp_path)
    assert is_world(path)
    world = World.load(path)
    (robot,) = world.robots.values()
    assert min(wall.distance(robot.x, robot.y) for wall in world.segments) > 0.4
    assert world.description.bounds.contains(robot.x, robot.y)
    _, problems, _ = read_map(write_map(tmp_path, ["##", "##"]))
    assert problems == []
    with pytest.raises(WorldError, match="no free place for a robot"):
        World.load(path)


def test_a_world_file_can_use_a_map(tmp_path: Path) -> None:
    write_map(tmp_path)
    text = "map: m.yaml\nwalls:\n  - segment: [[0, 0], [1, 0]]\nrobots:\n  - pose: {x: 0, y: -1}\n"
    path = tmp_path / "office.yaml"
    path.write_text(text)
    world = load_world(str(path))
    assert world.bounds == (-1, -2, 3, 2)
    assert (0, 0, 1, 0) in world.segments
    assert (0.5, 0, 1.5, 0.5) in world.boxes
    path.write_text(text.replace("y: -1", "y: 0.25").replace("x: 0", "x: 1"))
    with pytest.raises(WorldError, match="inside a box"):
        load_world(str(path))
    path.write_text(text.replace("map:", "size: [2, 2]\nmap:"))
    assert load_world(str(path)).bounds == (-1, -1, 1, 1)


def test_mistakes_in_a_map_are_also_reported_in_the_world_file(tmp_path: Path) -> None:
    made = write_map(tmp_path, b"P5 9 9 255 ", YAML.replace("0.5", "-1"))
    path = tmp_path / "office.yaml"
    path.write_text("name: x\nmap: m.yaml\nrobots:\n  - {name: 1}\n")
    problems = world_problems(path)[1]
    assert [(problem.line, problem.message) for problem in problems] == [
        (2, f"{made}:2:13: 'resolution' is -1, but must lie between 0.001 and 10"),
        (2, f"{made}:1:8: image `{tmp_path / 'm.pgm'}`: the image ends after 0 of 81 pixels (9 x 9)"),
        (4, "'name' must be a text, not 1"),
    ]
    path.write_text("name: x\nmap: mm.yaml\nrobots:\n  - {}\n")
    (problem,) = world_problems(path)[1]
    assert (problem.message, problem.help) == (
        f"map not found: `{tmp_path / 'mm.yaml'}`",
        "did you mean `m.yaml`?",
    )


@pytest.mark.parametrize("name", ["house", "two_robots"])
def test_a_world_survives_conversion_to_a_map(tmp_path: Path, name: str) -> None:
    world = load_world(name)
    text, image = map_of_world(world, "m.pgm")
    again = loaded(write_map(tmp_path, image, text))
    made = WorldDescription("again", again.bounds, tuple(again.walls()), tuple(again.boxes()))
    before, after = Grid(world), Grid(made)
    # A wall between two cells makes both of them occupied, so walls may grow by a cell.
    grown, width = 1.5 * before.resolution + 1e-9, before.width
    inner = [row * width + column for row in range(1, before.height - 1) for column in range(1, width - 1)]
    for cell, one, other in zip(inner, before.occupancy(), after.occupancy(), strict=True):
        assert other >= one
        assert other == one or before.clearance[cell] <= grown
